"""A drone that is sent through a block stops at its wall, and nobody else notices.

The map has one building, whose middle is the origin of the scenario's frame. Degrees into metres:
the radius of curvature of WGS-84 across the meridian, a = 6 378 137 m, e² = 0.00669438.
"""

import math
import pathlib
import tempfile
import unittest

from cuscus_run import BIN, Run

LATITUDE_DEG, LONGITUDE_DEG = 44.5, 11.35
HALF_DEG = 0.0003
BODY_M = 0.3  # arm and 10 cm
ALTITUDE_M = 5.0
SPEED_MPS = 10.0
BEYOND_M = 10.0  # of the building, the ends of both ways

MAP = f"""<?xml version='1.0' encoding='UTF-8'?>
<osm version='0.6'>
 <node id='1' lat='{LATITUDE_DEG - HALF_DEG}' lon='{LONGITUDE_DEG - HALF_DEG}'/>
 <node id='2' lat='{LATITUDE_DEG - HALF_DEG}' lon='{LONGITUDE_DEG + HALF_DEG}'/>
 <node id='3' lat='{LATITUDE_DEG + HALF_DEG}' lon='{LONGITUDE_DEG + HALF_DEG}'/>
 <node id='4' lat='{LATITUDE_DEG + HALF_DEG}' lon='{LONGITUDE_DEG - HALF_DEG}'/>
 <way id='10'><nd ref='1'/><nd ref='2'/><nd ref='3'/><nd ref='4'/><nd ref='1'/>
  <tag k='building' v='yes'/><tag k='height' v='30'/></way>
</osm>
"""


def half_width_m():
    """From the origin to the eastern and the western wall."""
    a_m, e2 = 6_378_137.0, 0.00669438
    sine = math.sin(math.radians(LATITUDE_DEG))
    across_m = a_m / math.sqrt(1 - e2 * sine**2) * math.cos(math.radians(LATITUDE_DEG))
    return across_m * math.radians(HALF_DEG)


def scenario():
    """One flies at the middle of the wall, towards a point behind the building; one passes by."""
    end_m = half_width_m() + BEYOND_M

    def uav(name, north_m):
        path = [-end_m, north_m, ALTITUDE_M, end_m, north_m, ALTITUDE_M]
        return {"name": name, "agent": [str(BIN / "path-agent"), str(SPEED_MPS), *map(str, path)],
                "vehicle": {"model": "x4", "collision": {"behaviour": "stop"}},
                "start": {"layout": "list",
                          "positions": [[f"{-end_m} m", f"{north_m} m", "0 m"]]}}
    return {"name": "wall", "duration": "22 s", "city": {"file": "map.osm"},
            "fleet": [uav("sent", 0), uav("past", 50)], "ground_station": {"enabled": False}}


class Wall(unittest.TestCase):
    def test_a_drone_sent_through_a_block_stops_at_the_wall(self):
        folder = pathlib.Path(tempfile.mkdtemp(prefix="cuscus-wall-"))
        (folder / "map.osm").write_text(MAP)
        with Run(scenario(), "--no-page", folder=folder) as run:
            self.assertIn(run.wait(), (0, 3), run.stderr)
            track = [row for row in run.metrics() if row["x_m"] is not None]
            sent = [row for row in track if row["node"] == "sent0"]
            past = [row for row in track if row["node"] == "past0"]
            wall_m = -half_width_m() - BODY_M
            print(f"stopped at {sent[-1]['x_m']:.3f} m, the wall less the body is at {wall_m:.3f} m; "
                  f"{run.node('sent0')['collisions']}")

            # The importer keeps seven digits of a degree: 1 cm.
            self.assertLess(max(row["x_m"] for row in sent), wall_m + 0.02)
            self.assertGreater(sent[-1]["x_m"], wall_m - 0.1)
            self.assertAlmostEqual(sent[-1]["y_m"], 0.0, delta=0.5)
            hit = run.node("sent0")["collisions"]
            self.assertGreaterEqual(hit["contacts"], 1)
            self.assertEqual(hit["buildings"], hit["contacts"])
            self.assertFalse(hit["crashed"])

            self.assertAlmostEqual(past[-1]["x_m"], half_width_m() + BEYOND_M, delta=0.5)
            self.assertEqual(run.node("past0")["collisions"]["contacts"], 0)


if __name__ == "__main__":
    unittest.main()
