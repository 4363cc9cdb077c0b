"""What follows from a host that does not keep up is what the scenario asks for."""

import re
import signal
import time
import unittest

from cuscus_run import Run
from fault_support import Target, Traces, members, private_registry, small_fleet

# Beyond the latest world step of a VALID run, far below that of an INVALID one.
STALL_S = 0.15
DURATION_S = 8


def setUpModule():
    private_registry()


class OnLate(unittest.TestCase):
    def fly_with_stall(self, *options):
        """A run whose world is kept from running for a moment."""
        run = Run(small_fleet(f"{DURATION_S} s"), "--no-page", *options)
        self.addCleanup(run.remove)
        traces = Traces()
        run.until_flying(0.5)
        traces.note(run)
        (world,) = members(run, "cuscus-world")
        with Target(run, world) as target:
            target.signal(signal.SIGSTOP)
            time.sleep(STALL_S)  # the fault itself
            target.signal(signal.SIGCONT)
        code = run.wait(40)
        traces.check_gone(self, run)
        self.assertNotEqual(run.fidelity["verdict"], "VALID")
        self.assertEqual(run.summary["exit_code"], code)
        return run, code

    def warnings(self, run):
        return re.findall(r"since ([\d.]+) s the run cannot become VALID any more: (.*)",
                          run.stderr)

    def test_warn(self):
        run, code = self.fly_with_stall()
        self.assertEqual(code, 3 if run.fidelity["verdict"] == "INVALID" else 0)
        self.assertEqual(len(self.warnings(run)), 1, run.stderr)
        self.assertLess(float(self.warnings(run)[0][0]), DURATION_S)
        self.assertEqual(run.summary["end_reason"], "duration reached")

    def test_fail(self):
        run, code = self.fly_with_stall("--on-late", "fail")
        self.assertEqual(code, 3, run.stderr)
        self.assertEqual(len(self.warnings(run)), 1, run.stderr)
        self.assertEqual(run.summary["end_reason"], "duration reached")

    def test_stop(self):
        run, code = self.fly_with_stall("--on-late", "stop")
        self.assertEqual(code, 3, run.stderr)
        self.assertLess(run.summary["simulated_s"], DURATION_S)
        self.assertRegex(run.summary["end_reason"],
                         "^stopped: cannot become VALID any more: .*world step")
        self.assertEqual(run.stderr.count("the run was stopped after"), 1, run.stderr)
        self.assertGreater(len(run.metrics()), 0)


if __name__ == "__main__":
    unittest.main()
