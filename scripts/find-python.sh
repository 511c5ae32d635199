#!/bin/sh
# Print the newest Python on PATH that Deck can use, or say what the best one lacks.
# If PYTHON is set in the environment, only that one is considered.
set -u
here=$(dirname "$0")

if [ -n "${PYTHON:-}" ]; then
    set -- "$PYTHON"
else
    set -- python3.13 python3.12 python3.11 python3.10 python3
fi
best=
for name; do
    # A name can be a version manager's stub with nothing behind it, or the very
    # environment that is about to be replaced, if its owner has activated it.
    python=$("$name" -c 'import sys; print(getattr(sys, "_base_executable", sys.executable))' \
        2>/dev/null) || continue
    if "$python" "$here/preflight.py" 2>/dev/null; then
        printf '%s\n' "$python"
        exit 0
    fi
    best=${best:-$python}
done
if [ -z "$best" ]; then
    # There is no Python that could ask setup_words.py.
    case "${DECK_LANG:-${LC_ALL:-${LC_MESSAGES:-${LANG:-}}}}" in
    ru*) echo "deck: ${PYTHON:-python3} здесь не запускается: установите Python 3.10–3.13 и его модуль venv" >&2 ;;
    *) echo "deck: ${PYTHON:-python3} does not run here: install Python 3.10 to 3.13 and its venv module" >&2 ;;
    esac
    exit 1
fi
exec "$best" "$here/preflight.py"
