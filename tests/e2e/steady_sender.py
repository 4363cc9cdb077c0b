"""Sends datagrams of a size to an address, some at once every so many milliseconds.

ADDRESS BYTES PERIOD [HOW MANY]
"""

import socket
import sys
import time

address, payload, period_s = sys.argv[1], bytes(int(sys.argv[2])), float(sys.argv[3]) / 1e3
at_once = int(sys.argv[4]) if len(sys.argv) > 4 else 1
with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
    sender.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
    due = time.monotonic()
    while True:
        for _ in range(at_once):
            sender.sendto(payload, (address, 5555))
        due += period_s
        time.sleep(max(0.0, due - time.monotonic()))
