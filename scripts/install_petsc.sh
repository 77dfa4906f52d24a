#!/usr/bin/env bash
# Install PETSc with MUMPS, petsc4py and mpi4py on Debian 12, for Corota's solver "petsc".
#
#   scripts/install_petsc.sh [PYTHON] [DIR]
#
# PYTHON (default: python3) is the interpreter that runs Corota, 3.10 or 3.11, with pip and NumPy.
# Packages go into its environment, or into DIR, which is then named in PYTHONPATH. System packages
# need root; they are left alone where they are installed.
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail

python=${1:-python3}
target=()
if [ $# -gt 1 ]; then target=(--target "$2"); fi

missing=()
# OpenBLAS takes the place of the reference BLAS, with which MUMPS takes more than twice the time;
# "serial" because processes share the cores already.
for package in libpetsc-real-dev openmpi-bin libopenmpi-dev libopenblas0-serial; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q "ok installed" || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  apt-get update
  DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}" g++
fi

export PETSC_DIR=/usr/lib/petsc
version=$(sed -n 's/^#define PETSC_VERSION_\(MAJOR\|MINOR\) *\([0-9]*\).*/\2/p' \
  "$PETSC_DIR/include/petscversion.h" | paste -sd.)
if [ "$version" != 3.18 ]; then
  echo "PETSc $version: this script knows Debian 12's PETSc 3.18" >&2
  exit 1
fi
"$python" - <<'CHECK'
import sys
if not (3, 10) <= sys.version_info[:2] <= (3, 11):
    sys.exit("petsc4py 3.18 needs Python 3.10 or 3.11")
CHECK

# What petsc4py is built with stays out of the environment; NumPy is the one that it will meet.
tools=$(mktemp -d)
trap 'rm -rf "$tools"' EXIT
"$python" -m pip install -q --target "$tools" 'cython<3' 'setuptools<70' wheel
MPICC=mpicc "$python" -m pip install -q --no-deps "${target[@]}" 'mpi4py>=4,<5'
PYTHONPATH="$tools${PYTHONPATH:+:$PYTHONPATH}" "$python" -m pip install -q --no-deps \
  --no-build-isolation "${target[@]}" petsc4py==3.18.5

PYTHONPATH="${2:+$2:}${PYTHONPATH:-}" "$python" -c '
import petsc4py
petsc4py.init(["install"])
from petsc4py import PETSc
print("PETSc", *PETSc.Sys.getVersion(), "is ready")'

blas=$(readlink -f "/usr/lib/$(gcc -dumpmachine)/libblas.so.3")
case $blas in
  *openblas*|*blis*|*atlas*|*mkl*) ;;
  *) echo "MUMPS will be slow with $blas: choose OpenBLAS by update-alternatives" >&2 ;;
esac
