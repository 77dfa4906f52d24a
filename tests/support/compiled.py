"""Compiled laws for tests; the linker that Rust needs compiles C as well."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

#: Subroutine UMAT and a function with the C interface.
SOURCE = Path(__file__).parents[1] / "plastic" / "compiled_laws.c"


def build(text: str, path: Path) -> Path:
    """Compile a library."""
    compiler = shutil.which("cc") or "gcc"
    command = [compiler, "-O2", "-shared", "-fPIC", "-o", str(path), "-x", "c", "-", "-lm"]
    subprocess.run(command, input=text, text=True, check=True)
    return path


def compiled_laws(folder: Path) -> Path:
    """The library of :data:`SOURCE` in a folder."""
    return build(SOURCE.read_text(encoding="utf-8"), folder / "laws.so")
