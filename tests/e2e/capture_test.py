"""Captures of a run, as tshark reads them.

Two fixed nodes at 100 m exchange datagrams over Friis, so every level follows from the link budget:
16 dBm - 40.18 dB - 20 log10(100) = -64.2 dBm.
"""

import collections
import math
import pathlib
import tempfile
import unittest

from cuscus_run import Run
from dissection import ACK, CTS, DATA, RTS, WARNING, packets

PORT = 9000
DISTANCE_M = 100.0
TX_DBM = 16
SIGNAL_DBM = round(TX_DBM - 40.18 - 20 * math.log10(DISTANCE_M))
COUNT = 50
LISTENING = "{scenario_dir}/marks/listening"
SENDER = """
import os, socket, time
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
while not os.path.exists("%s"):  # or the receiver's kernel answers with ICMP
    time.sleep(0.01)
for i in range(%d):
    for target, words in (("{ip:right0}", 25), ("{ip:right0}", 300), ("{broadcast}", 20)):
        s.sendto(i.to_bytes(4, "big") * words, (target, %d))
        time.sleep(0.01)
time.sleep(1000)
""" % (LISTENING, COUNT, PORT)
RECEIVER = """
import socket
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.bind(("", %d))
open("%s", "w").close()
while True:
    s.recv(4096)
""" % (PORT, LISTENING)


def scenario(record, **radio):
    def node(name, x_m, program):
        return {"name": name, "vehicle": {"model": "fixed"},
                "start": {"layout": "list", "positions": [[f"{x_m} m", "0 m", "10 m"]]},
                "command": ["/usr/bin/python3", "-c", program]}
    return {
        "name": "captures", "duration": "6 s",
        "radio": {"data_rate": "54 Mb/s", "group_rate": "6 Mb/s", "tx_power": f"{TX_DBM} dBm",
                  **radio},
        "fleet": [node("left", 0, SENDER), node("right", DISTANCE_M, RECEIVER)],
        "ground_station": {"enabled": False}, "record": record,
    }


def of_kind(found, kind):
    return [packet for packet in found if packet["wlan.fc.type_subtype"] == kind]


def payloads(found, words):
    """Which of the datagrams of so many words of 4 B are there, whole."""
    return {int(packet["udp.payload"][:8], 16) for packet in found
            if packet["udp.payload"] and packet["udp.payload"] == packet["udp.payload"][:8] * words}


