"""Tables into drawings."""

import csv
import subprocess

COLOURS = ("#1b6ca8", "#c8553d", "#3a7d44", "#7b4b94", "#c28f0e", "#2a9d8f", "#555555", "#d1478c")


def curves(rows, x, style):
    """Lines: `here`; points, with intervals where there are any: `expected`; dots: `analysis`.

    Names of curves have no commas, which gnuplot would take for the table's.
    """
    parts = []
    for number, curve in enumerate(dict.fromkeys(row["curve"] for row in rows)):
        colour, dash = style(number)
        select = f"(strcol('curve') eq '{curve}' ? column('{x}') : NaN)"
        parts.append(f"data using {select}:(column('here')) title '{curve}' with lines linewidth 2 "
                     f"dashtype {dash} linecolor '{colour}'")
        if "analysis" in rows[0]:
            parts.append(f"data using {select}:(column('analysis')) notitle with lines linewidth "
                         f"1.5 dashtype '.' linecolor '{colour}'")
        if "expected_ci95" in rows[0]:
            parts.append(f"data using {select}:(column('expected')):(column('expected_ci95')) "
                         f"notitle with yerrorbars pointtype 7 pointsize 0.6 linecolor '{colour}'")
        elif any(row.get("expected", "") != "" for row in rows if row["curve"] == curve):
            parts.append(f"data using {select}:(column('expected')) notitle with points "
                         f"pointtype 7 pointsize 0.6 linecolor '{colour}'")
    return "plot " + ", \\\n  ".join(parts)


def write_table(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows({key: f"{value:.6g}" if isinstance(value, float) else value
                          for key, value in row.items()} for row in rows)


def draw(folder, plot, terminals):
    rows = list(plot.rows())
    write_table(folder / f"{plot.name}.csv", rows)
    for terminal, ending in terminals:
        script = "\n".join((
            "set encoding utf8", f"data = '{plot.name}.csv'",
            f"set terminal {terminal} size 760,440 noenhanced font ',12'",
            f"set output '{plot.name}.{ending}'", "set datafile separator ','",
            "set datafile missing NaN", "set grid linetype 1 linecolor '#dddddd'",
            "set key outside right top", f"set xlabel '{plot.x_label}'",
            f"set ylabel '{plot.y_label}'", *plot.options, curves(rows, plot.x, plot.style), ""))
        subprocess.run(["gnuplot", "-"], input=script, text=True, cwd=folder, check=True)
