# sagitta: `make help` lists the targets.

SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
export PATH := $(HOME)/.cargo/bin:$(PATH)

# The Python with the judge's packages. Set it to use an environment of your own; then `venv` does nothing.
SAGITTA_PYTHON ?= $(CURDIR)/.venv/bin/python
# The Python that makes .venv.
PYTHON ?= python3
# Cargo profile of the tests: they curve meshes, which takes minutes without optimisation. `make test TEST_PROFILE=test` checks
# overflows and debug assertions too, and takes longer.
TEST_PROFILE ?= release

TARGET := $(or $(CARGO_TARGET_DIR),target)
SAGITTA := $(TARGET)/release/sagitta
# Where the tests' profile puts what it builds, and the Python package made of it.
BUILT := $(TARGET)/$(patsubst dev,debug,$(patsubst test,debug,$(TEST_PROFILE)))
PACKAGE := $(abspath $(TARGET))/python

# The steps of a target run in their order, also under -j.
.NOTPARALLEL:
.PHONY: help setup setup-build build demo venv test lint unit python python-consumers wheel deb examples fuzz fuzz-coverage parsers bench oracle table engines picture vendor-three bench-cases consumers solvers convergence figures reliability same-bits gauntlet-3d gauntlet-2d schema doc

help: ## this list
	@echo "sagitta curves linear viscous CFD meshes onto their CAD. Targets:"
	@awk -F ':[^#]*## ' '/^[a-z-]+:.*## / { printf "  make %-12s %s\n", $$1, $$2 }' Makefile

setup: setup-build ## install what building and testing need and is missing (Debian 12 or 13; rustup must be there)
	@.ci/setup test

setup-build: ## install what building alone needs and is missing
	@.ci/setup build

build: setup-build ## build target/release/sagitta
	cargo build --release

demo: build ## curve the weeble at P2 and P3 and print the reports (no Python needed)
	@mkdir -p $(TARGET)/demo
	@for order in 2 3; do \
	    echo "== weeble, P$$order -> $(TARGET)/demo/weeble_p$$order.msh"; \
	    $(SAGITTA) curve fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step \
	        --linkage fixtures/weeble/weeble.meshlink.xml --order $$order \
	        -o $(TARGET)/demo/weeble_p$$order.msh --report $(TARGET)/demo/weeble_p$$order.json; \
	done

venv: ## make .venv with the judge's Python packages, where it is missing or outdated
ifeq ($(SAGITTA_PYTHON),$(CURDIR)/.venv/bin/python)
	@PYTHON="$(PYTHON)" .ci/venv
else
	@"$(SAGITTA_PYTHON)" -c 'import gmsh, meshio, numpy, scipy'
endif

test: setup venv lint unit python examples ## everything that CI checks: format, clippy, docs, tests, doctests, Python, examples

lint: setup-build ## format, clippy and rustdoc, without warnings
	cargo fmt --all -- --check
	cargo clippy --workspace --all-targets -- -D warnings
	cargo clippy -p sagitta --no-default-features --lib --bins --examples -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --quiet

unit: setup-build venv ## tests and doctests, by cargo-nextest where it is installed
	@export SAGITTA_PYTHON="$(SAGITTA_PYTHON)"; \
	if cargo nextest --version >/dev/null 2>&1; then \
	    set -x; cargo nextest run --workspace --cargo-profile $(TEST_PROFILE); \
	else \
	    set -x; cargo test --workspace --lib --bins --tests --profile $(TEST_PROFILE); \
	fi
	SAGITTA_PYTHON="$(SAGITTA_PYTHON)" cargo test --workspace --doc --profile $(TEST_PROFILE)

# Built with the tests, so that features of crates are those that their build has.
python: setup-build venv ## the Python module: its tests, and its types by mypy
	cargo build --workspace --lib --bins --tests --profile $(TEST_PROFILE)
	python/assemble $(BUILT) $(PACKAGE)
	PYTHONPATH="$(PACKAGE)" "$(SAGITTA_PYTHON)" -m pytest -q -p no:cacheprovider -c python/pyproject.toml python/tests
	cd python && "$(SAGITTA_PYTHON)" -m mypy --cache-dir "$(PACKAGE)/mypy"

