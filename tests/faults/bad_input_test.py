"""Wrong input: one clear error on stderr, exit code 2, and nothing has been created."""

import json
import pathlib
import shutil
import socket
import tempfile
import unittest

from cuscus_run import Run, cuscus
from fault_support import Traces, check_next_run, private_registry, registry_entries, small_fleet


def setUpModule():
    private_registry()


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class BadInput(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="cuscus-bad-"))
        self.addCleanup(shutil.rmtree, self.folder, True)

    def file(self, content, name="bad.json"):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else
                         json.dumps(content).encode())
        return path

    def refused(self, *arguments, says, lines=1):
        """Every pattern of `says` is in the one error."""
        before = sorted(path.name for path in self.folder.iterdir())
        done = cuscus(*arguments, cwd=self.folder)
        self.assertEqual(done.returncode, 2, done)
        self.assertEqual(done.stdout, "")
        self.assertEqual(len(done.stderr.strip().splitlines()), lines, done.stderr)
        for pattern in says:
            self.assertRegex(done.stderr, pattern)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), before)
        self.assertEqual(registry_entries(), [])

    def scenario_refused(self, change, *says, commands=("check", "run")):
        scenario = small_fleet()
        change(scenario)
        for command in commands:
            with self.subTest(command=command):
                self.refused(command, self.file(scenario), says=(r"bad\.json", *says))

    def test_values(self):
        def put(key, value):
            return lambda scenario: scenario["fleet"][0].update({key: value})
        self.scenario_refused(put("commnd", 1), "/fleet/0/commnd", 'did you mean "command"')
        self.scenario_refused(put("count", 0), "/fleet/0/count", r"\b0\b", r"1 \.\.\. 1000")
        self.scenario_refused(put("count", 5000), "/fleet/0/count", "5000", r"1 \.\.\. 1000")
        self.scenario_refused(lambda scenario: scenario.update(duration="5 kg"), "/duration",
                              "5 kg", "allowed.*ms, s, min")
        self.scenario_refused(lambda scenario: scenario.update(duration=5), "/duration", "unit")
        self.scenario_refused(lambda scenario: scenario.update(fleet=[]), "/fleet")
        # A scenario may be checked where its programs are not.
        self.scenario_refused(put("command", ["./missing"]), "/fleet/0/command/0", "missing",
                              commands=("run",))
        self.scenario_refused(put("command", ["no-such-program"]), "/fleet/0/command/0",
                              "no-such-program", "allowed", commands=("run",))

    def test_command_that_does_not_start(self):
        # Its interpreter is missing, which only the kernel finds out.
        script = self.folder / "script"
        script.write_text("#!/no/such/interpreter\n")
        script.chmod(0o755)
        for on_exit in ("ignore", "mark"):
            scenario = small_fleet("30 s", command=[str(script)], on_exit=on_exit)
            with self.subTest(on_exit=on_exit), Run(scenario, "--no-page") as run:
                self.assertEqual(run.wait(20), 1, run.stderr)
                self.assertRegex(run.summary["end_reason"], "uav. command did not start")

    def test_files(self):
        (self.folder / "folder.json").mkdir()
        for command in ("check", "run"):
            self.refused(command, "missing.json", says=(r"missing\.json", "does not exist"))
            self.refused(command, "folder.json", says=(r"folder\.json", "not a file"))
            self.refused(command, self.file(b"", "empty.json"), says=(r"empty\.json",))
            self.refused(command, self.file(bytes(range(256)) * 50, "garbage.json"),
                         says=(r"garbage\.json",))
            self.refused(command, self.file(b"[" * 5000, "deep.json"), says=(r"deep\.json",))
            self.refused(command, self.file(b'{"name": "a", "name": "b"}', "twice.json"),
                         says=(r"twice\.json", "name"))

    def test_out_exists(self):
        taken = self.folder / "taken"
        taken.mkdir()
        self.refused("run", self.file(small_fleet()), "--no-page", "--out", taken,
                     says=("taken", "exists"))
        self.assertEqual(list(taken.iterdir()), [])

    def test_command_line(self):
        scenario = self.file(small_fleet())
        self.refused("frobnicate", says=("frobnicate", "run, check, air, city, schema"))
        self.refused("run", scenario, "--bogus", says=("--bogus", "--help"), lines=2)
        self.refused("run", says=("SCENARIO", "--help"), lines=2)
        self.refused(says=("subcommand", "--help"), lines=2)
        self.refused("run", scenario, "--set", "nothing", says=("--set nothing", "PATH=VALUE"))
        self.refused("run", scenario, "--set", "fleet.7.count=1", says=("fleet.7.count", "allowed"))

    def test_no_run_is_alive(self):
        self.refused("exec", "uav0", "--", "true", says=("no run is alive",))
        self.refused("stop", says=("no run is alive",))
        self.refused("stop", "some-run", says=("no run is alive",))

    def test_unknown_node_or_run(self):
        with Run(small_fleet("60 s"), "--no-page") as run:
            run.until_flying(0.2)
            for arguments, says in (
                    (("exec", "uav9", "--", "true"), ("uav9", "uav0, uav1, uav2, gcs")),
                    (("exec", "--run", "other", "uav0", "--", "true"), ("other", "alive: faults-")),
                    (("stop", "other"), ("other", "alive: faults-"))):
                done = cuscus(*arguments)
                self.assertEqual(done.returncode, 2, done)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                for text in says:
                    self.assertIn(text, done.stderr)
            run.interrupt()
            self.assertEqual(run.wait(), 130)

    def test_port_taken(self):
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            port = taken.getsockname()[1]
            self.refused("run", self.file(small_fleet()), "--set",
                         f"ground_station.page.port={port}", "--out", "results",
                         says=(rf"127\.0\.0\.1:{port}", "--no-page"))

    def test_two_runs_side_by_side(self):
        port = free_port()
        same_port = ("--set", f"ground_station.page.port={port}")
        traces = Traces()
        with Run(small_fleet("4 s"), *same_port) as first:
            first.until_flying(0.2)
            self.check_second_refused(same_port, port)
            with Run(small_fleet("2 s"), "--no-page") as second:
                second.until_flying(0.2)
                listed = json.loads(cuscus("ps", "--json").stdout)
                self.assertEqual({run["pid"] for run in listed},
                                 {first.process.pid, second.process.pid})
                several = cuscus("stop")
                self.assertEqual(several.returncode, 2)
                self.assertIn("several runs are alive", several.stderr)
                traces.note(first)
                traces.note(second)
                for run in (second, first):
                    self.assertIn(run.wait(30), (0, 3), run.stderr)
                    self.assertEqual(run.summary["end_reason"], "duration reached")
                    for node in run.summary["nodes"]:
                        self.assertGreater(node["radio"]["received"], 0)
                        for program in node["programs"]:
                            self.assertEqual(program["exit_code"], 0)
                traces.check_gone(self, second)
            traces.check_gone(self, first)
        check_next_run(self)

    def check_second_refused(self, options, port):
        entries = registry_entries()
        out = self.folder / "second"
        done = cuscus("run", self.file(small_fleet()), *options, "--out", out)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn(f"127.0.0.1:{port}", done.stderr)
        self.assertFalse(out.exists())
        self.assertEqual(registry_entries(), entries)


if __name__ == "__main__":
    unittest.main()
