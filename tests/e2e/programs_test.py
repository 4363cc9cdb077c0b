"""Unmodified programs between flying UAVs: iperf3, ping and a Python script."""

import json
import os
import pathlib
import re
import shutil
import tempfile
import unittest

from cuscus_run import SOURCE, Run

DURATION_S = 25


def flying_pair(command0, command1, attach="bridge", **group):
    """Two UAVs on a circle of 20 m, each with a program beside the autopilot."""
    mission = {"type": "circle", "radius": "20 m", "altitude": "10 m", "speed": "2 m/s"}

    def uav(name, angle, command):
        # Formations of their own, so that each has its own program.
        return {"name": name, "vehicle": {"model": "x4"}, "mission": mission,
                "start": {"layout": "list", "positions": [[f"{20 * angle} m", "0 m", "0 m"]]},
                "command": command, "on_exit": "fail", **group}
    return {
        "name": "programs", "duration": f"{DURATION_S} s",
        "network": {"attach": attach},
        "radio": {"data_rate": "54 Mb/s", "group_rate": "6 Mb/s"},
        "fleet": [uav("left", -1, command0), uav("right", 1, command1)],
        "ground_station": {"enabled": False},
    }


class Programs(unittest.TestCase):
    def check_flight(self, run):
        code = run.wait()
        # A host that was too slow has said so; the flight and the traffic are judged below.
        self.assertEqual(code, 3 if run.fidelity["verdict"] == "INVALID" else 0, run.stderr)
        last = [row for row in run.metrics() if row["sim_time_s"] > DURATION_S - 1]
        self.assertTrue(last)
        for row in last:
            self.assertEqual(row["flight_state"], "flying")
            self.assertAlmostEqual(row["z_m"], 10.0, delta=0.5)

    def test_ping(self):
        for attach in ("bridge", "direct"):
            with self.subTest(attach=attach):
                scenario = flying_pair(["ping", "-n", "-c", "100", "-i", "0.2", "{ip:right0}"],
                                       ["sleep", "1000"], attach, capabilities=["cap_net_raw"])
                with Run(scenario, "--no-page") as run:
                    self.check_flight(run)
                    output = run.log("left0-command.log")
                    found = re.search(r"(\d+) received, .*= [\d.]+/([\d.]+)/", output, re.S)
                    self.assertTrue(found, output)
                    self.assertGreaterEqual(int(found[1]), 99)
                    # The air alone takes 236 us at 54 Mb/s; a busy host adds to it.
                    self.assertGreater(float(found[2]), 0.236)

    def test_iperf3(self):
        self.assertTrue(shutil.which("iperf3"))
        scenario = flying_pair(
            ["sh", "-c", "sleep 8; exec iperf3 --client {ip:right0} --udp --bitrate 30M "
                         "--length 1400 --time 10 --json"],
            ["iperf3", "--server", "--one-off"])
        with Run(scenario, "--no-page") as run:
            self.check_flight(run)
            report = json.loads(run.log("left0-command.log"))
            received = report["end"]["sum"]
            rate = received["bits_per_second"] * (1 - received["lost_percent"] / 100) / 1e6
            # 54 Mb/s with a slot of 20 us carries 24.1 Mb/s of IP packets of 1500 B (formula of
            # docs/models/mac.md); of 1400 B datagrams with beacons beside them somewhat less.
            self.assertGreater(rate, 18.0)
            self.assertLess(rate, 24.1)

    def test_python_script(self):
        # A copy that every uid can read, wherever the sources are.
        folder = pathlib.Path(tempfile.mkdtemp(prefix="cuscus-programs-"))
        self.addCleanup(shutil.rmtree, folder, True)
        folder.chmod(0o755)
        script = shutil.copy(SOURCE / "tests" / "e2e" / "udp_echo.py", folder)
        os.chmod(script, 0o644)
        scenario = flying_pair(["/usr/bin/python3", str(script), "ask", "{ip:right0}", "100"],
                               ["/usr/bin/python3", str(script), "serve"])
        with Run(scenario, "--no-page") as run:
            self.check_flight(run)
            found = re.search(r"answered (\d+) of 100", run.log("left0-command.log"))
            self.assertTrue(found, run.log("left0-command.log"))
            self.assertGreaterEqual(int(found[1]), 98)


if __name__ == "__main__":
    unittest.main()
