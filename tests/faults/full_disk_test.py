"""A disk that fills up during the flight: the run goes on, and says what it could not keep."""

import pathlib
import subprocess
import tempfile
import unittest

from cuscus_run import Run
from fault_support import Traces, check_next_run, check_readable, private_registry, small_fleet


def setUpModule():
    private_registry()


class FullDisk(unittest.TestCase):
    def setUp(self):
        self.disk = pathlib.Path(tempfile.mkdtemp(prefix="cuscus-disk-"))
        self.addCleanup(self.disk.rmdir)
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=2m,mode=755", "tmpfs", self.disk],
                       check=True)
        self.addCleanup(subprocess.run, ["umount", "--lazy", self.disk], check=True)

    def fill(self):
        with open(self.disk / "filler", "wb", buffering=0) as file:
            try:
                while True:
                    file.write(bytes(4096))
            except OSError:
                pass

    def test_results_do_not_fit(self):
        traces = Traces()
        with Run(small_fleet("3 s"), "--no-page", folder=self.disk,
                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as run:
            run.until_flying(0.5)
            traces.note(run)
            self.fill()
            stdout, stderr = run.process.communicate(timeout=30)
            self.assertEqual(run.process.returncode, 1, stderr)
            self.assertRegex(stdout.splitlines()[-1], "^fidelity: (VALID|DEGRADED|INVALID)")
            for name in ("metrics.csv", "fidelity.json", "summary.json"):
                self.assertIn(name, stderr)
            self.assertFalse((run.results / "summary.json").exists())
            check_readable(self, run.results)
            traces.check_gone(self, run)
        check_next_run(self)


if __name__ == "__main__":
    unittest.main()
