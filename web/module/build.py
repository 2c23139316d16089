"""Build the core for the browser into web/module/, with the digest of the sources that it was made from.

    python web/module/build.py           build it, unless the one that is there is of these sources
    python web/module/build.py --check   leave with 1 if the one that is there is of others

It takes the compiler of rustup if that has the wasm32 target, else Debian's, and says what is missing.
"""

import hashlib
import json
import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "packaging"))
import toolchain  # noqa: E402

MODULE = HERE / "restitution_web.wasm"
STAMP = HERE / "restitution_web.json"
TARGET = "wasm32-unknown-unknown"
# Vectors of two doubles, which every browser has had since 2023.
FLAGS = "-Ctarget-feature=+simd128"


def packages() -> list[dict[str, object]]:
    """Entries of Cargo.lock that the module is made of."""
    locked = tomllib.loads((ROOT / "Cargo.lock").read_text())["package"]
    by_name = {entry["name"]: entry for entry in locked}
    found: dict[str, dict[str, object]] = {}
    waiting = ["restitution-web", "restitution-core"]
    for name in waiting:
        # A development dependency is of no consequence, but Cargo.lock does not tell it from the others.
        if name not in found and name != "proptest":
            found[name] = by_name[name]
            waiting += [dependency.split()[0] for dependency in by_name[name].get("dependencies", [])]
    return [found[name] for name in sorted(found)]


def sources() -> str:
    """Digest of everything that the module follows from, but the compiler."""
    digest = hashlib.sha256()
    for crate in ("core", "web"):
        folder = ROOT / "crates" / crate
        for path in [folder / "Cargo.toml", *sorted((folder / "src").rglob("*.rs"))]:
            digest.update(path.relative_to(ROOT).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    profile = tomllib.loads((ROOT / "Cargo.toml").read_text())["profile"]["web"]
    versions = [[entry["name"], entry["version"], entry.get("checksum")] for entry in packages()]
    digest.update(json.dumps([profile, versions, FLAGS], sort_keys=True).encode())
    return digest.hexdigest()


def is_fresh() -> bool:
    """Whether the module that is there was made from these sources, and is whole."""
    if not (MODULE.exists() and STAMP.exists()):
        return False
    stamp = json.loads(STAMP.read_text())
    whole = stamp["module"] == hashlib.sha256(MODULE.read_bytes()).hexdigest()
    return bool(whole and stamp["sources"] == sources())


def linker(found: toolchain.Toolchain) -> dict[str, str] | None:
    """Environment that names the linker, which rustup's compiler brings along; None where there is none."""
    if not found.build_std:
        return {}
    path = shutil.which("wasm-ld")
    return {"CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER": path} if path else None


def build() -> None:
    """Compile the module and write down what it is made of."""
    found = toolchain.find(TARGET)
    linked = linker(found) if found else None
    if found is None or linked is None:
        missing = toolchain.missing(TARGET, "rustc-web cargo-web rust-web-src rust-web-llvm lld")
        sys.exit(f"The module for the browser needs {missing}\nand then: make web")
    environment = {**found.environment, **linked, "CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS": FLAGS}
    folder = ROOT / "target" / "web"
    what = ["--package", "restitution-web", "--target", TARGET, "--profile", "web", "--locked"]
    subprocess.run(
        [found.cargo, "build", *found.flags, *what, "--target-dir", str(folder)],
        cwd=ROOT,
        env={**os.environ, **environment},
        check=True,
    )
    made = folder / TARGET / "web" / MODULE.name
    version = subprocess.run([environment["RUSTC"], "--version"], capture_output=True, text=True, check=True)
    content = made.read_bytes()
    MODULE.write_bytes(content)
    subprocess.run([sys.executable, str(ROOT / "packaging" / "licences.py")], check=True)
    stamp = {
        "sources": sources(),
        "module": hashlib.sha256(content).hexdigest(),
        "size": len(content),
        "compiler": " ".join(version.stdout.split()[:2]),
    }
    STAMP.write_text(json.dumps(stamp, indent=2) + "\n")
    print(f"{MODULE.relative_to(ROOT)}: {len(content)} bytes")


if __name__ == "__main__":
    if "--check" in sys.argv[1:]:
        sys.exit(0 if is_fresh() else "web/module/restitution_web.wasm is not of these sources: run make web")
    if is_fresh():
        print(f"{MODULE.relative_to(ROOT)} is of these sources")
    else:
        build()
