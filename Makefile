# Everything is installed in .venv, nothing outside this folder. Only the built message types are also
# kept in ~/.cache/deck, see scripts/wheel_cache.py.

PROFILE ?=
ARGS ?=
PYTHON ?=
ROS ?=
export PYTHON ROS

# A sourced ROS, or a Deck that this make runs under, would put its libraries
# before those of .venv.
unexport _ROS_WHEELS_BOOTSTRAP_COMPLETE
ifneq ($(AMENT_PREFIX_PATH)$(_ROS_WHEELS_BOOTSTRAP_COMPLETE),)
unexport AMENT_PREFIX_PATH CMAKE_PREFIX_PATH COLCON_PREFIX_PATH LD_LIBRARY_PATH PYTHONPATH
endif

# Keep compiled modules: the tests start nodes by the hundred.
unexport PYTHONDONTWRITEBYTECODE

ifneq ($(shell PYTHON='$(PYTHON)' ROS='$(ROS)' sh scripts/sound.sh && echo yes),yes)
.PHONY: .venv/.ready
endif

ROOMS := agents bench brain bridges cli course deck graph launcher nodes robot ros2 scripts space tests text tui view

.PHONY: help setup run view test test-all lint lock architecture site clean
.DEFAULT_GOAL := help

help:
	@echo 'make run    set up if needed, then open Deck; PROFILE=09-brain ARGS="--lang ru"'
	@echo 'make view   also install the viewers, Rerun and Foxglove: 700 MB'
	@echo 'make test   set up if needed, then run the tests; ARGS="-k sonar"'
	@echo 'make test-all  also the slow tests and those that need more of the machine, such as a browser'
	@echo 'make lint   style, types and who may import whom'
	@echo 'make setup  only set up; PYTHON=python3.12 chooses the Python, ROS=kilted the ROS in place of jazzy'
	@echo 'make lock   ask for newer libraries and write down which, with their hashes'
	@echo 'make architecture  write the list of rooms in ARCHITECTURE.md from the code'
	@echo 'make site   write the documentation as web pages to build/site'
	@echo 'make clean  remove what the others made'

setup: catalogues

.venv/.ready: pyproject.toml $(shell find interfaces locked)
	@python=$$(sh scripts/find-python.sh) && exec "$$python" scripts/environment.py .venv

# Compile those whose sources have changed, for example by a `git pull`.
.PHONY: catalogues
catalogues: .venv/.ready
	@for source in text/locale/*/LC_MESSAGES/deck.po; do \
	if [ -e "$$source" ] && [ ! "$${source%.po}.mo" -nt "$$source" ]; then \
	exec .venv/bin/python scripts/catalogues.py compile; fi; done

run: catalogues
	@if [ -t 1 ]; then exec .venv/bin/deck $(PROFILE) $(ARGS); fi; \
	exec .venv/bin/deck run $(or $(PROFILE),09-brain) $(ARGS)

# What only those need who want to see the robot in 3D, and the tests.
.venv/.view: .venv/.ready $(wildcard locked/view.txt)
	@.venv/bin/python scripts/setup_words.py 'deck: installing the viewers, 250 MB to load'
	@.venv/bin/python -m pip --disable-pip-version-check install --quiet --no-compile --no-deps --require-hashes \
	--requirement locked/view.txt
	@touch $@

view: catalogues .venv/.view

test: catalogues .venv/.view
	@exec .venv/bin/python -m tests.run $(ARGS)

test-all: catalogues .venv/.view
	@.venv/bin/python -m tests.machine
	@exec .venv/bin/python -m tests.run --all $(ARGS)

lint: .venv/.ready
	@.venv/bin/ruff check .
	@.venv/bin/ruff format --check .
	@.venv/bin/mypy
	@.venv/bin/lint-imports

lock: .venv/.ready
	@exec .venv/bin/python scripts/lock.py

architecture: .venv/.ready
	@.venv/bin/python scripts/architecture.py --write

# What only those need who build the site.
.venv/.docs: .venv/.ready $(wildcard locked/docs.txt)
	@.venv/bin/python -m pip --disable-pip-version-check install --quiet --no-compile --no-deps --require-hashes \
	--requirement locked/docs.txt
	@touch $@

site: catalogues .venv/.docs
	@exec .venv/bin/mkdocs build --strict --quiet

# A folder without the mark of scripts/environment.py belongs to the user.
clean:
	@if [ ! -e .venv ] || [ -e .venv/.ready ] || [ -e .venv/.unfinished ]; then rm -rf .venv; \
	else echo '.venv is not of this make'"'"'s making: it stays'; fi
	rm -rf build/setup build/site .hypothesis .import_linter_cache .mypy_cache .pytest_cache .ruff_cache
	@if [ -d build ]; then rmdir --ignore-fail-on-non-empty build; fi
	@for room in $(ROOMS); do \
	if [ -d $$room ]; then find $$room -path '*/__pycache__/*.pyc' -type f -delete; \
	find $$room -name __pycache__ -type d -empty -delete; fi; done
