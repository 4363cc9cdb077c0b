"""Without root, without /dev/net/tun, with few descriptors: a run either says clearly what it lacks
or flies with what it has and says so.

An ordinary user's runs have their own mount namespace, in which /dev/net/tun is what the test says.
"""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from cuscus_run import BIN
from fault_support import private_registry, registry_entries, small_fleet

NOBODY = 65534
AS_NOBODY = ("setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups")


def setUpModule():
    private_registry()


def in_mounts(script):
    """A prefix that runs `script` in a new mount namespace, and then what follows."""
    return ("unshare", "--mount", "sh", "-ec", script + '\nexec "$@"', "sh")


TUN_FOR_ALL = in_mounts("""
    mount -t tmpfs -o mode=755,dev tmpfs /mnt
    mkdir /mnt/net
    mknod -m 666 /mnt/net/tun c 10 200
    mount --bind /mnt/net /dev/net""")
TUN_FOR_ROOT = in_mounts("""
    mount -t tmpfs -o mode=755,dev tmpfs /mnt
    mkdir /mnt/net
    mknod -m 600 /mnt/net/tun c 10 200
    mount --bind /mnt/net /dev/net""")
NO_TUN = in_mounts("""
    mount -t tmpfs tmpfs /mnt
    mount --bind /mnt /dev/net""")


class WithoutRights(unittest.TestCase):
    def setUp(self):
        # The build's folder may be closed to other users, and results are to be theirs.
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="cuscus-rights-"))
        self.addCleanup(shutil.rmtree, self.folder, True)
        self.bin = self.folder / "bin"
        shutil.copytree(BIN, self.bin)
        self.home = self.folder / "home"
        self.home.mkdir()
        self.scenario = self.home / "scenario.json"
        self.scenario.write_text(json.dumps(small_fleet("2 s")))
        os.chmod(self.folder, 0o755)
        for path in (self.home, self.scenario):
            os.chown(path, NOBODY, NOBODY)

    def start(self, *prefix, options=()):
        return subprocess.run(
            [*prefix, self.bin / "cuscus", "run", self.scenario, "--no-page",
             "--out", self.home / "results", *options],
            capture_output=True, text=True, timeout=60, cwd=self.home, stdin=subprocess.DEVNULL,
            env={"PATH": os.environ["PATH"], "XDG_RUNTIME_DIR": str(self.home)})

    def check_refused(self, done, *says):
        self.assertEqual(done.returncode, 2, done)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        for text in says:
            self.assertIn(text, done.stderr)
        self.assertEqual(sorted(path.name for path in self.home.iterdir()), ["scenario.json"])
        self.assertEqual(registry_entries(), [])

    def test_tun_is_for_root(self):
        self.check_refused(self.start(*TUN_FOR_ROOT, *AS_NOBODY), "/dev/net/tun", "sudo",
                           "chmod 0666")

    def test_no_tun(self):
        self.check_refused(self.start(*NO_TUN), "/dev/net/tun", "modprobe tun")
        self.check_refused(self.start(*NO_TUN, *AS_NOBODY), "/dev/net/tun")

    def test_few_descriptors(self):
        few = ("prlimit", "--nofile=64:64")
        # Root may raise the hard limit, unless it has lost that right.
        self.check_refused(
            self.start(*few, "setpriv", "--bounding-set=-sys_resource", "--inh-caps=-sys_resource"),
            "64", "ulimit -n")
        self.check_refused(self.start(*TUN_FOR_ALL, *few, *AS_NOBODY), "64", "ulimit -n")

    def test_under_sudo_results_are_the_callers(self):
        self.scenario.write_text(json.dumps(small_fleet("1 s", command=["true"])))
        done = subprocess.run(
            [self.bin / "cuscus", "run", self.scenario, "--no-page"], capture_output=True, text=True,
            timeout=60, cwd=self.home, stdin=subprocess.DEVNULL,
            env={"PATH": os.environ["PATH"], "SUDO_UID": str(NOBODY), "SUDO_GID": str(NOBODY)})
        self.assertIn(done.returncode, (0, 3), done.stderr)
        made = sorted(self.home.rglob("*"))
        self.assertIn("summary.json", [path.name for path in made])
        self.assertIn("uav0-command.log", [path.name for path in made])
        for path in made:
            self.assertEqual((path.stat().st_uid, path.stat().st_gid), (NOBODY, NOBODY), path)

    def test_maps_and_tables_into_a_closed_folder(self):
        closed = self.home / "closed"
        closed.mkdir(mode=0o700)
        for command in (["city", "generate", "grid", "--out", closed / "x.osm"],
                        ["air", self.scenario, "--duration", "1s", "--out", closed / "x.csv"]):
            done = subprocess.run([*AS_NOBODY, self.bin / "cuscus", *command], capture_output=True,
                                  text=True, timeout=60, cwd=self.home)
            self.assertEqual(done.returncode, 2, done)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn(f"{closed}/x.", done.stderr)
            self.assertIn("Permission denied", done.stderr)
            self.assertEqual(list(closed.iterdir()), [])

    def test_user_namespace_flies(self):
        done = self.start(*TUN_FOR_ALL, *AS_NOBODY)
        self.assertIn(done.returncode, (0, 3), done.stderr)
        results = self.home / "results"
        summary = json.loads((results / "summary.json").read_text())
        fidelity = json.loads((results / "fidelity.json").read_text())
        self.assertEqual(summary["end_reason"], "duration reached")
        for node in summary["nodes"]:
            self.assertGreater(node["radio"]["received"], 0)
            self.assertEqual([program["exit_code"] for program in node["programs"]], [0])
        notes = "\n".join(fidelity["notes"])
        self.assertIn("send times were taken when netsim read the frames", notes)
        for component in ("netsim", "world"):
            self.assertRegex(notes, rf"{component} ran under SCHED_OTHER instead of SCHED_FIFO")
        self.assertEqual((results / "summary.json").stat().st_uid, NOBODY)
        self.assertEqual(list((self.home / "cuscus").iterdir()), [])


if __name__ == "__main__":
    unittest.main()
