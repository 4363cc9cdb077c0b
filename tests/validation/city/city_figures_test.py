"""Imports real cities and compares what `cuscus city` says with what osmium-tool and arithmetic of
its own say of the same files.

Numbers: areas that `osmium export` makes of the file, by their tags. Ground: each polygon's area in
the plane that has the ellipsoid's two radii of curvature at its latitude, which over a building
differs from the ellipsoid's area by less than 1e-6. Tallest: the largest plain number in a height
tag.
"""

import json
import math
import os
import pathlib
import shutil
import subprocess
import unittest

from cuscus_run import BIN, SOURCE

DATA = pathlib.Path(os.environ.get("CUSCUS_OSM_DATA", SOURCE.parent / "shared/data/osm"))
MAJOR_AXIS_M = 6378137.0
ECCENTRICITY_2 = 0.00669437999014


def ring_m2(ring):
    """The area of a closed ring of (longitude, latitude) in degrees."""
    longitude, latitude = (math.radians(x) for x in ring[0])
    root = math.sqrt(1 - ECCENTRICITY_2 * math.sin(latitude) ** 2)
    east = MAJOR_AXIS_M / root * math.cos(latitude)
    north = MAJOR_AXIS_M * (1 - ECCENTRICITY_2) / root ** 3
    points = [((math.radians(x) - longitude) * east, (math.radians(y) - latitude) * north)
              for x, y in ring]
    return abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:]))) / 2


def area_m2(geometry):
    polygons = geometry["coordinates"]
    if geometry["type"] == "Polygon":
        polygons = [polygons]
    return sum(ring_m2(p[0]) - sum(ring_m2(hole) for hole in p[1:]) for p in polygons)


def number(text):
    try:
        return float(text)
    except ValueError:
        return 0.0


class Figures:
    """Of one file, without a line of cuscus."""

    def __init__(self, file):
        exported = subprocess.run(
            ["osmium", "export", "--no-progress", "-f", "geojsonseq", "--geometry-types=polygon",
             file], capture_output=True, check=True).stdout
        self.outlines = self.parts = 0
        self.ground_m2 = self.tallest_m = 0.0
        for record in exported.decode("utf-8").split("\x1e")[1:]:
            feature = json.loads(record)
            tags = feature["properties"]
            outline = tags.get("building", "no") != "no"
            if not outline and tags.get("building:part", "no") == "no":
                continue
            self.outlines += outline
            self.parts += not outline
            if tags.get("location") == "underground" or tags.get("layer", "").startswith("-"):
                continue
            self.tallest_m = max(self.tallest_m, number(tags.get("height", "")))
            if outline:
                self.ground_m2 += area_m2(feature["geometry"])


@unittest.skipUnless(DATA.is_dir(), f"no map data in {DATA}: set CUSCUS_OSM_DATA")
@unittest.skipUnless(shutil.which("osmium"), "needs osmium (Debian: osmium-tool)")
class CityFigures(unittest.TestCase):
    def city(self, name, *options):
        done = subprocess.run([BIN / "cuscus", "city", DATA / name, "--json", *options],
                              capture_output=True, text=True, timeout=120)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return json.loads(done.stdout)

    def check(self, name):
        """The file's figures, which are those of osmium."""
        city = self.city(name)
        expected = Figures(DATA / name)
        buildings = city["buildings"]
        self.assertEqual(buildings["outline_areas"], expected.outlines)
        self.assertEqual(buildings["part_areas"], expected.parts)
        # Parts without an outline have ground of their own, of which osmium knows nothing.
        alone = sum(p["count"] for f in city["files"] for p in f["problems"]
                    if p["problem"] == "part_alone")
        if alone == 0:
            self.assertAlmostEqual(buildings["footprint_m2"] / expected.ground_m2, 1.0, places=5)
        if expected.tallest_m > 0:
            self.assertEqual(buildings["tallest"]["height_m"], expected.tallest_m)
        return city

    def test_bryant_park_has_the_figures_that_osmium_gives(self):
        buildings = self.check("manhattan-bryant-park.buildings.osm.pbf")["buildings"]
        # The data's own README: 1,318 areas; the Empire State Building with 443.2 m.
        self.assertEqual(buildings["outline_areas"] + buildings["part_areas"], 1318)
        self.assertEqual(buildings["tallest"], {"height_m": 443.2, "object": "way 34633854",
                                                "name": "Empire State Building"})

    def test_bologna_has_the_figures_that_osmium_gives(self):
        city = self.check("bologna-centre-blocks.osm.pbf")
        # README: 1,362 polygons, 4.10 km2 built, no heights: the rule gives 10 to 15 m.
        self.assertEqual(city["buildings"]["count"], 1362)
        self.assertAlmostEqual(city["buildings"]["footprint_m2"] * 1e-6, 4.10, places=2)
        self.assertEqual(city["buildings"]["height_from_rule"], 1362)
        self.assertLess(city["buildings"]["tallest"]["height_m"], 15.0)
        self.assertEqual(city["files"][0]["problems"], [])

    def test_midtown_has_the_figures_that_osmium_gives(self):
        buildings = self.check("manhattan-midtown.buildings.osm.pbf")["buildings"]
        self.assertEqual(buildings["tallest"]["height_m"], 443.2)

    def test_xml_and_pbf_of_one_extract_make_one_city(self):
        cities = [self.city(name) for name in ("manhattan-bryant-park.buildings.osm",
                                               "manhattan-bryant-park.buildings.osm.pbf")]
        for city in cities:
            for file in city["files"]:
                del file["file"]
        self.assertEqual(*cities)

    def test_a_box_cuts_out_its_buildings(self):
        name = "bologna-centre-blocks.osm.pbf"
        whole = self.city(name)
        # Around Piazza Maggiore, 800 m by 780 m.
        cut = self.city(name, "--bbox", "11.338,44.490,11.348,44.497", "--heights", "20m..20m")
        self.assertLess(cut["buildings"]["count"], whole["buildings"]["count"] / 4)
        self.assertGreater(cut["buildings"]["count"], 10)
        self.assertEqual(cut["buildings"]["mean_height_m"], 20.0)
        self.assertAlmostEqual(cut["origin"]["latitude_deg"], 44.4935)


if __name__ == "__main__":
    unittest.main()
