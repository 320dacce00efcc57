# Needs only make and Python >= 3.11; `make help` lists what there is.
# PYTHON=/path/to/python chooses the interpreter that .venv is made with.

# Small dense systems are many times slower with threaded BLAS.
export OPENBLAS_NUM_THREADS ?= 1
export OMP_NUM_THREADS ?= 1

VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check --editable
PROGRAM_STAMP := $(VENV)/.installed-program
WEB_STAMP := $(VENV)/.installed-web
STAMP := $(VENV)/.installed
DOCS_STAMP := $(VENV)/.installed-docs
CANDIDATES := $(if $(PYTHON),$(PYTHON),python3.13 python3.12 python3.11 python3)

.DEFAULT_GOAL := help
.PHONY: help venv demo serve test test-first-half test-second-half test-slow test-slow-laws \
        test-slow-others test-browser bench rates check docs clean

help: ## list the targets
	@grep -E '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## (.*)/make \1\t\2/' | expand -t 18

venv: $(STAMP) ## make .venv with all that the tests need (again only when pyproject.toml changed)

$(STAMP): $(PROGRAM_STAMP)
	$(PIP) '.[dev]'
	@touch $@

$(WEB_STAMP): $(PROGRAM_STAMP)
	$(PIP) '.[web]'
	@touch $@

# The program alone, without the designer and what tests need: a third of the download.
$(PROGRAM_STAMP): pyproject.toml
	@python=; for candidate in $(CANDIDATES); do \
	  if "$$candidate" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' \
	    >/dev/null 2>&1; then python=$$candidate; break; fi; \
	done; \
	if [ -z "$$python" ]; then \
	  echo "No Python >= 3.11 with its venv module among: $(CANDIDATES)." >&2; \
	  echo "Install one (Debian, Ubuntu: apt-get install python3 python3-venv), or say: make venv PYTHON=/path/to/python3" >&2; \
	  exit 1; \
	fi; \
	if $(BIN)/python -m pip --version >/dev/null 2>&1; then :; \
	else echo "making $(VENV) with $$python"; "$$python" -m venv --clear $(VENV); fi
	$(PIP) .
	@touch $@

demo: $(PROGRAM_STAMP) ## solve a driven press nip, print the summary, write a picture to out/
	@mkdir -p out
	$(BIN)/rollnip solve examples/press-driven.toml --plot out/press-driven.png

serve: $(WEB_STAMP) ## the nip designer at http://127.0.0.1:8000
	$(BIN)/rollnip serve

# Two halves of about the same length at a time; what the second one prints comes at the end.
FAST := $(BIN)/python -m pytest -m "not slow"
HALF := $(addprefix tests/,cli closed_forms compliance design dma docs face heat identification interior io judges lda paper patch rough sweeps verification web)

test: venv ## the tests, in some minutes
	@log=$$(mktemp); trap 'rm -f "$$log"' EXIT; \
	echo '$(FAST), in two halves'; \
	$(MAKE) -s test-second-half >"$$log" 2>&1 & other=$$!; \
	failed=0; $(MAKE) -s test-first-half || failed=1; wait $$other || failed=1; \
	cat "$$log"; exit $$failed

test-first-half: venv
	$(FAST) $(HALF)

test-second-half: venv
	$(FAST) $(addprefix --ignore=,$(HALF))

SLOW := $(BIN)/python -m pytest -m slow
LAWS := $(addprefix tests/,all_orders properties rolling sheet)

test-slow: venv ## the tests that take more: with killed processes, on many random nips, of the built pages
	$(SLOW) --ignore=tests/browser

test-slow-laws: venv
	$(SLOW) $(LAWS)

test-slow-others: venv
	$(SLOW) --ignore=tests/browser $(addprefix --ignore=,$(LAWS))

test-browser: venv ## the tests in a browser
	$(SLOW) tests/browser

bench: venv ## how long things take, as ratios to a calibration on this machine
	$(BIN)/python -m pytest benchmarks -q -p no:cacheprovider --benchmark-timer=time.process_time --benchmark-quiet

rates: venv ## measure the times that the documentation states, to docs/rates.json
	$(BIN)/python benchmarks/rates.py

check: venv ## style, types, floors
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

docs: $(DOCS_STAMP) ## the documentation, to docs/_build/html; docs/verification.md is computed afresh
	@mkdir -p docs/_build
	$(BIN)/rollnip verify --markdown > docs/_build/verification.md
	mv docs/_build/verification.md docs/verification.md
	$(BIN)/sphinx-build -q -W --keep-going -b html -d docs/_build/doctrees docs docs/_build/html

$(DOCS_STAMP): $(STAMP)
	$(PIP) '.[docs]'
	@touch $@

clean: ## remove .venv, caches and out/
	rm -rf $(VENV) out build dist docs/_build docs/examples .pytest_cache .mypy_cache .ruff_cache .import_linter_cache .hypothesis
	find src tests -name __pycache__ -type d -prune -exec rm -rf {} +
