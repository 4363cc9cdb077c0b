"""Fleets in the shipped cities, flown as a user flies them."""

import csv
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

CUSCUS = pathlib.Path(os.environ["CUSCUS_BIN"]) / "cuscus"
SCENARIOS = pathlib.Path(os.environ["CUSCUS_SOURCE"]) / "scenarios"
FLIGHT_S = 25


class CityFlight(unittest.TestCase):
    def fly(self, name):
        """The run's summary, and the last height of every UAV."""
        with tempfile.TemporaryDirectory() as scratch:
            out = pathlib.Path(scratch) / "results"
            done = subprocess.run(
                [CUSCUS, "run", SCENARIOS / f"{name}.json", "--duration", f"{FLIGHT_S}s",
                 "--no-page", "--out", out], capture_output=True, text=True, check=False)
            self.assertIn(done.returncode, (0, 3), done.stderr)  # 3: the host was too slow
            self.assertIn("buildings up to", done.stderr)
            self.assertTrue((out / "city.pb").exists())
            heights_m = {}
            with open(out / "metrics.csv", newline="") as file:
                for row in csv.DictReader(file):
                    heights_m[row["node"]] = float(row["z_m"])
            return json.loads((out / "summary.json").read_text()), heights_m

    def check_flight(self, name, low_m, high_m):
        summary, heights_m = self.fly(name)
        nodes = [node for node in summary["nodes"] if node["name"] != "gcs"]
        self.assertEqual(len(nodes), 10)
        for node in nodes:
            expected_m = low_m if node["name"].startswith("low") else high_m
            self.assertAlmostEqual(heights_m[node["name"]], expected_m, delta=1.5, msg=node)
            self.assertEqual(node["collisions"]["contacts"], 0, node)

    def test_ten_fly_on_the_square_and_above_the_roofs_of_an_old_town(self):
        self.check_flight("old-town", 5.0, 35.0)

    def test_ten_fly_between_and_above_the_towers_of_a_grid(self):
        self.check_flight("grid", 5.0, 163.0)


if __name__ == "__main__":
    unittest.main()
