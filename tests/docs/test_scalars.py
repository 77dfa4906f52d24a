"""Every scalar of frames is in the table of the documents, with the dimension that labels use."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import pytest

import corota as ct
from corota.model.contact import RigidCurve
from corota.results.scalars import SCALARS, general, table
from corota.results.variables import dimension

PAGE = Path(__file__).resolve().parents[2] / "docs" / "output.md"


def strip() -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 8, 2))
    model.section(element="Q4I", material=ct.Elastic(1000.0, 0.3, rho=0.01))
    model.fix("left")
    return model


def loaded(*steps: ct.Step) -> ct.Results:
    model = strip()
    for step in steps:
        step.force("right", x=-1.0, y=-0.1)
    return ct.solve(model, list(steps), threads=1)


def in_contact() -> ct.Results:
    model = strip()
    floor = RigidCurve.line((-1.0, -0.005), (5.0, -0.005))
    model.contact("bottom", floor, friction=0.3, name="floor: left")
    model.fix("right", y=-0.01, x=None)
    return ct.solve(model, ct.Static(increments=2), threads=1)


RUNS = {
    "static": lambda: loaded(ct.Static(increments=2)),
    "path": lambda: loaded(ct.Static(path=ct.ArcLength(factor=0.5))),
    "buckling": lambda: loaded(ct.Buckle(modes=2)),
    "dynamic": lambda: loaded(ct.Dynamic(period=0.1, increments=2)),
    "explicit": lambda: loaded(ct.Dynamic(period=0.01, scheme="central_difference")),
    "frequencies": lambda: loaded(ct.Frequency(modes=2)),
    "complex": lambda: loaded(ct.Frequency(modes=2, complex_modes=True, rayleigh=(0.1, 0.0))),
    "modal": lambda: loaded(ct.Frequency(modes=3), ct.ModalDynamic(period=0.1, increments=2)),
    "harmonic": lambda: loaded(
        ct.Frequency(modes=3), ct.SteadyState(lowest=1.0, highest=50.0, points=3, damping=0.02)
    ),
    "contact": in_contact,
}


@pytest.mark.parametrize("run", RUNS)
def test_every_scalar_is_known(run: str) -> None:
    found = {name for frame in RUNS[run]().frames for name in frame.scalars}
    assert {general(name) for name in found} <= set(SCALARS)
    assert found


def test_the_documents_have_the_table() -> None:
    assert "\n".join(table()) in PAGE.read_text(encoding="utf-8"), (
        "paste: python -c 'from corota.results.scalars import *; print(*table(), sep=chr(10))'"
    )


def test_labels_have_these_dimensions() -> None:
    for name, (_, wanted) in SCALARS.items():
        assert dimension(name.replace(" k", " 2").replace("PAIR", "floor")) == wanted
    assert strip_units("momentum x") == "momentum x [N·s]"


def strip_units(name: str) -> str:
    from corota.model.units import Units
    from corota.results.variables import labeled

    return labeled(name, Units.of("mm", "N", "t", "s"))
