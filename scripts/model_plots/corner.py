"""Plots of a street corner: one UAV hovers in an avenue, the other flies out of its sight.

As in tests/e2e/corner_test.py and tests/validation/netsim/street_corner_test.cc: 0 dBm, 10 m above the
ground, the one 60 m from the crossing.
"""

import math
import pathlib
import subprocess
import sys
import tempfile

from . import theory
from .runs import BIN, walk

TX_DBM = 0.0
NOISE_DBM = -93.97
NEEDED_SNR_DB = 2.0  # of a ping at 6 Mb/s
STEP_M = 0.25


def received(map_file, legs):
    """Rows of all curves along the legs; x is 0 at the crossing, where the second one begins."""
    standing, begin, crossing, end = legs
    before_m = math.dist(begin, crossing)
    options = ("--model", "friis", "--city", map_file)
    rows = [(row["way_m"] - before_m, row)
            for row in walk(standing, begin, crossing, STEP_M, *options)]
    rows += [(row["way_m"], row) for row in walk(standing, crossing, end, STEP_M, *options)]
    for x_m, row in rows:
        walls_db = row["outer_walls_db"] + row["inner_walls_db"]
        by_hand_db = (theory.free_space_db(row["distance_m"]) + walls_db + row["diffraction_db"] +
                      row["foliage_db"])
        for curve, loss_db in (("free space", row["basic_db"]),
                               ("through the walls alone", row["basic_db"] + walls_db),
                               ("received", row["loss_db"])):
            yield {"curve": curve, "way_m": x_m, "here": TX_DBM - loss_db,
                   "expected": TX_DBM - by_hand_db
                   if curve == "received" and x_m % 2 == 0 else ""}
        yield {"curve": "needed for ping", "way_m": x_m, "here": NOISE_DBM + NEEDED_SNR_DB,
               "expected": ""}


def street_corner():
    """In a generated grid."""
    with tempfile.TemporaryDirectory() as scratch:
        grid = pathlib.Path(scratch) / "grid.osm"
        done = subprocess.run([BIN / "cuscus", "city", "generate", "grid", "--seed", "1", "--out", grid],
                              capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"model-plots: cuscus city generate failed:\n{done.stderr}")
        yield from received(grid, ((0, -60, 10), (0, -30, 10), (0, 0, 10), (45, 0, 10)))


def manhattan_corner(map_file):
    """Sixth Avenue and a street south of Bryant Park, in a map around 40.752097, -73.984991."""
    yield from received(map_file, ((-71.7, 40.1, 10), (-57.7, 66.6, 10), (-43.7, 93.1, 10),
                                         (-4.1, 71.7, 10)))
