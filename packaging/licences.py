"""Write the licences of what is compiled into the package and into the module of the page.

    python packaging/licences.py           write packaging/LICENCES.txt and web/module/LICENCES.txt
    python packaging/licences.py --check   leave with 1 if one of them is of other crates

The page adds those of its own libraries (web/build.mjs).
"""

import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# A wheel may be of any platform, so its list is that of all of them.
FILES = {
    ROOT / "packaging" / "LICENCES.txt": ("restitution-python", "all"),
    ROOT / "web" / "module" / "LICENCES.txt": ("restitution-web", "wasm32-unknown-unknown"),
}
RULE = "\n\n" + 72 * "-" + "\n\n"
STANDARD_LIBRARY = """The Rust standard library, MIT OR Apache-2.0

Copyright (c) The Rust Project Contributors.
The text of the MIT licence is that of the crates below."""
UNWINDER = """LLVM's libunwind and compiler-rt (wheels for Linux), Apache-2.0 WITH LLVM-exception

Copyright (c) The LLVM Project contributors.
Its exception lets compiled programs contain it without the text of the Apache licence."""


def cargo(*arguments: str) -> str:
    """Return what cargo prints."""
    return subprocess.run(
        ["cargo", *arguments, "--locked"], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout


def crates(package: str, target: str) -> list[str]:
    """Names and versions of the crates of others that end up in `package`: no macros, no build scripts."""
    tree = cargo("tree", "-p", package, "--target", target, "-e", "normal,no-proc-macro", "--prefix", "none")
    lines = {line.removesuffix(" (*)") for line in tree.splitlines() if line}
    return sorted(line.replace(" v", " ") for line in lines if not line.startswith("restitution-"))


def text(folder: Path) -> str | None:
    """Licence in the sources of a crate: MIT's, where there is a choice."""
    found = [path for name in ("LICENSE", "LICENCE", "COPYING") for path in sorted(folder.glob(f"{name}*"))]
    found = [path for path in found if path.is_file()]
    one = next((path for path in found if "MIT" in path.name.upper()), found[0] if found else None)
    return one.read_text().strip() if one else None


def licences(package: str, target: str) -> str:
    """List what `package` contains, and the licence of each."""
    listed = json.loads(cargo("metadata", "--format-version", "1"))["packages"]
    by_name = {f"{entry['name']} {entry['version']}": entry for entry in listed}
    parts = [STANDARD_LIBRARY, *([UNWINDER] if target == "all" else [])]
    for name in crates(package, target):
        entry = by_name[name]
        terms = text(Path(entry["manifest_path"]).parent)
        authors = ", ".join(author.split(" <")[0] for author in entry["authors"])
        # Some crates name their licence without its text.
        parts.append(f"{name}, {entry['license']}\n\n{terms or f'Copyright (c) {authors}'}")
    return RULE.join(parts) + "\n"


def is_fresh(path: Path) -> bool:
    """Return whether the file lists the crates that `Cargo.lock` gives."""
    parts = path.read_text().split(RULE) if path.exists() else []
    listed = [part.split(",")[0] for part in parts]
    return [name for name in listed if name[-1].isdigit()] == crates(*FILES[path])


if __name__ == "__main__":
    if "--check" in sys.argv[1:]:
        stale = [path.relative_to(ROOT).as_posix() for path in FILES if not is_fresh(path)]
        sys.exit(f"{', '.join(stale)}: run python packaging/licences.py" if stale else 0)
    for path, of in FILES.items():
        path.write_text(licences(*of))
        print(f"{path.relative_to(ROOT)}: {len(crates(*of))} crates")
