"""The memory that a process can have, as the system and its control groups say."""

from pathlib import Path

import psutil
import pytest

from restitution._internal.parameters import TooLargeError
from restitution._internal.resources import available_memory, check_room, check_size, control_groups


def test_what_bounds_the_memory(tmp_path: Path) -> None:
    """Control groups of either version and at any height, less what is used but not what files left there."""

    def write(path: str, text: str) -> None:
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text, encoding="ascii")

    assert list(control_groups(tmp_path)) == []
    write("proc/self/cgroup", "0::/user/job\n")
    write("sys/fs/cgroup/user/job/memory.max", "max\n")
    write("sys/fs/cgroup/user/job/memory.current", "100\n")
    assert list(control_groups(tmp_path)) == []
    write("sys/fs/cgroup/user/memory.max", "1000000\n")
    write("sys/fs/cgroup/user/memory.current", "400000\n")
    write("sys/fs/cgroup/user/memory.stat", "anon 1\ninactive_file 50000\n")
    assert list(control_groups(tmp_path)) == [650_000]
    write("proc/self/cgroup", "5:cpu,memory:/job\n3:pids:/job\n")
    write("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "5000\n")
    write("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "6000\n")
    assert list(control_groups(tmp_path)) == [-1000]


def test_the_least_of_all_bounds_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    """And what does not fit is refused by name."""
    assert 0 < available_memory() <= psutil.virtual_memory().total
    monkeypatch.setattr("restitution._internal.resources.control_groups", lambda _: [-1000])
    assert available_memory() == 0
    monkeypatch.setattr("restitution._internal.resources.control_groups", lambda _: [2_000_000])
    assert available_memory() == 2_000_000
    check_room("a table", 2_000_000)
    with pytest.raises(MemoryError, match=r"^a table: takes 3 MB of memory, and this process can have 2 MB$"):
        check_room("a table", 3_000_000)
    with pytest.raises(TooLargeError, match=r"^size = 9: must be at most 2e\+05 draws, which this process"):
        check_size("size", 9, 300_000, 10, "draws")
