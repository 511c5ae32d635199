#!/bin/sh
# Print the newest Python on PATH that can set Deck up, or say what the best one lacks.
set -u
here=$(dirname "$0")

best=
for name in ${PYTHON:+"$PYTHON"} python3.13 python3.12 python3.11 python3.10 python3; do
    # A name can be a version manager's stub with nothing behind it, or the very
    # environment that is about to be replaced, if its owner has activated it.
    python=$("$name" -c 'import sys; print(getattr(sys, "_base_executable", sys.executable))' \
        2>/dev/null) || continue
    if "$python" "$here/preflight.py" 2>/dev/null; then
        printf '%s\n' "$python"
        exit 0
    fi
    best=${best:-$python}
    [ -z "${PYTHON:-}" ] || break
done
if [ -z "$best" ]; then
    echo "deck: there is no Python ${PYTHON:+named $PYTHON}: install Python 3.10 to 3.13" >&2
    exit 1
fi
exec "$best" "$here/preflight.py"
