"""Run a wheel for another processor: Debian's Python for it, unpacked into a folder, under qemu-user."""

import shutil
import subprocess
import sys
from pathlib import Path

DEBIAN = {"aarch64": "arm64"}
# Python 3.11 of Debian 12, and the libraries that it and NumPy, SciPy and netCDF4 load.
PYTHON = "3.11"
PACKAGES = [f"python{PYTHON}-minimal", f"libpython{PYTHON}-minimal", f"libpython{PYTHON}-stdlib"]
PACKAGES += ["libc6", "libgcc-s1", "libstdc++6", "zlib1g", "libexpat1", "libssl3", "libffi8", "libbz2-1.0"]
PACKAGES += ["liblzma5", "libuuid1", "libsqlite3-0", "libcrypt1", "libtinfo6", "libncursesw6", "libreadline8"]


def missing(machine: str) -> list[str]:
    """List what this machine lacks to run a wheel for `machine`."""
    needs = {
        f"qemu-{machine}": "qemu for programs of other processors (Debian: qemu-user)",
        "apt-get": "apt-get, for a Python of that processor",
        "dpkg-deb": "dpkg-deb, to unpack it",
    }
    return [what for program, what in needs.items() if shutil.which(program) is None]


def system(architecture: str, folder: Path) -> Path:
    """Unpack Python for another processor; nothing is installed."""
    state, root, packages = folder / "apt", folder / "root", folder / "packages"
    for path in (state / "lists" / "partial", state / "cache" / "archives" / "partial", packages):
        path.mkdir(parents=True)
    (state / "status").touch()
    options = [f"APT::Architecture={architecture}", f"APT::Architectures::={architecture}"]
    options += [
        f"Dir::State={state}",
        f"Dir::State::status={state / 'status'}",
        f"Dir::Cache={state / 'cache'}",
    ]
    apt = ["apt-get", "-qq", *[word for option in options for word in ("-o", option)]]
    subprocess.run([*apt, "update"], check=True)
    subprocess.run([*apt, "download", *PACKAGES], cwd=packages, check=True, stdout=subprocess.DEVNULL)
    for package in packages.iterdir():
        subprocess.run(["dpkg-deb", "-x", str(package), str(root)], check=True)
    return root


def run(wheel: Path, machine: str, program: str, folder: Path) -> str:
    """Install `wheel` and all that it needs for `machine` into `folder`; what `program` prints there."""
    root, site = system(DEBIAN[machine], folder), folder / "site"
    platforms = [f"--platform=manylinux{version}_{machine}" for version in ("2014", "_2_17", "_2_28")]
    asked = ["--quiet", "--disable-pip-version-check", "--only-binary=:all:", *platforms]
    asked += [f"--python-version={PYTHON}", "--implementation=cp", f"--target={site}"]
    subprocess.run([sys.executable, "-m", "pip", "install", *asked, str(wheel)], check=True)
    environment = {
        "PYTHONHOME": str(root / "usr"),
        "PYTHONPATH": str(site),
        "HOME": str(folder),
        "LC_ALL": "C.UTF-8",
    }
    qemu = shutil.which(f"qemu-{machine}") or f"qemu-{machine}"
    python = [qemu, "-L", str(root), str(root / "usr" / "bin" / f"python{PYTHON}")]
    return subprocess.check_output(
        [*python, "-c", program], cwd=folder, env={**environment, "PATH": "/usr/bin"}, text=True
    ).strip()
