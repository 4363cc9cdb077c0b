"""A hostile program on board of one UAV harms no other UAV, and summary.json says what it did."""

import json
import os
import pathlib
import shutil
import socket
import tempfile
import time
import unittest
from unittest import mock

import cuscus_run
import fault_support
from cuscus_run import BIN, Run
from fault_support import Traces, private_registry, small_fleet

HERE = pathlib.Path(__file__).parent
PYTHON = "/usr/bin/python3"
HOSTILE, OTHERS = "uav1", ("uav0", "uav2")
REJECTED = ("rejected_not_finite", "rejected_out_of_range", "rejected_torn")


def setUpModule():
    private_registry()


def with_command(duration, arguments, **group):
    """Three UAVs, of which uav1 runs the command; the others' copies of it end at once."""
    only_there = f'if [ "$CUSCUS_NAME" = {HOSTILE} ]; then exec "$@"; fi'
    return small_fleet(duration, command=["/bin/sh", "-c", only_there, "sh", *map(str, arguments)],
                       **group)


class HostileAgent(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="cuscus-hostile-"))
        self.addCleanup(shutil.rmtree, self.folder, True)
        os.chmod(self.folder, 0o755)

    def script(self, name):
        """A copy that every uid can read."""
        return shutil.copy(HERE / name, self.folder / name)

    def check_others(self, run):
        """They flew as if nothing had been."""
        for name in OTHERS:
            node = run.node(name)
            self.assertEqual(node["programs"][0]["exit_code"], 0, node)
            self.assertIsNone(node["programs"][0]["ended_at_s"])
            self.assertEqual(node["agent"]["failsafes"], 0, node)
            self.assertIn(node["agent"]["final_state"], ("taking-off", "flying"))
            self.assertGreater(node["commands"]["accepted"], 300, node)
            self.assertEqual([node["commands"][key] for key in REJECTED], [0, 0, 0], node)
            self.assertGreater(node["agent"]["beacons_received"], 0)
            last = [row for row in run.metrics() if row["node"] == name][-1]
            self.assertGreater(last["z_m"], 0.5, last)
            self.assertLess(last["formation_error_m"], 5.0, last)

    def programs_with_hostile_agent(self, mode):
        """A folder with this build's programs, in which uav1's agent is the hostile one."""
        bin_folder = self.folder / "bin"
        shutil.copytree(BIN, bin_folder)
        agent = bin_folder / "cuscus-agent"
        agent.rename(bin_folder / "real-agent")
        agent.write_text(f"""#!/bin/sh
if [ "$CUSCUS_NAME" = {HOSTILE} ]; then
  CUSCUS_HOSTILE={mode} exec {bin_folder}/hostile-agent
fi
exec {bin_folder}/real-agent
""")
        agent.chmod(0o755)
        return bin_folder

    def fly_with_hostile_agent(self, mode):
        bin_folder = self.programs_with_hostile_agent(mode)
        traces = Traces()
        with mock.patch.object(cuscus_run, "BIN", bin_folder), \
                mock.patch.object(fault_support, "BIN", bin_folder), \
                Run(small_fleet("5 s"), "--no-page") as run:
            run.until_flying(0.5)
            traces.note(run)
            began = time.monotonic()
            self.assertIn(run.wait(30), (0, 3), run.stderr)
            self.assertLess(time.monotonic() - began, 5 + 5)
            traces.check_gone(self, run)
            self.check_others(run)
            self.assertEqual(run.summary["end_reason"], "duration reached")
            node = run.node(HOSTILE)
            return node, node["programs"][0], run.stderr

    def test_not_a_number(self):
        node, _, _ = self.fly_with_hostile_agent("nan")
        self.assertGreater(node["commands"]["rejected_not_finite"], 1000)
        self.assertEqual(node["commands"]["accepted"], 0)

    def test_out_of_range(self):
        node, _, _ = self.fly_with_hostile_agent("out-of-range")
        self.assertGreater(node["commands"]["rejected_out_of_range"], 1000)
        self.assertEqual(node["commands"]["accepted"], 0)

    def test_random_bytes(self):
        node, _, _ = self.fly_with_hostile_agent("random")
        self.assertGreater(sum(node["commands"][key] for key in REJECTED), 100, node)

    def test_silence(self):
        node, program, _ = self.fly_with_hostile_agent("silence")
        self.assertEqual(node["commands"]["accepted"], 0)
        self.assertIsNone(node["agent"])
        self.assertEqual(program["exit_code"], 0)

    def test_exit_with_0(self):
        _, program, _ = self.fly_with_hostile_agent("exit0")
        self.assertEqual(program["exit_code"], 0)
        self.assertAlmostEqual(program["ended_at_s"], 1.0, delta=0.5)

    def test_exit_with_3(self):
        _, program, stderr = self.fly_with_hostile_agent("exit3")
        self.assertEqual(program["exit_code"], 3)
        self.assertAlmostEqual(program["ended_at_s"], 1.0, delta=0.5)
        self.assertIn("uav1 ended: exit code 3", stderr)

    def test_abort(self):
        _, program, stderr = self.fly_with_hostile_agent("abort")
        self.assertEqual(program["signal"], 6)
        self.assertAlmostEqual(program["ended_at_s"], 1.0, delta=0.5)
        self.assertIn("uav1 ended: signal 6", stderr)

    def test_ignores_stop(self):
        _, program, _ = self.fly_with_hostile_agent("ignore-stop")
        self.assertEqual(program["signal"], 9)

    def test_babble_on_the_control_socket(self):
        self.fly_with_hostile_agent("babble")

    def test_flood_of_heartbeats(self):
        _, program, _ = self.fly_with_hostile_agent("flood")
        self.assertEqual(program["signal"], 9)

    def test_never_ready(self):
        bin_folder = self.programs_with_hostile_agent("deaf")
        traces = Traces()
        with mock.patch.object(cuscus_run, "BIN", bin_folder), \
                mock.patch.object(fault_support, "BIN", bin_folder), \
                Run(small_fleet("5 s"), "--no-page") as run:
            self.assertEqual(run.wait(40), 1, run.stderr)
            traces.check_gone(self, run)
            self.assertIn("in vain for uav1 to be ready", run.summary["end_reason"])
            self.assertEqual(run.fidelity["verdict"], "INVALID")

    def fly_with_command(self, duration, arguments, **group):
        traces = Traces()
        run = Run(with_command(duration, arguments, **group), "--no-page")
        self.addCleanup(run.remove)
        try:
            run.until_flying(0.5)
            traces.note(run)
            began = time.monotonic()
            self.assertIn(run.wait(40), (0, 3), run.stderr)
            self.assertLess(time.monotonic() - began, float(duration.split()[0]) + 5)
            traces.check_gone(self, run)
        except AssertionError:
            print(run.stderr, run.log("uav1-command.log")[-2000:])
            raise
        return run

    def test_flood(self):
        run = self.fly_with_command(
            "8 s", [PYTHON, self.script("flood.py"), "{broadcast}", "{ip:uav0}"])
        self.check_others(run)
        flooder = run.node(HOSTILE)["radio"]
        self.assertGreater(flooder["dropped_queue_full"], 1000, flooder)
        for name in OTHERS:
            self.assertEqual(run.node(name)["radio"]["dropped_queue_full"], 0)
            self.assertGreater(run.node(name)["radio"]["transmissions"], 50)
        lateness = next(check for check in run.fidelity["checks"]
                        if check["name"] == "release_lateness_max")
        self.assertLess(lateness["measured"], 1000.0)

    def test_link_games(self):
        run = self.fly_with_command(
            "6 s", ["/bin/sh", self.script("link_games.sh"), "02:63:75:73:00:01", "{ip:uav0}",
                    "{broadcast}"],
            capabilities=["cap_net_admin", "cap_net_raw"])
        self.assertIn("games over", run.log("uav1-command.log"))
        self.check_others(run)

    def test_stubborn_daemons(self):
        run = self.fly_with_command("5 s", [PYTHON, self.script("stubborn.py")])
        self.assertEqual(run.log("uav1-command.log").count("ready"), 2)
        self.check_others(run)
        self.assertEqual(run.node(HOSTILE)["programs"][1]["signal"], 9)

    def test_log_of_50_megabytes(self):
        run = self.fly_with_command("5 s", ["head", "-c", "50000000", "/dev/zero"])
        self.assertEqual((run.results / "logs/uav1-command.log").stat().st_size, 50_000_000)
        self.check_others(run)

    def test_escapes(self):
        secret = self.folder / "secret"
        secret.touch(0o600)
        abstract = self.folder.name
        with socket.create_server(("127.0.0.1", 0)) as host, \
                socket.socket(socket.AF_UNIX) as host_abstract:
            host_abstract.bind("\0" + abstract)
            host_abstract.listen()
            run = self.fly_with_command(
                "5 s", [PYTHON, self.script("escape_attempts.py"), os.getpid(),
                        host.getsockname()[1], abstract, secret, "{broadcast}"])
        output = run.log("uav1-command.log")
        attempts = json.loads(output.splitlines()[-1])
        self.assertGreaterEqual(len(attempts), 20)
        self.assertEqual([name for name, success in attempts.items() if success],
                         ["use the radio"])
        self.check_others(run)


if __name__ == "__main__":
    unittest.main()
