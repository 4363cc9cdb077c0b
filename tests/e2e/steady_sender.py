"""Sends datagrams of a size to an address, one every so many milliseconds: ADDRESS BYTES PERIOD."""

import socket
import sys
import time

address, payload, period_s = sys.argv[1], bytes(int(sys.argv[2])), float(sys.argv[3]) / 1e3
with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
    sender.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
    due = time.monotonic()
    while True:
        sender.sendto(payload, (address, 5555))
        due += period_s
        time.sleep(max(0.0, due - time.monotonic()))