python-consumers: setup build ## the module's meshes in PyMFEM, NGSolve, and with DOLFINX=PYTHON in DOLFINx: integrals of polynomials; minutes
	@WANTED=tests/consumers/requirements.txt VENV=.venv-consumers PYTHON="$(PYTHON)" .ci/venv
	cargo build --release -p sagitta -p sagitta-python --lib --bins
	python/assemble $(TARGET)/release $(PACKAGE)
	for python in .venv-consumers/bin/python $(DOLFINX); do \
	    PYTHONPATH="$(PACKAGE)" "$$python" -m pytest -q -rs -p no:cacheprovider -c python/pyproject.toml python/consumers; \
	done

wheel: setup-build ## dist/sagitta-*.whl for pip, with OpenCASCADE and HDF5 inside, and tried in an empty environment; minutes
	@WANTED=python/requirements.txt VENV=.venv-wheel PYTHON="$(PYTHON)" .ci/venv
	VENV=.venv-wheel python/wheel dist
	PYTHON="$(PYTHON)" python/try dist/sagitta-*.whl

deb: build ## dist/sagitta_*.deb for this release of Debian, with man pages and completions; needs dpkg-dev
	packaging/deb $(SAGITTA) dist

# Built with the workspace, so that features of crates are those of the tests and nothing is built again.
examples: setup-build ## run the programs in examples/
	cargo build --workspace --examples --profile $(TEST_PROFILE)
	@for example in curve_in_memory check convert project; do \
	    echo "== $$example"; $(BUILT)/examples/$$example; \
	done

fuzz: setup-build ## 10 000 mutants of the samples of every format (SAGITTA_FUZZ=N, SAGITTA_SEED=N); a quarter of an hour
	SAGITTA_FUZZ=$${SAGITTA_FUZZ:-10000} cargo test --release --test suite -- --exact fuzz_formats::damaged_files_are_answered --nocapture

fuzz-coverage: setup-build ## every reader fuzzed by coverage (cargo-fuzz), FUZZ_SECONDS=120 each; installs cargo-fuzz where it is missing
	fuzz/run $${FUZZ_SECONDS:-120}

parsers: setup-build ## sagitta's readers beside strict parsers of other code, on 2 000 mutants of each format (MUTANTS=N); minutes
	cargo build --release --manifest-path fuzz/Cargo.toml --bin account
	$(PYTHON) tests/reliability/agree.py fuzz/target/release/account --mutants $${MUTANTS:-2000}

bench: build ## benchmarks; minutes, not a test
	cargo bench --bench curve
	cargo bench --bench plane
	cargo bench --bench formats
	cargo bench -p sagitta-cad --bench projection

oracle: setup-build ## closest points beside OCCT's own searches and dense grids; SAGITTA_CAD=DIR[:DIR] adds foreign CAD; minutes
	SAGITTA_ORACLE_QUERIES=125 cargo test -p sagitta-cad --release --test suite oracle:: -- --ignored --nocapture

table: build venv ## a table of the fixtures, curved and judged by other code; minutes
	"$(SAGITTA_PYTHON)" tests/judge/table.py $(SAGITTA)

engines: build venv ## the engines side by side on the weeble and the wing: fixtures/pictures/engines.png and a table; 4 minutes
	"$(SAGITTA_PYTHON)" tests/pictures/engines.py $(SAGITTA) fixtures/pictures/engines.png

picture: build venv ## the README's pictures of the weeble: fixtures/pictures/weeble_*.png; the one of the page needs chromium
	$(SAGITTA) curve fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step --order 3 -o $(TARGET)/weeble_p3.vtu --quiet \
	    --report $(TARGET)/weeble_p3.json --html $(TARGET)/weeble_p3.html
	"$(SAGITTA_PYTHON)" tests/pictures/weeble.py $(TARGET)/weeble_p3.vtu fixtures/pictures/weeble_p3.png
	$(SAGITTA) picture $(TARGET)/weeble_p3.vtu --cut y:0 --view -y --color scaled --size 720x560 -o fixtures/pictures/weeble_cut.png
	"$(SAGITTA_PYTHON)" tests/pages/browse.py $(TARGET)/weeble_p3.html $(TARGET)/weeble_p3.json fixtures/pictures/weeble_page.png

