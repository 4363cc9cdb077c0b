"""Plots of PHY and MAC: what cuscus-air prints, against analysis and other simulators."""

from . import theory
from .runs import air, rates, reference

NOISE_DBM = -93.97  # of 20 MHz, noise figure 7 dB


def error_models():
    """Delivery of frames of 1400 B over the SNR, of each error model."""
    for model in ("nist", "yans", "table"):
        for mbps in (6, 24, 54):
            for step in range(-4, 100):
                snr_db = step / 4
                row = air("--traffic", "flow", "-n", 1, "--payload", 1400, "--period", 5,
                          "--duration", 5, "--no-detection", "--error-model", model, *rates(mbps),
                          "--equal-power", NOISE_DBM + snr_db)
                yield {"curve": f"{model} {mbps} Mb/s", "snr_db": snr_db,
                       "here": row["delivery_ratio"]}


def distance():
    """Delivery over distance in free space, here and in ns-3, without preamble detection."""
    for row in reference("pdr_vs_distance_friis.csv"):
        if row["preamble_det"] != "none":
            continue
        curve = f"{'broadcast' if row['cast'] == 'bcast' else 'unicast'} {row['mode_mbps']} Mb/s"
        cast = [] if row["cast"] == "bcast" else ["--unicast"]
        here = air("--traffic", "flow", "-n", 1, "--layout", "line", "--model", "friis",
                   "--payload", row["payload_B"], "--period", 40, "--duration", 80,
                   "--no-detection", *rates(row["mode_mbps"]), "--distance", row["dist_m"], *cast)
        yield {"curve": f"{curve} {row['payload_B']} B", "distance_m": row["dist_m"],
               "here": here["delivery_ratio"], "expected": row["pdr_mean"],
               "expected_ci95": row["pdr_ci95"]}


def saturation():
    """Goodput of saturated stations with 1400 B at 6 Mb/s, slot 20 us, here and in ns-3."""
    for cast, layout in (("unicast", "equalRSS-50"), ("unicast", "circle10m-friis"),
                         ("broadcast", "equalRSS-50"), ("broadcast", "circle10m-friis")):
        for row in reference(f"saturation_{cast}.csv"):
            if (row["layout"], row["slot_us"], row["mode_mbps"]) != (layout, "20", "6"):
                continue
            options = ["--unicast"] if cast == "unicast" else []
            options += ["--layout", "circle", "--model", "friis"] if "circle" in layout else []
            here = air("--traffic", "saturated", "-n", row["n"], "--payload", 1400, "--duration",
                       20, *options)
            yield {"curve": f"{cast} {'circle' if 'circle' in layout else 'equal powers'}",
                   "stations": row["n"], "here": here["goodput_mbps"],
                   "expected": row["goodput_mbps_mean"], "expected_ci95": row["goodput_ci95"]}


# Of an independent simulation of the standard's DCF (agreement.md): goodput [Mb/s] of IP packets of
# 1500 B by number of stations, and probabilities of collision with slots of 20 us.
SIMULATED_MBPS = {(6, 20): {1: 5.133, 2: 4.959, 5: 4.569, 10: 4.232, 20: 3.864},
                  (24, 20): {1: 15.27, 2: 15.55, 5: 14.81, 10: 13.85, 20: 12.71},
                  (54, 20): {1: 24.11, 2: 25.77, 5: 25.35, 10: 23.98, 20: 22.17},
                  (54, 9): {1: 30.50, 2: 30.86, 5: 28.96, 10: 27.01, 20: 24.78}}
SIMULATED_COLLISIONS = {2: 0.110, 5: 0.262, 10: 0.368, 20: 0.471}
# Time on air of 1536 B and of the ACK [us], IEEE Std 802.11.
AIRTIMES_US = {6: (2078, 50), 24: (542, 34), 54: (254, 34)}
STATIONS = range(1, 21)


def saturated(stations, mbps, slot_us, duration_s):
    """Every collision is noticed as a frame that failed, so that those around wait EIFS."""
    return air("--traffic", "saturated", "--unicast", "-n", stations, "--payload", 1472, "--slot",
               slot_us, "--duration", duration_s, "--no-detection", *rates(mbps))


def saturation_analysis():
    for (mbps, slot_us), simulated in SIMULATED_MBPS.items():
        for stations in STATIONS:
            here = saturated(stations, mbps, slot_us, 10)
            yield {"curve": f"{mbps} Mb/s: slot {slot_us} µs", "stations": stations,
                   "here": f"{float(here['goodput_mbps']) * 1500 / 1472:.4f}",
                   "expected": simulated.get(stations, ""),
                   "analysis": theory.saturation_mbps(stations, 1500, *AIRTIMES_US[mbps], slot_us)}


def collisions():
    for stations in STATIONS:
        here = saturated(stations, 54, 20, 20)
        yield {"curve": "54 Mb/s: slot 20 µs", "stations": stations,
               "here": f"{1 - float(here['attempt_success']):.4f}",
               "expected": SIMULATED_COLLISIONS.get(stations, ""),
               "analysis": theory.collision_probability(stations)[0]}


def fairness():
    """Jain's index of saturated stations over how long it is measured, means of 10 seeds."""
    for stations in (2, 5, 20):
        for duration_s in (0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20):
            runs = [float(air("--traffic", "saturated", "--unicast", "-n", stations, "--payload",
                              1472, "--duration", duration_s, "--seed", seed)["jain"])
                    for seed in range(1, 11)]
            yield {"curve": f"{stations} stations", "duration_s": duration_s,
                   "here": f"{sum(runs) / len(runs):.4f}"}


def beacons():
    """Delivery of 64 B beacons each 50 ms, jitter 1 ms, here (20 seeds) and in ns-3."""
    for row in reference("beacons.csv"):
        if (row["layout"], row["phase"]) != ("equalRSS-50", "jitter1ms"):
            continue
        runs = [float(air("-n", row["n"], "--jitter", 1, "--duration", 1, "--seed", seed)
                      ["delivery_ratio"]) for seed in range(1, 21)]
        yield {"curve": "beacons", "nodes": row["n"], "here": f"{sum(runs) / len(runs):.5f}",
               "expected": row["delivery_mean"], "expected_ci95": row["delivery_ci95"]}


def rate_control():
    """Goodput of one sender in free space, as fast as its MAC takes frames of 1400 B."""
    curves = (*((name, ("--rate", 6, "--rate-control", name))
                for name in ("ideal", "aarf", "minstrel")),
              *((f"constant {mbps} Mb/s", ("--rate", mbps)) for mbps in (6, 24, 54)))
    distances = [round(100 * 1.06**step) for step in range(53)]
    for curve, options in curves:
        for distance_m in distances:
            here = air("--traffic", "saturated", "--unicast", "-n", 1, "--payload", 1400,
                       "--layout", "line", "--model", "friis", "--no-detection", "--distance",
                       distance_m, "--duration", 5, *options)
            yield {"curve": curve, "distance_m": distance_m, "here": here["goodput_mbps"]}
