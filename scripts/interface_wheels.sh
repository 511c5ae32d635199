#!/bin/sh
# Build the wheels of the message types (interfaces/) for other machines, one for each given Python.
# Usage: interface_wheels.sh FOLDER PYTHON..., with auditwheel and patchelf on PATH; meant for a
# container of manylinux_2_28, since a wheel asks for a C library as new as the one it was built on.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1"
out=$(cd "$1" && pwd)
shift

for python; do
    work=$(mktemp -d)
    "$python" "$here/environment.py" --build-interfaces "$work/built" "$work/environment"
    # Libraries of ROS come with its own wheels, and those of the message types name one another.
    auditwheel repair --plat manylinux_2_28_x86_64 --only-plat \
        --exclude 'lib*rosidl*' --exclude 'libros*' --exclude 'librc*' --exclude 'librmw*' \
        --exclude 'libfast*' --wheel-dir "$out" "$work"/built/*.whl
    rm -r "$work"
done
