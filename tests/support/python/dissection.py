"""What tshark makes of a capture."""

import os
import subprocess
import tempfile

# Beyond a note, which tshark attaches to every retransmission.
WARNING = 0x600000

FIELDS = ("frame.time_epoch", "frame.p2p_dir", "frame.len", "frame.cap_len", "frame.comment",
          "radiotap.datarate", "radiotap.dbm_antsignal", "radiotap.dbm_antnoise",
          "radiotap.txpower", "radiotap.data_retries", "radiotap.channel.freq",
          "radiotap.flags.badfcs", "wlan.fc.type_subtype", "wlan.fc.retry", "wlan.seq",
          "wlan.duration", "wlan.ra", "wlan.ta", "wlan.da", "wlan.sa", "wlan.bssid",
          "wlan.fcs.status", "ip.src", "ip.dst", "udp.dstport", "udp.checksum.status",
          "udp.payload", "_ws.malformed", "_ws.expert.severity", "_ws.expert.message")

DATA, RTS, CTS, ACK = 0x20, 0x1b, 0x1c, 0x1d


def tshark(*arguments):
    """Standard output of tshark, which must have nothing to say beside it."""
    with tempfile.TemporaryDirectory() as home:  # nobody's settings
        done = subprocess.run(
            ["tshark", "-n", "-o", "wlan.check_checksum:TRUE", "-o", "ip.check_checksum:TRUE",
             "-o", "udp.check_checksum:TRUE", *map(str, arguments)],
            capture_output=True, text=True, timeout=60, env={**os.environ, "HOME": home})
    said = [line for line in done.stderr.splitlines() if "Running as user" not in line]
    assert done.returncode == 0 and not said, said
    return done.stdout


def packets(path, ports=()):
    """Every packet of a capture as a dictionary; numbers as numbers. Payloads on `ports` are taken
    as data, and not for a protocol that they happen to look like."""
    options = [part for field in FIELDS for part in ("-e", field)]
    for port in ports:
        options += ["-d", f"udp.port=={port},data"]
    text = tshark("-r", path, "-T", "fields", "-E", "separator=|", *options)
    return [{field: value(field, cell) for field, cell in zip(FIELDS, line.split("|"))}
            for line in text.splitlines()]


# Read as text, or as hexadecimal digits.
TEXTS = {"frame.comment", "udp.payload", "_ws.malformed", "_ws.expert.message"}


def value(field, text):
    """What a cell says: None, a text, or the highest of its numbers."""
    if not text:
        return None
    if field in TEXTS or ":" in text or field.startswith("ip."):
        return text
    return max(float(part) if "." in part else int(part, 0) for part in text.split(","))
