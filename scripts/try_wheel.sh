#!/bin/sh
# Install the wheel of dist/ in an empty environment without any toolchain and solve a deck.
# SPDX-License-Identifier: BSD-3-Clause
set -eu
cd "$(dirname "$0")/.."

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT INT TERM
wheel=$(ls -t dist/corota-*.whl | head -n 1)

"${PYTHON:-python3}" -m venv "$place/venv"
# From here on nothing of the system is on the path: no cargo, no compiler.
alone() { env -i HOME="$place" PATH="$place/venv/bin" "$@"; }
pip() { PIP_DISABLE_PIP_VERSION_CHECK=1 "$place/venv/bin/python" -m pip "$@"; }

pip install --quiet --no-compile --only-binary :all: --require-hashes -r requirements.txt
pip install --quiet --no-deps --no-index "$wheel"
for tool in cargo rustc cc gcc clang; do
    if alone "$place/venv/bin/python" -c "import shutil, sys; sys.exit(shutil.which('$tool') is None)"
    then
        echo "try_wheel: $tool is on the path" >&2
        exit 1
    fi
done
cp -r examples/flexure "$place/job"
cd "$place/job"
alone "$place/venv/bin/corota" run flexure.inp -o "$place/out"
test -s "$place/out/flexure.dat"
test -s "$place/out/flexure.vtkhdf"
alone "$place/venv/bin/corota" report "$place/out/flexure"
test -s "$place/out/flexure.html"
echo "try_wheel: $(basename "$wheel") solves flexure.inp in an empty environment"
