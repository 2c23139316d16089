"""Damage to files that were right: bits and bytes, words and lines, and what their formats are made of."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any

_WORDS = (
    b"nan",
    b"inf",
    b"-1",
    b"0",
    b"1e400",
    b"5e-324",
    b"9" * 30,
    b"true",
    b'""',
    b"[]",
    b"{}",
    b"[[0]]",
    b"",
    b"0,5",
)
_STRANGE = (
    b"\0",
    b"\xff",
    b"\xef\xbb\xbf",
    b"\xed\xa0\x80",
    b'"',
    b"'",
    b"\n",
    b"\r",
    b"=",
    b"[",
    b"]" * 9,
    b"[" * 5000,
    b"#",
    b",",
)
_SIZES = (0, 1, -1, 2**31 - 1, -(2**31), 2**63 - 1, 2**32)
_VALUES: tuple[Any, ...] = (
    None,
    True,
    -1,
    0,
    10**30,
    1e308,
    float("nan"),
    "",
    "x",
    "../..",
    [],
    {},
    [[]],
    [0] * 40,
)


def _cut(whole: bytes, draw: Random) -> bytes:
    return whole[: draw.randrange(len(whole))]


def _bit(whole: bytes, draw: Random) -> bytes:
    harmed, place = bytearray(whole), draw.randrange(8 * len(whole))
    harmed[place // 8] ^= 1 << place % 8
    return bytes(harmed)


def _over(whole: bytes, draw: Random, words: bytes) -> bytes:
    """Put words over what is there; half of the time in the head, where sizes stand."""
    at = draw.randrange(len(whole) if draw.random() < 0.5 else min(len(whole), 200))
    return whole[:at] + words + whole[at + len(words) :]


def _bytes(whole: bytes, draw: Random) -> bytes:
    return _over(whole, draw, draw.randbytes(draw.randrange(1, 9)))


def _size(whole: bytes, draw: Random) -> bytes:
    width = draw.choice((4, 8))
    number = draw.choice(_SIZES) % 256**width
    return _over(whole, draw, number.to_bytes(width, draw.choice(("little", "big"))))


def _zeros(whole: bytes, draw: Random) -> bytes:
    return _over(whole, draw, bytes(draw.randrange(1, 600)))


def _slices(whole: bytes, draw: Random) -> bytes:
    """Leave out a slice, repeat it, or put it elsewhere."""
    a, b, c = sorted(draw.randrange(len(whole) + 1) for _ in range(3))
    return draw.choice(
        (whole[:a] + whole[b:], whole[:b] + whole[a:], whole[:a] + whole[b:c] + whole[a:b] + whole[c:])
    )


def _other(whole: bytes, draw: Random) -> bytes:
    """Something else altogether, perhaps after a right beginning."""
    return whole[: draw.choice((0, 4, 64))] + draw.randbytes(draw.randrange(2000))


def _word(whole: bytes, draw: Random) -> bytes:
    """Put another word in the place of a number, a name or a string."""
    words = list(re.finditer(rb'"[^"\n]*"|[\w.+-]+', whole))
    if not words:
        return _other(whole, draw)
    found = draw.choice(words)
    return whole[: found.start()] + draw.choice((*_WORDS, draw.choice(words)[0])) + whole[found.end() :]


def _line(whole: bytes, draw: Random) -> bytes:
    lines = whole.splitlines(keepends=True) or [b""]
    i, j = draw.randrange(len(lines)), draw.randrange(len(lines))
    return b"".join(
        draw.choice((lines[:i] + lines[i + 1 :], [*lines, lines[i]], [*lines[:i], lines[j], *lines[i:]]))
    )


def _strange(whole: bytes, draw: Random) -> bytes:
    at = draw.randrange(len(whole) + 1)
    return whole[:at] + draw.choice(_STRANGE) + whole[at:]


Harm = Callable[[bytes, Random], bytes]
BINARY: tuple[Harm, ...] = (_cut, _bit, _bytes, _size, _zeros, _slices, _other)
TEXT: tuple[Harm, ...] = (_word, _word, _word, _line, _strange, _cut, _bytes, _slices, _other)


def harmed(whole: bytes, draw: Random, kinds: tuple[Harm, ...]) -> bytes:
    """Harm a file in one to three ways."""
    for _ in range(draw.choice((1, 1, 1, 2, 3))):
        whole = draw.choice(kinds)(whole, draw) or b"\n"
    return whole


def harm_json(whole: bytes, draw: Random) -> bytes:
    """Replace one value of a JSON file, or leave it out; a string of JSON is gone into."""
    tree = json.loads(whole)
    places: list[tuple[Any, Any]] = []

    def walk(node: Any) -> None:
        for key in list(node) if isinstance(node, dict) else range(len(node)):
            places.append((node, key))
            if isinstance(node[key], dict | list):
                walk(node[key])

    walk(tree)
    node, key = draw.choice(places)
    if isinstance(node[key], str) and node[key].startswith("{"):
        node[key] = harm_json(node[key].encode(), draw).decode()
    elif draw.random() < 0.2:
        del node[key]
    else:
        node[key] = draw.choice(_VALUES)
    return json.dumps(tree).encode()


def harm_store(folder: Path, draw: Random) -> None:
    """Harm one of the files of a folder."""
    files = sorted(file for file in folder.rglob("*") if file.is_file())
    file = draw.choice(files)
    whole = file.read_bytes()
    way = draw.random()
    if file.suffix == ".json" and way < 0.8:
        file.write_bytes(harm_json(whole, draw))
    elif way < 0.9:
        file.write_bytes(harmed(whole, draw, BINARY))
    else:
        file.unlink()
