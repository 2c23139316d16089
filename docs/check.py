"""Follow every link of the built site, in build/site or the folder that is named; find refused formulas.

Links inside must lead to a page, and to an anchor that is there. DOIs are looked up, where the network
allows.
"""

import json
import sys
import urllib.error
import urllib.request
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

HANDLES = "https://doi.org/api/handles/"


class Page(HTMLParser):
    """The links and the anchors of a page."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: set[str] = set()
        self.anchors: set[str] = set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Collect."""
        for name, value in attrs:
            if value and name in ("href", "src"):
                self.links.add(value)
            elif value and name in ("id", "name"):
                self.anchors.add(value)


def inside(site: Path) -> tuple[list[str], set[str]]:
    """Dead links, and links to other hosts."""
    site = site.resolve()
    pages = {path: Page(path) for path in site.rglob("*.html") if "_static" not in path.parts}
    dead, others = [], set()
    for path, page in pages.items():
        if path.name == "explorer.html":
            continue  # its own tests load it
        if _unset(path):
            dead.append(f"{path.relative_to(site)}: a formula of several lines has a number")
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                others.add(link)
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            target = target / "index.html" if target.is_dir() else target
            known = pages.get(target)
            anchor = unquote(parts.fragment)
            state = target.name == "explorer.html" or not anchor  # there the fragment is a state
            if not target.exists() or not (state or known is None or anchor in known.anchors):
                dead.append(f"{path.relative_to(site)}: {link}")
    return sorted(dead), others


def _unset(path: Path) -> bool:
    """Tell whether a page has a numbered formula of several lines, which MathJax does not set."""
    formulas = path.read_text(encoding="utf-8").split('<div class="math')[1:]
    return any(
        "\\begin{split}" in one and "\\tag{" in one for one in (f.split("</div>")[0] for f in formulas)
    )


def outside(links: set[str]) -> list[str]:
    """DOIs that nobody registered, and links to hosts that a page has no business with."""
    wrong = []
    for link in sorted(links):
        if not link.startswith("https://doi.org/"):
            if not link.startswith(("mailto:", "data:")):
                wrong.append(link)
            continue
        try:
            with urllib.request.urlopen(
                HANDLES + link.removeprefix("https://doi.org/"), timeout=10
            ) as answer:
                if json.load(answer)["responseCode"] != 1:
                    wrong.append(link)
        except urllib.error.HTTPError as error:
            wrong.append(f"{link}: {error.code}")
        except OSError as error:
            print(f"DOIs were not looked up: {error}")
            break
    return wrong


if __name__ == "__main__":
    site = Path(sys.argv[1] if len(sys.argv) > 1 else "build/site")
    dead, others = inside(site)
    dead += outside(others)
    print(*dead, sep="\n")
    sys.exit(f"{len(dead)} dead links or formulas" if dead else 0)
