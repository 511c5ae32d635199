#!/bin/sh
# Succeed if .venv was finished, lies where it was made, and is of the Python asked for.
set -u
[ -x .venv/bin/python ] || exit 1
[ ! -e .venv/.unfinished ] || exit 1
python=$(readlink -f .venv/bin/python)
# scripts/environment.py writes the same words when it has finished.
[ "$(cat .venv/.ready 2>/dev/null)" = "$(readlink -f .venv) $python" ] || exit 1
[ -z "${PYTHON:-}" ] || [ "$(readlink -f "$(sh scripts/find-python.sh)")" = "$python" ]
