"""Plots of what disturbs a network: disruption, jammers, and a station that is slow."""

import contextlib
import json
import math
import pathlib
import tempfile

from . import theory
from .medium import NOISE_DBM
from .runs import air, rates, scenario_air

OVERHEAD_B = 64  # UDP, IP, LLC/SNAP, MAC, FCS


@contextlib.contextmanager
def scenario(positions, radio):
    """The path of a scenario with nodes that stand at `positions` [m]."""
    document = {
        "name": "plot",
        "radio": {"data_rate": "6 Mb/s", "group_rate": "6 Mb/s", "tx_power": "16 dBm",
                  "propagation": {"model": "friis"}, **radio},
        "fleet": [{"name": "node", "count": len(positions), "vehicle": {"model": "fixed"},
                   "start": {"layout": "list",
                             "positions": [[f"{x} m" for x in place] for place in positions]}}],
        "ground_station": {"enabled": False}}
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "scenario.json"
        path.write_text(json.dumps(document))
        yield path


def airtime_us(udp_payload_b, mbps):
    """ERP-OFDM without the signal extension, in which nothing is received (IEEE Std 802.11)."""
    symbols = math.ceil((16 + 8 * (udp_payload_b + OVERHEAD_B) + 6) / (4 * mbps))
    return 20 + 4 * symbols


def disruption():
    """Beacons of two nodes; of frames of airtime t, gamma + t / T are lost."""
    interval_us = 20_000
    for payload_b in (64, 1400):
        for step in range(10):
            gamma = step / 10
            with scenario([(0, 0, 10), (20, 0, 10)],
                          {"disruption": {"fraction": gamma, "interval": f"{interval_us} us",
                                          "phase": "random"}}) as path:
                row = scenario_air(path, "--payload", payload_b, "--period", "7.3ms", "--duration",
                                   "60s")
            expected = max(0.0, 1 - gamma - (airtime_us(payload_b, 6) / interval_us if gamma else 0))
            yield {"curve": f"{payload_b} B", "gamma": gamma, "here": row["delivery_ratio"],
                   "expected": expected}


def jammer():
    """A flow over 150 m, and a jammer beside its receiver.

    Expected: no jammer, and a sender that is weaker by what the jammer adds to the noise.
    """
    sender_dbm = 16 - theory.free_space_db(150)
    for mbps in (6, 24, 54):
        for eirp_dbm in range(-20, 15):
            with scenario([(0, 0, 10), (150, 0, 10)],
                          {"data_rate": f"{mbps} Mb/s", "preamble_detection": "none",
                           "rate_control": "constant", "retry_limit": 1,
                           "jammers": [{"position": ["150 m", "100 m", "10 m"],
                                        "power": f"{eirp_dbm} dBm"}]}) as path:
                row = scenario_air(path, "--traffic", "flow", "--payload", 1400, "--period", "5ms",
                                   "--duration", "10s")
            jammed_db = 10 * math.log10(
                1 + 10**((eirp_dbm - theory.free_space_db(100) - NOISE_DBM) / 10))
            expected = ""
            if eirp_dbm % 4 == 0:
                expected = air("--traffic", "flow", "-n", 1, "--payload", 1400, "--period", 5,
                               "--duration", 10, "--no-detection", *rates(mbps),
                               "--equal-power", sender_dbm - jammed_db)["delivery_ratio"]
            yield {"curve": f"{mbps} Mb/s", "eirp_dbm": eirp_dbm, "here": row["delivery_ratio"],
                   "expected": expected}


def rate_anomaly():
    """Three saturated stations, two of them together, the third ever farther away.

    Expected (Heusse et al., INFOCOM 2003): a cycle is one frame of each, of which that of the one
    next door takes as long as among three neighbours, and the others as long as among three that
    are as far apart as the third is.
    """
    def together(distance_m):
        return float(air("--traffic", "saturated", "--unicast", "-n", 3, "--payload", 1400,
                         "--layout", "circle", "--model", "friis", "--radius",
                         distance_m / math.sqrt(3), "--rate-control", "ideal", "--no-detection",
                         "--duration", 10)["goodput_mbps"])

    near = together(10)
    for step in range(36):
        distance_m = round(20 * 1.12**step)
        with scenario([(0, 0, 10), (10, 0, 10), (distance_m, 0, 10)],
                      {"rate_control": "ideal", "preamble_detection": "none"}) as path:
            row = scenario_air(path, "--traffic", "saturated", "--unicast", "--payload", 1400,
                               "--duration", "10s")
        expected = 3 / (1 / near + 2 / together(distance_m)) if step % 2 == 0 else ""
        yield {"curve": "all three", "distance_m": distance_m, "here": row["goodput_mbps"],
               "expected": expected}
