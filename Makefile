# Everything lands in .venv; nothing is installed outside this folder.

PROFILE ?=
ARGS ?=
PYTHON ?=
export PYTHON

# A sourced ROS, or a Deck that this make runs under, would put its libraries
# before those of .venv.
unexport _ROS_WHEELS_BOOTSTRAP_COMPLETE
ifneq ($(AMENT_PREFIX_PATH)$(_ROS_WHEELS_BOOTSTRAP_COMPLETE),)
unexport AMENT_PREFIX_PATH CMAKE_PREFIX_PATH COLCON_PREFIX_PATH LD_LIBRARY_PATH PYTHONPATH
endif

# What was compiled once is kept: nodes are started by the hundred.
unexport PYTHONDONTWRITEBYTECODE

ifneq ($(shell PYTHON='$(PYTHON)' sh scripts/sound.sh && echo yes),yes)
.PHONY: .venv/.ready
endif

.PHONY: help setup run test lint lock clean
.DEFAULT_GOAL := help

help:
	@echo 'make run    set up if needed, then open Deck; PROFILE=09-brain ARGS="--lang ru"'
	@echo 'make test   set up if needed, then run the tests; ARGS="-k sonar"'
	@echo 'make lint   style, types and who may import whom'
	@echo 'make setup  only set up; PYTHON=python3.12 chooses the Python'
	@echo 'make lock   ask for newer libraries and write down which, with their hashes'
	@echo 'make clean  remove what the others made'

setup: .venv/.ready

.venv/.ready: pyproject.toml $(shell find interfaces locked)
	@python=$$(sh scripts/find-python.sh) && exec "$$python" scripts/environment.py .venv

run: .venv/.ready
	@if [ -t 1 ]; then exec .venv/bin/deck $(PROFILE) $(ARGS); fi; \
	exec .venv/bin/deck run $(or $(PROFILE),09-brain) $(ARGS)

test: .venv/.ready
	@exec .venv/bin/python -m pytest -n 3 --dist loadfile --no-loadscope-reorder $(ARGS)

lint: .venv/.ready
	@.venv/bin/ruff check .
	@.venv/bin/ruff format --check .
	@.venv/bin/mypy
	@.venv/bin/lint-imports

lock: .venv/.ready
	@exec .venv/bin/python scripts/lock.py

clean:
	rm -rf .venv build .hypothesis .import_linter_cache .mypy_cache .pytest_cache .ruff_cache
	find bench graph launcher nodes robot scripts tests text tui -name __pycache__ -exec rm -rf {} +
