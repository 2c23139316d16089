"""Recordings that no memory holds: the error names them, wherever memory ends."""

import json
import sys

import numpy as np
import pytest

from reference import measuring
from reference.command import Program
from restitution import sound


def test_a_recording_that_no_memory_holds_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Before it is read, and a file by its name; with samples in two channels, more is needed."""
    monkeypatch.setattr("restitution.experiment.sound.load.available_memory", lambda: 100_000)
    samples, path = measuring.samples(), measuring.recording()
    told = (
        rf"{samples.size:,} samples in 1 channel take 0\.00[0-9]+ GB of memory: must be at most 0.0001 GB, "
    )
    for kind in (ValueError, MemoryError):
        with pytest.raises(kind, match=f"^source: {told}what this process can have$"):
            sound.impacts(samples, 8000)
        with pytest.raises(kind, match=f"^{path}: {told}"):
            sound.impacts(path)
    with pytest.raises(ValueError, match=r"^source: 2,000 samples in 2 channels take 0\.000112 GB"):
        sound.impacts(np.zeros((2000, 2)), 8000)


def test_memory_that_ends_in_the_midst_of_it() -> None:
    """SciPy's filters have a MemoryError without words, NumPy's names no argument."""
    if sys.platform != "linux":
        pytest.skip("reads /proc, limits memory")
    code = """
import json, resource
import numpy as np
from reference import measuring
from restitution import sound
ball = measuring.samples()
sound.impacts(ball, 8000)
wave = np.random.default_rng(1).normal(0.0, 1e-4, 3_000_000)
wave[: ball.size] += ball
used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
from restitution.experiment.sound import load
load.available_memory = lambda: 2**60
found = []
for room in (1, 60, 120):
    resource.setrlimit(resource.RLIMIT_AS, (used + room * 2**20, resource.RLIM_INFINITY))
    try:
        sound.impacts(wave, 8000)
        found.append("done")
    except MemoryError as error:
        found.append(str(error))
print(json.dumps(found))
"""
    assert set(json.loads(Program(code).said())) == {"source: takes more memory than this process can have"}
