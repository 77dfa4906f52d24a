"""The functions of numba and JAX on the how-to page, beside the same laws by hand and in the core.

Neither library belongs to the package. Where one is missing, its program ends at its import.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct

PAGE = Path(__file__).parents[2] / "docs" / "howto" / "compiled_laws.md"
LAMBDA, MU = 600.0, 400.0


def material_of(library: str) -> Any:
    """Material that the last block of a section of the page makes; none without the library."""
    section = PAGE.read_text(encoding="utf-8").split(f"## {library}\n")[1].split("\n## ")[0]
    program = re.findall(r"^```\n(.*?)^```", section, re.MULTILINE | re.DOTALL)[-1]
    names: dict[str, Any] = {"ct": ct, "np": np, "LAMBDA": LAMBDA, "MU": MU}
    if find_spec(library.lower()) is None:
        with pytest.raises(ModuleNotFoundError, match=library.lower()):
            exec(compile(program, str(PAGE), "exec"), names)
        return None
    exec(compile(program, str(PAGE), "exec"), names)
    return names["material"]


def solve(material: Any) -> ct.Results:
    model = ct.Model(ct.mesh.distort(ct.mesh.rectangle(2.0, 1.0, 4, 2), 0.2))
    model.section("all", element="Q4", material=material, plane="strain", local_strain="linear")
    model.fix("left")
    model.fix("right", x=0.04, y=0.02)
    return ct.solve(model, ct.Static(increments=1), threads=1)


def test_numba() -> None:
    material = material_of("numba")
    if material is not None:
        strain = np.array([0.01, -0.002, 0.004])
        point = material.respond(strain)
        assert point["stress"][0] == pytest.approx([10.0, -2.0, 2.0], rel=1e-12)
        assert point["energy"][0] == pytest.approx(0.5 * (0.1 + 0.004 + 0.008), rel=1e-12)
        core = ct.Orthotropic(1000.0, 1000.0, 1000.0, 0.0, 0.0, 0.0, 500.0)
        force = solve(core).frames[-1].RF
        assert np.abs(solve(material).frames[-1].RF - force).max() < 1e-8 * np.abs(force).max()


def test_jax() -> None:
    material = material_of("JAX")
    if material is not None:
        nu = LAMBDA / (2.0 * (LAMBDA + MU))
        core = ct.Elastic(2.0 * MU * (1.0 + nu), nu)
        force = solve(core).frames[-1].RF
        assert np.abs(solve(material).frames[-1].RF - force).max() < 1e-8 * np.abs(force).max()
