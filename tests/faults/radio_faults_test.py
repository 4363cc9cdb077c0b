"""What befalls a node's interface or the emulator, on both attachments: the radio counts it, the
other nodes go on, and whatever ends the run says so once."""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from chatter import MENDED_AT_S, NEW_MAC, PERIOD_S, FAULT_AT_S
from cuscus_run import BIN, Run
from fault_support import (Target, Traces, check_next_run, members, private_registry,
                           processes_of)

HERE = pathlib.Path(__file__).parent
PYTHON = "/usr/bin/python3"
NODES = ("node0", "node1", "node2")
VICTIM = "node1"
FLOOD_BITS_PER_S = 1e9
QUEUE_FRAMES = 500  # the default of radio.queue.frames


def setUpModule():
    private_registry()


def three_nodes(attach, duration, command, **radio):
    """Within metres of one another: nothing is lost but to collisions."""
    return {"name": "radio-faults", "duration": duration, "network": {"attach": attach},
            "radio": radio,
            "fleet": [{"name": "node", "count": 3, "vehicle": {"model": "fixed"},
                       "start": {"layout": "circle", "radius": "5 m"},
                       "command": list(map(str, command)),
                       "capabilities": ["cap_net_admin", "cap_net_raw"]}],
            "ground_station": {"enabled": False}}


def heard(log, node=None):
    """(node, number) of each datagram heard, or the numbers of one node's."""
    pairs = [(int(a), int(b)) for a, b in re.findall(r"^heard (\d+) (\d+)$", log, re.MULTILINE)]
    return pairs if node is None else [number for other, number in pairs if other == node]


