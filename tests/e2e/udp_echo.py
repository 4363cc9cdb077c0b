"""An ordinary Python UDP program: `udp_echo.py serve` echoes, `udp_echo.py ask ADDRESS COUNT` asks.

It knows nothing of the testbed. The asker prints "answered A of B".
"""

import socket
import sys
import time

PORT = 6000
GAP_S = 0.1


def serve():
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sock.bind(("", PORT))
    while True:
        data, sender = sock.recvfrom(2048)
        sock.sendto(data, sender)


def ask(address, count):
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sock.settimeout(1.0)
    answered = 0
    for i in range(count):
        sock.sendto(f"question {i}".encode(), (address, PORT))
        try:
            answered += sock.recv(2048) == f"question {i}".encode()
        except socket.timeout:
            pass
        time.sleep(GAP_S)
    print(f"answered {answered} of {count}", flush=True)


if __name__ == "__main__":
    if sys.argv[1] == "serve":
        serve()
    else:
        ask(sys.argv[2], int(sys.argv[3]))
