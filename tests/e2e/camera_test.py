"""A vehicle in flight sees through its camera what its pose implies."""

import os
import signal
import unittest

from cuscus_run import BIN, Run, descendants, program_of

AGENT = [str(BIN / "camera-agent")]


def scenario(camera):
    """A hovering vehicle at the origin, another node 5 m east of it and 1.5 m to the left, 4 m up."""
    return {"name": "camera", "duration": "13 s",
            "fleet": [{"name": "eye", "agent": AGENT,
                       "vehicle": {"model": "x4", "sensors": {"camera": camera}},
                       "start": {"layout": "list", "positions": [["0 m", "0 m", "0 m"]]}},
                      {"name": "mast", "vehicle": {"model": "fixed"}, "command": ["sleep", "60"],
                       "start": {"layout": "list", "positions": [["5 m", "1.5 m", "4 m"]]}}]}


class Picture:
    """A line that camera_agent.cc has printed."""

    def __init__(self, line):
        fields = line.split()
        self.number, self.time_s = int(fields[1]), float(fields[2])
        self.width, self.height, self.focal = int(fields[3]), int(fields[4]), float(fields[5])
        self.p_m = [float(field) for field in fields[6:9]]
        w, x, y, z = (float(field) for field in fields[9:13])
        self.R = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                  [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                  [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
        self.rgb = bytes.fromhex(fields[13])

    def at(self, column, row):
        first = 3 * (row * self.width + column)
        return tuple(self.rgb[first:first + 3])

    def in_body(self, p_W_m):
        d = [p_W_m[i] - self.p_m[i] for i in range(3)]
        return [sum(self.R[i][k] * d[i] for i in range(3)) for k in range(3)]

    def ahead(self, p_W_m):
        """Where a camera that looks ahead from 5 cm above the vehicle sees a point."""
        x, y, z = self.in_body(p_W_m)
        return (self.width / 2 - self.focal * y / x,
                self.height / 2 - self.focal * (z - 0.05) / x)


def is_sky(rgb):
    return rgb[2] > rgb[0] + 20


def is_dark(rgb):
    return max(rgb) < 60


class Camera(unittest.TestCase):
    def flown(self, camera):
        """The picture that was printed, once all that both views have in common is checked."""
        with Run(scenario(camera), "--no-page") as run:
            run.until_flying()
            below = [program_of(pid) for pid in descendants(run.process.pid)]
            self.assertEqual(below.count("cuscus-camera"), 1)
            self.assertIn(run.wait(), (0, 3), run.stderr)
            log = run.log("eye0-agent.log").splitlines()
            tally = run.node("eye0")["camera"]
            # 13 s of 20 Hz, less what a busy machine leaves out, which is told up to the last
            # picture that was begun.
            self.assertLessEqual(tally["pictures"] + tally["skipped"], 263)
            self.assertGreater(tally["pictures"] + tally["skipped"], 220)
            self.assertGreater(tally["pictures"], 100)
            seen = next(line for line in log if line.startswith("pictures ")).split()
            self.assertGreater(int(seen[1]), 0.8 * tally["pictures"])
            self.assertLessEqual(int(seen[1]), tally["pictures"])
            self.assertIsNone(run.node("mast0")["camera"])
            self.assertIn("SCHED_BATCH", run.summary["cameras"]["scheduler"])
            self.assertGreater(run.summary["cameras"]["drawing"]["p50_ns"], 0)
            return Picture(next(line for line in log if line.startswith("picture ")))

    def test_ahead(self):
        picture = self.flown({})
        self.assertEqual((picture.width, picture.height), (320, 240))
        self.assertAlmostEqual(picture.focal, 228.504, delta=0.001)
        self.assertGreater(picture.p_m[2], 2.0)

        # The horizon on the right, where nothing stands.
        horizon = picture.ahead((10_000, -2_000, 3))[1]
        column = int(picture.ahead((10_000, -2_000, 3))[0])
        row = next(r for r in range(picture.height) if not is_sky(picture.at(column, r)))
        self.assertAlmostEqual(row, horizon, delta=3)

        # The other node: a cube of 50 cm whose near side is 4.75 m ahead, and whose right side shows
        # as well. What the vehicle has
        # moved between pose and picture (50 ms at most) is a few pixels.
        columns, rows = zip(*((c, r) for c in range(picture.width) for r in range(picture.height)
                              if is_dark(picture.at(c, r))))
        left, top = picture.ahead((4.75, 1.75, 4.25))
        self.assertAlmostEqual(min(columns), left, delta=4)
        self.assertAlmostEqual(min(rows), top, delta=4)
        right, _ = picture.ahead((5.25, 1.25, 4.25))
        _, bottom = picture.ahead((4.75, 1.75, 3.75))
        self.assertAlmostEqual(max(columns) + 1, right, delta=4)
        self.assertAlmostEqual(max(rows) + 1, bottom, delta=4)

    def test_down(self):
        picture = self.flown({"direction": "down", "width": 160, "height": 120,
                              "field": "90 deg"})
        self.assertEqual((picture.width, picture.height), (160, 120))
        self.assertAlmostEqual(picture.focal, 80.0, delta=0.001)
        self.assertFalse(any(is_sky(picture.at(c, r)) for c in range(0, 160, 5)
                             for r in range(0, 120, 5)))
        # Ground has checks of 1 m: some 26 pixels from 3 m above. Half a metre ahead of the vehicle,
        # which stands where four of them meet.
        brightness = [sum(picture.at(c, 45)) for c in range(160)]
        steps = [c for c in range(1, 160) if abs(brightness[c] - brightness[c - 1]) > 15]
        self.assertGreaterEqual(len(steps), 3)
        distances = [b - a for a, b in zip(steps, steps[1:]) if b - a > 2]
        expected = picture.focal / (picture.p_m[2] + 0.05)
        self.assertTrue(all(abs(d - expected) < 4 for d in distances), (distances, expected))

    def test_a_dead_camera_ends_the_run_by_its_name(self):
        with Run(scenario({}), "--no-page") as run:
            run.until_flying()
            (camera,) = [pid for pid in descendants(run.process.pid)
                         if program_of(pid) == "cuscus-camera"]
            os.kill(camera, signal.SIGKILL)
            self.assertEqual(run.wait(30), 1)
            self.assertIn("camera ended: signal 9", run.summary["end_reason"])

    def test_without_cameras_there_is_no_process_for_them(self):
        with Run(scenario("none"), "--no-page", "--duration", "2s") as run:
            run.until_flying()
            below = [program_of(pid) for pid in descendants(run.process.pid)]
            self.assertIn("cuscus-world", below)
            self.assertNotIn("cuscus-camera", below)
            self.assertIn(run.wait(), (0, 3), run.stderr)
            self.assertIsNone(run.summary["cameras"])
            self.assertIsNone(run.node("eye0")["camera"])


if __name__ == "__main__":
    unittest.main()
