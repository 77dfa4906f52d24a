#!/bin/sh
# Say in one line what is missing to build Corota; silent when all is there.
# SPDX-License-Identifier: BSD-3-Clause
set -u
python=${PYTHON:-python3}

stop() {
    echo "corota: $1" >&2
    exit 1
}

command -v "$python" >/dev/null 2>&1 ||
    stop "Python is missing: install Python 3.10 or newer (or name it: make PYTHON=...)"
"$python" -c 'import sys; sys.exit(sys.version_info < (3, 10))' 2>/dev/null ||
    stop "$("$python" --version 2>&1) is too old: install Python 3.10 or newer (or name it: make PYTHON=...)"
"$python" -c 'import ensurepip, venv' 2>/dev/null ||
    stop "this Python cannot make virtual environments: install its venv package (Debian: python3-venv)"

# The minimum is the one that Cargo.toml states.
need=$(sed -n 's/^rust-version *= *"\([0-9]*\.[0-9]*\).*/\1/p' "$(dirname "$0")/../Cargo.toml")
command -v cargo >/dev/null 2>&1 && have=$(cargo --version 2>/dev/null) ||
    stop "Rust is missing: install Rust $need or newer, with cargo (the rustup installer does)"
have=$(echo "$have" | sed -n 's/^cargo \([0-9]*\.[0-9]*\).*/\1/p')
[ -n "$have" ] || stop "cargo does not run: install Rust $need or newer (rustup default stable)"
if [ "${have%%.*}" -lt "${need%%.*}" ] ||
    { [ "${have%%.*}" -eq "${need%%.*}" ] && [ "${have#*.}" -lt "${need#*.}" ]; }; then
    stop "Rust $have is too old: install Rust $need or newer (rustup update stable)"
fi

compiler=${CC:-cc}
command -v "${compiler%% *}" >/dev/null 2>&1 ||
    stop "a linker is missing: install gcc or clang (Debian: build-essential), or set CC"
