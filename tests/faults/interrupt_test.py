"""Signals to cuscus itself: a run that is ended from outside keeps what it has recorded."""

import fcntl
import os
import signal
import termios
import time
import unittest

from cuscus_run import Run, pause
from fault_support import Traces, check_next_run, check_readable, private_registry, small_fleet


def setUpModule():
    private_registry()


class Interrupt(unittest.TestCase):
    def check_ended(self, run, traces, number, since):
        self.assertEqual(run.wait(15), 128 + number, run.stderr)
        self.assertLess(time.monotonic() - since, 5.0)
        traces.check_gone(self, run)
        check_readable(self, run.results)
        self.assertEqual(run.summary["exit_code"], 128 + number)
        self.assertIn("interrupted", run.summary["end_reason"])
        self.assertIn(run.summary["verdict"], ("VALID", "DEGRADED", "INVALID"))
        self.assertTrue((run.results / "fidelity.json").exists())

    def interrupt_flight(self, number):
        traces = Traces()
        with Run(small_fleet("60 s"), "--no-page") as run:
            run.until_flying(1.0)
            traces.note(run)
            since = time.monotonic()
            run.interrupt(number)
            self.check_ended(run, traces, number, since)
            self.assertLess(1.0, run.summary["simulated_s"])
            self.assertLess(run.summary["simulated_s"], 30.0)
            self.assertGreater(run.metrics()[-1]["sim_time_s"], 0.9)
            # Every program has reported, so the end was graceful.
            for node in run.summary["nodes"]:
                self.assertEqual([program["exit_code"] for program in node["programs"]], [0])
        check_next_run(self)

    def test_sigint(self):
        self.interrupt_flight(signal.SIGINT)

    def test_sigterm(self):
        self.interrupt_flight(signal.SIGTERM)

    def test_sighup(self):
        self.interrupt_flight(signal.SIGHUP)

    def test_reader_of_the_output_leaves(self):
        in_pipe = ("bash", "-o", "pipefail", "-c", '"$@" 2>&1 | head -n 1', "bash")
        with Run(small_fleet("3 s"), "--no-page", prefix=in_pipe) as run:
            self.assertIn(run.wait(30), (0, 3), run.stderr)
            self.assertEqual(len(run.stdout.splitlines()), 1)
            self.assertEqual(run.summary["end_reason"], "duration reached")
            self.assertEqual(run.summary["verdict"], run.fidelity["verdict"])

    def run_on_terminal(self, terminal, **options):
        return Run(small_fleet("3 s" if options else "60 s"), "--no-page", stdin=terminal,
                   stdout=terminal, stderr=terminal,
                   preexec_fn=lambda: fcntl.ioctl(terminal, termios.TIOCSCTTY, 0), **options)

    def test_terminal_is_closed(self):
        traces = Traces()
        user, terminal = os.openpty()
        with self.run_on_terminal(terminal) as run:
            os.close(terminal)
            run.until_flying(0.5)
            traces.note(run)
            since = time.monotonic()
            os.close(user)
            self.check_ended(run, traces, signal.SIGHUP, since)

    def test_terminal_is_closed_under_nohup(self):
        user, terminal = os.openpty()
        with self.run_on_terminal(terminal, prefix=("env", "--ignore-signal=HUP")) as run:
            os.close(terminal)
            run.until_flying(0.5)
            os.close(user)
            self.assertIn(run.wait(30), (0, 3))
            self.assertEqual(run.summary["end_reason"], "duration reached")

    def test_sigint_while_a_hundred_nodes_are_built(self):
        traces = Traces()
        scenario = small_fleet("60 s", 100)
        scenario["fleet"][0]["start"] = {"layout": "grid"}
        scenario["fleet"][0]["mission"] = "none"
        with Run(scenario, "--no-page") as run:
            def some_nodes():
                traces.note(run)
                return 10 <= len(traces.namespaces)
            run.until("ten nodes", some_nodes)
            self.assertFalse((run.results / "metrics.csv").read_text().count("\n") > 1)
            since = time.monotonic()
            run.interrupt()
            self.check_ended(run, traces, signal.SIGINT, since)
            self.assertEqual(run.summary["simulated_s"], 0.0)
        check_next_run(self)

    def test_two_at_once(self):
        traces = Traces()
        with Run(small_fleet("60 s"), "--no-page") as run:
            run.until_flying(0.5)
            traces.note(run)
            since = time.monotonic()
            run.interrupt()
            run.interrupt()
            self.check_ended(run, traces, signal.SIGINT, since)

    def test_stopped_for_eight_seconds_and_continued(self):
        with Run(small_fleet("12 s"), "--no-page") as run:
            run.until_flying(1.0)
            run.interrupt(signal.SIGSTOP)
            try:
                until = time.monotonic() + 8.0
                while time.monotonic() < until:
                    pause()
            finally:
                run.interrupt(signal.SIGCONT)
            self.assertIn(run.wait(30), (0, 3), run.stderr)
            self.assertEqual(run.summary["end_reason"], "duration reached")
            check = next(check for check in run.fidelity["checks"]
                         if check["name"] == "supervision_gap")
            self.assertGreater(check["measured"], 7500)
            self.assertNotEqual(check["verdict"], "VALID")
            self.assertTrue(any("cuscus itself did not run" in reason
                                for reason in run.fidelity["reasons"]))
            times = sorted({row["sim_time_s"] for row in run.metrics()})
            self.assertGreater(max(b - a for a, b in zip(times, times[1:])), 7.5)
            self.assertGreater(times[-1], 11.5)

    def test_seldom_metrics_are_no_gap(self):
        with Run(small_fleet("5 s"), "--no-page", "--set", "record.metrics_period=2 s") as run:
            self.assertIn(run.wait(30), (0, 3), run.stderr)
            check = next(check for check in run.fidelity["checks"]
                         if check["name"] == "supervision_gap")
            self.assertLess(check["measured"], 1900)  # the rows alone would make it 2000


if __name__ == "__main__":
    unittest.main()
