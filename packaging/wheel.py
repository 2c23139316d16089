"""Build the wheels for Linux, install each in an environment of its own, and run something there.

    python packaging/wheel.py             x86-64, and AArch64 where this machine has what that takes
    python packaging/wheel.py aarch64     that one, or what is missing

The wheels come into dist/. zig links them against glibc 2.17, so that they run on any system since 2014.
`make wheel` installs maturin and zig and calls this.
"""

import json
import os
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

import emulated
import toolchain

ROOT = Path(__file__).resolve().parents[1]
DIST = ROOT / "dist"
POLICY = "manylinux2014"
BUNDLED = (
    "explorer/explorer.html",
    "templates/sampler.h",
    "templates/sampler.f90",
    "licenses/LICENSE",
    "licenses/packaging/LICENCES.txt",
    "/_core.abi3.so",
)

# What a wheel has to do; it prints the processor, the instructions, and a digest that is the same everywhere.
PROGRAM = """
import hashlib, importlib.resources, platform
import restitution as rs
assert (importlib.resources.files("restitution.explorer") / "explorer.html").is_file()
body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Coulomb(normal=0.95, friction=0.2)
data = rs.simulate(body, law, particles=64, impacts=50, orientation="isotropic", seed=7)
digest = hashlib.sha256(b"".join(data[name].values.tobytes() for name in ("time", "restitution", "angle")))
print(platform.machine(), rs.build_info()["simd"], digest.hexdigest())
"""
CLOCK = """
import time
start = time.perf_counter()
import restitution
print(time.perf_counter() - start)
"""


def build(machine: str) -> Path:
    """Build the wheel for a kind of processor."""
    found = toolchain.find(f"{machine}-unknown-linux-gnu")
    assert found is not None
    asked = ["--release", "--locked", "--zig", "--target", f"{machine}-unknown-linux-gnu"]
    asked += ["--compatibility", POLICY, "--interpreter", sys.executable, "--out", str(DIST)]
    asked += ["--target-dir", str(ROOT / "target" / "wheel"), *found.flags]
    environment = {**os.environ, **found.environment}
    # maturin asks the first Python on the path for zig.
    first = [str(Path(sys.executable).parent), str(Path(found.cargo).parent)]
    environment["PATH"] = os.pathsep.join([*first, os.environ["PATH"]])
    subprocess.run([sys.executable, "-m", "maturin", "build", *asked], cwd=ROOT, env=environment, check=True)
    return max(DIST.glob(f"restitution-*_{machine}.whl"), key=lambda path: path.stat().st_mtime)


def look_into(wheel: Path) -> None:
    """See that everything is in the wheel that has to be, and nothing else."""
    names = zipfile.ZipFile(wheel).namelist()
    lacking = [wanted for wanted in BUNDLED if not any(name.endswith(wanted) for name in names)]
    strange = [name for name in names if not name.startswith("restitution") or "test" in name]
    if lacking or strange:
        sys.exit(f"{wheel.name} lacks {lacking} and has {strange}")


def run_native(wheel: Path, folder: Path) -> tuple[str, float]:
    """Install into a fresh environment; what the program prints, and the time of an import in seconds."""
    subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    python = folder / "bin" / "python"
    quiet = ["--quiet", "--disable-pip-version-check"]
    subprocess.run(
        [str(python), "-m", "pip", "install", *quiet, "--only-binary=:all:", str(wheel)], check=True
    )

    def printed(program: str) -> str:
        return subprocess.check_output(
            [str(python), "-W", "error::DeprecationWarning", "-c", program], cwd=folder, text=True
        )

    subprocess.run([str(folder / "bin" / "restitution"), "--version"], cwd=folder, check=True)
    return printed(PROGRAM).strip(), min(float(printed(CLOCK)) for _ in range(10))


def main(asked: list[str]) -> None:
    """Build, look, run, compare."""
    here = os.uname().machine
    digests, seconds = {}, 0.0
    for machine in asked or ["x86_64", "aarch64"]:
        target = f"{machine}-unknown-linux-gnu"
        lacks = []
        if toolchain.find(target) is None:
            lacks.append(toolchain.missing(target, "rustc-web cargo-web rust-web-src"))
        if machine != here:
            lacks += emulated.missing(machine)
        if lacks:
            print(f"No wheel for {machine}: it takes " + "\nand ".join(lacks), file=sys.stderr)
            if asked:
                sys.exit(1)
            continue
        wheel = build(machine)
        look_into(wheel)
        with tempfile.TemporaryDirectory() as folder:
            if machine == here:
                line, seconds = run_native(wheel, Path(folder) / "venv")
            else:
                line = emulated.run(wheel, machine, PROGRAM, Path(folder))
        digests[machine] = line.split()[-1]
        print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.2f} MB; {line}")
    if len(set(digests.values())) > 1:
        sys.exit(f"The processors disagree: {json.dumps(digests)}")
    if seconds:
        print(f"import restitution: {1e3 * seconds:.0f} ms")


if __name__ == "__main__":
    main(sys.argv[1:])
