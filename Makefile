# Every target makes the virtual environment it needs in .venv and installs the package there.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
IMPACTS ?= 100000000
OUT ?= paper
CORE := $(shell find crates -name '*.rs' -o -name 'Cargo.toml') Cargo.toml Cargo.lock pyproject.toml

.PHONY: help install paper test lint bench clean

help:  ## list the targets
	@grep -hE '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*##/\t/' | expand -t 12

$(STAMP): $(CORE)
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[test,bench]'
	touch $@

install: $(STAMP)  ## build the core and install the package into .venv

paper: $(STAMP)  ## redraw and judge the whole paper into $(OUT)/
	$(BIN)/restitution paper --out $(OUT) --impacts $(IMPACTS)

lint: $(STAMP)
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --locked -- -D warnings
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy

test: lint  ## every check: Rust format, clippy, Rust tests, ruff, mypy, pytest
	cargo test --workspace --locked
	$(BIN)/python -m pytest

bench: $(STAMP)  ## speed beside the peers, as ratios measured in one run
	$(BIN)/python -m benchmarks

clean:  ## remove everything that was built
	rm -rf $(VENV) target build paper
