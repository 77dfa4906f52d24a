"""Materials written in Python: the same contract, and the same results as the core's own."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.check.material import check_material
from corota.model import elements
from corota.verification.plastic_models import cook, perforated_strip
from support.pairs import quickly

E, NU, SY, H = 70000.0, 0.2, 243.0, 2240.0


def j2(strain: np.ndarray, state: np.ndarray, plane: str) -> Any:
    """J2 with linear hardening in plane stress, a thousand points at a time.

    Written apart from the core: Newton's method for the multiplier itself.
    """
    assert plane == "stress"
    c = E / (1 - NU**2) * np.array([[1, NU, 0], [NU, 1, 0], [0, 0, (1 - NU) / 2]])
    p = np.array([[2, -1, 0], [-1, 2, 0], [0, 0, 6]]) / 3
    ep, alpha = state[..., :3], state[..., 3]
    trial = (strain - ep) @ c
    a, b = np.array([1, 1, 0]), np.array([1, -1, 0])
    m, d, s = (trial @ a) ** 2 / 6, (trial @ b) ** 2 / 2, 2 * trial[..., 2] ** 2
    k1, k3 = E / (3 * (1 - NU)), E / (1 + NU)
    plastic = np.sqrt(1.5 * (m + d + s)) > SY + H * alpha
    g = np.zeros_like(alpha)
    for _ in range(60):
        xi = m / (1 + k1 * g) ** 2 + (d + s) / (1 + k3 * g) ** 2
        dxi = -2 * k1 * m / (1 + k1 * g) ** 3 - 2 * k3 * (d + s) / (1 + k3 * g) ** 3
        q, dq = np.sqrt(2 * xi / 3), dxi / np.sqrt(6 * np.maximum(xi, 1e-300))
        sy = SY + H * (alpha + g * q)
        value = 0.5 * xi - sy**2 / 3
        slope = 0.5 * dxi - 2 / 3 * sy * H * (q + g * dq)
        g = np.where(plastic, g - value / np.where(plastic, slope, 1.0), 0.0)
        if np.all(np.abs(value) <= 1e-15 * sy**2, where=plastic):  # rounding is all that is left
            break
    xi_matrix = np.linalg.inv(np.linalg.inv(c) + g[..., None, None] * p)
    stress = np.einsum("...ij,...j->...i", xi_matrix, strain - ep)
    flow = g[..., None] * (stress @ p)
    xi = np.einsum("...i,ij,...j->...", stress, p, stress)
    n = np.einsum("...ij,...j->...i", xi_matrix, stress @ p)
    t2 = 1 - 2 / 3 * H * g
    low = np.einsum("...i,ij,...j->...", n, p, stress) + 2 / 3 / t2 * xi * H
    rank = np.where(plastic, 1 / np.where(low == 0, 1, low), 0.0)[..., None, None]
    tangent = xi_matrix - rank * n[..., :, None] * n[..., None, :]
    new = np.concatenate([ep + flow, (alpha + g * np.sqrt(2 * xi / 3))[..., None]], axis=-1)
    return stress, tangent, new, {"PEEQ": new[..., 3]}


def core() -> ct.Mises:
    return ct.Mises(E=E, nu=NU, yield_stress=SY, isotropic=H)


def test_contract_of_both() -> None:
    """The law in Python keeps what the core's keeps."""
    for law in (core(), ct.UserMaterial(j2, members=4)):
        assert check_material(law).faults == []


def test_points_agree_with_the_core() -> None:
    path = np.cumsum(np.random.default_rng(5).uniform(-1e-3, 1e-3, (60, 3)), axis=0)
    mine = ct.UserMaterial(j2, members=4).respond(path)
    theirs = core().respond(path)
    assert np.abs(mine["stress"] - theirs["stress"]).max() < 1e-9 * SY
    assert np.abs(mine["PEEQ"] - theirs["PEEQ"]).max() < 1e-12


@pytest.mark.parametrize("element", ["Q4", "Q8", "Q4I", "Q4D", "OPT"])
def test_model_agrees_with_the_core(element: str) -> None:
    """Iteration by iteration without internal modes; to the tolerance with them."""
    out = []
    for material in (core(), ct.UserMaterial(j2, members=4)):
        model = perforated_strip(element, 3, material, local_strain="logarithmic")
        results = ct.solve(model, ct.Static(increments=6), threads=1)
        frame = results.frames[-1]
        out.append((frame.U, frame.RF, frame.fields[0].values["PEEQ"], results.info["iterations"]))
    one, two = out
    assert np.abs(one[0] - two[0]).max() < 1e-8 * np.abs(one[0]).max()
    assert np.abs(one[1] - two[1]).max() < 1e-7 * np.abs(one[1]).max()
    assert np.abs(one[2] - two[2]).max() < 1e-8
    assert abs(one[3] - two[3]) <= 2


