"""Plots of the channel: what cuscus-channel prints along a walk, against closed forms.

A row has a curve's name, x, `here`, and `expected` where there is something to compare with.
"""

import math

from . import theory
from .runs import walk

FAR = 10_000


def spread(rows, x, count):
    """About `count` rows, evenly spaced on a logarithmic x."""
    next_x = 0.0
    ratio = (rows[-1][x] / rows[0][x])**(1 / count)
    for row in rows:
        if row[x] >= next_x:
            next_x = row[x] * ratio
            yield row


def path_loss():
    """Basic models between two nodes 10 m above the ground; two_ray() has lobes of its own."""
    models = (("friis", ()), ("log-distance: n = 3", ("--exponent", 3)),
              ("paper-eq1: α = 30", ("--alpha", 30)), ("p1411: middle", ()),
              ("al-hourani: urban mean", ("--line-of-sight", "mean")),
              ("tr36777: UMa-AV mean", ("--line-of-sight", "mean")))
    for curve, options in models:
        rows = walk((0, 0, 10), (10, 0, 10), (FAR, 0, 10), 1, "--model", curve.split(":")[0],
                    *options)
        for row in spread(rows, "distance_m", 250):
            yield {"curve": curve, "distance_m": row["distance_m"], "here": row["basic_db"]}


def two_ray():
    """Excess over free space between nodes at one height."""
    for curve, height_m, options in (("10 m: medium dry", 10, ()),
                                     ("10 m: rough by 0.3 m", 10, ("--roughness", 0.3)),
                                     ("1.5 m: medium dry", 1.5, ())):
        rows = walk((0, 0, height_m), (100, 0, height_m), (5000, 0, height_m), 1,
                    "--model", "two-ray", *options)
        for row in spread(rows, "distance_m", 800):
            yield {"curve": curve, "distance_m": row["distance_m"],
                   "here": row["basic_db"] - theory.free_space_db(row["distance_m"])}


def p1411():
    """The bounds at 10 m and 1.5 m above the street, with free space."""
    for bound in ("lower", "middle", "upper"):
        rows = walk((0, 0, 10), (10, 0, 1.5), (5000, 0, 1.5), 1, "--model", "p1411", "--bound",
                    bound)
        for row in spread(rows, "distance_m", 200):
            yield {"curve": f"{bound} bound" if bound != "middle" else bound,
                   "distance_m": row["distance_m"], "here": row["basic_db"]}
    for row in spread(rows, "distance_m", 100):
        yield {"curve": "free space", "distance_m": row["distance_m"],
               "here": theory.free_space_db(row["distance_m"])}


def al_hourani():
    """Mean excess over free space by elevation, from a node on the ground 300 m away."""
    # eta and the sigmoid, from the sources named at AlHourani
    environments = {"suburban": (4.88, 0.43, 0.1, 21), "urban": (9.61, 0.16, 1, 20),
                    "dense-urban": (12.08, 0.11, 1.6, 23), "high-rise": (27.23, 0.08, 2.3, 34)}
    for environment, (a, b, in_sight_db, hidden_db) in environments.items():
        latest = -1.0
        for row in walk((0, 0, 0), (300, 0, 0), (300, 0, 17_000), 5, "--model", "al-hourani",
                        "--environment", environment, "--line-of-sight", "mean"):
            elevation = math.degrees(math.atan2(row["z_m"], 300))
            if elevation < latest + 0.5:
                continue
            expected = ""
            if int(elevation / 5) != int(latest / 5):
                sight = 1 / (1 + a * math.exp(-b * (elevation - a)))
                expected = sight * in_sight_db + (1 - sight) * hidden_db
            latest = elevation
            yield {"curve": environment, "elevation_deg": elevation,
                   "here": row["basic_db"] - theory.free_space_db(row["distance_m"]),
                   "expected": expected}


def tr36777():
    """Mean excess over free space at a horizontal distance of 500 m, by the UAV's height."""
    for area, mast_m in (("RMa-AV", 35), ("UMa-AV", 25), ("UMi-AV", 10)):
        for row in walk((0, 0, mast_m), (500, 0, 1), (500, 0, 300), 1, "--model", "tr36777",
                        "--area", area, "--line-of-sight", "mean"):
            if row["z_m"] > mast_m:
                yield {"curve": f"{area}: mast of {mast_m} m", "height_m": row["z_m"],
                       "here": row["basic_db"] - theory.free_space_db(row["distance_m"])}


def knife_edge():
    """Up behind a wide wall 20 m high, 50 m from either end: only the roof's edge matters."""
    for row in walk((-50, 0, 20), (50, 0, 0), (50, 0, 40), 0.1, "--model", "friis", "--box",
                    "0,0,0.02,4000,20,300"):
        edge_m = 20 - (20 + row["z_m"]) / 2
        obstacles = row["outer_walls_db"] + row["diffraction_db"]
        step = round(row["way_m"] / 0.1)
        yield {"curve": "behind the wall", "height_m": row["z_m"], "here": obstacles,
               "expected": theory.knife_edge_db(theory.fresnel_parameter(edge_m, 50, 50))
               if step % 12 == 0 else ""}


