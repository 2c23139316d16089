"""Give everything that names the version the same one: CITATION.cff has version, date and address.

    python packaging/release.py 0.2.0     set version and date everywhere; say what a person has to fill in
    python packaging/release.py           check that all places agree; with --tag v0.2.0, with the tag too
    python packaging/release.py --readme  make the links of README.md absolute, as a package index needs them

`make release VERSION=0.2.0` calls this.
"""

import argparse
import datetime
import json
import re
import sys
from pathlib import Path

VERSION = r"\d+\.\d+\.\d+"
# Where the version stands, and with which words around it.
PLACES = {
    "CITATION.cff": rf"(?m)^(version: )({VERSION})()$",
    "Cargo.toml": rf'(?m)^(version = ")({VERSION})(")$',
    "codemeta.json": rf'("version": ")({VERSION})(")',
    "packaging/conda/recipe.yaml": rf'(  version: ")({VERSION})(")',
    "web/package.json": rf'("version": ")({VERSION})(")',
    "web/package-lock.json": rf'("name": "restitution-explorer",\s+"version": ")({VERSION})(")',
    "Cargo.lock": rf'(name = "restitution-(?:core|python|web)"\nversion = ")({VERSION})(")',
}
# What is so until the first release, and from then on.
CLONE = "Python 3.11 or later, Rust 1.89 or later (cargo)"
BEFORE = (
    (
        "README.md",
        f"Until the first release the package is built from a clone: with {CLONE} and a C linker, "
        "`pip install .` takes some six minutes on two cores.",
        f"`pip install restitution` takes no compiler. From a clone, with {CLONE} and a C linker, "
        "`pip install .` takes some six minutes on two cores.",
    ),
    (
        "README.md",
        "`pip install '.[measure]'` for recordings and\n"
        "inference, `'.[sweep]'` for parameter studies, `'.[notebook]'`",
        "`pip install 'restitution[measure]'` for recordings and\n"
        "inference, `'restitution[sweep]'` for parameter studies, `'restitution[notebook]'`",
    ),
    (
        "docs/start.md",
        "There is no release yet, so that the package is built from a clone. That takes",
        "`pip install restitution` takes no compiler. To build the package from a clone takes",
    ),
    (
        "docs/start.md",
        "From the first release on, `pip install restitution` will do, without a compiler. ",
        "",
    ),
    (
        "docs/index.md",
        "There is no release yet; in a clone of the sources, "
        "[six minutes and a Rust compiler](start.md#install) are all that it takes:\n\n"
        "```sh\npip install .\n",
        "To [install](start.md#install) it takes no compiler:\n\n```sh\npip install restitution\n",
    ),
)


def cited(root: Path, key: str) -> str | None:
    """Return an entry of CITATION.cff, if it has that."""
    text = (root / "CITATION.cff").read_text(encoding="utf-8")
    found = re.search(rf'(?m)^{key}: *"?([^"\n]+)"?$', text)
    return found and found[1]


def put(root: Path, name: str, change: dict[str, str]) -> None:
    """Replace each pattern in a file; what is not there is an error."""
    path = root / name
    text = path.read_text(encoding="utf-8")
    for pattern, new in change.items():
        text, number = re.subn(pattern, new, text)
        if number == 0:
            sys.exit(f"{name}: nothing is like {pattern}")
    path.write_text(text, encoding="utf-8")


