"""An ordinary program of three nodes: broadcasts a numbered datagram every 50 ms and tells what it
hears. On the node named by the third argument it does to its own interface what the fourth says.

usage: chatter.py OWN_NUMBER BROADCAST_ADDRESS NAME_OF_THE_VICTIM link|mac|flood [DESTINATION...]
prints 'heard NODE NUMBER', the victim's steps, and at the end 'sent COUNT'
"""

import fcntl
import os
import select
import socket
import struct
import subprocess
import sys
import time

PORT = 5005
PERIOD_S = 0.05
# Others are still quiet when the last datagram arrives, and the run goes on for longer than this.
TALK_S, LISTEN_S = 5.0, 0.5
FAULT_AT_S, MENDED_AT_S = 1.5, 3.0
NEW_MAC = "02:11:22:33:44:55"
LOCAL_EXPERIMENTAL = 0x88B5  # EtherType, IEEE Std 802, 9.2.4
SIOCGIFHWADDR = 0x8927


def set_link(*arguments):
    subprocess.run(["ip", "link", "set", "wlan0", *arguments], check=True)


def own_mac(sock):
    reply = fcntl.ioctl(sock.fileno(), SIOCGIFHWADDR, struct.pack("256s", b"wlan0"))
    return reply[18:24]


class Chatter:
    def __init__(self, number, broadcast):
        self.number, self.broadcast = number, broadcast
        self.sent = 0
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
        self.socket.bind(("", PORT))
        self.socket.setblocking(False)

    def speak(self):
        """Numbers go on while the interface is down: the others see the gap."""
        try:
            self.socket.sendto(struct.pack("!II", self.number, self.sent), (self.broadcast, PORT))
        except OSError as error:
            print("not sent:", error.strerror, flush=True)
        self.sent += 1

    def hear(self):
        while True:
            try:
                data, _ = self.socket.recvfrom(2048)
            except BlockingIOError:
                return
            if len(data) == 8 and (heard := struct.unpack("!II", data))[0] != self.number:
                print("heard", *heard, flush=True)

    def run(self, faults):
        """`faults`: (time, what to do then) in order."""
        begin = time.monotonic()
        faults = list(faults)
        next_s = self.number * PERIOD_S / 3
        while (now := time.monotonic() - begin) < TALK_S + LISTEN_S:
            self.hear()
            if faults and now >= faults[0][0]:
                faults.pop(0)[1]()
            if now >= next_s and now < TALK_S:
                self.speak()
                next_s += PERIOD_S
            select.select([self.socket], [], [], 0.005)
        print("sent", self.sent, flush=True)


def link_faults(chatter):
    def down():
        set_link("down")
        chatter.hear()  # what had come by then
        print("wlan0 down", flush=True)

    def up():
        print("wlan0 up", flush=True)
        set_link("up")
    return [(FAULT_AT_S, down), (MENDED_AT_S, up)]


def mac_faults(chatter):
    def change():
        print("was", own_mac(chatter.socket).hex(":"), flush=True)
        set_link("address", NEW_MAC)
        print("is", own_mac(chatter.socket).hex(":"), flush=True)
    return [(FAULT_AT_S, change)]


def raw_frames_to(address, count):
    """Frames past the IP stack, to an Ethernet address of one's own choice."""
    with socket.socket(socket.AF_PACKET, socket.SOCK_RAW) as raw:
        raw.bind(("wlan0", 0))
        for _ in range(count):
            raw.send(bytes.fromhex(address.replace(":", "")) + own_mac(raw) +
                     struct.pack("!H", LOCAL_EXPERIMENTAL) + bytes(46))


def main():
    number, broadcast, victim, fault, *addresses = sys.argv[1:]
    chatter = Chatter(int(number), broadcast)
    faults = []
    if os.environ["CUSCUS_NAME"] == victim:
        faults = {"link": link_faults, "mac": mac_faults}[fault](chatter)
    elif addresses and chatter.number == 0:
        faults = [(MENDED_AT_S + 0.1 * i, lambda address=address: raw_frames_to(address, 10))
                  for i, address in enumerate(addresses)]
    chatter.run(faults)


if __name__ == "__main__":
    main()
