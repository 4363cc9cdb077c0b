"""The canary measures the way through the host, end to end, and nobody else sees it."""

import os
import signal
import time
import unittest

from cuscus_run import Run, cuscus, descendants, program_of

DURATION_S = 5
PERIOD_S = 0.097
# Of netsim; beyond what a probe waits for its host on any day, below its patience.
STALL_S = 0.2


def silent_nodes(attach):
    """Nothing sends: only the canary can tell how late the emulator is."""
    return {"name": "silent", "duration": f"{DURATION_S} s", "network": {"attach": attach},
            "fleet": [{"name": "node", "count": 2, "vehicle": {"model": "fixed"}}],
            "ground_station": {"enabled": False}}


class Canary(unittest.TestCase):
    def check_consistent(self, run):
        canary = run.fidelity["canary"]
        self.assertEqual(canary["late"]["count"] + canary["lost"], canary["sent"])
        self.assertGreater(canary["sent"], 0.5 * DURATION_S / PERIOD_S)
        self.assertLessEqual(canary["sent"], DURATION_S / PERIOD_S + 1)
        checks = {check["name"]: check for check in run.fidelity["checks"]}
        self.assertIn("canary_later_than_8ms", checks)
        self.assertIn("canary_lost", checks)
        return canary

    def sings_unheard(self, attach):
        with Run(silent_nodes(attach), "--no-page") as run:
            run.until_flying(0.5)
            entry = run.registered()
            inside = ["exec", "--run", entry["run_id"], "node0"]
            hosts = cuscus(*inside, "cat", "/etc/hosts").stdout
            neighbours = cuscus(*inside, "ip", "neigh").stdout
            self.assertIn(run.wait(30), (0, 3), run.stderr)

            canary = self.check_consistent(run)
            print(f"{attach}: {canary}", flush=True)
            self.assertEqual(canary["lost"], 0)
            self.assertEqual([node["name"] for node in entry["nodes"]], ["node0", "node1"])
            self.assertIn("node1", hosts)
            self.assertNotIn("canary", hosts)
            self.assertNotIn("198.18.", neighbours)
            self.assertEqual([node["name"] for node in run.summary["nodes"]], ["node0", "node1"])
            self.assertEqual(set(run.summary["radio_total"].values()), {0})
            self.assertEqual(run.fidelity["radio"]["release_lateness"]["count"], 0)

    def test_sees_a_stalled_emulator(self):
        with Run(silent_nodes("direct"), "--no-page") as run:
            run.until_flying(0.5)
            (netsim,) = [pid for pid in descendants(run.process.pid)
                         if program_of(pid) == "cuscus-netsim"]
            os.kill(netsim, signal.SIGSTOP)
            time.sleep(STALL_S)  # the fault itself
            os.kill(netsim, signal.SIGCONT)
            self.assertIn(run.wait(30), (0, 3), run.stderr)

            canary = self.check_consistent(run)
            # A probe every 97 ms waited for the end of a stall of 200 ms.
            self.assertGreater(canary["late"]["max_ns"], 0.1e9)

    def test_sings_unheard_bridge(self):
        self.sings_unheard("bridge")

    def test_sings_unheard_direct(self):
        self.sings_unheard("direct")


if __name__ == "__main__":
    unittest.main()
