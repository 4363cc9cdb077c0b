"""mon0: unmodified programs on libpcap read the signal strength of every frame.

Fixed nodes on a line, 100 m apart, over Friis: 16 dBm - 40.18 dB - 20 log10(d) at 100 m and 200 m.
"""

import json
import math
import re
import unittest

from cuscus_run import Run, cuscus

CHATTER = """
import socket, time
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
while True:
    s.sendto(b"beacon", ("{broadcast}", 9000))
    time.sleep(0.05)
"""
TCPDUMP = ["tcpdump", "-i", "mon0", "-y", "IEEE802_11_RADIO", "-nn", "-l"]
NAMES = ("left0", "middle0", "right0")
ADDRESSES = ("10.42.0.1", "10.42.0.2", "10.42.0.3")


def signal_dbm(distance_m):
    return round(16 - 40.18 - 20 * math.log10(distance_m))


def scenario(**network):
    return {
        "name": "monitor", "duration": "8 s", "network": network,
        "radio": {"tx_power": "16 dBm", "group_rate": "12 Mb/s"},
        "fleet": [{"name": name[:-1], "vehicle": {"model": "fixed"},
                   "capabilities": ["cap_net_raw"],
                   "start": {"layout": "list", "positions": [[f"{100 * i} m", "0 m", "10 m"]]},
                   "command": ["/usr/bin/python3", "-c", CHATTER]}
                  for i, name in enumerate(NAMES)],
        "ground_station": {"enabled": False},
    }


def heard(text):
    """{(sender's address, signal)} of a printout of tcpdump."""
    return {(found[2], int(found[1])) for found in
            re.finditer(r"12\.0 Mb/s 2437 MHz 11g (-\d+)dBm signal -94dBm noise "
                        r"IP ([\d.]+)\.\d+ > 10\.42\.255\.255\.9000: UDP, length 6", text)}


class Monitor(unittest.TestCase):
    def fly(self, **network):
        run = Run(scenario(**network), "--no-page")
        self.addCleanup(run.remove)
        run.until_flying(1.0)
        self.id = run.registered()["run_id"]
        return run

    def inside(self, node, *command):
        done = cuscus("exec", "--run", self.id, node, "--", *command)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_neighbours_are_heard_at_the_level_that_the_channel_gives(self):
        for attach in ("bridge", "direct"):
            with self.subTest(attach=attach):
                run = self.fly(attach=attach)
                self.inside("right0", "ip", "link", "set", "mon0", "up")
                printed = self.inside("right0", *TCPDUMP, "-c", "40")
                self.assertEqual(heard(printed), {(ADDRESSES[0], signal_dbm(200)),
                                                  (ADDRESSES[1], signal_dbm(100))}, printed)
                # Its own transmissions have their power instead.
                self.assertRegex(printed, r"16dBm tx power .* IP 10\.42\.0\.3\.")
                self.assertIn(run.wait(), (0, 3))
                radio = run.fidelity["radio"]
                self.assertGreaterEqual(radio["packets_monitored"], 40)
                self.assertEqual(radio["packets_not_monitored"], 0)

    def test_an_interface_that_nobody_sets_up_costs_no_writes(self):
        run = self.fly()
        self.assertEqual(self.inside("left0", "cat", "/sys/class/net/mon0/type"), "803\n")
        link = json.loads(self.inside("left0", "ip", "-j", "-s", "link", "show", "mon0"))[0]
        self.assertNotIn("UP", link["flags"])
        self.assertEqual(link["stats64"]["rx"]["packets"], 0)
        self.assertIn(run.wait(), (0, 3))
        self.assertEqual(run.fidelity["radio"]["packets_monitored"], 0)
        self.assertEqual(run.fidelity["radio"]["packets_not_monitored"], 0)

    def test_it_can_be_up_from_the_start_and_goes_quiet_when_it_is_set_down(self):
        run = self.fly(monitor=True, ipv6=True)
        printed = self.inside("middle0", *TCPDUMP, "-c", "20")
        self.assertEqual({address for address, _ in heard(printed)},
                         {ADDRESSES[0], ADDRESSES[2]}, printed)
        for name in NAMES:
            self.inside(name, "ip", "link", "set", "mon0", "down")
        # What was on its way has been refused by now: a question every 100 ms, and no more.
        before = self.inside("middle0", "cat", "/sys/class/net/mon0/statistics/rx_packets")
        self.inside("middle0", "sleep", "1")
        after = self.inside("middle0", "cat", "/sys/class/net/mon0/statistics/rx_packets")
        self.assertEqual(before, after)
        self.assertIn(run.wait(), (0, 3))

    def test_nothing_but_the_radio_is_on_it(self):
        """No neighbour discovery, no multicast reports: neither of IPv4 nor of IPv6."""
        run = self.fly(ipv6=True)
        self.inside("left0", "ip", "link", "set", "mon0", "up")
        sent = self.inside("left0", "cat", "/sys/class/net/mon0/statistics/tx_packets")
        addresses = json.loads(self.inside("left0", "ip", "-j", "addr", "show", "mon0"))[0]
        self.assertEqual(sent, "0\n")
        self.assertEqual(addresses["addr_info"], [])
        self.assertIn(run.wait(), (0, 3))

    def test_a_program_of_the_scenario_reads_it(self):
        wanted = scenario(monitor=True)
        wanted["fleet"][1]["command"] = [*TCPDUMP, "-c", "10"]
        with Run(wanted, "--no-page") as run:
            self.assertIn(run.wait(), (0, 3), run.stderr)
            self.assertEqual(heard(run.log("middle0-command.log")),
                             {(ADDRESSES[0], signal_dbm(100)), (ADDRESSES[2], signal_dbm(100))})


if __name__ == "__main__":
    unittest.main()
