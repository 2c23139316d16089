# Every target makes the virtual environment it needs in .venv and installs the package there.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
IMPACTS ?= 100000000
OUT ?= paper
FUZZ ?= 300
JOBS ?= 2
# What is about Linux alone, and has no types elsewhere.
ELSEWHERE := --exclude 'tests/(manual|reference/(environments|processes)|cli/test_environments)'
CORE := $(shell find crates -name '*.rs' -o -name 'Cargo.toml') Cargo.toml Cargo.lock pyproject.toml

.PHONY: help install quick minimum sdist crate release pages paper rough gas calibrate slow onsets test fuzz hostile audit mutants test-arm test-web rust-tests test-rust bench-web look web docs wheel licences coverage lint lint-rust lint-python bench clean

help:  ## list the targets
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*##/\t/' | expand -t 12

$(STAMP): $(CORE)
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[test,bench]'
	touch $@

install: $(STAMP)  ## build the core and install the package into .venv

paper: $(STAMP)  ## redraw and judge the whole paper into $(OUT)/
	$(BIN)/restitution paper --overwrite --out $(OUT) --impacts $(IMPACTS)

rough: $(STAMP)  ## simulate and judge rough spheres into rough/
	$(BIN)/restitution rough --overwrite --out rough

gas: $(STAMP)  ## figures and report of gases of grains into gas/
	$(BIN)/restitution gas-figures --overwrite --out gas

calibrate: $(STAMP)  ## 120 synthetic experiments: do posteriors cover? Some minutes on one core
	$(BIN)/python -m benchmarks.calibration build/calibration

slow: $(STAMP)  ## tests that take long, of which make test does smaller ones
	$(BIN)/python -m pytest -n $(JOBS) --dist loadfile -m slow

onsets: $(STAMP)  ## errors of onsets, slopes and second balls over many recordings: two minutes
	$(BIN)/python -m pytest tests/manual/onsets.py

lint: lint-rust lint-python

lint-rust:
	cargo fmt --all --check
	$(PYTHON) packaging/licences.py --check
	cargo clippy --workspace --all-targets --locked -- -D warnings

lint-python: $(STAMP)
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	for system in win32 darwin; do $(BIN)/mypy --platform $$system --cache-dir .mypy_cache/$$system $(ELSEWHERE) || exit 1; done
	$(BIN)/lint-imports

# The package is built by one core; the other builds the Rust tests meanwhile. So are both languages checked, and the page beside the Rust tests.
test:  ## every check: Rust format, clippy, Rust tests, ruff, mypy, the explorer, pytest
	$(MAKE) --jobs=2 $(STAMP) rust-tests
	$(MAKE) --jobs=2 lint
	$(MAKE) --jobs=2 test-rust test-web
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -n $(JOBS) --dist loadfile --no-loadscope-reorder

# Of each folder something that takes no long; with what has been built and checked before, three minutes.
QUICK := bodies/test_bodies cli/test_commands distribution/test_table drop/test_engine drop/test_bad_input drop/test_rigid \
    analytic/test_first_impact_manners experiment/test_flight_times fit/test_counts internal/test_files internal/test_parameters \
    laws/test_laws papers/test_misprints project/test_packaging project/test_names study/test_store

quick: $(STAMP)  ## format, lints, types and a sample of the tests: three minutes on a built tree
	$(MAKE) --jobs=2 lint
	$(BIN)/python -m pytest -q -n $(JOBS) --dist loadfile $(QUICK:%=tests/%.py)

# Old packages warn of newer ones, which lowest-direct leaves free.
minimum:  ## the tests with the lowest versions that pyproject.toml allows, in an environment of its own, by uv
	$(PYTHON) -m venv build/minimum
	build/minimum/bin/python -m pip install --quiet --disable-pip-version-check uv
	build/minimum/bin/uv pip install --python build/minimum/bin/python --resolution lowest-direct '.[test]' 'google-crc32c>=1.5'  # or numcodecs warns in every process
	build/minimum/bin/python -m pytest -n $(JOBS) --dist loadfile -W ignore::DeprecationWarning -W 'ignore:numpy.ndarray size changed'

sdist: $(STAMP)  ## the source distribution; build it outside of a git tree, and run quick tests from it
	$(BIN)/python -m pip install --quiet --disable-pip-version-check 'maturin>=1.9,<2'
	$(BIN)/maturin sdist --out dist
	sh packaging/sdist.sh dist/restitution-*.tar.gz

crate:  ## the core as a crate: documentation without a warning, the package and its tests, examples without optimisation
	RUSTDOCFLAGS='-D warnings' cargo doc --locked --no-deps -p restitution-core
	cargo package --locked --allow-dirty -p restitution-core
	CARGO_PROFILE_DEV_OPT_LEVEL=0 cargo run --locked --target-dir target/plain -p restitution-core --example dumbbell

release:  ## VERSION=0.2.0: set version and date in every place, check them, and say what is left to do
	$(PYTHON) packaging/release.py $(VERSION)

rust-tests:
	cargo test --workspace --locked --no-run

test-rust:
	cargo test --workspace --locked

