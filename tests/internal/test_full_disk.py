"""A netCDF file for which there is no room: the error is the system's, at whatever byte the room ends."""

import json
import subprocess
import sys
from pathlib import Path

from reference.command import AMONG_TESTS


def test_the_error_is_the_systems_wherever_room_ends(tmp_path: Path) -> None:
    """A limit on the size of files stands for the disk; HDF5 keeps something beside the numbers."""
    code = (
        AMONG_TESTS
        + f"""
import errno, json, os, resource, signal
from pathlib import Path
from reference.command import small
from restitution._internal.datasets import save
data, file = small(), Path({str(tmp_path)!r}) / "run.nc"
save(data, file)
size = file.stat().st_size
found = [data.nbytes, size]
for limit in (0, 512, data.nbytes, data.nbytes + 4096, size // 2, size - 4096, size - 1):
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
    try:
        save(data, file, replace=True)
        found.append("done")
    except OSError as error:
        found.append(errno.errorcode[error.errno])
print(json.dumps([*found, os.listdir(file.parent)]))
"""
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    numbers, size, *errors, left = json.loads(done.stdout)
    assert numbers < size // 2
    assert errors == ["EFBIG"] * 7
    assert left == ["run.nc"]
