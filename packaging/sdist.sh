#!/bin/sh
# Build a source distribution where there is no git, install it into an environment of its own, and run quick tests from it.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
tar -xzf "$1" -C "$folder" --strip-components=1
cd "$folder"
python3 -m venv "$folder/.venv"
"$folder/.venv/bin/python" -m pip install --quiet --disable-pip-version-check '.[test]'
"$folder/.venv/bin/python" packaging/smoke.py
"$folder/.venv/bin/python" -m pytest -q tests/drop/test_engine.py tests/bodies/test_bodies.py tests/internal/test_files.py tests/project/test_packaging.py
cargo test --locked --no-run -p restitution-core