vendor-three: ## make src/html/vendor/three.min.js again, by npm, from the versions in package.json there
	cd src/html/vendor && npm install --no-save --no-audit --no-fund && \
	    npx esbuild entry.js --bundle --minify --format=iife --global-name=THREE --legal-comments=inline --outfile=three.min.js && \
	    rm -rf node_modules && sha256sum --check SHA256SUMS

consumers: setup build ## curved meshes given to Gmsh, meshio, MFEM, PyFR, PyHOPE, VTK and cgnscheck, and what they find; minutes
	@WANTED=tests/consumers/requirements.txt VENV=.venv-consumers PYTHON="$(PYTHON)" .ci/venv
	.venv-consumers/bin/python tests/consumers/consume.py $(SAGITTA) | tee $(TARGET)/consumers.md

solvers: setup build ## what --for writes, read and run by each solver: the table of docs/solvers.md; DOLFINX=PYTHON with dolfinx; half an hour
	@WANTED=tests/consumers/requirements.txt VENV=.venv-consumers PYTHON="$(PYTHON)" .ci/venv
	.venv-consumers/bin/python tests/consumers/solvers.py $(SAGITTA) $(or $(DOLFINX),-) docs/solvers.md

convergence: setup build ## orders of convergence on curved and straight meshes by MFEM: docs/convergence.md and its picture; 10 minutes
	@WANTED=tests/consumers/requirements.txt VENV=.venv-consumers PYTHON="$(PYTHON)" .ci/venv
	.venv-consumers/bin/python tests/convergence/convergence.py $(SAGITTA) docs/convergence.md fixtures/pictures/convergence.png

gauntlet-3d: build ## viscous meshes made on every CAD file in SAGITTA_CAD=DIR[:DIR], curved at P2 and P3, beside Gmsh; GAUNTLET_OPTIONS; an hour
	@WANTED=tests/gauntlet/requirements.txt VENV=.venv-gauntlet PYTHON="$(PYTHON)" .ci/venv
	.venv-gauntlet/bin/python tests/gauntlet/gauntlet_3d.py $(SAGITTA) "$(SAGITTA_CAD)" $(GAUNTLET_OPTIONS) | tee $(TARGET)/gauntlet_3d.md

gauntlet-2d: build ## viscous plane meshes made round random airfoils, curved at P2 to P4; GAUNTLET_OPTIONS (--count N --seed S --judge); minutes
	@WANTED=tests/gauntlet/requirements_2d.txt VENV=.venv-gauntlet-2d PYTHON="$(PYTHON)" .ci/venv
	.venv-gauntlet-2d/bin/python tests/gauntlet/gauntlet_2d.py $(SAGITTA) $(GAUNTLET_OPTIONS) | tee $(TARGET)/gauntlet_2d.md

reliability: build ## kills at random times, full disks, signals in each step: what is left behind; root or `unshare -Urm`; 10 minutes
	$(PYTHON) tests/reliability/harm.py $(SAGITTA)

same-bits: build ## the optimised program and one that is hardly optimised write the same meshes; minutes
	cargo build --bin sagitta
	$(PYTHON) tests/reliability/same_bits.py $(SAGITTA) $(TARGET)/debug/sagitta

schema: ## write the JSON Schemas of the reports to docs/schema
	cargo test --test suite --profile $(TEST_PROFILE) schema::write -- --ignored

figures: venv ## what Gmsh, meshio and VTK find in fixtures/samples, and in SAGITTA_SAMPLES=DIR
	"$(SAGITTA_PYTHON)" tests/judge/figures.py fixtures/samples $(SAGITTA_SAMPLES) > $(TARGET)/figures.json
	mv $(TARGET)/figures.json fixtures/samples/figures.json

bench-cases: build venv ## curve every case in CASES=DIR (folders of NAME.msh, .step, .meshlink.xml) and judge it; BENCH_OPTIONS=--peer adds Gmsh
	"$(SAGITTA_PYTHON)" tests/judge/bench_cases.py $(SAGITTA) "$(CASES)" $(BENCH_OPTIONS)

doc: setup-build ## the documentation, in target/doc
	cargo doc --workspace --no-deps
	@echo "$(TARGET)/doc/sagitta/index.html"
