"""A program on the SDK asks its radio whom it hears, and gets what the channel gives."""

import math
import re
import sys
import unittest

from cuscus_run import BIN, SOURCE, Run

SENDER = SOURCE / "tests" / "e2e" / "steady_sender.py"
NOISE_DBM = -93.97    # k 290 K 20 MHz and 7 dB
THRESHOLD_DBM = -82   # radio.preamble_detection, at its default


def friis_dbm(distance_m):
    """16 dBm through free space at 2.437 GHz."""
    return 16.0 - 20 * math.log10(4 * math.pi * distance_m * 2.437e9 / 299792458)


class Neighbours(unittest.TestCase):
    def test_a_program_sees_its_neighbours_as_its_radio_hears_them(self):
        listener = {"name": "ear", "agent": [str(BIN / "neighbours-agent")],
                    "start": {"layout": "list", "positions": [["0 m", "0 m", "0 m"]]}}

        def speaker(name, x_m):
            return {"name": name, "vehicle": {"model": "fixed"},
                    "start": {"layout": "list", "positions": [[f"{x_m} m", "0 m", "0 m"]]},
                    "command": [sys.executable, str(SENDER), "{broadcast}", "100", "50"]}
        scenario = {"name": "neighbours", "duration": "8 s", "ground_station": {"enabled": False},
                    "radio": {"group_rate": "12 Mb/s", "propagation": {"model": "friis"}},
                    "fleet": [listener, speaker("near", 40), speaker("next", 100),
                              speaker("far", 5000)]}
        with Run(scenario, "--no-page") as run:
            self.assertIn(run.wait(), (0, 3), run.stderr)
            lines = run.log("ear0-agent.log")
            nodes = {int(node) for node in re.findall(r"neighbour (\d+) ", lines)}
            self.assertEqual(nodes, {1, 2}, lines)  # the one far away is below the threshold
            for node, distance_m in ((1, 40), (2, 100)):
                last = re.findall(rf"neighbour {node} (.*)", lines)[-1].split()
                said = dict(zip(last[::2], map(float, last[1::2])))
                expected_dbm = friis_dbm(distance_m)
                # Positions are right to the centimetre: 0.002 dB at 40 m.
                self.assertAlmostEqual(said["rssi_dbm"], expected_dbm, delta=0.02)
                self.assertAlmostEqual(said["mean_dbm"], expected_dbm, delta=0.02)
                self.assertAlmostEqual(said["snr_db"], expected_dbm - NOISE_DBM, delta=0.03)
                self.assertAlmostEqual(said["budget_db"], expected_dbm - THRESHOLD_DBM, delta=0.02)
                self.assertEqual(said["rate_kbps"], 12000)
                self.assertGreater(said["frames"], 40)
                self.assertLess(said["age_s"], 0.5)

    def test_the_page_shows_what_the_test_runs(self):
        example = (SOURCE / "tests" / "e2e" / "neighbours_agent.cc").read_text()
        function = example[example.index("/// One line per neighbour"):example.index("/// Stands")]
        self.assertIn(function.strip(), (SOURCE / "docs" / "sdk.md").read_text())


if __name__ == "__main__":
    unittest.main()