class Captures(unittest.TestCase):
    def fly(self, record, **radio):
        folder = pathlib.Path(tempfile.mkdtemp(prefix="cuscus-test-"))
        marks = folder / "marks"
        marks.mkdir()
        marks.chmod(0o777)  # programs have users of their own
        run = Run(scenario(record, **radio), "--no-page", folder=folder)
        self.addCleanup(run.remove)
        code = run.wait()
        self.assertIn(code, (0, 3), run.stderr)  # a host that was too slow has said so
        return run

    def capture(self, run, name):
        """The packets of one node, after what is true of every capture."""
        path = run.results / "captures" / f"{name}.pcapng"
        found = packets(path, ports=[PORT])
        self.assertGreater(len(found), COUNT)
        times = [packet["frame.time_epoch"] for packet in found]
        self.assertEqual(times, sorted(times))
        for packet in found:
            self.assertIsNone(packet["_ws.malformed"], packet)
            self.assertLess(packet["_ws.expert.severity"] or 0, WARNING, packet)
            self.assertEqual(packet["radiotap.channel.freq"], 2437)
            own = packet["frame.p2p_dir"] == 0
            self.assertEqual(packet["radiotap.txpower"], TX_DBM if own else None)
            self.assertEqual(packet["radiotap.dbm_antnoise"], None if own else -94)
            if packet["frame.len"] == packet["frame.cap_len"] and \
                    not packet["radiotap.flags.badfcs"]:
                self.assertEqual(packet["wlan.fcs.status"], 1, packet)
                self.assertIn(packet["udp.checksum.status"], (None, 1), packet)
        return found

    def test_rates_levels_and_payloads_are_those_of_the_run(self):
        run = self.fly({"captures": True}, rts_threshold=500)
        left, right = self.capture(run, "left0"), self.capture(run, "right0")
        self.assertEqual(run.fidelity["radio"]["packets_not_captured"], 0)
        self.assertEqual(run.fidelity["radio"]["packets_captured"], len(left) + len(right))

        for packet in left + right:
            group = packet["wlan.fc.type_subtype"] == DATA and packet["wlan.da"].startswith("ff")
            rate = {DATA: 6 if group else 54}.get(packet["wlan.fc.type_subtype"], 24)
            self.assertEqual(packet["radiotap.datarate"], rate)
            if packet["frame.p2p_dir"] == 1:
                self.assertEqual(packet["radiotap.dbm_antsignal"], SIGNAL_DBM)
        for found in (left, right):
            self.assertEqual(payloads(found, 25), set(range(COUNT)))
            self.assertEqual(payloads(found, 300), set(range(COUNT)))
            self.assertEqual(payloads(found, 20), set(range(COUNT)))
            # Only the long ones are announced; group frames are not answered.
            self.assertEqual(len(of_kind(found, RTS)), COUNT)
            self.assertEqual(len(of_kind(found, CTS)), COUNT)
            self.assertEqual(len(of_kind(found, ACK)), 2 * COUNT)
        self.assertEqual(len([p for p in of_kind(left, DATA) if p["frame.p2p_dir"] == 0]),
                         run.node("left0")["radio"]["transmissions"])

    def test_an_exchange_has_the_addresses_and_durations_of_the_standard(self):
        run = self.fly({"captures": ["right0"]}, rts_threshold=500)
        self.assertFalse((run.results / "captures" / "left0.pcapng").exists())
        found = self.capture(run, "right0")

        first = next(i for i, p in enumerate(found) if p["wlan.fc.type_subtype"] == RTS)
        rts, cts, data, ack = found[first:first + 4]
        self.assertEqual([p["wlan.fc.type_subtype"] for p in (rts, cts, data, ack)],
                         [RTS, CTS, DATA, ACK])
        left, right = "02:63:75:73:00:01", "02:63:75:73:00:02"
        self.assertEqual((rts["wlan.ra"], rts["wlan.ta"]), (right, left))
        self.assertEqual((data["wlan.da"], data["wlan.sa"]), (right, left))
        self.assertEqual(data["wlan.bssid"], "02:63:75:73:ff:ff")
        self.assertEqual((cts["wlan.ra"], ack["wlan.ra"]), (left, left))
        # CTS and ACK at 24 Mb/s take 20 + 8 + 6 us, SIFS is 10 us, and 1200 B of payload are a
        # PSDU of 1264 B, which takes 20 + 4 ceil((22 + 8 * 1264) / 216) + 6 = 214 us at 54 Mb/s.
        self.assertEqual(ack["wlan.duration"], 0)
        self.assertEqual(data["wlan.duration"], 10 + 34)
        self.assertEqual(cts["wlan.duration"], 10 + 214 + 10 + 34)
        self.assertEqual(rts["wlan.duration"], 10 + 34 + cts["wlan.duration"])

    def test_retries_are_marked_and_keep_their_sequence_number(self):
        run = self.fly({"captures": True, "failed_receptions": True},
                       fading={"model": "nakagami", "m": 1}, tx_power="10 dBm")
        radio = run.node("left0")["radio"]
        self.assertGreater(radio["retries"], 20)
        path = run.results / "captures"
        own = [p for p in of_kind(packets(path / "left0.pcapng", ports=[PORT]), DATA)
               if p["frame.p2p_dir"] == 0]
        self.assertEqual(len(own), radio["transmissions"])
        self.assertEqual(sum(p["wlan.fc.retry"] for p in own), radio["retries"])
        for before, packet in zip(own, own[1:]):
            if packet["wlan.fc.retry"]:
                self.assertEqual(packet["wlan.seq"], before["wlan.seq"])
                self.assertEqual(packet["radiotap.data_retries"],
                                 before["radiotap.data_retries"] + 1)
            else:
                self.assertEqual(packet["wlan.seq"], (before["wlan.seq"] + 1) % 4096)

        failed = [p for p in packets(path / "right0.pcapng", ports=[PORT])
                  if p["radiotap.flags.badfcs"]]
        self.assertGreater(len(failed), 10)
        for packet in failed:
            self.assertRegex(packet["frame.comment"], r"^lost: noise, SINR -?\d+\.\d dB$")
        levels = collections.Counter(p["radiotap.dbm_antsignal"] for p in failed)
        self.assertGreater(len(levels), 3)  # they fade

    def test_a_snap_length_cuts_packets_and_nothing_else(self):
        run = self.fly({"captures": True, "snap_length": 80})
        found = packets(run.results / "captures" / "right0.pcapng", ports=[PORT])
        self.assertEqual(max(p["frame.cap_len"] for p in found), 80)
        # Radiotap, MAC header, LLC and SNAP, IP, UDP, payload and FCS.
        self.assertEqual(max(p["frame.len"] for p in found), 24 + 24 + 8 + 20 + 8 + 1200 + 4)
        self.assertEqual({p["radiotap.dbm_antsignal"] for p in found} - {None}, {SIGNAL_DBM})


if __name__ == "__main__":
    unittest.main()
