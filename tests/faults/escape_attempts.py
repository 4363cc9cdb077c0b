"""Runs as a UAV's command and tries to get out of its node without harming what it might reach:
nothing is written, signals are number 0. Prints a JSON object: attempt -> whether it succeeded.

Arguments: a process of the host, a TCP port of the host's loopback, an abstract Unix socket of the
host, a private file of the host, the broadcast address.
"""

import ctypes
import json
import os
import pathlib
import socket
import sys

HOST_PID, PORT, ABSTRACT, SECRET, BROADCAST = (
    int(sys.argv[1]), int(sys.argv[2]), sys.argv[3], sys.argv[4], sys.argv[5])
LIBC = ctypes.CDLL(None, use_errno=True)
PTRACE_ATTACH, CLONE_NEWNET = 16, 0x40000000


def call(function, *arguments):
    if function(*arguments) != 0:
        raise OSError(ctypes.get_errno(), "refused")
    return True


def opens(path, flags=os.O_RDONLY):
    os.close(os.open(path, flags))
    return True


def connects(family, address):
    with socket.socket(family) as client:
        client.settimeout(1)
        client.connect(address)
    return True


def signals(pid):
    os.kill(pid, 0)
    return True


def enters(path):
    return call(LIBC.setns, os.open(path, os.O_RDONLY), 0)


def sees_other_programs():
    programs = [(entry / "cmdline").read_bytes().split(b"\0")[0]
                for entry in pathlib.Path("/proc").iterdir() if entry.name.isdigit()]
    return any(program.endswith((b"/cuscus", b"-netsim", b"-world", b"-gcs"))
               for program in programs) or len(programs) > 10


def other_routes():
    lines = pathlib.Path("/proc/net/route").read_text().splitlines()[1:]
    return any(line.split()[0] != "wlan0" for line in lines)


def raw_socket():
    socket.socket(socket.AF_PACKET, socket.SOCK_RAW).close()
    return True


def becomes_root():
    os.setuid(0)
    return True


def takes_priority():
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(99))
    return True


def renames_node():
    socket.sethostname("other")
    return True


def uses_radio():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
        return sender.sendto(b"hello", (BROADCAST, 5555)) == 5


ATTEMPTS = {
    "use the radio": uses_radio,  # allowed; shows that success shows
    "see programs of the host": sees_other_programs,
    "signal a process of the host": lambda: signals(HOST_PID),
    "trace a process of the host": lambda: call(LIBC.ptrace, PTRACE_ATTACH, HOST_PID, 0, 0),
    "signal the node's init": lambda: signals(1),
    "trace the node's init": lambda: call(LIBC.ptrace, PTRACE_ATTACH, 1, 0, 0),
    "read the init's memory": lambda: opens("/proc/1/mem"),
    "list the init's descriptors": lambda: bool(os.listdir("/proc/1/fd")),
    "enter the init's network": lambda: enters("/proc/1/ns/net"),
    "see the init's root": lambda: bool(os.listdir("/proc/1/root")),
    "reach the host's loopback": lambda: connects(socket.AF_INET, ("127.0.0.1", PORT)),
    "reach the host's abstract socket": lambda: connects(socket.AF_UNIX, "\0" + ABSTRACT),
    "have an interface besides lo, wlan0 and mon0":
        lambda: bool(set(os.listdir("/sys/class/net")) - {"lo", "wlan0", "mon0"}),
    "have a route besides wlan0": other_routes,
    "have a bridge or TAP in sight":
        lambda: bool([line for line in pathlib.Path("/proc/net/dev").read_text().splitlines()[2:]
                      if line.split(":")[0].strip() not in ("lo", "wlan0", "mon0")]),
    "mount": lambda: call(LIBC.mount, b"tmpfs", b"/mnt", b"tmpfs", 0, None),
    "make a network namespace": lambda: call(LIBC.unshare, CLONE_NEWNET),
    "see the registry of runs": lambda: os.path.exists("/run/cuscus"),
    "see anything in /run but the node's own": lambda: bool(set(os.listdir("/run")) - {"hosts"}),
    "see others' shared memory": lambda: bool(os.listdir("/dev/shm")),
    "read a private file of the host": lambda: opens(SECRET),
    "read the host's passwords": lambda: opens("/etc/shadow"),
    "write to the interface's settings": lambda: opens("/sys/class/net/wlan0/mtu", os.O_WRONLY),
    "write to /proc/sys/net": lambda: opens("/proc/sys/net/ipv4/ip_forward", os.O_WRONLY),
    "write to /proc/sys/kernel": lambda: opens("/proc/sys/kernel/core_pattern", os.O_WRONLY),
    "open a raw socket": raw_socket,
    "take realtime priority": takes_priority,
    "become root": becomes_root,
    "rename the node": renames_node,
    "have a descriptor of the testbed's": lambda: any(
        os.readlink(f"/proc/self/fd/{fd}").startswith(("/memfd:", "/dev/net", "socket:", "net:"))
        for fd in (3, 4, 5, 6, 7, 8, 9, 10) if os.path.lexists(f"/proc/self/fd/{fd}")),
}


def attempt(action):
    try:
        return bool(action())
    except OSError:
        return False


print(json.dumps({name: attempt(action) for name, action in ATTEMPTS.items()}), flush=True)
