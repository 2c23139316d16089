"""Build the site of every released version and of the present one, with a switch between them.

    python docs/versions.py https://HOST/PATH OUT

Versions are the tags vX.Y.Z; each is built by its own `make docs`, in a work tree of its own, unless OUT has
it already. OUT then has a folder for each, versions.json for the switch, and an index.html that leads to the
newest release.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def git(*arguments: str) -> str:
    """Return what git prints."""
    return subprocess.run(
        ["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.strip()


def build(commit: str, name: str, site: str, out: Path) -> None:
    """Build the site of a commit into OUT/name."""
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder) / "tree"
        git("worktree", "add", "--detach", str(tree), commit)
        try:
            environment = {**os.environ, "RESTITUTION_SITE": site, "RESTITUTION_VERSION": name}
            subprocess.run(["make", "docs"], cwd=tree, env=environment, check=True)
            shutil.copytree(tree / "build" / "site", out / name)
        finally:
            git("worktree", "remove", "--force", str(tree))


def main(site: str, out: Path) -> None:
    """Build all of them."""
    tags = git("tag", "--list", "v*", "--sort=-version:refname").split()
    versions = [(tag.removeprefix("v"), tag) for tag in tags] + [("dev", "HEAD")]
    out.mkdir(parents=True, exist_ok=True)
    shutil.rmtree(out / "dev", ignore_errors=True)
    for name, commit in versions:
        if not (out / name).exists():
            build(commit, name, site, out)
    newest = versions[0][0]
    listed = [
        {"name": name, "version": name, "url": f"{site}/{name}/", "preferred": name == newest}
        for name, _ in versions
    ]
    (out / "versions.json").write_text(json.dumps(listed, indent=2) + "\n")
    (out / "index.html").write_text(
        f'<!doctype html><meta http-equiv="refresh" content="0; url={newest}/">\n'
        f'<a href="{newest}/">{newest}</a>\n'
    )


if __name__ == "__main__":
    main(sys.argv[1].rstrip("/"), Path(sys.argv[2]))
