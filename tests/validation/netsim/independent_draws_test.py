"""Can the comparison of live_equals_simulation_test.py tell a true emulator from a wrong one?

One log of send times, simulated with different seeds: backoffs differ, distributions do not, and
the test of Kolmogorov and Smirnov must say so. Frames that are late, that enter the air in clumps,
or whose slots are too short have other distributions, and it must say that too."""

import pathlib
import tempfile
import unittest

from frame_replay import air_delays_us, beacon_log, sent_when_read, simulate
from kolmogorov_smirnov import distance, probability

FRAME_B = 14 + 20 + 8 + 64  # as in the live runs: 64 B of UDP
PERIOD_NS = 50_000_000
SIGNIFICANCE = 0.01
PAIRS = 12
LATE_US = 300.0
READ_PERIOD_NS = 500_000


def p_value(first, second):
    return probability(distance(first, second), len(first), len(second))


class IndependentDraws(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="cuscus-draws-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def check(self, nodes, seconds):
        # A jitter of a whole period: other frames meet in every period.
        log = beacon_log(nodes, seconds, FRAME_B, PERIOD_NS, jitter_ns=PERIOD_NS)
        contended, apart = log.contended_places(), log.places_apart()
        receptions = len(log.frames) * (nodes - 1)
        runs = [simulate(self.folder, log, seed=seed) for seed in range(1, 2 * PAIRS + 1)]
        delays_us = [air_delays_us(log, run, contended) for run in runs]
        same = [p_value(first, second) for first, second in zip(delays_us[::2], delays_us[1::2])]
        late = p_value(delays_us[0], [delay_us + LATE_US for delay_us in delays_us[1]])
        clumped = p_value(air_delays_us(log, runs[0], apart), air_delays_us(log, simulate(
            self.folder, log, seed=2, send_time_ns=sent_when_read(READ_PERIOD_NS)), apart))
        log.header.append("# slot_ns=9000")
        short_slots = p_value(delays_us[0],
                              air_delays_us(log, simulate(self.folder, log, seed=2), contended))
        print(f"N = {nodes}: {len(contended)} of {len(log.frames)} frames; p of {PAIRS} pairs of "
              f"seeds {min(same):.3f} ... {max(same):.3f}; {LATE_US:.0f} us late {late:.1g}, "
              f"clumped {clumped:.1g}, slots of 9 us {short_slots:.1g}", flush=True)

        self.assertFalse(set(delays_us[0]) == set(delays_us[1]), "one seed draws as the other")
        # Of 12 at a level of 1 % two and more happen once in 170 times.
        self.assertLessEqual(sum(p < SIGNIFICANCE for p in same), 1, same)
        self.assertLess(late, SIGNIFICANCE)
        self.assertLess(clumped, SIGNIFICANCE)
        self.assertLess(short_slots, SIGNIFICANCE)
        for run in runs:
            self.assertAlmostEqual(len(run) / receptions, len(runs[0]) / receptions, delta=0.01)

    def test_10_nodes(self):
        self.check(10, seconds=12)

    def test_40_nodes(self):
        self.check(40, seconds=3)

    def test_the_same_seed_draws_the_same(self):
        log = beacon_log(10, 1, FRAME_B, jitter_ns=PERIOD_NS)
        self.assertTrue(simulate(self.folder, log, seed=7) == simulate(self.folder, log, seed=7))


if __name__ == "__main__":
    unittest.main()
