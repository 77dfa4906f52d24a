#!/bin/sh
# Wrapper of rustc for `cargo build`: lints of clippy and no machine code.
# `cargo clippy` would check all dependencies again, which are built.
# SPDX-License-Identifier: BSD-3-Clause
set -eu
for argument in "$@"; do
    shift
    case $argument in --emit=*) argument=--emit=dep-info,metadata ;; esac
    set -- "$@" "$argument"
done
exec clippy-driver "$@" -D warnings
