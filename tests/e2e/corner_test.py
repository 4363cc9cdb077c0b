"""One street corner: a UAV flies out of another's sight, and its ping ends and comes back there.

In the generated grid city one hovers in an avenue, 60 m from a crossing, and sends pings; the other
flies from the crossing into the street, behind a tower, and back. Where the link ends follows from
what cuscus-channel says of the same city, step by step along the street:

  SNR = P_tx - loss - N,   N = k 290 K 20 MHz + NF = -93.97 dBm

With NIST's error model at 6 Mb/s and 7 attempts a ping passes from about 2 dB on (distance_test.py).
"""

import csv
import io
import re
import subprocess
import unittest

from cuscus_run import BIN, Run

TX_DBM = 0.0
NOISE_DBM = -93.97
HOME = (0, -60, 10)
CROSSING = (0, 0, 10)
HIDDEN = (45, 0, 10)
SPEED_MPS = 4
DURATION_S = 39


def scenario():
    def uav(name, points, command=None):
        path = [str(value) for point in points for value in point]
        east_m, north_m, _ = points[0]
        return {"name": name, "agent": [str(BIN / "path-agent"), str(SPEED_MPS), *path],
                "start": {"layout": "list", "positions": [[f"{east_m} m", f"{north_m} m", "0 m"]]},
                **({"command": command} if command else {}), "capabilities": ["cap_net_raw"]}
    ping = ["ping", "-n", "-D", "-i", "0.1", "-O", "{ip:away0}"]
    return {"name": "corner", "duration": f"{DURATION_S} s",
            "city": {"generate": "grid", "seed": 1},
            "radio": {"tx_power": f"{TX_DBM} dBm", "data_rate": "6 Mb/s",
                      "preamble_detection": "none", "cca": {"preamble": "-110 dBm"},
                      "propagation": {"model": "friis"}},
            "fleet": [uav("home", [HOME], ping), uav("away", [CROSSING, HIDDEN, CROSSING])],
            "ground_station": {"enabled": False}}


def predicted(city):
    """[(east, SNR)] along the street."""
    def place(point):
        return ",".join(map(str, point))
    walk = subprocess.run(
        [BIN / "cuscus-channel", "--city", city, "--model", "friis", f"--standing={place(HOME)}",
         f"--from={place(CROSSING)}", f"--to={place(HIDDEN)}", "--step", "0.25"],
        capture_output=True, text=True, check=True)
    return [(float(row["x_m"]), TX_DBM - float(row["loss_db"]) - NOISE_DBM)
            for row in csv.DictReader(io.StringIO(walk.stdout))]


def away_track(run):
    """[(SimTime, east, height)], from the truth."""
    return [(row["sim_time_s"], row["x_m"], row["z_m"]) for row in run.metrics()
            if row["node"] == "away0" and row["x_m"] is not None]


def pings(run):
    """[(SimTime at which it was sent, answered)]. The first leaves at SimTime 0; "no answer yet for
    icmp_seq=7" is printed as the next one leaves."""
    lines = re.findall(r"\[([\d.]+)\] (no answer yet for )?.*?icmp_seq=(\d+)",
                       run.log("home0-command.log"))
    start = float(lines[0][0])
    return [(float(stamp) - start - (0.1 if missed else 0.0), not missed)
            for stamp, missed, _ in lines]


class Corner(unittest.TestCase):
    def test_ping_ends_at_the_corner_and_comes_back_there(self):
        with Run(scenario(), "--no-page") as run:
            self.assertIn(run.wait(), (0, 3), run.stderr)
            snr_db = predicted(run.results / "city.pb")
            end_m = next(east for east, snr in snr_db if snr < 2.0)
            track = away_track(run)
            turned_s = max(track, key=lambda entry: entry[1])[0]
            self.assertGreater(max(east for _, east, _ in track), end_m + 20, "did not fly far")
            self.assertLess(track[-1][1], 5.0, "did not come back")

            near, far, answered_at = [], [], []
            for sent_s, answered in pings(run):
                _, east_m, height_m = min(track, key=lambda entry: abs(entry[0] - sent_s))
                if height_m < 9.5:
                    continue  # it climbs
                # The truth is written every 200 ms: 1 m of flight.
                around = [snr for east, snr in snr_db if abs(east - east_m) <= 1.0]
                if min(around) > 5.0:
                    near.append(answered)
                elif max(around) < 0.5:
                    far.append(answered)
                if answered:
                    answered_at.append((sent_s, east_m))
            left_m = max(east for sent_s, east in answered_at if sent_s < turned_s)
            back_m = max(east for sent_s, east in answered_at if sent_s > turned_s)
            print(f"{sum(near)} of {len(near)} answered above 5 dB, {sum(far)} of {len(far)} below "
                  f"0.5 dB; 2 dB at {end_m:.1f} m, last answer at {left_m:.1f} m, first one on the "
                  f"way back at {back_m:.1f} m")
            self.assertGreater(len(near), 100)
            self.assertGreater(len(far), 80)
            self.assertGreaterEqual(sum(near) / len(near), 0.98)
            self.assertLessEqual(sum(far) / len(far), 0.02)
            # A ping every 0.4 m, the truth every 0.8 m, and whatever the host adds to either.
            self.assertAlmostEqual(left_m, end_m, delta=3.0)
            self.assertAlmostEqual(back_m, end_m, delta=3.0)


if __name__ == "__main__":
    unittest.main()
