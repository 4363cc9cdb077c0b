"""Frame logs, and what the simulator makes of their send times."""

import csv
import random
import subprocess

from cuscus_run import BIN

# Longer than any busy period of the loads that the tests have: a quarter of the air, frames of
# 0.2 ms.
APART_NS = 5_000_000
# For so long at least the medium is busy, or about to be, after a frame of 64 B of UDP was sent at
# 6 Mb/s: DIFS 50 us, 196 us of energy.
BUSY_NS = 240_000


class FrameLog:
    """frames.csv: lines of the header, and the frames by send time as replays number them."""

    def __init__(self, text):
        lines = text.splitlines()
        self.header = [line for line in lines if line.startswith("#")]
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
        self.columns = list(rows[0])
        self.frames = sorted(({key: value if key in ("destination", "outcome") else int(value)
                               for key, value in row.items()} for row in rows),
                             key=lambda frame: frame["sent_ns"])

    def write(self, path, send_time_ns):
        with open(path, "w") as file:
            file.write("".join(line + "\n" for line in self.header))
            writer = csv.DictWriter(file, self.columns, lineterminator="\n")
            writer.writeheader()
            writer.writerows({**frame, "sent_ns": send_time_ns(frame)} for frame in self.frames)

    def places_apart(self):
        """Places of frames that are sent at least APART_NS after one another.

        The frames of one busy period wait for one another, so their delays say nearly the same
        thing several times over, while a test of two samples takes each for a draw of its own.
        Frames of different busy periods owe each other nothing once their send times are given:
        what is left of their delays are backoffs. That both samples have the same send times
        makes them more alike than draws from one distribution, never less.
        """
        return self._apart(lambda before, frame: True)

    def contended_places(self):
        """The same of frames that come to a busy medium.

        A frame that finds the medium idle takes DIFS and its time on the air, whatever is drawn:
        only the others tell how backoffs are distributed. Which these are is read from the send
        times alone, so that every simulation of them picks the same.
        """
        return self._apart(lambda before, frame: frame["node"] != before["node"] and
                           frame["sent_ns"] - before["sent_ns"] < BUSY_NS)

    def _apart(self, wanted):
        places, latest_ns = set(), -APART_NS
        for place, (before, frame) in enumerate(zip(self.frames, self.frames[1:]), start=1):
            if frame["sent_ns"] >= latest_ns + APART_NS and wanted(before, frame):
                places.add(place)
                latest_ns = frame["sent_ns"]
        return places


def beacon_log(nodes, seconds, frame_bytes, period_ns=50_000_000, jitter_ns=0, seed=1):
    """The log of nodes that all hear one another and broadcast at phases of their own; how its
    frames fared is not in it."""
    draws = random.Random(seed)
    sends = sorted((round(phase_ns + period * period_ns + draws.uniform(0, jitter_ns)), node)
                   for node, phase_ns in ((node, draws.uniform(0, period_ns))
                                          for node in range(nodes))
                   for period in range(round(seconds * 1e9 / period_ns)))
    return FrameLog(f"# nodes={nodes}\n"
                    "sent_ns,node,destination,bytes,attempts,outcome,delivered_count,"
                    "first_delivery_ns,priority\n" +
                    "".join(f"{sent_ns},{node},group,{frame_bytes},1,sent,0,0,0\n"
                            for sent_ns, node in sends))


def simulate(folder, log, positions_m=None, seed=None, send_time_ns=lambda frame: frame["sent_ns"]):
    """Delivery times [ns] by (place of the frame in the log, receiver); without positions all are
    in range, without a seed the draws are those of the logged run."""
    frames, positions, receptions = (folder / name for name in
                                     ("sends.csv", "positions.csv", "receptions.csv"))
    log.write(frames, send_time_ns)
    options = [] if seed is None else ["--seed", str(seed)]
    if positions_m is not None:
        positions.write_text("time_ns,node,x_m,y_m,z_m\n" + "".join(
            f"0,{node},{x},{y},{z}\n" for node, (x, y, z) in enumerate(positions_m)))
        options += ["--positions", positions]
    subprocess.run([BIN / "cuscus-air", "--replay", frames, "--receptions", receptions, *options],
                   check=True, capture_output=True)
    with open(receptions) as file:
        return {(int(row["frame"]), int(row["receiver"])): int(row["delivery_ns"])
                for row in csv.DictReader(file)}


def air_delays_us(log, deliveries, places=None):
    """From each send, or from those at `places`, to the first reception."""
    first = {}
    for (place, _), time_ns in deliveries.items():
        if places is None or place in places:
            first[place] = min(time_ns, first.get(place, time_ns))
    return [(time_ns - log.frames[place]["sent_ns"]) / 1e3 for place, time_ns in first.items()]


def sent_when_read(period_ns):
    """A clock that sees frames late: those of one period enter the air together at its end."""
    return lambda frame: -(-frame["sent_ns"] // period_ns) * period_ns