def release(root: Path, version: str, date: str) -> None:
    """Write version and date, and the address where there is one, into every place."""
    log = (root / "CHANGELOG.md").read_text(encoding="utf-8")
    if f"## [{version}] - " not in log:
        sys.exit(f"CHANGELOG.md: has no section ## [{version}]")
    for name, pattern in PLACES.items():
        put(root, name, {pattern: rf"\g<1>{version}\g<3>"})
    dated = f"date-released: {date}"
    if cited(root, "date-released"):
        put(root, "CITATION.cff", {r"(?m)^date-released: .*$": dated})
    else:
        put(root, "CITATION.cff", {r"(?m)^(version: .*)$": rf"\g<1>\n{dated}"})
    put(root, "CHANGELOG.md", {rf"(?m)^(## \[{re.escape(version)}\] - ).*$": rf"\g<1>{date}"})
    for name, old, new in BEFORE:
        path = root / name
        text = path.read_text(encoding="utf-8").replace(old, new)
        path.write_text(text, encoding="utf-8")
    about = json.loads((root / "codemeta.json").read_text(encoding="utf-8"))
    about |= {"datePublished": date}
    code, site = cited(root, "repository-code"), cited(root, "url")
    if code and site:
        about |= {"codeRepository": code, "url": site}
        urls = f'[project.urls]\nHomepage = "{site}"\nRepository = "{code}"\n\n[project.scripts]'
        put(root, "pyproject.toml", {r"(\[project\.urls\]\n(.+\n)+\n)?\[project\.scripts\]": urls})
        conda = f"about:\n  homepage: {site}\n  repository: {code}\n"
        put(root, "packaging/conda/recipe.yaml", {r"about:\n(  (homepage|repository): .+\n)*": conda})
    text = json.dumps(about, indent=2, ensure_ascii=False)
    (root / "codemeta.json").write_text(text + "\n", encoding="utf-8")


def wrong(root: Path, tag: str | None) -> list[str]:
    """List what is not the same in all places, or not of the tag; of a tag also what is not filled in."""
    version = cited(root, "version")
    found = [
        f"{name}: version {other}, not {version} as in CITATION.cff"
        for name, pattern in PLACES.items()
        for _, other, _ in re.findall(pattern, (root / name).read_text(encoding="utf-8"))
        if other != version
    ]
    if tag is not None:
        date = cited(root, "date-released")
        log = (root / "CHANGELOG.md").read_text(encoding="utf-8")
        found += [f"tag {tag}, not v{version}"] if tag != f"v{version}" else []
        found += [] if f"## [{version}] - {date}\n" in log else [f"CHANGELOG.md: no ## [{version}] - {date}"]
        found += missing(root)
    return found


def missing(root: Path) -> list[str]:
    """List what only a person knows."""
    found = [f"CITATION.cff: {key}" for key in ("url", "repository-code") if cited(root, key) is None]
    if "orcid:" not in (root / "CITATION.cff").read_text(encoding="utf-8").partition("references:")[0]:
        found.append("CITATION.cff, .zenodo.json, codemeta.json: names and ORCID of the authors")
    if "0000-0000-0000-0000" in (root / "paper/paper.md").read_text(encoding="utf-8"):
        found.append("paper/paper.md: the same")
    return found


def absolute(text: str, repository: str, version: str) -> str:
    """Lead the links and pictures of a page to the repository, at the tag of a version."""

    def full(link: re.Match[str]) -> str:
        way = "raw" if link[2].endswith((".png", ".gif", ".svg")) else "blob"
        return f"{link[1]}{repository}/{way}/v{version}/{link[2]}"

    return re.sub(r'(\]\(|<img src=")(?!https?:|#)([^)"]+)', full, text)


def main(arguments: list[str], root: Path) -> None:
    """Do what the arguments say."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("version", nargs="?")
    parser.add_argument("--tag")
    parser.add_argument("--readme", action="store_true")
    asked = parser.parse_args(arguments)
    if asked.readme:
        repository, version = cited(root, "repository-code"), cited(root, "version")
        if repository is None or version is None:
            sys.exit("CITATION.cff: repository-code is not filled in")
        page = root / "README.md"
        page.write_text(absolute(page.read_text(encoding="utf-8"), repository, version), encoding="utf-8")
        return
    if asked.version is not None:
        if not re.fullmatch(VERSION, asked.version):
            sys.exit(f"VERSION = {asked.version}: must be three numbers, as 0.2.0")
        release(root, asked.version, datetime.date.today().isoformat())
        print("\n".join(["To be filled in by a person:", *missing(root)] if missing(root) else []))
        print(
            f"Then: make web docs test; commit; git tag v{asked.version}; git push --tags, which publishes."
        )
    if found := wrong(root, asked.tag):
        sys.exit("\n".join(found))


if __name__ == "__main__":
    main(sys.argv[1:], Path(__file__).resolve().parents[1])