# The kept module and page must be of these sources: built anew here, they would pass where everybody else gets the old ones.
test-web: $(STAMP) web/node_modules/.package-lock.json  ## the explorer: types, its engine beside the native one, the page in a real browser
	$(PYTHON) web/module/build.py --check
	cd web && npx tsc --project . && node build.mjs --check && node --test --test-reporter=spec tests/*.test.mjs

web: web/node_modules/.package-lock.json  ## the explorer: the core as WebAssembly, and the page around it
	$(PYTHON) web/module/build.py
	cd web && node build.mjs

web/node_modules/.package-lock.json: web/package.json web/package-lock.json
	@command -v npm >/dev/null && command -v node >/dev/null && \
	    node -e 'process.exit(+(parseInt(process.versions.node) < 20))' || \
	    { echo "The explorer needs Node.js 20 or later, with npm (Debian: nodejs, npm). All else is there without it." >&2; exit 1; }
	cd web && npm ci --no-audit --no-fund
	touch $@

# With fewer impacts than `make paper`: the verdicts rest on the recorded ones, which are as many.
build/extra/paper/report.html: $(STAMP)
	$(BIN)/restitution paper --overwrite --quiet --impacts 4000000 --out $(@D)

docs: $(STAMP) web/node_modules/.package-lock.json build/extra/paper/report.html  ## the site, into build/site: no warning, every line of code run, every link followed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --upgrade 'pip>=25.1'
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --group docs
	rm -rf build/site
	$(BIN)/python -m sphinx -W --keep-going -b html -d build/doctrees docs build/site
	$(BIN)/python docs/check.py build/site
	$(BIN)/python -m pytest tests/project/test_import.py -q -m '' -k pages

wheel: $(STAMP)  ## wheels for Linux into dist/, each installed and run in an environment of its own
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --upgrade 'pip>=25.1'
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --group wheel
	$(BIN)/python packaging/wheel.py $(MACHINE)

licences:  ## list the licences of what is compiled into the package and the page
	$(PYTHON) packaging/licences.py

fuzz:  ## random runs beside the oracle and between the SIMD levels, $(FUZZ) seconds each
	RESTITUTION_FUZZ_SECONDS=$(FUZZ) cargo test -p restitution-core --locked --test core -- --nocapture agreement:: fuzz::

hostile: $(STAMP)  ## every public function with every hostile value and every harmed Dataset, harmed files and random tables for $(FUZZ) seconds, every command in every hostile environment
	PYTHONPATH=tests $(BIN)/python tests/manual/hostile.py
	PYTHONPATH=tests OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 $(BIN)/python tests/manual/fuzz.py --seconds $(FUZZ)
	PYTHONPATH=tests OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 $(BIN)/python tests/manual/environments.py

audit:  ## known weaknesses of dependencies; says of each check whether it ran
	sh tests/manual/audit.sh

# Hours for a file of the core, a day for a folder of the package; what each missed stays in build/mutants.out and build/mutants.
mutants: $(STAMP)  ## which changes of the sources does no test notice? RUST="--file FILE" and NAMES='restitution.laws.*' take a part
	@command -v cargo-mutants >/dev/null || { echo "It takes cargo-mutants (cargo install --locked cargo-mutants)." >&2; exit 1; }
	@test -x $(BIN)/mutmut || { echo "It takes mutmut ($(BIN)/python -m pip install 'mutmut>=3.8')." >&2; exit 1; }
	-cargo mutants --output build $(RUST)
	mkdir -p build/mutants
	ln -sfn ../../python build/mutants/src
	cd build/mutants && ln -sfn $(addprefix ../../,tests crates examples docs benchmarks pyproject.toml) .
	cd build/mutants && $(CURDIR)/$(BIN)/mutmut run $(NAMES)

test-arm:  ## the digests on AArch64, under qemu-user; installs nothing and says what it needs
	sh crates/core/tests/arm.sh

pages: $(STAMP)  ## tables and figures of docs/ anew
	$(BIN)/python docs/pages.py
	$(BIN)/python docs/homework.py
	$(BIN)/python examples/pictures.py docs/images

bench: $(STAMP)  ## speed beside the peers, as ratios measured in one run
	$(BIN)/python -m benchmarks

look: web  ## pictures of the explorer as people see it, into web/shots
	cd web && node look.mjs

bench-web: $(STAMP) web  ## the explorer's first picture, redraw and frame rate
	cd web && node tests/speed.mjs

# Rust as far as its own tests go; what Python drives is counted in Python.
coverage: $(STAMP)  ## lines that the tests reach, in Python and in Rust, into build/coverage
	$(BIN)/python -m pip install --quiet --disable-pip-version-check 'pytest-cov>=6'
	$(BIN)/python -m pytest --cov=restitution --cov-report=term --cov-report=html:build/coverage/python $(TESTS)
	@cargo llvm-cov --version >/dev/null 2>&1 || \
	    { echo "Rust's coverage takes cargo-llvm-cov (cargo install cargo-llvm-cov; rustup component add llvm-tools)." >&2; exit 1; }
	cargo llvm-cov --package restitution-core --locked --html --output-dir build/coverage/rust

clean:  ## remove everything that was built
	rm -rf $(VENV) target build dist rough gas web/node_modules web/shots
	git clean -fqdX paper
