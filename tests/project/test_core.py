"""The order of the core's folders and files."""

import re
from collections.abc import Iterator
from graphlib import TopologicalSorter
from pathlib import Path

ROOT = Path(__file__).parents[2]
CORE = ROOT / "crates/core/src"


def test_a_folder_of_the_core_imports_only_those_above_it() -> None:
    """The order is that of the map; names of the root count as those of their folders."""
    rows = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8").split("### `crates/core/src`")[1]
    order = re.findall(r"^\| `(\w+)(?:/|\.rs)` \|", rows.split("\n###")[0], re.MULTILINE)
    root = (CORE / "lib.rs").read_text(encoding="utf-8")
    exported: dict[str, str] = {}
    for folder, names in re.findall(r"^pub use (\w+)::([^;]*);", root, re.MULTILINE):
        exported |= dict.fromkeys(re.findall(r"\w+", names), folder)
    for path in CORE.rglob("*.rs"):
        folder = path.relative_to(CORE).parts[0].removesuffix(".rs")
        source = re.split(r"#\[cfg\(test\)\]\nmod ", path.read_text(encoding="utf-8"))[0]
        source = re.sub(r"//.*", "", source)
        paths = re.findall(r"\bcrate::(\{[^}]*\}|\w+)", source)
        names = {name for path in paths for name in re.findall(r"\w+", path)}
        above = order[: order.index(folder) + 1]
        assert {exported.get(name, name) for name in names} <= set(above), path


def expanded(path: str) -> list[str]:
    """Paths of a `use` without braces."""
    found = re.search(r"\{([^{}]*)\}", path)
    if not found:
        return [path]
    names = [name for name in found[1].split(",") if name]
    return [one for name in names for one in expanded(path[: found.start()] + name + path[found.end() :])]


def test_no_files_of_the_core_import_each_other_in_a_circle() -> None:
    """The head of a folder counts as one with the files in it, which it enters in its table."""
    sources = {
        path: re.sub(r"//.*", "", re.split(r"#\[cfg\(test\)\]\nmod ", path.read_text(encoding="utf-8"))[0])
        for path in CORE.rglob("*.rs")
    }
    item = r"^(?:pub(?:\(\w+\))? )?(?:struct|enum|trait|type|const|static|(?:const )?fn|macro_rules!) (\w+)"
    defined: dict[str, set[Path]] = {}
    for path, source in sources.items():
        for name in re.findall(item, source, re.MULTILINE):
            defined.setdefault(name, set()).add(path)

    def imports(path: Path) -> Iterator[Path]:
        """The files that define what one names by a path of modules, however it is exported."""
        here = path.relative_to(CORE).with_suffix("")
        module = here.parts[:-1] if here.name in ("mod", "lib") else here.parts
        joined = re.sub(r"([{,])\s+|\s+(?=\})", r"\1", sources[path])
        for chain in re.findall(r"\b(?:crate|super)(?:::(?:\w+|\{[^;]*\}(?=;)))+", joined):
            for parts in (one.split("::") for one in expanded(chain)):
                up = parts.count("super")
                folder, parts = CORE.joinpath(*(module[:-up] if up else ())), parts[max(up, 1) :]
                while parts and (folder / parts[0]).is_dir():
                    folder /= parts.pop(0)
                if parts and (folder / f"{parts[0]}.rs").is_file():
                    yield folder / f"{parts[0]}.rs"
                elif parts:
                    yield from (file for file in defined.get(parts[0], ()) if folder in file.parents)

    def is_head(head: Path, file: Path) -> bool:
        return head == file or (head.name in ("mod.rs", "lib.rs") and head.parent in file.parents)

    graph = {
        path: {file for file in imports(path) if not is_head(file, path) and not is_head(path, file)}
        for path in sources
    }
    TopologicalSorter(graph).prepare()
