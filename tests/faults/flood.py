"""Sends datagrams of 1400 bytes as fast as it can, broadcast and to one address in turn."""

import socket
import sys

with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
    sender.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
    sender.setblocking(False)
    payload = bytes(1400)
    targets = [(address, 5555) for address in sys.argv[1:]]
    while True:
        for target in targets:
            try:
                sender.sendto(payload, target)
            except BlockingIOError:
                pass
