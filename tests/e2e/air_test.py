"""`cuscus air` as an ordinary user runs it: a table of numbers that a formula gives too, a drawing,
one clear error where it cannot be, and an end where it is asked for.
"""

import csv
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from cuscus_run import BIN

NOBODY = 65534
AS_NOBODY = ("setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups")
HAS_GNUPLOT = shutil.which("gnuplot") is not None


def masts(count):
    """Fixed nodes within a few metres, 54 Mb/s, without a ground station."""
    return {"name": "masts", "seed": 5,
            "radio": {"data_rate": "54 Mb/s", "group_rate": "6 Mb/s"},
            "fleet": [{"name": "mast", "count": count, "vehicle": {"model": "fixed"},
                       "start": {"layout": "circle", "radius": "5 m"}}],
            "ground_station": {"enabled": False}}


class Air(unittest.TestCase):
    def setUp(self):
        # The build's folder may be closed to other users.
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="cuscus-air-"))
        self.addCleanup(shutil.rmtree, self.folder, True)
        self.bin = self.folder / "bin"
        self.bin.mkdir()
        for program in ("cuscus", "cuscus-air"):
            shutil.copy2(BIN / program, self.bin)
        self.home = self.folder / "home"
        self.home.mkdir()
        os.chmod(self.folder, 0o755)
        os.chown(self.home, NOBODY, NOBODY)
        self.scenario = self.home / "masts.json"
        self.scenario.write_text(json.dumps(masts(2)))

    def command(self, *options):
        return [*AS_NOBODY, self.bin / "cuscus", "air", self.scenario, *map(str, options)]

    def air(self, *options, path=None):
        return subprocess.run(self.command(*options), capture_output=True, text=True, timeout=60,
                              cwd=self.home, stdin=subprocess.DEVNULL,
                              env={"PATH": path or os.environ["PATH"]})

    def rows(self, *options):
        done = self.air(*options)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return list(csv.DictReader(done.stdout.splitlines()))

    def test_flow_has_the_goodput_of_its_exchanges(self):
        # 1500 B of IP: DIFS 50 + 7.5 slots of 20 + data 254 + SIFS 10 + ACK 34 = 498 us a frame.
        rows = self.rows("--traffic", "flow", "--payload", 1472, "--seeds", 3, "--duration", "5s")
        self.assertEqual([row["seed"] for row in rows], ["5", "6", "7"])
        for row in rows:
            self.assertAlmostEqual(float(row["goodput_mbps"]), 1472 * 8 / 498, delta=0.25)
            self.assertEqual(float(row["delivery_ratio"]), 1.0)

    def test_ping_takes_two_frames_and_two_answers(self):
        # 64 B of ICMP: (DIFS 50 + data 38 + SIFS 10 + ACK 34) twice, less the last ACK and its SIFS.
        row, = self.rows("--traffic", "ping", "--payload", 56, "--set", "radio.basic_rates=[\"24 Mb/s\"]")
        self.assertAlmostEqual(float(row["round_trip_us"]), 236.1, delta=0.5)

    def test_sweep_of_nodes(self):
        # Two saturated broadcasters collide with 2/17 on average; see saturation_test.cc.
        rows = self.rows("--traffic", "saturated", "--nodes", "2,10", "--payload", 100)
        self.assertEqual([row["nodes"] for row in rows], ["2", "10"])
        self.assertAlmostEqual(float(rows[0]["delivery_ratio"]), 0.881, delta=0.015)
        self.assertLess(float(rows[1]["delivery_ratio"]), 0.6)

    def test_the_same_again_is_the_same(self):
        options = ("--nodes", "10", "--duration", "2s")
        self.assertEqual(self.air(*options).stdout, self.air(*options).stdout)

    def test_file_is_the_callers_and_never_overwritten(self):
        done = self.air("--out", "curve.csv", "--duration", "1s")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
        table = self.home / "curve.csv"
        self.assertEqual(table.stat().st_uid, NOBODY)
        self.assertEqual(len(table.read_text().splitlines()), 2)
        self.refused("--out", "curve.csv", says=("curve.csv exists",))

    @unittest.skipUnless(HAS_GNUPLOT, "SKIPPED: gnuplot is not installed")
    def test_plot(self):
        done = self.air("--nodes", "2,5", "--seeds", 2, "--duration", "1s", "--out", "it's.csv", "--plot")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertTrue((self.home / "it's.png").read_bytes().startswith(b"\x89PNG"))
        self.assertIn("</svg>", (self.home / "it's.svg").read_text())
        self.assertIn("it''s.csv", (self.home / "it's.gp").read_text())

    def test_plot_without_gnuplot(self):
        empty = self.folder / "empty"
        empty.mkdir()
        setpriv = shutil.which("setpriv")
        done = subprocess.run([setpriv, *self.command("--out", "curve.csv", "--plot")[1:]],
                              capture_output=True, text=True, timeout=60, cwd=self.home,
                              env={"PATH": str(empty)})
        self.check_refused(done, "gnuplot", "gnuplot-nox")

    def check_refused(self, done, *says):
        self.assertEqual(done.returncode, 2, done)
        self.assertEqual(done.stdout, "")
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        for text in says:
            self.assertIn(text, done.stderr)

    def refused(self, *options, says):
        before = sorted(self.home.iterdir())
        self.check_refused(self.air(*options), *says)
        self.assertEqual(sorted(self.home.iterdir()), before)

    def test_bad_input(self):
        self.refused("--traffic", "flood", says=("flood", "beacons, saturated, flow, ping"))
        self.refused("--payload", 2000, says=("2000", "1 ... 1472"))
        self.refused("--period", "5 kg", says=("--period 5 kg", "ms"))
        self.refused("--period", "1ns", says=("--period 1 ns", "100 us"))
        self.refused("--duration", "forever", says=("--duration forever",))
        self.refused("--nodes", "1", says=("--nodes 1", "2 or more"))
        self.refused("--nodes", "5000", says=("--nodes 5000", "1 ... 1000"))
        self.refused("--traffic", "flow", "--to", "mast9", says=("mast9", "mast0 ... mast1"))
        self.refused("--plot", says=("--out FILE",))
        self.refused("--out", "curve.png", "--plot", says=("curve.csv",) if HAS_GNUPLOT else ("gnuplot",))
        self.refused("--set", "fleet.0.count=1", says=("one radio node",))

    def test_out_that_cannot_be_written(self):
        done = self.air("--out", "missing/curve.csv", "--duration", "1s")
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)

    def test_interrupt_ends_it_and_its_simulator(self):
        process = subprocess.Popen(self.command("--nodes", "300", "--duration", "24h"),
                                   cwd=self.home, start_new_session=True,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        group = process.pid
        deadline = time.monotonic() + 20
        children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
        while not children.read_text() and time.monotonic() < deadline:
            time.sleep(0.01)
        child = children.read_text().split()[0]
        os.killpg(group, signal.SIGINT)  # as a terminal does
        self.assertEqual(process.wait(10), -signal.SIGINT)
        process.stderr.close()
        while pathlib.Path(f"/proc/{child}").exists() and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertFalse(pathlib.Path(f"/proc/{child}").exists())


if __name__ == "__main__":
    unittest.main()
