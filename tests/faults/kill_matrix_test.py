"""kill -9 of any process of a run, at any moment, leaves nothing behind: 100 times."""

import os
import random
import signal
import time
import unittest

from cuscus_run import Run
from fault_support import (Target, Traces, check_next_run, check_readable, members,
                           private_registry, small_fleet)

SEED = int(os.environ.get("CUSCUS_KILL_SEED", "20261123"))
PHASES = ("set-up", "flight", "tear-down")
SERVICES = ("netsim", "world")


def setUpModule():
    private_registry()


def wait_s(seconds):
    """The random moment itself, not a wait for a state."""
    time.sleep(seconds)


class KillMatrix(unittest.TestCase):
    def matrix(self, victim, times):
        dice = random.Random(f"{SEED} {victim}")
        print(f"seed {SEED}", flush=True)
        for number in range(times):
            phase = PHASES[number % len(PHASES)]
            with self.subTest(victim=victim, number=number, phase=phase):
                self.kill_once(victim, phase, dice)
        check_next_run(self)

    def kill_once(self, victim, phase, dice):
        for attempt in range(20):
            traces = Traces()
            # An init has a command to be told the end, beside the agent.
            group = {"command": ["sleep", "1000"]} if victim == "init" else {}
            # The strike must come before the end; only without an agent a run flies to its end.
            duration = "1 s" if victim == "agent" and phase != "tear-down" else "5 s"
            with Run(small_fleet(duration, **group), "--no-page") as run:
                killed = self.strike(run, traces, victim, phase, dice, attempt)
                struck = time.monotonic()
                code = run.wait(15)
                took_s = time.monotonic() - struck
                traces.check_gone(self, run)
                check_readable(self, run.results)
                if killed:
                    self.check_end(run, victim, phase, code, took_s)
                    return
        self.fail(f"{victim} was always gone before it could be killed")

    def strike(self, run, traces, victim, phase, dice, attempt):
        """Kills the victim, the earlier the more attempts. False when it had ended already."""
        program = f"cuscus-{victim}"
        pids = [run.process.pid]
        if phase != "set-up":
            run.until_flying(dice.uniform(0.02, 0.5))
        elif victim == "cuscus":
            wait_s(dice.uniform(0, 0.3))
        else:
            run.until(f"{program} there", lambda: members(run, program))
        if victim != "cuscus":
            pids = members(run, program)
        if not pids:
            return False
        with Target(run, dice.choice(pids)) as target:
            traces.note(run)
            if phase == "tear-down":
                run.interrupt()
                wait_s(dice.uniform(0, 0.01) / 2**attempt)
            elif phase == "set-up" and victim != "cuscus":
                wait_s(dice.uniform(0, 0.05))
            return target.signal()

    def check_end(self, run, victim, phase, code, took_s):
        if victim == "cuscus":
            # Death may come after the last line of a run that was interrupted.
            self.assertIn(code, (-9, 130) if phase == "tear-down" else (-9,))
            return
        self.assertLess(took_s, 5.0)
        summary, fidelity = run.summary, run.fidelity
        self.assertEqual(summary["exit_code"], code)
        self.assertEqual(summary["verdict"], fidelity["verdict"])
        if phase == "tear-down":
            self.assertEqual(code, 128 + signal.SIGINT, run.stderr)
        elif victim in SERVICES:
            self.assertEqual(code, 1, run.stderr)
            self.assertIn(f"{victim} ended: signal 9", summary["end_reason"])
            self.assertEqual(fidelity["verdict"], "INVALID")
            self.assertIn(summary["end_reason"], fidelity["reasons"])
        elif victim == "init":
            self.assertEqual(code, 1, run.stderr)
            self.assertRegex(summary["end_reason"], r"\b(uav\d|gcs)\b")
            self.assertEqual(fidelity["verdict"], "INVALID")
        else:
            self.check_marked(victim, summary, code, phase)

    def check_marked(self, victim, summary, code, phase):
        ends = [program for node in summary["nodes"] for program in node["programs"]
                if program["signal"] == 9]
        self.assertEqual(len(ends), 1, summary["nodes"])
        self.assertEqual(ends[0]["program"], f"cuscus-{victim}")
        self.assertIsNotNone(ends[0]["ended_at_s"])
        if victim == "gcs":
            self.assertEqual(code, 1)
            return
        self.assertIn(code, (0, 3))
        self.assertEqual(summary["end_reason"], "duration reached")
        if phase == "flight":
            self.assertGreater(ends[0]["ended_at_s"], 0.0)

    def test_cuscus(self):
        self.matrix("cuscus", 24)

    def test_netsim(self):
        self.matrix("netsim", 18)

    def test_world(self):
        self.matrix("world", 18)

    def test_gcs(self):
        self.matrix("gcs", 10)

    def test_agent(self):
        self.matrix("agent", 15)

    def test_init(self):
        self.matrix("init", 15)


if __name__ == "__main__":
    unittest.main()
