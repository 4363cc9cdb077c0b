"""What the tests of faults share: a registry of their own, and a look at what a run leaves behind.

Other people's runs may be alive on the same machine. Nothing here may see or touch them: processes
are signalled through pidfds after checking that they descend from the test's own run.
"""

import csv
import ctypes
import json
import os
import pathlib
import signal
import time

from cuscus_run import (BIN, Run, cuscus, descendants, links, mounts, network_namespaces,
                        pause)

CLONE_NEWNS = 0x00020000
MS_REC, MS_PRIVATE, MS_SHARED = 0x4000, 0x40000, 0x100000
REGISTRY = pathlib.Path("/run/cuscus")


def private_registry():
    """Gives this process and its children an empty /run/cuscus: `stop`, `exec` and `clean` without
    a run id then reach this test's runs alone. Call from setUpModule, once."""
    libc = ctypes.CDLL(None, use_errno=True)

    def check(result, what):
        if result != 0:
            raise OSError(ctypes.get_errno(), what)
    REGISTRY.mkdir(mode=0o755, exist_ok=True)
    check(libc.unshare(CLONE_NEWNS), "unshare")
    check(libc.mount(b"none", b"/", None, MS_REC | MS_PRIVATE, None), "make mounts private")
    # Shared again among ourselves, as systemd has it: a node's mounts would show here if they could.
    check(libc.mount(b"none", b"/", None, MS_REC | MS_SHARED, None), "make mounts shared")
    check(libc.mount(b"tmpfs", bytes(REGISTRY), b"tmpfs", 0, b"mode=0755"), "mount tmpfs")


def registry_entries():
    return sorted(entry.name for entry in REGISTRY.iterdir())


def small_fleet(duration="1 s", count=3, **group):
    """UAVs that take off on a circle, as quickly set up as possible."""
    return {"name": "faults", "duration": duration, "record": {"metrics_period": "20 ms"},
            "fleet": [{"name": "uav", "count": count,
                       "start": {"layout": "circle", "radius": "5 m"},
                       "mission": {"type": "circle", "radius": "5 m", "altitude": "2 m",
                                   "speed": "1 m/s"}, **group}]}


def program_path(pid):
    try:
        return pathlib.Path(os.readlink(f"/proc/{pid}/exe"))
    except OSError:
        return pathlib.Path()


def processes_of(run):
    """Processes of this build's programs, and all that have a file of the run's folder open."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit() or int(entry.name) == os.getpid():
            continue
        if program_path(entry.name).parent == BIN.resolve():
            found.append(int(entry.name))
            continue
        try:
            targets = [os.readlink(fd) for fd in (entry / "fd").iterdir()]
        except OSError:
            continue
        if any(target.startswith(f"{run.folder}/") for target in targets):
            found.append(int(entry.name))
    return found


class Target:
    """A process of the run to be signalled, never another that has got its number."""

    def __init__(self, run, pid):
        self.pidfd = None
        try:
            self.pidfd = os.pidfd_open(pid)
        except ProcessLookupError:
            return
        # Looked up with the pidfd open: the number cannot have changed hands in between.
        if pid != run.process.pid and pid not in descendants(run.process.pid):
            self.__exit__()

    def signal(self, number=signal.SIGKILL):
        """False: it has ended."""
        try:
            if self.pidfd is not None:
                signal.pidfd_send_signal(self.pidfd, number)
                return True
        except ProcessLookupError:
            pass
        return False

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        if self.pidfd is not None:
            os.close(self.pidfd)
            self.pidfd = None


def is_first_of_namespace(pid):
    """Whether it has number 1 in its own namespace of processes."""
    try:
        status = pathlib.Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return False
    return any(line.startswith("NSpid:") and line.split()[-1] == "1"
               for line in status.splitlines())


def members(run, program):
    """The run's processes of that program, oldest first. What an init has forked is still its
    program for a moment, and no init."""
    return [pid for pid in descendants(run.process.pid) if program_path(pid).name == program
            and (program != "cuscus-init" or is_first_of_namespace(pid))]


def namespaces_of(run):
    found = set()
    for pid in [run.process.pid, *descendants(run.process.pid)]:
        try:
            found.add(os.readlink(f"/proc/{pid}/ns/net"))
            found |= {target for fd in pathlib.Path(f"/proc/{pid}/fd").iterdir()
                      if (target := os.readlink(fd)).startswith("net:[")}
        except OSError:
            continue
    return found - {os.readlink("/proc/self/ns/net")}


class Traces:
    """What of a run would show that it has left something behind."""

    def __init__(self):
        self.links, self.mounts = links(), mounts()
        self.namespaces = set()

    def note(self, run):
        self.namespaces |= namespaces_of(run)

    def leftovers(self, run):
        left = {"processes": [(pid, str(program_path(pid))) for pid in processes_of(run)],
                "namespaces": sorted(self.namespaces & network_namespaces()),
                "links": sorted(set(links()) - set(self.links)),
                "mounts": sorted(set(mounts().splitlines()) - set(self.mounts.splitlines()))}
        return {what: which for what, which in left.items() if which}

    def check_gone(self, test, run, within_s=2.0):
        deadline = time.monotonic() + within_s
        while (left := self.leftovers(run)) and time.monotonic() < deadline:
            pause()
        test.assertEqual(left, {})


def check_readable(test, results):
    """Whatever has been recorded is whole."""
    for name in ("scenario.resolved.json", "summary.json", "fidelity.json"):
        if (results / name).exists():
            json.loads((results / name).read_text())
    metrics = results / "metrics.csv"
    if metrics.exists() and (text := metrics.read_text()):
        test.assertTrue(text.endswith("\n"), text[-200:])
        rows = list(csv.reader(text.splitlines()))
        test.assertEqual({len(row) for row in rows}, {len(rows[0])})


def check_next_run(test):
    with Run(small_fleet(), "--no-page") as run:
        test.assertIn(run.wait(30), (0, 3), run.stderr)
        test.assertEqual(run.summary["end_reason"], "duration reached")
    test.assertEqual(registry_entries(), [])
    test.assertEqual(cuscus("ps", "--json").stdout.strip(), "[]")
