"""The machine on which the figures were measured."""

import os
import platform
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import restitution as rs

SIMD = ("sse4_2", "avx", "fma", "avx2", "avx512f", "avx512dq", "neon", "asimd", "sve")
PACKAGES = ("restitution", "numpy", "numba", "llvmlite", "scipy", "xarray")


def _cpuinfo(*keys: str) -> str:
    """The first value under any of `keys` in /proc/cpuinfo; empty where there is no such file or key."""
    path = Path("/proc/cpuinfo")
    for line in path.read_text().splitlines() if path.exists() else ():
        key, _, value = line.partition(":")
        if key.strip() in keys:
            return value.strip()
    return ""


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "absent"


def _caches() -> str:
    """Sizes of the caches that the first core sees."""
    places = sorted(Path("/sys/devices/system/cpu/cpu0/cache").glob("index*"))
    found = ((place / "level", place / "type", place / "size") for place in places)
    return ", ".join(
        f"L{level.read_text().strip()} {size.read_text().strip()}"
        for level, kind, size in found
        if kind.read_text().strip() != "Instruction"
    )


def _huge_pages() -> str:
    """Who gets huge pages: all, those who ask (madvise), or nobody."""
    path = Path("/sys/kernel/mm/transparent_hugepage/enabled")
    return path.read_text().partition("[")[2].partition("]")[0] if path.exists() else ""


def generation() -> str:
    """Vendor, family and model of the processor, as it gives them; its name often leaves them out."""
    vendor, family, model = (_cpuinfo(key) for key in ("vendor_id", "cpu family", "model"))
    return f"{vendor} family {family} model {model}" if vendor and family else ""


def describe() -> str:
    """CPU, cores, caches, SIMD extensions, load, system and versions, one a line."""
    flags = set(_cpuinfo("flags", "Features").split())
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    load = f"{os.getloadavg()[0]:.2f}" if hasattr(os, "getloadavg") else "unknown"
    return "\n".join(
        (
            f"CPU      {_cpuinfo('model name', 'Model') or platform.processor() or platform.machine()}; "
            f"{generation() or 'of unknown generation'}",
            f"cores    {cores} usable; load at the start {load}",
            f"memory   {_caches() or 'caches unknown'}; huge pages: {_huge_pages() or 'unknown'}",
            f"SIMD     {' '.join(flag for flag in SIMD if flag in flags) or 'unknown'}; "
            f"the engine uses {rs.build_info()['simd']}",
            f"system   {platform.system()} {platform.machine()}, Python {platform.python_version()}",
            f"versions {', '.join(f'{package} {_version(package)}' for package in PACKAGES)}",
        )
    )
