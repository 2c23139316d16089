"""Find a Rust compiler that has the standard library of a target, or the sources to build it from."""

import shutil
import subprocess
from pathlib import Path
from typing import NamedTuple

# Debian has the standard library as sources, and no nightly compiler to build them with.
DEBIAN = [
    Path("/usr/bin/rustc"),
    Path("/usr/bin/cargo"),
    Path("/usr/lib/rustlib/src/rust/library/Cargo.lock"),
]


class Toolchain(NamedTuple):
    """The command to call, its environment, and whether the standard library must be built with the rest."""

    cargo: str
    environment: dict[str, str]
    build_std: bool

    @property
    def flags(self) -> list[str]:
        """Arguments of `cargo build`."""
        return ["-Zbuild-std=std,panic_abort"] if self.build_std else []


def find(target: str) -> Toolchain | None:
    """Toolchain for `target`: the one on the path if it has that target (rustup), else Debian's."""
    rustc, cargo = shutil.which("rustc"), shutil.which("cargo")
    if rustc and cargo:
        asked = [rustc, "--print", "target-libdir", "--target", target]
        found = subprocess.run(asked, capture_output=True, text=True, check=False)
        if found.returncode == 0 and any(Path(found.stdout.strip()).glob("libstd-*.rlib")):
            return Toolchain(cargo, {"RUSTC": rustc}, build_std=False)
    if all(path.exists() for path in DEBIAN):
        environment = {"RUSTC": str(DEBIAN[0]), "CARGO": str(DEBIAN[1]), "RUSTC_BOOTSTRAP": "1"}
        return Toolchain(str(DEBIAN[1]), environment, build_std=True)
    return None


def missing(target: str, debian: str) -> str:
    """Say what to install where `find` gives nothing; `debian`: the packages of Debian."""
    return f"""a Rust compiler with the standard library of {target}:
  rustup:  rustup target add {target}
  Debian:  apt-get install {debian}"""
