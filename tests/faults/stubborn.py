"""Ignores every signal it can, and leaves a daemon behind that does too."""

import os
import signal

for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    signal.signal(number, signal.SIG_IGN)
if os.fork() == 0:
    os.setsid()
    if os.fork() != 0:
        os._exit(0)
print("ready", os.getpid(), flush=True)
while True:
    signal.pause()
