"""`cuscus city generate` as an ordinary user runs it: a file that osmium finds nothing wrong with, the
same for the same seed, and one clear error where it cannot be.
"""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

from cuscus_run import BIN

OSMIUM = shutil.which("osmium")


class CityGenerate(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="cuscus-city-"))
        self.addCleanup(shutil.rmtree, self.folder, True)

    def generate(self, *options):
        return subprocess.run([BIN / "cuscus", "city", "generate", *map(str, options)],
                              capture_output=True, text=True, timeout=60, cwd=self.folder,
                              stdin=subprocess.DEVNULL)

    def made(self, name, *options):
        done = self.generate(*options, "--out", name)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return self.folder / name

    @unittest.skipUnless(OSMIUM, "SKIPPED: osmium-tool is not installed")
    def test_osmium_finds_every_reference_and_the_order(self):
        for style in ("old-town", "grid"):
            file = self.made(f"{style}.osm", style, "--seed", 7)
            checked = subprocess.run([OSMIUM, "check-refs", "-r", file], capture_output=True, text=True)
            self.assertEqual(checked.returncode, 0, checked.stderr)
            told = {key: subprocess.run([OSMIUM, "fileinfo", "-e", "-g", key, file], text=True,
                                        capture_output=True, check=True).stdout.strip()
                    for key in ("data.objects_ordered", "data.multiple_versions",
                                "data.maxid.relations", "data.count.relations")}
            self.assertEqual(told["data.objects_ordered"], "yes")
            self.assertEqual(told["data.multiple_versions"], "no")
            self.assertGreater(int(told["data.count.relations"]), 5)
            self.assertEqual(told["data.count.relations"], told["data.maxid.relations"])

    def test_a_seed_is_a_city(self):
        first = self.made("first.osm", "old-town", "--seed", 7, "--size", "300m").read_bytes()
        again = self.made("again.osm", "old-town", "--seed", 7, "--size", "0.3km").read_bytes()
        other = self.made("other.osm", "old-town", "--seed", 8, "--size", "300m").read_bytes()
        self.assertEqual(first, again)
        self.assertNotEqual(first, other)

    def test_origin_is_the_middle(self):
        file = self.made("there.osm", "grid", "--size", "400m", "--origin", "-33.5,151.25")
        bounds = ElementTree.parse(file).getroot().find("bounds").attrib
        self.assertAlmostEqual((float(bounds["minlat"]) + float(bounds["maxlat"])) / 2, -33.5, 9)
        self.assertAlmostEqual((float(bounds["minlon"]) + float(bounds["maxlon"])) / 2, 151.25, 9)
        # 400 m north are 400 / 110.9 km of a degree at that latitude, within 0.2 %.
        height_deg = float(bounds["maxlat"]) - float(bounds["minlat"])
        self.assertAlmostEqual(height_deg * 110_900, 400, delta=1)

    def refused(self, *options, says):
        before = sorted(self.folder.iterdir())
        done = self.generate(*options)
        self.assertEqual(done.returncode, 2, done)
        self.assertEqual(done.stdout, "")
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        for text in says:
            self.assertIn(text, done.stderr)
        self.assertEqual(sorted(self.folder.iterdir()), before)

    def test_bad_input(self):
        self.refused("suburb", "--out", "x.osm", says=("suburb", "old-town, grid"))
        self.refused("grid", "--out", "x.osm", "--size", "3 kg", says=("--size 3 kg", "km"))
        self.refused("grid", "--out", "x.osm", "--size", "10m", says=("--size 10m", "200 m ... 5000 m"))
        self.refused("grid", "--out", "x.osm", "--origin", "91,0", says=("--origin 91,0", "LATITUDE"))
        self.refused("grid", "--out", "x.osm", "--origin", "1;2", says=("--origin 1;2",))
        self.refused("grid", "--out", "missing/x.osm", says=("missing/x.osm", "No such file"))
        (self.folder / "mine.osm").write_text("mine")
        self.refused("grid", "--out", "mine.osm", says=("mine.osm: the file exists",))
        self.assertEqual((self.folder / "mine.osm").read_text(), "mine")

    def test_file_has_the_mode_that_the_umask_leaves(self):
        os.umask(0o027)
        self.addCleanup(os.umask, 0o022)
        self.assertEqual(self.made("x.osm", "grid", "--size", "200m").stat().st_mode & 0o777, 0o640)


if __name__ == "__main__":
    unittest.main()
