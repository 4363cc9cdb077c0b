"""`cuscus city` as an ordinary user runs it: what it says of a map, and one clear error otherwise."""

import json
import pathlib
import subprocess
import tempfile
import unittest

from cuscus_run import BIN

MAP = """<?xml version='1.0' encoding='UTF-8'?>
<osm version='0.6'>
 <node id='1' lat='44.4930' lon='11.3420'/>
 <node id='2' lat='44.4930' lon='11.3430'/>
 <node id='3' lat='44.4940' lon='11.3430'/>
 <node id='4' lat='44.4940' lon='11.3420'/>
 <node id='5' lat='44.4935' lon='11.3440'><tag k='natural' v='tree'/></node>
 <way id='10'><nd ref='1'/><nd ref='2'/><nd ref='3'/><nd ref='4'/><nd ref='1'/>
  <tag k='building' v='yes'/><tag k='name' v='Palazzo'/><tag k='height' v='3 storeys'/></way>
 <way id='11'><nd ref='1'/><nd ref='2'/><nd ref='3'/><tag k='building' v='yes'/></way>
</osm>
"""


class City(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="cuscus-city-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.map = self.folder / "map.osm"
        self.map.write_text(MAP)

    def city(self, *arguments):
        return subprocess.run([BIN / "cuscus", "city", *arguments], capture_output=True, text=True,
                              timeout=60, cwd=self.folder, stdin=subprocess.DEVNULL)

    def refused(self, *arguments):
        done = self.city(*arguments)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        return done.stderr

    def test_it_says_what_was_understood_and_what_was_dropped(self):
        done = self.city(self.map)

        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("buildings: 1 of 1 outlines and 0 parts", done.stdout)
        self.assertIn("heights: 0 tagged, 0 from levels, 1 by the rule", done.stdout)
        self.assertIn("way 10 (Palazzo)", done.stdout)
        self.assertIn("the outline does not close: way 11", done.stdout)
        self.assertIn("the height makes no sense: way 10 (height=3 storeys)", done.stdout)
        self.assertIn("OpenStreetMap contributors", done.stdout)

    def test_heights_follow_rule_and_seed(self):
        tallest = [json.loads(self.city(self.map, "--json", *options).stdout)
                   ["buildings"]["tallest"]["height_m"]
                   for options in (("--heights", "50m..150m"), ("--heights", "50m..150m"),
                                   ("--heights", "50m..150m", "--seed", "2"))]

        self.assertEqual(tallest[0], tallest[1])
        self.assertNotEqual(tallest[0], tallest[2])
        self.assertTrue(all(50 <= height < 150 for height in tallest), tallest)

    def test_what_cannot_be_is_one_line_with_the_cause(self):
        for arguments, cause in (
                ((), "a FILE is missing"),
                (("no.osm",), "no.osm: No such file"),
                ((self.folder,), "is no OpenStreetMap file by its name"),
                ((self.map, "--bbox", "1,2,3"), "--bbox 1,2,3: allowed: WEST,SOUTH,EAST,NORTH"),
                ((self.map, "--bbox", "nan,0,1,1"), "allowed: WEST,SOUTH,EAST,NORTH"),
                ((self.map, "--bbox", "11.4,44,11.3,45"), "allowed: WEST,SOUTH,EAST,NORTH"),
                ((self.map, "--bbox", "1,1,2,2"), "no buildings in 1.0000,1.0000,2.0000,2.0000"),
                ((self.map, "--heights", "10m"), "--heights 10m: allowed: two lengths"),
                ((self.map, "--heights", "10..15"), "--heights 10..15: "),
                ((self.map, "--heights", "15m..10m"), "the lower one first"),
                ((self.map, "--terrain", "no.asc"), "no.asc: there is no such file")):
            with self.subTest(arguments=arguments):
                self.assertIn(cause, self.refused(*arguments))


if __name__ == "__main__":
    unittest.main()
