#!/bin/sh
# Succeed if .venv is complete, is where it was made, and has the requested Python and ROS.
set -u
[ -x .venv/bin/python ] || exit 1
[ ! -e .venv/.unfinished ] || exit 1
python=$(readlink -f .venv/bin/python)
# scripts/environment.py writes the same text when it has finished.
[ "$(cat .venv/.ready 2>/dev/null)" = "$(readlink -f .venv) $python" ] || exit 1
[ -z "${ROS:-}" ] || [ "$(cat .venv/.ros 2>/dev/null || echo jazzy)" = "$ROS" ] || exit 1
[ -z "${PYTHON:-}" ] || [ "$(readlink -f "$(sh scripts/find-python.sh)")" = "$python" ]
