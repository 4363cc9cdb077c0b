"""What the programs of this build say, and the reference curves of tests/validation."""

import csv
import io
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BIN = pathlib.Path(os.environ.get("CUSCUS_BIN", ROOT / "build/release/bin"))
REFERENCE = ROOT / "tests" / "validation" / "netsim" / "ns3-3.37"


def table(program, *options):
    """The rows that a program prints."""
    done = subprocess.run([BIN / program, *map(str, options)], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"model-plots: {program} failed:\n{done.stderr}")
    return list(csv.DictReader(io.StringIO(done.stdout)))


def air(*options):
    """One line of cuscus-air's table."""
    return table("cuscus-air", *options)[0]


def scenario_air(path, *options):
    """One line of the table of `cuscus air`."""
    return table("cuscus", "air", path, *options)[0]


def walk(standing, begin, end, step_m, *options):
    """The rows of cuscus-channel, as numbers."""
    places = [f"--{name}=" + ",".join(map(str, place))
              for name, place in (("standing", standing), ("from", begin), ("to", end))]
    return [{key: float(value) for key, value in row.items()}
            for row in table("cuscus-channel", *places, "--step", step_m, *options)]


def reference(name):
    """Rows of a reference file; of columns with one name the first counts."""
    with open(REFERENCE / name) as file:
        lines = list(csv.reader(file))
    return [dict(reversed(list(zip(lines[0], row)))) for row in lines[1:]]


def rates(mbps):
    return ("--rate", mbps, "--group-rate", mbps)
