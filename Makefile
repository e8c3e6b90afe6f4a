# Every target sets up what it needs; a second run finds it done. Needs Python >= 3.11 and make.
#
#   make demo      the game; without a display, the scripted tour off screen, into out/demo/
#   make test      every test
#   make bench     every benchmark, JSON into out/bench/
#   make lint      ruff and mypy
#   make clean     removes what the above made
#
# PYTHON=/path/to/python picks the interpreter, ARGS="..." goes to the game or to pytest.

ifeq ($(OS),Windows_NT)
BIN := .venv/Scripts
else
BIN := .venv/bin
endif
PY := $(BIN)/python

.PHONY: demo test bench lint clean setup setup-test
.DELETE_ON_ERROR:

demo: setup
	$(PY) -m demo_game $(ARGS)

test: setup-test
	$(PY) -m pytest -n 2 --dist loadfile $(ARGS)

bench: setup
	@mkdir -p out/bench
	@set -e; for name in $${BENCH:-$$($(PY) -m benchmarks --list)}; do \
		$(PY) -m benchmarks $$name --json out/bench/$$name.json $(ARGS); \
	done

lint: .venv/.stamp-python
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

clean:
	rm -rf .venv build dist out *.egg-info .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

setup: .venv/.stamp-opengl
setup-test: .venv/.stamp-opengl .venv/.stamp-window

# The first Python of at least 3.11, or the one that PYTHON names.
.venv/.stamp-python: pyproject.toml tools/system_packages.py
	@set -e; \
	if [ ! -x $(PY) ]; then \
		found=; \
		for candidate in $${PYTHON:-python3 python3.14 python3.13 python3.12 python3.11 python}; do \
			if "$$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then \
				found=$$candidate; break; \
			fi; \
		done; \
		if [ -z "$$found" ]; then \
			echo "make: no Python >= 3.11 found; name one: make PYTHON=/path/to/python" >&2; exit 1; \
		fi; \
		"$$found" tools/system_packages.py venv; \
		echo "set-up: virtual environment in .venv"; \
		"$$found" -m venv --clear .venv; \
	fi
	@echo "set-up: Python packages"
	@$(PY) -m pip install --quiet --disable-pip-version-check -e '.[dev,demo]'
	@touch $@

.venv/.stamp-opengl: .venv/.stamp-python
	@$(PY) tools/system_packages.py opengl
	@touch $@

.venv/.stamp-window: .venv/.stamp-python
	@$(PY) tools/system_packages.py window
	@touch $@
