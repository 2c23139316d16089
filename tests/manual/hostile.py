"""`make hostile`: every value of the catalogue at every argument of every public function, and every harm."""

import os
import sys
import tempfile
import warnings

import restitution as rs
from reference.contract import CALLS, arguments, attack
from reference.harmed import every_harm, harm, takers
from reference.hostile import VALUES


def main(wanted: list[str]) -> int:
    """Attack the functions whose names hold a word of `wanted`, or all; tell what breaks the contract."""
    warnings.simplefilter("error")
    warnings.filterwarnings("ignore", category=rs.EnergyWarning)
    warnings.filterwarnings("ignore", category=rs.DistanceWarning)
    calls = failures = 0
    os.chdir(tempfile.mkdtemp())  # some values are names of files that can be written
    for name in CALLS:
        if wanted and not any(word in name for word in wanted):
            continue
        for argument in arguments(name):
            for value in VALUES:
                calls += 1
                found = attack(name, argument, VALUES[value]())
                if found is not None:
                    failures += 1
                    print(f"{name}({argument} = {value}): {found}", flush=True)
        for words in every_harm(name) if name in takers() else ():
            calls += 1
            found = harm(name, words)
            if found is not None:
                failures += 1
                print(f"{name}({takers()[name]}: {words}): {found}", flush=True)
    print(f"{calls} calls, {failures} break the contract")
    return min(failures, 1)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