class RadioFaults(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="cuscus-radio-faults-"))
        self.addCleanup(shutil.rmtree, self.folder, True)
        os.chmod(self.folder, 0o755)

    def script(self, name):
        """A copy that every uid can read."""
        return shutil.copy(HERE / name, self.folder / name)

    def fly(self, scenario):
        traces = Traces()
        run = Run(scenario, "--no-page")
        self.addCleanup(run.remove)
        run.until_flying(0.5)
        traces.note(run)
        code = run.wait(60)
        logs = {name: run.log(f"{name}-command.log") for name in NODES}
        self.assertIn(code, (0, 3), run.stderr)
        self.assertEqual(run.summary["end_reason"], "duration reached", run.stderr)
        traces.check_gone(self, run)
        return run, logs

    def check_every_reception_is_counted(self, run, logs):
        """Each frame of one node has one fate at each of the others, and the programs heard what
        the radio says they have."""
        radios = {name: run.node(name)["radio"] for name in NODES}
        for name, radio in radios.items():
            fates = radio["received"] + sum(count for key, count in radio.items()
                                            if key.startswith("lost_"))
            self.assertEqual(fates, sum(other["transmissions"] for other_name, other
                                        in radios.items() if other_name != name), radios)
            # Bridged, a TAP follows its wlan0 a moment later, in which a frame or two are lost.
            self.assertAlmostEqual(len(heard(logs[name])), radio["received"], delta=3)

    def link_down_and_up(self, attach):
        run, logs = self.fly(three_nodes(
            attach, "7 s",
            [PYTHON, self.script("chatter.py"), "{index}", "{broadcast}", VICTIM, "link"]))
        periods_down = round((MENDED_AT_S - FAULT_AT_S) / PERIOD_S)

        before, while_down, after = re.split(r"^wlan0 .*$", logs[VICTIM], flags=re.MULTILINE)
        self.assertGreater(len(heard(before)), 0)
        self.assertEqual(heard(while_down), [])
        self.assertGreater(len(heard(after)), 0)
        radio = run.node(VICTIM)["radio"]
        # Half of what the two others sent meanwhile, whoever was slow in between.
        self.assertGreater(radio["lost_interface"], periods_down, radio)
        for other in (0, 2):
            numbers = heard(logs[f"node{other}"], 1)
            gap = max(later - number for number, later in zip(numbers, numbers[1:]))
            self.assertGreater(gap, periods_down / 2, numbers)
            self.assertEqual(run.node(f"node{other}")["radio"]["lost_interface"], 0)
        self.check_every_reception_is_counted(run, logs)

    def mac_changed(self, attach):
        old = "02:63:75:73:00:02"
        run, logs = self.fly(three_nodes(
            attach, "7 s", [PYTHON, self.script("chatter.py"), "{index}", "{broadcast}", VICTIM,
                            "mac", old, NEW_MAC]))
        self.assertIn(f"was {old}\nis {NEW_MAC}\n", logs[VICTIM])

        # Its broadcasts are its own as before, and it hears those of the others.
        radio = run.node(VICTIM)["radio"]
        sent = int(re.search(r"^sent (\d+)$", logs[VICTIM], re.MULTILINE)[1])
        self.assertEqual(radio["transmissions"], sent)
        self.assertGreater(min(heard(logs[VICTIM], node)[-1] for node in (0, 2)), 0.9 * sent)
        for other in (0, 2):
            self.assertGreater(heard(logs[f"node{other}"], 1)[-1], 0.9 * sent)
        # The radio answers to the address that the run has given it, and to no other.
        sender = run.node("node0")["radio"]
        self.assertEqual(sender["acknowledged"], 10, sender)
        self.assertEqual(sender["dropped_retry_limit"], 10, sender)

    def flood_of_1_gbps(self, attach):
        """The flood is broadcast; what does not fit the air is the flooder's own loss."""
        script = (f'if [ "$CUSCUS_NAME" = {VICTIM} ]; then exec "$1" "$2" {FLOOD_BITS_PER_S:.0f} 4; '
                  'fi; exec "$3" "$4" "$5" "$2" none link')
        run, logs = self.fly(three_nodes(
            attach, "8 s", ["/bin/sh", "-c", script, "sh", BIN / "flooder", "{broadcast}", PYTHON,
                            self.script("chatter.py"), "{index}"]))
        sent, rate = re.search(r"^sent (\d+) at (\d+) b/s$", logs[VICTIM], re.MULTILINE).groups()

        # Frame by frame: on the air, dropped by its queue, or lost on its way to the emulator.
        flooder = run.node(VICTIM)["radio"]
        print(f"{attach}: {int(sent)} datagrams at {int(rate) / 1e9:.2f} Gb/s, {flooder}")
        self.assertEqual(flooder["offered"], int(sent), flooder)
        self.assertGreater(flooder["dropped_queue_full"], 1000, flooder)
        node = run.node(VICTIM)
        self.assertGreaterEqual(node["emulator"]["queue_high_water"], QUEUE_FRAMES, node)
        # A TAP holds 1000 frames: what did not fit is among those that never reached the air.
        self.assertLessEqual(node["tap_dropped"], flooder["dropped_before_air"], node)
        # Many times what the air carries at 6 Mb/s, if not all that was asked of the host.
        self.assertGreater(int(rate), 60e6)
        # The others share the air with it, as with any station that always has something to send:
        # nothing of theirs is dropped, and they hear one another.
        for name, other in (("node0", 2), ("node2", 0)):
            radio = run.node(name)["radio"]
            own = int(re.search(r"^sent (\d+)$", logs[name], re.MULTILINE)[1])
            self.assertEqual(radio["transmissions"], own, radio)
            self.assertEqual(radio["dropped_queue_full"] + radio["dropped_lifetime"], 0, radio)
            self.assertGreater(len(heard(logs[name], other)), own / 2)

    def netsim_killed(self, attach):
        traces = Traces()
        with Run(three_nodes(attach, "20 s", ["sleep", "1000"]), "--no-page") as run:
            run.until_flying(0.5)
            (netsim,) = members(run, "cuscus-netsim")
            with Target(run, netsim) as target:
                traces.note(run)
                target.signal()
            self.assertEqual(run.wait(15), 1, run.stderr)
            traces.check_gone(self, run)
            self.assertEqual(run.fidelity["verdict"], "INVALID")
            self.assertEqual(run.summary["exit_code"], 1)
            self.assertRegex(run.summary["end_reason"], "netsim ended: signal 9")
            self.assertEqual(run.stderr.count("netsim ended: signal 9"), 1, run.stderr)

            # What somebody starts in its place says what it is, and changes nothing.
            by_hand = subprocess.run([BIN / "cuscus-netsim"], capture_output=True, text=True,
                                     timeout=20, env={"PATH": "/usr/bin:/bin"})
            self.assertEqual(by_hand.returncode, 1)
            self.assertIn("CUSCUS_CONTROL_FD", by_hand.stdout + by_hand.stderr)
            self.assertEqual(traces.leftovers(run), {})
            self.assertEqual(processes_of(run), [])
        check_next_run(self)

    def test_link_down_and_up_bridge(self):
        self.link_down_and_up("bridge")

    def test_link_down_and_up_direct(self):
        self.link_down_and_up("direct")

    def test_mac_changed_bridge(self):
        self.mac_changed("bridge")

    def test_mac_changed_direct(self):
        self.mac_changed("direct")

    def test_flood_of_1_gbps_bridge(self):
        self.flood_of_1_gbps("bridge")

    def test_flood_of_1_gbps_direct(self):
        self.flood_of_1_gbps("direct")

    def test_netsim_killed_by_hand_bridge(self):
        self.netsim_killed("bridge")

    def test_netsim_killed_by_hand_direct(self):
        self.netsim_killed("direct")


if __name__ == "__main__":
    unittest.main()