def test_failed_increments_leave_no_trace() -> None:
    """The committed history is the function's only past."""
    material = ct.UserMaterial(j2, members=4)
    long = ct.Static(first_increment=1.0, plastic_increment=0.005)
    results = ct.solve(perforated_strip("Q4", 3, material, pull=0.1), long, threads=1)
    same = ct.solve(perforated_strip("Q4", 3, core(), pull=0.1), long, threads=1)
    assert results.info["cut-backs"] == same.info["cut-backs"] >= 1
    peeq = [r.frames[-1].fields[0].values["PEEQ"] for r in (results, same)]
    assert np.abs(peeq[0] - peeq[1]).max() < 1e-10


def _good(strain: np.ndarray, state: np.ndarray, plane: str) -> Any:
    return strain * 1.0, np.broadcast_to(np.eye(3), (*strain.shape, 3)), state


BAD = [
    (lambda e, s, p: e, "must return"),
    (lambda e, s, p: (e[..., :2], _good(e, s, p)[1], s), "returned stress of shape"),
    (lambda e, s, p: (e, e, s), "returned tangent of shape"),
    (lambda e, s, p: (*_good(e, s, p)[:2], s[..., :0]), "returned state of shape"),
    (lambda e, s, p: (s.fill(1.0), _good(e, s, p))[1], "changed the history"),
]


@pytest.mark.parametrize(("function", "reason"), BAD)
def test_refuses(function: Any, reason: str) -> None:
    model = cook("Q4", 2, material=ct.Elastic(E=1.0))
    model.sections[0].material = ct.UserMaterial(function, members=2)
    with pytest.raises(ct.InputError, match=reason):
        ct.solve(model, ct.Static(), threads=1)


def test_refuses_its_own_arguments() -> None:
    with pytest.raises(ct.InputError, match="callable"):
        ct.UserMaterial(3)  # type: ignore[arg-type]
    with pytest.raises(ct.InputError, match="members must be"):
        ct.UserMaterial(_good, members=-1)
    with pytest.raises(ct.InputError, match="initial must have 2"):
        ct.UserMaterial(_good, members=2, initial=[0.0])


def kicked(law: ct.Material, element: str, increments: int) -> ct.Frame:
    """The end of a beam kicked past yield, by the energy-momentum scheme."""
    mesh = ct.mesh.rectangle(100.0, 10.0, nx=6, ny=1, cell=elements.find(element).cell)
    model = ct.Model(mesh)
    model.section("all", element=element, material=replace(law, rho=1e-9))
    model.fix("left")
    model.velocity("", spin=-500.0)
    step = ct.Dynamic(
        period=2e-4, increments=increments, scheme="energy_momentum", max_iterations=60
    )
    return ct.solve(model, step, threads=1).frames[-1]


@pytest.mark.parametrize("element", quickly(["Q4", "OPT", "Q8", "Q4I", "Q4D"], "Q8", "Q4D"))
def test_energy_momentum_tends_to_that_of_the_core(element: str) -> None:
    """The scheme takes the stress of both ends of the increment from the function. The built-in
    law has forces along the increment; the difference vanishes with the increment."""
    apart = []
    for increments in (20, 80):
        ours = kicked(ct.UserMaterial(j2, members=4), element, increments)
        theirs = kicked(core(), element, increments)
        assert theirs.fields[0].values["PEEQ"].max() > 1e-3
        apart.append(np.abs(ours.U - theirs.U).max() / np.abs(theirs.U).max())
    assert apart[1] < min(1e-3, apart[0] / 3.0)


@pytest.mark.parametrize(
    ("plane", "name", "given"),
    [
        ("stress", "strain_zz", False),
        ("strain", "stress_zz", False),
        ("stress", "strain_zz", True),
        ("strain", "stress_zz", True),
    ],
)
def test_a_law_says_what_it_leaves_out_of_the_normal_direction(
    plane: str, name: str, given: bool
) -> None:
    """Its stress or strain there was shown as 0 in silence."""
    c = np.diag([1000.0, 1000.0, 500.0])

    def spring(strain, state, plane):
        extra = {name: np.zeros(strain.shape[:2])} if given else {}
        return strain @ c, np.broadcast_to(c, (*strain.shape, 3)), state, extra

    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1))
    model.section("all", element="Q4", material=ct.UserMaterial(spring), plane=plane)
    model.fix("left")
    model.fix("right", x=0.02, y=None)
    notes = ct.solve(model, ct.Static(nlgeom=False), threads=1).notes
    assert any(name in note for note in notes) == (not given)