def box_corner():
    """Past a stone building 30 m long, 20 m wide, 15 m high: who stands is on the other side."""
    for row in walk((0, -60, 1.5), (-10, 40, 1.5), (60, 40, 1.5), 0.1, "--model", "friis", "--box",
                    "0,0,30,20,15,12"):
        for curve, loss_db in (("walls crossed", row["outer_walls_db"]),
                               ("diffraction", row["diffraction_db"]),
                               ("sum", row["outer_walls_db"] + row["diffraction_db"])):
            yield {"curve": curve, "x_m": row["x_m"], "here": loss_db}


def shadowing_correlation():
    """Of shadowing of 6 dB over the way of one end, over 8000 fields."""
    for decorrelation_m in (10, 20, 50):
        sums = {}
        fields = {}
        for row in walk((0, 0, 10), (100, 0, 10), (180, 0, 10), 4, "--shadowing", 6,
                        "--decorrelation", decorrelation_m, "--seeds", 8000):
            first = fields.setdefault(row["seed"], row["shadowing_db"])
            both = sums.setdefault(row["way_m"], [0.0, 0.0])
            both[0] += first * row["shadowing_db"]
            both[1] += row["shadowing_db"]**2
        for way_m, (product, square) in sums.items():
            yield {"curve": f"{decorrelation_m} m", "way_m": way_m,
                   "here": product / math.sqrt(sums[0][1] * square),
                   "expected": math.exp(-way_m / decorrelation_m) if way_m % 8 == 0 else ""}


def tracks(step_m, length_m, seeds, k_db=None):
    """Powers along a straight way, of independent links; the rest of the world stands still."""
    options = ["--fading", "rice", "--residual-doppler", 0, "--seeds", seeds]
    options += [] if k_db is None else ["--k-factor", k_db]
    powers = {}
    for row in walk((-200, 0, 10), (0, 0, 10), (length_m * 0.8, length_m * 0.6, 10), step_m,
                    *options):
        powers.setdefault(row["seed"], []).append(10**(-row["fading_db"] / 10))
    return list(powers.values())


def fading_distribution():
    """Of the power, along 400 ways of 20 wavelengths."""
    for curve, k_db in (("Rayleigh", None), ("Rice: K = 3 dB", 3), ("Rice: K = 10 dB", 10)):
        k = 0.0 if k_db is None else 10**(k_db / 10)
        samples = sorted(power for track in tracks(theory.WAVELENGTH_M / 5,
                                                   20 * theory.WAVELENGTH_M, 400, k_db)
                         for power in track)
        place = 0
        for level in range(-30, 9):
            while place < len(samples) and samples[place] < 10**(level / 10):
                place += 1
            theoretical = theory.rice_probability_below(10**(level / 10), k)
            yield {"curve": curve, "power_db": level, "here": place / len(samples) or "",
                   "expected": theoretical if level % 2 == 0 and theoretical > 1e-5 else ""}


def fading_correlation():
    """Of the power of a node that moves, with Rayleigh fading."""
    step_m = theory.WAVELENGTH_M / 40
    lags = 81
    products, total, count = [0.0] * lags, 0.0, 0
    for track in tracks(step_m, 20 * theory.WAVELENGTH_M, 400):
        for start in range(0, len(track) - lags, 7):
            for lag in range(lags):
                products[lag] += track[start] * track[start + lag]
            total += track[start]
            count += 1
    mean = total / count
    variance = products[0] / count - mean**2
    for lag in range(lags):
        # The waves' own J0 is averaged over elevations of +-20 degrees; of 16 waves of equal power the squares are
        # correlated as (J0^2 - 1/16) / (1 - 1/16).
        angle = 2 * math.pi * lag / 40
        field = sum(theory.bessel_j0(angle * math.cos(math.radians(-19 + 2 * i)))
                    for i in range(20)) / 20
        yield {"curve": "sum of 16 waves", "wavelengths": lag / 40,
               "here": (products[lag] / count - mean**2) / variance,
               "expected": (field**2 - 1 / 16) / (1 - 1 / 16) if lag % 2 == 0 else "",
               "analysis": theory.bessel_j0(angle)**2}


def fading_crossings():
    """Upward crossings per wavelength that a node moves, with Rayleigh fading."""
    all_tracks = tracks(theory.WAVELENGTH_M / 100, 20 * theory.WAVELENGTH_M, 400)
    for level_db in range(-30, 9):
        level = 10**(level_db / 10)
        crossings = sum(before < level <= after for track in all_tracks
                        for before, after in zip(track, track[1:]))
        yield {"curve": "sum of 16 waves", "level_db": level_db,
               "here": crossings / (20 * len(all_tracks)) or "",
               "expected": theory.crossings_per_wavelength(math.sqrt(level))}


def dipole():
    """Gain over elevation of upright half-wave dipoles, half of both ends'."""
    latest = -1.0
    rows = walk((0, 0, 0), (100, 0, 0), (100, 0, 10_000), 0.5, "--antenna", "dipole")
    for row in rows:
        elevation = math.degrees(math.atan2(row["z_m"], 100))
        if elevation < latest + 0.25:
            continue
        expected = (theory.dipole_dbi(elevation)
                    if int(elevation / 5) != int(latest / 5) else "")
        latest = elevation
        yield {"curve": "half-wave dipole", "elevation_deg": elevation,
               "here": row["antennas_db"] / 2, "expected": expected}
