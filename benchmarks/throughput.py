"""The engine's share of the throughput of the vector units.

The instructions of a vector of impacts are counted from the machine code for the job of Fig. 2, in
docs/performance.md. The multiplications set the peak: processors have two units for them, which on some are
half as wide as the widest vectors.
"""

from time import perf_counter

import numba

MULTIPLICATIONS = 167
"""Those that multiply, or multiply and add."""

INSTRUCTIONS = 554
"""All vector instructions, loads and stores of their own among them."""

LANES = {"avx512": 8, "avx2": 4}

ZEN_4 = "AuthenticAMD family 25 "
"""Processors (Zen 3 has no AVX-512) that take vectors of eight lanes in two halves."""


def units(level: str, generation: str) -> int:
    """Multiplications of vectors of a level at a time."""
    return 1 if level == "avx512" and generation.startswith(ZEN_4) else 2


@numba.njit(error_model="numpy")
def _chain(steps: int) -> int:
    x = steps
    for i in range(steps):
        x = (x + i) ^ 0x5BD1E995
    return x


def clock(steps: int = 200_000_000) -> float:
    """Cycles a nanosecond, from a chain of an addition and an exclusive or, a cycle each."""
    _chain(1)
    start = perf_counter()
    _chain(steps)
    return 2e-9 * steps / (perf_counter() - start)


def shares(nanoseconds: dict[str, float], cycles: float, generation: str) -> list[str]:
    """One line a level, from its time an impact, the clock and the processor."""
    lines = []
    for level, time in nanoseconds.items():
        if lanes := LANES.get(level):
            needed, taken = MULTIPLICATIONS / lanes / units(level, generation), cycles * time
            lines.append(
                f"{level:<8} {taken:.1f} cycles an impact at {cycles:.2f} GHz for "
                f"{INSTRUCTIONS / lanes:.0f} vector instructions, whose multiplications "
                f"need {needed:.1f}: {needed / taken:.0%} of the peak"
            )
    return lines
