"""The order of the core's folders."""

import re
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
