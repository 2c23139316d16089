#!/usr/bin/env -S uv run --script
# /// script
# dependencies = ["nox>=2025.2.9"]
# ///
"""Tests on every supported Python: `nox`. On one of them, with all other checks: `make test`."""

import nox

nox.needs_version = ">=2025.2.9"
nox.options.default_venv_backend = "uv|virtualenv"


@nox.session(python=["3.11", "3.12", "3.13", "3.14"])
def tests(session: nox.Session) -> None:
    """Build the package, install it as a user does, and run the Python tests."""
    session.install(".[test]")
    session.run("python", "-m", "pytest", *session.posargs)


if __name__ == "__main__":
    nox.main()
