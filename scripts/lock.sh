#!/bin/sh
# Pin the Python packages by version and hash, without any registry's address.
# SPDX-License-Identifier: BSD-3-Clause
set -eu
cd "$(dirname "$0")/.."

pin() {
    out=$1
    shift
    uv pip compile --quiet --upgrade --universal --generate-hashes --python-version 3.10 \
        --no-emit-index-url --no-emit-find-links --no-header "$@" --output-file "$out"
}

pin requirements.txt pyproject.toml --extra plot
pin requirements-build.txt requirements-build.in
pin requirements-dev.txt requirements-dev.in --constraint requirements.txt --constraint requirements-build.txt
pin requirements-mesh.txt requirements-mesh.in
pin requirements-optimize.txt requirements-optimize.in --constraint requirements.txt
pin requirements-docs.txt requirements-docs.in --constraint requirements.txt
pin requirements-view.txt requirements-view.in --constraint requirements.txt --constraint requirements-dev.txt
