# quatspline: every target makes its own environment; a second call does not reinstall.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
RUN := $(BIN)/python -m quatspline
INSTALL := $(BIN)/python -m pip --quiet --disable-pip-version-check install
# Locked releases, each checked by its hash: $(call LOCKED,test docs) is what the package needs and these extras add. Nothing is
# built from source but a third-party scheme without a wheel for this machine: its archive is checked, not what its build asks for.
LOCKED = $(INSTALL) --require-hashes $(if $(filter peers%,$(1)),,--only-binary :all:) $(foreach lock,run $(1),--requirement locks/$(lock).txt)
TESTED := motions test dev dask docs
UPGRADE ?=
QUICK ?=
COMPILED ?=
MOTIONS ?= motions
# Text that reaches a command as it was given, through the environment: neither make nor a shell reads it.
override QUICK := $(value QUICK)
override COMPILED := $(value COMPILED)
override UPGRADE := $(value UPGRADE)
override NAME := $(value NAME)
override TASK := $(value TASK)
override MOTIONS := $(value MOTIONS)
override SHARE := $(value SHARE)
override MINUTES := $(value MINUTES)
export NAME TASK MOTIONS SHARE MINUTES

.DEFAULT_GOAL := help
.PHONY: help peers-heavy peers-drake peers-node reproduce benchmark benchmark-speed motions report test torture docs lint format new-baseline check-baseline reference lock clean

help: ## Show the targets
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /|/' | awk -F'|' '{printf "  make %-16s %s\n", $$1, $$2}'

# The environment proper: the package with the light third-party schemes, then its kernels compiled once.
$(VENV)/run: pyproject.toml locks/run.txt locks/peers.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "quatspline needs Python 3.11 or newer; set PYTHON=")'
	@$(PYTHON) -m venv $(VENV)
	@echo "installing into $(VENV) ..."
	@$(call LOCKED)
	@$(INSTALL) --no-deps --no-build-isolation --editable .
	@$(call LOCKED,peers) || echo "some third-party schemes could not be installed: their rows will read n/a"
	@echo "more third-party schemes, whose rows read n/a without: make peers-heavy (294 MB to download)," \
	  "peers-drake (58 MB, with Mosek, which is proprietary), peers-node (19 MB, needs Node.js)"
	@$(RUN) warmup
	@touch $@

$(VENV)/motions: $(VENV)/run locks/motions.txt
	@$(call LOCKED,motions)
	@touch $@

$(VENV)/test: $(VENV)/run $(TESTED:%=locks/%.txt)
	@$(call LOCKED,peers)
	@$(call LOCKED,$(TESTED))
	@touch $@

peers-heavy: $(VENV)/run ## Add GTSAM, OpenUSD, Pinocchio, Spatial Math and VTK: 294 MB to download, 1.3 GB on disk
	@$(call LOCKED,peers-heavy)

peers-drake: $(VENV)/run ## Add Drake, which installs Mosek (proprietary): 58 MB to download, 233 MB on disk
	@$(call LOCKED,peers-drake)

peers-node: ## Add three.js, glMatrix and Babylon.js, for which Node.js must be there: 19 MB to download, 93 MB on disk
	@cd src/quatspline/peers/javascript && npm ci --silent --no-audit --no-fund

reproduce: $(VENV)/run ## The paper in full and every other experiment at quick size, into results/
	@$(RUN) run

benchmark: $(VENV)/run ## Every experiment at full size (QUICK=1: all at quick size)
	@$(RUN) run $(if $(QUICK),--quick,--full)

benchmark-speed: $(VENV)/test ## The speed suite (pytest-benchmark) as times the floor, compared with its last run: TASK=evaluate
	@$(BIN)/python -m pytest benchmarks -q --benchmark-only --benchmark-autosave --benchmark-compare \
	  --benchmark-storage=file://results/benchmarks --benchmark-columns=median,iqr,rounds \
	  --benchmark-max-time=0.3 --benchmark-min-rounds=3 \
	  -W ignore::pytest_benchmark.logger.PytestBenchmarkWarning $${TASK:+-k "$$TASK"}

motions: $(VENV)/motions ## Fetch the recorded clips, 9 MB, into MOTIONS=motions; QUATSPLINE_MOTIONS=motions measures on them
	@$(RUN) motions "$$MOTIONS"

report: $(VENV)/run ## Write results/report.html again from the tables that are there
	@$(RUN) report

test: $(VENV)/test lint docs ## Lint, types, docs and all tests
	@$(BIN)/python -m pytest -n 2 --dist worksteal -q

torture: $(VENV)/test ## Kill, corrupt and fill what runs write; bad plug-ins, hostile files: SHARE=0.1 of the counts, MINUTES=120 at most
	@$(BIN)/python tests/robustness/torture.py $${SHARE:+--share "$$SHARE"} $${MINUTES:+--minutes "$$MINUTES"}

docs: $(VENV)/test ## Build docs into site/; broken links, citations and formulas fail
	@$(BIN)/mkdocs build --quiet --strict

lint: $(VENV)/test ## Lint, format check, type check, and imports against architecture.ini
	@$(BIN)/ruff check --quiet .
	@$(BIN)/ruff format --quiet --check .
	@$(BIN)/mypy --no-error-summary
	@$(BIN)/lint-imports --no-logo --no-cache architecture.ini

format: $(VENV)/test ## Format the sources
	@$(BIN)/ruff check --quiet --fix . ; $(BIN)/ruff format --quiet .

new-baseline: $(VENV)/run ## Write a working template: NAME=my_scheme (COMPILED=1: with a compiled family)
	@$(BIN)/python -m tools.new_scheme "$$NAME" $(if $(COMPILED),--compiled)

check-baseline: $(VENV)/test ## Conformance and claims of one scheme: NAME=my_scheme
	@$(BIN)/python -m pytest -q tests/schemes/test_conformance.py tests/schemes/test_claims.py --scheme "$$NAME"

reference: $(VENV)/run ## Take the tables of the last run as the reference and quote them in the README
	@$(BIN)/python -m tools.readme --adopt results

lock: ## Write locks/ again for pyproject.toml, with hashes; what is locked stays (UPGRADE=1: the newest releases)
	@$(PYTHON) -m venv $(VENV)-lock
	@$(subst $(BIN),$(VENV)-lock/bin,$(INSTALL)) --require-hashes --requirement locks/uv.txt
	@PATH="$(CURDIR)/$(VENV)-lock/bin:$$PATH" $(VENV)-lock/bin/python -m tools.lock $(if $(UPGRADE),--upgrade)
	@rm -rf $(VENV)-lock

clean: ## Remove the environment, caches and generated results
	@rm -rf $(VENV) build dist site .pytest_cache .mypy_cache .ruff_cache .hypothesis .benchmarks
	@mkdir -p results && find results -mindepth 1 -maxdepth 1 ! -name reference ! -name README.md -exec rm -rf {} +
	@find . -name __pycache__ -not -path './.git/*' -prune -exec rm -rf {} +
