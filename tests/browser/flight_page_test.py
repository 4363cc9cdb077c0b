"""The page of a real run in Chromium: ten drones that move, with their table and links."""

import os
import pathlib
import socket
import subprocess
import unittest

from cuscus_run import SCENARIOS, SOURCE, Run


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class FlightPage(unittest.TestCase):
    def test_ten_drones_move_on_the_page(self):
        port = free_port()
        pictures = pathlib.Path(os.environ["CUSCUS_BUILD"]) / "tests" / "browser" / "screenshots"
        pictures.mkdir(parents=True, exist_ok=True)
        with Run(SCENARIOS / "default.json", "--set", f"ground_station.page.port={port}",
                 "--duration", "90s") as run:
            run.until_flying(14.0)
            check = subprocess.run(
                ["node", SOURCE / "tests" / "browser" / "check_page.mjs",
                 "--url", f"http://127.0.0.1:{port}", "--drones", "10", "--trail-s", "5",
                 "--screenshot", pictures / "flight.png"],
                capture_output=True, text=True, timeout=100)
            self.assertEqual(check.returncode, 0, check.stdout + check.stderr)
            run.interrupt()
            self.assertEqual(run.wait(30), 130)


if __name__ == "__main__":
    unittest.main()
