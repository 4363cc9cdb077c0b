"""Watches how long the host keeps each processor from running what is due.

A witness per processor sleeps for two milliseconds at a time, above every real-time thread of a
run: what makes it late is not the run but the machine below. Shorter sleeps would disturb the run.
"""

import gc
import json
import os
import signal
import subprocess
import sys
import time

PERIOD_S = 0.002
PRIORITY = 90


def watch(core, tolerance_s):
    """Until SIGTERM; prints the time watched and that in which a wake-up came too late."""
    stopped = []
    signal.signal(signal.SIGTERM, lambda *_: stopped.append(True))
    os.sched_setaffinity(0, {core})
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
    gc.disable()
    begin = last = time.monotonic()
    stalled_s = 0.0
    while not stopped:
        time.sleep(PERIOD_S)
        now = time.monotonic()
        # Whatever was due in the stall, but for its last tolerance_s, was late by more than that.
        stalled_s += max(0.0, now - last - PERIOD_S - tolerance_s)
        last = now
    print(json.dumps({"watched_s": last - begin, "stalled_s": stalled_s}))


class StallWitness:
    """Watches from enter to exit; then `share` is the worst processor's share of stalled time."""

    def __init__(self, tolerance_s):
        self.tolerance_s = tolerance_s
        self.share = None

    def __enter__(self):
        self.processes = [
            subprocess.Popen([sys.executable, __file__, str(core), str(self.tolerance_s)],
                             stdout=subprocess.PIPE, text=True)
            for core in sorted(os.sched_getaffinity(0))]
        return self

    def __exit__(self, *unused):
        for process in self.processes:
            process.terminate()
        reports = [json.loads(process.communicate()[0]) for process in self.processes]
        self.share = max(report["stalled_s"] / report["watched_s"] for report in reports)


if __name__ == "__main__":
    watch(int(sys.argv[1]), float(sys.argv[2]))
