"""Processor hogs: a run on a host that does not keep up says so, and why."""

import os
import pathlib
import subprocess
import time
import unittest

from cuscus_run import SCENARIOS, Run, pause
from fault_support import private_registry, program_path, small_fleet
from stall_witness import StallWitness

HOGS = 4
# Ends by itself, whatever happens to the test.
LIMIT_S = 10
# Later releases than this are counted by the verdict on the default scenario.
RELEASE_TOLERANCE_S = 0.0021


def setUpModule():
    private_registry()


def runs_of_others():
    """Runs and benchmarks on this machine, none of which is ours yet: hogs would ruin them."""
    return [entry.name for entry in pathlib.Path("/proc").iterdir() if entry.name.isdigit()
            and program_path(entry.name).name.startswith(("cuscus", "bench-", "ns3"))]


def busy_share():
    """Share of the processors' time that was used in the last second."""
    def read():
        fields = [int(n) for n in pathlib.Path("/proc/stat").read_text().split("\n")[0].split()[1:]]
        return sum(fields), fields[3] + fields[4]
    total, idle = read()
    deadline = time.monotonic() + 1.0
    while time.monotonic() < deadline:
        pause()
    total_later, idle_later = read()
    return 1.0 - (idle_later - idle) / (total_later - total)


def await_idle(limit_s=120):
    """Waits until nothing else keeps the machine busy."""
    deadline = time.monotonic() + limit_s
    while (share := busy_share()) > 0.2:
        if time.monotonic() > deadline:
            raise AssertionError(f"the machine is {100 * share:.0f} % busy with something else")


class Hogs:
    """Four busy loops pinned on every core in turn, in netsim's own scheduling class if wanted."""

    def __init__(self, realtime):
        cores = sorted(os.sched_getaffinity(0))
        wrapper = ["chrt", "--fifo", "60"] if realtime else []
        self.processes = [
            subprocess.Popen(["timeout", "--signal=KILL", str(LIMIT_S), "taskset", "--cpu-list",
                              str(core), *wrapper, "sh", "-c", "while :; do :; done"])
            for _ in range(max(1, HOGS // len(cores))) for core in cores]

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        for process in self.processes:
            process.terminate()  # `timeout` passes it on
        for process in self.processes:
            process.wait()


class Hog(unittest.TestCase):
    def setUp(self):
        if others := runs_of_others():
            self.skipTest(f"other runs or benchmarks are alive: {', '.join(others)}")

    def check_consistent(self, run, code):
        fidelity = run.fidelity
        self.assertEqual(code, 3 if fidelity["verdict"] == "INVALID" else 0)
        self.assertEqual(run.summary["verdict"], fidelity["verdict"])
        self.assertEqual(run.summary["verdict_reasons"], fidelity["reasons"])
        self.assertEqual(fidelity["verdict"] == "VALID", not fidelity["reasons"])
        worst = {check["verdict"] for check in fidelity["checks"]}
        self.assertIn(fidelity["verdict"], worst)
        self.assertIn(f"fidelity: {fidelity['verdict']}", run.stdout)

    def test_hogs_at_equal_priority_make_it_invalid(self):
        # Longer than the time after which a service that says nothing is looked at as hung.
        with Run(small_fleet("7 s"), "--no-page") as run:
            run.until_flying(0.2)
            with Hogs(realtime=True):
                code = run.wait(LIMIT_S + 20)
            self.check_consistent(run, code)
            self.assertEqual(code, 3, run.stdout)
            self.assertEqual(run.summary["exit_code"], 3)
            self.assertRegex(run.fidelity["reasons"][0], r"late|overran|ended after|did not run")

    def test_ordinary_hogs_without_realtime(self):
        scenario = small_fleet("5 s")
        scenario["realtime"] = False
        with Run(scenario, "--no-page") as run:
            run.until_flying(0.5)
            with Hogs(realtime=False):
                code = run.wait(LIMIT_S + 20)
            self.check_consistent(run, code)

    def test_idle_machine_is_valid(self):
        # A virtual machine's own host may disturb it: one of six flights has to be left alone, or
        # the host must have stalled all of them for about as long as the verdict complains of.
        allowed_share = 0.001
        stalls = []
        for _ in range(6):
            await_idle()
            with Run(SCENARIOS / "default.json", "--no-page", "--duration", "20s") as run:
                with StallWitness(RELEASE_TOLERANCE_S) as witness:
                    code = run.wait(60)
                self.check_consistent(run, code)
                print(run.stdout, f"stalled by the host: {100 * witness.share:.3f} % of the time")
                if run.fidelity["verdict"] == "VALID":
                    return
            stalls.append(witness.share)
        self.assertGreater(min(stalls), allowed_share / 2, "not one VALID flight on a quiet host")
        self.skipTest(f"the host stalled every flight, {', '.join(f'{100 * s:.3f} %' for s in stalls)}"
                      " of the time")


if __name__ == "__main__":
    unittest.main()
