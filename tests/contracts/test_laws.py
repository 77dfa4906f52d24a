"""What every material law keeps, whatever it is: tangent, axes, energy, elements, units.

Closed forms of uniaxial, planar, biaxial and shear states differ by law:
`tests/rubber/test_point.py`, `tests/rubber/test_mullins.py`, `tests/plastic/test_point.py`,
`tests/plastic/test_hill.py`,
`tests/plastic/test_ramberg_osgood.py`, `tests/rates/test_point.py`,
`tests/rates/test_viscoelastic.py`.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.check.material import check_material
from corota.model import elements
from corota.model.hyperelastic import laws_of_energies
from corota.model.materials import Material
from support.laws import ENERGIES, LAWS
from support.models import DRILLING, cell

PLANES = ("stress", "strain")
PLANAR = [name for name in elements.names() if not elements.find(name).weighted]

#: Strain that loads a law well: that of rubber is large.
STRAIN = {name: 0.2 if make(1.0, 1.0).local_strain else 0.01 for name, make in LAWS.items()}
#: Laws with axes of their own, and those without an answer at a single point.
AXES = {"orthotropic", "Hill", "Hill combined", "elastic"}
POINTLESS = {"elastic", "orthotropic"}


@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("name", [n for n in LAWS if n not in POINTLESS])
def test_tangent_axes_and_energy(name: str, plane: str) -> None:
    """Along four closed paths: derivatives, turned paths, work and energy, no gain in a cycle."""
    found = check_material(LAWS[name](1.0, 1.0), plane, STRAIN[name])
    assert found.faults == []
    assert (found.objectivity is None) == name.startswith("Hill")


def gradient(strain: float, turn: float) -> tuple[np.ndarray, np.ndarray]:
    """Logarithmic strain xx, yy, xy of a stretch, and the gradient with a turn after it."""
    log = strain * np.array([[1.0, 0.3], [0.3, -0.9]])
    sizes, axes = np.linalg.eigh(log)
    stretch = axes @ np.diag(np.exp(sizes)) @ axes.T
    c, s = np.cos(turn), np.sin(turn)
    return np.array([log[0, 0], log[1, 1], 2.0 * log[0, 1]]), np.array([[c, -s], [s, c]]) @ stretch


@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("name", [n for n in LAWS if n not in AXES])
def test_every_element_gives_the_answer_of_the_point(name: str, plane: Any) -> None:
    """A distorted patch, stretched and turned by 70 degrees in one increment: stress, force of
    the right side, energy, from the law alone.
    """
    law = LAWS[name](1.0, 1.0)
    turn = np.radians(70.0)
    strain, F = gradient(STRAIN[name], turn)
    timed = {"time": [1.0]} if law.depends_on_time else {}
    point = law.respond(strain, plane, **timed)
    x, y, xy = point["stress"][0]
    zz, normal = point["zz"][0]
    c, s = np.cos(turn), np.sin(turn)
    R = np.array([[c, -s], [s, c]])
    cauchy = R @ np.array([[x, xy], [xy, y]]) @ R.T / (np.linalg.det(F) * np.exp(zz))
    nominal = np.linalg.det(F) * np.exp(zz) * cauchy @ np.linalg.inv(F).T
    wanted = np.array([cauchy[0, 0], cauchy[1, 1], normal, cauchy[0, 1]])
    wanted[2] /= np.linalg.det(F) * np.exp(zz)
    top = np.abs(wanted).max()
    for element in PLANAR:
        if law.flows and not law.remembers and elements.find(element).stabilized:
            continue  # refused: the hourglass flows by a history
        mesh = ct.mesh.distort(ct.mesh.rectangle(2.0, 1.0, 2, 2, cell(element)), 0.2)
        model = ct.Model(mesh)
        model.section("all", element=element, material=law, plane=plane, local_strain="logarithmic")
        sides = [mesh.nodes_of(e) for e in ("left", "right", "top", "bottom")]
        for node in np.unique(np.concatenate(sides)):
            ux, uy = (F - np.eye(2)) @ mesh.points[node]
            model.fix([node], x=ux, y=uy, rotation=turn if element in DRILLING else None)
        # The point goes there in one increment; creep would choose shorter ones.
        step = ct.Visco if law.depends_on_time else ct.Static
        one = step(increments=1, fixed_increments=True)
        frame = ct.solve(model, one, threads=1).frames[-1]
        # The rotation of a drilling element is tied to the skew gradient, which is linear.
        error = 1e-2 if element in DRILLING else 1e-7
        assert np.abs(frame.fields[0].values["S"] - wanted).max() < error * top, element
        force = frame.RF[mesh.nodes_of("right")].sum(axis=0)[:2]
        assert np.abs(force - nominal[:, 0]).max() < error * top, element
        stored = frame.scalars["strain energy"] / 2.0
        assert stored == pytest.approx(point["energy"][0], rel=10.0 * error), element


@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("name", [n for n in LAWS if n not in POINTLESS])
def test_units_do_not_matter(name: str, plane: str) -> None:
    """Pa and hours instead of MPa and seconds, along a path that turns back."""
    f, t = 1e6, 1.0 / 3600.0
    path = STRAIN[name] * np.array(
        [[0.5, -0.2, 0.3], [1.0, -0.5, 0.2], [0.4, 0.1, -0.5], [-0.8, 0.3, 0.1]]
    )
    answers = []
    for force, time in ((1.0, 1.0), (f, t)):
        law = LAWS[name](force, time)
        timed = {"time": time * np.arange(1.0, 5.0)} if law.depends_on_time else {}
        answers.append(law.respond(path, plane, **timed))
    first, second = answers
    for key in ("stress", "tangent", "energy"):
        scale = np.abs(first[key]).max()
        assert np.abs(second[key] / f - first[key]).max() < 1e-9 * scale, key
    assert np.abs(second["zz"] / [1.0, f] - first["zz"]).max() < 1e-9 * np.abs(first["zz"]).max()


def test_every_public_law_is_here() -> None:
    """A new law is not forgotten; those of users and by temperature stand in `tests/plastic`."""
    tried = {type(make(1.0, 1.0)) for make in LAWS.values()}
    names = {t.__name__ for t in tried}
    public = {
        name
        for name, home in ct._HOMES.items()
        if home.startswith("corota.model.") and issubclass(type(found := getattr(ct, name)), type)
        if issubclass(found, Material)
    }
    other = {"CompiledMaterial", "MaterialTable", "Umat", "UserMaterial"}
    assert public - names == other, "enter the law in LAWS of tests/support/laws.py"
    assert ENERGIES.keys() == set(laws_of_energies()), "and its energy in ENERGIES there"
