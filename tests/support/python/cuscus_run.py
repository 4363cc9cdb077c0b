"""Runs `cuscus` as a user does and reads what it leaves, for tests that are Python programs.

Every run gets a scratch folder of its own; nothing is ever found by a process's name.
"""

import csv
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

BIN = pathlib.Path(os.environ["CUSCUS_BIN"])
SOURCE = pathlib.Path(os.environ["CUSCUS_SOURCE"])
SCENARIOS = SOURCE / "scenarios"


class Run:
    """One `cuscus run`, started in the background."""

    def __init__(self, scenario, *options, folder=None, env=None, prefix=(),
                 **popen):
        self.folder = pathlib.Path(folder or tempfile.mkdtemp(prefix="cuscus-test-"))
        os.chmod(self.folder, 0o755)
        if isinstance(scenario, dict):
            self.scenario = self.folder / "scenario.json"
            self.scenario.write_text(json.dumps(scenario, indent=1))
        else:
            self.scenario = pathlib.Path(scenario)
        self.results = self.folder / "results"
        self.stdout_path = self.folder / "stdout"
        self.stderr_path = self.folder / "stderr"
        command = [*prefix, BIN / "cuscus", "run", self.scenario, "--out", self.results, *options]
        with open(self.stdout_path, "w") as out, open(self.stderr_path, "w") as err:
            self.process = subprocess.Popen(
                [str(part) for part in command], env={**os.environ, **(env or {})},
                **{"stdout": out, "stderr": err, "stdin": subprocess.DEVNULL,
                   "start_new_session": True, **popen})

    def wait(self, timeout=180):
        """The exit code."""
        try:
            return self.process.wait(timeout)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise AssertionError(f"the run did not end within {timeout} s:\n{self.stderr}")

    def interrupt(self, number=signal.SIGINT):
        self.process.send_signal(number)

    @property
    def stdout(self):
        return self.stdout_path.read_text()

    @property
    def stderr(self):
        return self.stderr_path.read_text()

    @property
    def summary(self):
        return json.loads((self.results / "summary.json").read_text())

    @property
    def fidelity(self):
        return json.loads((self.results / "fidelity.json").read_text())

    def metrics(self):
        """Rows of metrics.csv, numbers as floats, empty fields as None."""
        with open(self.results / "metrics.csv") as file:
            return [{key: number(value) for key, value in row.items()}
                    for row in csv.DictReader(file)]

    def log(self, name):
        path = self.results / "logs" / name
        return path.read_text(errors="replace") if path.exists() else ""

    def node(self, name):
        """What summary.json says of one node."""
        return next(node for node in self.summary["nodes"] if node["name"] == name)

    def registered(self):
        """The entry of this run in `cuscus ps`, or None."""
        for entry in json.loads(cuscus("ps", "--json").stdout):
            if entry["pid"] == self.process.pid:
                return entry
        return None

    def until(self, what, condition, timeout=60):
        """Waits for a state of the run; fails when the run ends first."""
        deadline = time.monotonic() + timeout
        while True:
            value = condition()
            if value:
                return value
            if self.process.poll() is not None:
                raise AssertionError(f"the run ended before {what}:\n{self.stderr}")
            if time.monotonic() > deadline:
                raise AssertionError(f"no {what} within {timeout} s:\n{self.stderr}")
            pause()

    def until_flying(self, sim_time_s=0.5):
        """Waits until metrics.csv has rows of that SimTime."""
        path = self.results / "metrics.csv"

        def reached():
            lines = path.read_text().splitlines() if path.exists() else []
            return len(lines) > 1 and float(lines[-1].split(",")[0]) >= sim_time_s
        self.until(f"SimTime {sim_time_s} s", reached)

    def remove(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def __enter__(self):
        return self

    def __exit__(self, kind, value, trace):
        if kind is not None:
            print(f"--- stderr of the run ---\n{self.stderr}\n--- stdout ---\n{self.stdout}",
                  file=sys.stderr)
        self.remove()


def number(text):
    """`text` as a float where it is one; empty as None."""
    try:
        return float(text) if text else None
    except ValueError:
        return text


def pause():
    """Between two looks at a state that is waited for."""
    time.sleep(0.02)


def cuscus(*arguments, timeout=60, **options):
    """A short command of cuscus, finished."""
    return subprocess.run([str(BIN / "cuscus"), *map(str, arguments)], capture_output=True,
                          text=True, timeout=timeout, stdin=subprocess.DEVNULL, **options)


def descendants(pid):
    """The processes below `pid`, by pid."""
    children = {}
    for entry in pathlib.Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                parent = int((entry / "stat").read_text().rsplit(")", 1)[1].split()[1])
            except (OSError, IndexError):
                continue
            children.setdefault(parent, []).append(int(entry.name))
    found, todo = [], [pid]
    while todo:
        for child in children.get(todo.pop(), []):
            found.append(child)
            todo.append(child)
    return sorted(found)


def program_of(pid):
    """Name of a process's executable."""
    try:
        return pathlib.Path(os.readlink(f"/proc/{pid}/exe")).name
    except OSError:
        return ""


def network_namespaces():
    """The network namespaces that some process is in or holds open."""
    found = set()
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            found.add(os.readlink(entry / "ns/net"))
            for fd in (entry / "fd").iterdir():
                target = os.readlink(fd)
                if target.startswith("net:["):
                    found.add(target)
        except OSError:
            continue
    return found


def links():
    return sorted(os.listdir("/sys/class/net"))


def mounts():
    return pathlib.Path("/proc/self/mounts").read_text()
