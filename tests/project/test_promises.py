"""The page of guarantees names tests that there are."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/project.md").read_text(encoding="utf-8").split("\n## Guarantees\n")[1].split("\n## ")[0]


def test_every_guarantee_names_a_test() -> None:
    rows = [row for row in PAGE.splitlines() if row.startswith("| ") and not row.startswith("| guarantee")]
    assert len(rows) > 20
    for row in rows:
        *_, named, _ = row.split("|")
        assert re.fullmatch(r" (`(tests|crates)/[\w/]+\.(py|rs)::\w+`(, )?)+ ", named), row


def test_every_test_that_is_named_is_there() -> None:
    for path, name in re.findall(r"`([\w/]+\.(?:py|rs))::(\w+)`", PAGE):
        source = (ROOT / path).read_text(encoding="utf-8")
        head = rf"^def {name}\(" if path.endswith(".py") else rf"#\[test\]\nfn {name}\("
        assert re.search(head, source, re.MULTILINE), f"{path}: there is no {name}"


def test_every_file_that_is_named_is_there() -> None:
    for path in re.findall(r"`((?:tests|crates|docs)/[\w/.]+?)(?:::\w+)?`", PAGE):
        assert (ROOT / path).is_file(), path
