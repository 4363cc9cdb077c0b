"""The default scenario: ten UAVs form the decagon and hold it, by radio and by motion capture."""

import contextlib
import json
import statistics
import unittest

from cuscus_run import SCENARIOS, Run


class Formation(unittest.TestCase):
    def finish(self, run):
        """Summary and metrics of a run that has been started."""
        self.assertIn(run.wait(), (0, 3), run.stderr)
        return run.summary, run.metrics()

    def median_error(self, rows):
        return statistics.median(row["formation_error_m"] for row in rows
                                 if row["sim_time_s"] >= 30 and row["formation_error_m"] is not None)

    def test_older_knowledge_makes_a_larger_error(self):
        variants = {
            "motion capture": ["--set", "fleet.0.neighbours.source=motion-capture"],
            "beacons, 50 ms": [],
            "beacons, 500 ms": ["--set", "fleet.0.neighbours.beacon_period=500 ms"]}
        medians = {}
        with contextlib.ExitStack() as runs:
            # Side by side: together they need less than one core.
            started = {name: runs.enter_context(Run(SCENARIOS / "default.json", "--no-page", *options))
                       for name, options in variants.items()}
            for name, run in started.items():
                summary, rows = self.finish(run)
                medians[name] = self.median_error(rows)
                self.assertAlmostEqual(medians[name], summary["formation_error"]["p50_m"], delta=0.01)
                print(f"{name}: median formation error {medians[name]:.3f} m, "
                      f"{summary['verdict']}")
        self.assertLess(medians["motion capture"], medians["beacons, 50 ms"])
        self.assertLess(medians["beacons, 50 ms"], medians["beacons, 500 ms"])
        self.assertLess(medians["beacons, 50 ms"], 0.5)

    def test_beacons_travel_by_radio_alone(self):
        # With a transmitter of -50 dBm nobody hears anybody: the UAVs fly, but know of no neighbour.
        with Run(SCENARIOS / "default.json", "--no-page", "--duration", "15s",
                 "--set", "radio.tx_power=-50 dBm") as run:
            summary, _ = self.finish(run)
        for node in summary["nodes"]:
            if node["role"] == "uav":
                self.assertEqual(node["agent"]["beacons_received"], 0, json.dumps(node))
                self.assertGreater(node["agent"]["beacons_sent"], 200)

    def test_without_a_mission_a_uav_waits_on_the_ground(self):
        scenario = {"name": "idle", "duration": "3 s", "fleet": [{"name": "idle", "count": 2}]}
        with Run(scenario, "--no-page") as run:
            self.assertIn(run.wait(), (0, 3), run.stderr)
            rows = [row for row in run.metrics() if row["node"] == "idle1"]
            self.assertGreater(len(rows), 20)
            self.assertTrue(all(row["z_m"] == 0 for row in rows))
            self.assertEqual(rows[-1]["flight_state"], "stopped")


if __name__ == "__main__":
    unittest.main()
