# Corota: `make demo` and `make test` set up everything they need.
# SPDX-License-Identifier: BSD-3-Clause
PYTHON ?= python3
JOBS ?= 2
RESULTS ?= results

VENV := .venv
BIN := $(VENV)/bin
# The environment with what compiles; what Corota runs with; what lint and tests need beside it.
TOOL := $(VENV)/.stamp-tool
RUNTIME := $(VENV)/.stamp-runtime
DEPS := $(VENV)/.stamp-deps
COMPILED := $(VENV)/.stamp-compiled
CORE := $(VENV)/.stamp-core

CORE_SOURCES := Cargo.toml Cargo.lock pyproject.toml $(shell find rust -type f 2>/dev/null)
# One profile and one target folder for wheel, tests and clippy: dependencies build once.
CARGO := --release --locked
# The tests run in seconds; optimized, they would build for minutes. Unoptimized frames are large.
UNOPTIMIZED := --config 'profile.release.package.corota.opt-level=0'
CARGO_TEST := RUST_MIN_STACK=67108864 cargo test --quiet $(CARGO) $(UNOPTIMIZED) --jobs $(JOBS)
WITH_PYTHON := --features python,pyo3/extension-module
# Python compiles the modules that are used when they are imported first.
INSTALL := $(BIN)/python -m pip install --quiet --no-compile --require-hashes
AS_MATURIN = $(addprefix PYO3_CONFIG_FILE=$(CURDIR)/,$(lastword $(wildcard target/maturin/pyo3-config-*.txt)))

export VIRTUAL_ENV := $(abspath $(VENV))
export PIP_DISABLE_PIP_VERSION_CHECK := 1
# Commands that tests start would compile the whole package each time.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help core setup demo test test-rust test-python test-slow test-view test-mesh test-optimize test-petsc lint lint-python \
	clippy format bench docs check-site wheel try-wheel meshes lock clean

help: ## Say what the targets do
	@sed -n 's/^\([a-z-]*\):.*## /\1|/p' Makefile | awk -F'|' '{printf "make %-12s %s\n", $$1, $$2}'

$(TOOL): requirements-build.txt
	@PYTHON="$(PYTHON)" scripts/check_toolchain.sh
	@echo "Setting up the Python environment in $(VENV)"
	@$(PYTHON) -m venv $(VENV)
	@$(INSTALL) -r requirements-build.txt
	@touch $@

$(RUNTIME): $(TOOL) requirements.txt
	@$(INSTALL) -r requirements.txt
	@touch $@

$(DEPS): $(RUNTIME) requirements-dev.txt
	@$(INSTALL) -r requirements-dev.txt
	@touch $@

$(COMPILED): $(TOOL) $(CORE_SOURCES)
	@PYTHON="$(PYTHON)" scripts/check_toolchain.sh
	@echo "Building the compute core (minutes the first time)"
	@$(BIN)/maturin develop --quiet --skip-install $(CARGO) --jobs $(JOBS)
	@touch $@

$(CORE): $(COMPILED) $(RUNTIME)
	@$(BIN)/maturin develop --quiet $(CARGO) --jobs $(JOBS)
	@touch $@

core: $(CORE)

# Packages are fetched while the core compiles.
setup: ## Make the environment and build the compute core
	@$(MAKE) --no-print-directory --jobs 2 core

demo: setup ## Run the compliant gripper: progress, files and a picture
	@$(BIN)/python examples/gripper/gripper.py --output $(RESULTS)/gripper

test: ## Set up everything and run the tests but for slow ones
	@$(MAKE) test-rust
	@$(MAKE) test-python

test-rust: $(DEPS)
	$(CARGO_TEST)

test-python: $(CORE) $(DEPS)
	$(BIN)/python -m pytest -n $(JOBS)

test-slow: $(CORE) $(DEPS) ## Run the slow tests: full products of cases, long examples
	$(CARGO_TEST) -- --ignored
	$(BIN)/python -m pytest -n $(JOBS) -m slow

VIEW := $(VENV)/.stamp-view

$(VIEW): $(CORE) $(DEPS) requirements-view.txt
	@$(INSTALL) -r requirements-view.txt
	@touch $@

test-view: $(VIEW) ## Run the tests against VTK, PyVista, xarray, pandas, meshio and ccx2paraview
	$(BIN)/python -m pytest -n $(JOBS) tests/output tests/interface

test-mesh: $(CORE) $(DEPS) ## Install Gmsh and ezdxf, and run the tests of outlines
	@$(INSTALL) -r requirements-mesh.txt -c requirements.txt
	$(BIN)/python -m pytest tests/outline

test-optimize: $(CORE) $(DEPS) ## Install mmapy, and run the tests of optimization
	@$(INSTALL) -r requirements-optimize.txt -c requirements.txt
	$(BIN)/python -m pytest tests/gradients/test_optimize.py

test-petsc: $(CORE) $(DEPS) ## Install PETSc (Debian 12, as root) and test runs on two processes
	scripts/install_petsc.sh $(abspath $(BIN)/python)
	$(BIN)/python -m pytest tests/scale tests/contracts/test_petsc.py tests/contracts/test_linear_solvers.py

lint: clippy lint-python ## Check style, types and lints of both languages

lint-python: $(DEPS)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	PYTHONPATH=src $(BIN)/lint-imports --no-logo --no-cache
	$(BIN)/python scripts/check_tree.py
	$(BIN)/python scripts/check_words.py

# In the environment in which maturin compiles: in another one, the next wheel would compile all of
# the crate again.
clippy: $(DEPS)
	cargo fmt --check
	env $(AS_MATURIN) RUSTC_WORKSPACE_WRAPPER=$(CURDIR)/scripts/clippy_only.sh \
		cargo build --quiet $(CARGO) --jobs $(JOBS) --all-targets $(WITH_PYTHON)

format: $(DEPS) ## Format both languages
	$(BIN)/ruff check --fix --quiet .
	$(BIN)/ruff format .
	cargo fmt

DOCS := $(VENV)/.stamp-docs

$(DOCS): $(CORE) requirements-docs.txt
	@$(INSTALL) -r requirements-docs.txt
	@touch $@

docs: $(DOCS) ## Build the site of the documentation into build/site, warnings as errors
	@MPLBACKEND=Agg $(BIN)/python -m sphinx -b html -q -W --keep-going -d build/doctrees docs build/site
	@echo "build/site/index.html"

check-site: docs ## Open every page of the site in a headless Chromium, which must be installed
	$(BIN)/python -m benchmarks site_check build/site

bench: $(CORE) ## Install the peers, run all programs side by side (benchmarks/README.md)
	$(BIN)/python -m benchmarks side_by_side
	$(BIN)/python -m benchmarks bench_tables

# After the core: at once they would take each other's files.
wheel: $(CORE) ## Build a wheel into dist/ for every Python from 3.10
	$(BIN)/maturin build --quiet $(CARGO) --jobs $(JOBS) --out dist

try-wheel: wheel ## Install the wheel where no toolchain is, and solve a deck
	@PYTHON="$(PYTHON)" scripts/try_wheel.sh

meshes: $(CORE) ## Mesh the examples again (needs Gmsh's Python package)
	$(INSTALL) -r requirements-mesh.txt
	$(BIN)/python examples/gripper/mesh.py

lock: ## Pin the newest versions of the Python packages again (needs uv)
	scripts/lock.sh

clean: ## Remove what was built, the environment included
	rm -rf $(VENV) target dist $(RESULTS) src/corota/_core*.so
