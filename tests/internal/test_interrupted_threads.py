"""Ctrl-C while a run is in a thread that is not the main one: Python tells the main thread alone."""

import json
import subprocess
import sys

from reference.command import AMONG_TESTS

CODE = (
    AMONG_TESTS
    + """
import json, os, signal, threading
import restitution as rs
from reference.signals import watched
body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
how = {"particles": 4000, "impacts": 100, "threads": 1}
begun, ended, found, alone = threading.Event(), threading.Event(), [], rs.simulate(body, law, **how)
watched(lambda *_: begun.set())
def work():
    try:
        found.append(rs.simulate(body, law, **how))
    finally:
        ended.set()
worker = threading.Thread(target=work)
worker.start()
interrupted = False
try:
    begun.wait()
    os.kill(os.getpid(), signal.SIGINT)
    ended.wait()
except KeyboardInterrupt:
    interrupted = True
ended.wait()
print(json.dumps([interrupted, found[0].identical(alone)]))
"""
)


def test_a_run_in_another_thread_goes_on_to_its_end() -> None:
    """The main thread is interrupted at once; the run has the result of one that was never disturbed."""
    done = subprocess.run(
        [sys.executable, "-c", CODE], capture_output=True, text=True, check=True, timeout=60
    )
    assert json.loads(done.stdout) == [True, True]
