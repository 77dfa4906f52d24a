"""Plastic element vectors, the driver path through one element, and invariances."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota import _core
from corota.model.local_strain import local_strain
from plastic.test_point import CORNERS, DRIVER

VECTORS = json.loads(
    (Path(__file__).parents[1] / "data" / "element_vectors.json").read_text(encoding="utf-8")
)["plastic"]
IDS = [f"{v['element']}-{i}" for i, v in enumerate(VECTORS)]


def evaluate(case: dict[str, Any], law: ct.Mises) -> tuple[np.ndarray, np.ndarray]:
    """Force and full tangent of one element in global axes."""
    x = np.array(case["X"])
    block = {
        "element": case["element"],
        "law": law.law,
        "parameters": law.parameters(),
        "plane": case["plane"],
        "local_strain": local_strain(case["local_strain"]),
        "thickness": case["thickness"],
        "rho": 0.0,
        "nodes": np.arange(len(x), dtype=np.uint32),
    }
    core = _core.Problem(x, [block], np.zeros(0, np.uint8))
    n = core.n_dofs
    force, scale, values = np.empty(n), np.empty(n), np.empty(len(core.indices))
    core.assemble(np.ravel(np.array(case["u"])), True, force, scale, values)
    upper = np.zeros((n, n))
    columns = np.repeat(np.arange(n), np.diff(core.indptr.astype(int)))
    upper[core.indices.astype(int), columns] = values
    return force, upper + np.triu(upper, 1).T


@pytest.mark.parametrize("case", VECTORS, ids=IDS)
def test_element_vectors(case: dict[str, Any]) -> None:
    """Against an independent implementation."""
    data = case["plastic"]
    law = ct.Mises(
        E=case["E"],
        nu=case["nu"],
        yield_stress=data["yield_stress"],
        isotropic=data["isotropic_hardening"],
    )
    force, tangent = evaluate(case, law)
    reference = np.array(case["force"]).ravel()
    assert np.abs(force - reference).max() < 1e-9 * np.abs(reference).max()
    reference = np.array(case["tangent"]).reshape(tangent.shape)
    assert np.abs(tangent - reference).max() < 1e-9 * np.abs(reference).max()


def driver_deck(K: float, H: float, steps: int) -> str:
    """One element through the corners of the driver path, all displacements prescribed."""
    if H and K:
        plastic = (
            f"*PLASTIC, HARDENING=COMBINED, DATA TYPE=PARAMETERS, NUMBER BACKSTRESSES=1\n"
            f"250., {H}, 0.\n*CYCLIC HARDENING\n250., 0.\n{250 + K}., 1.\n"
        )
    elif H:
        plastic = f"*PLASTIC, HARDENING=KINEMATIC\n250., 0.\n{250 + H}., 1.\n"
    elif K:
        plastic = f"*PLASTIC\n250., 0.\n{250 + K}., 1.\n"
    else:
        plastic = "*PLASTIC\n250.\n"
    head = (
        "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n"
        "*ELEMENT, TYPE=CPS4, ELSET=ALL\n1, 1, 2, 3, 4\n"
        f"*MATERIAL, NAME=STEEL\n*ELASTIC\n200000., .3\n{plastic}"
        "*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL\n1.\n"
    )
    text = [head]
    for corner in CORNERS[1:]:
        text.append(f"*STEP\n*STATIC, DIRECT\n{1 / steps}, 1.\n*BOUNDARY\n")
        for node, (x, y) in enumerate([(0, 0), (1, 0), (1, 1), (0, 1)], start=1):
            u = corner[0] * x + corner[2] / 2 * y
            v = corner[1] * y + corner[2] / 2 * x
            text.append(f"{node}, 1, 1, {float(u)!r}\n{node}, 2, 2, {float(v)!r}\n")
        text.append("*END STEP\n")
    return "".join(text)


@pytest.mark.parametrize(("K", "H", "steps", "ends", "alpha"), DRIVER)
def test_driver_through_a_deck(
    K: float, H: float, steps: int, ends: list[float], alpha: float, tmp_path: Path
) -> None:
    path = tmp_path / "driver.inp"
    path.write_text(driver_deck(K, H, steps), encoding="utf-8")
    results = ct.solve(ct.read(path), threads=1)
    last = [f for f in results.frames if f.factor == 1.0]
    stress = np.array([f.fields[0].values["S"][0, 0, [0, 1, 3]] for f in last])
    assert np.abs(stress.ravel() - ends).max() < 6e-9
    assert abs(last[-1].fields[0].values["PEEQ"][0, 0] - alpha) < 6e-11


@pytest.mark.parametrize("measure", ["linear", "logarithmic"])
@pytest.mark.parametrize("element", ["T3", "T6", "Q4", "Q4I", "Q8", "Q8R", "Q9", "OPT", "Q4D"])
def test_turning_changes_nothing(element: str, measure: str) -> None:
    """A plastic state turned as a whole has the turned force and the same energy."""
    kinds = {e["name"]: e["n_nodes"] for e in _core.elements()}
    drilling = element in ("OPT", "Q4D")
    cases = {v["element"]: v for v in VECTORS}
    similar = {"T6": None, "Q4I": "Q4", "Q8R": "Q8"}
    if element == "T6":
        corners = np.array(cases["T3"]["X"])
        x = np.vstack([corners, 0.5 * (corners + np.roll(corners, -1, axis=0))])
        u = 0.01 * np.random.default_rng(0).standard_normal(x.shape)
        base = {**cases["T3"], "X": x.tolist(), "u": u.tolist()}
    else:
        base = dict(cases[similar.get(element) or element])
    base |= {"element": element, "local_strain": measure}
    assert len(base["X"]) == kinds[element]
    law = ct.Mises(E=base["E"], nu=base["nu"], yield_stress=0.004 * base["E"], kinematic=30.0)
    force, tangent = evaluate(base, law)
    x, u = np.array(base["X"]), np.array(base["u"])
    angle = 2.1
    r = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    turned = (x + u[:, :2]) @ r.T - x
    if drilling:
        turned = np.column_stack([turned, u[:, 2] + angle])
    big = np.eye(3)
    big[:2, :2] = r
    m = 3 if drilling else 2
    turn = np.kron(np.eye(len(x)), big[:m, :m])
    force_2, tangent_2 = evaluate({**base, "u": turned.tolist()}, law)
    assert np.abs(force_2 - turn @ force).max() < 1e-11 * np.abs(force).max()
    assert np.abs(tangent_2 - turn @ tangent @ turn.T).max() < 1e-9 * np.abs(tangent).max()


@pytest.mark.parametrize("hardening", [0.0, 250.0])
def test_incompatible_modes_settle_when_the_element_is_back_in_its_shape(hardening):
    """The last step returns to zero displacement, where nothing but stress is left to measure
    the modes with: no cut-back, and the stress of the material everywhere."""
    from corota.verification.problems import plasticity_patch as problem

    mesh = ct.mesh.distort(ct.mesh.rectangle(1.0, 1.0, 3, 3), 0.2, seed=1)
    model = ct.Model(mesh)
    law = ct.Mises(E=250e3, nu=0.25, yield_stress=5.0, isotropic=hardening)
    model.section("all", element="Q4I", material=law, plane="strain")
    results = problem.strained(model)
    assert results.info.get("cut-backs", 0) == 0
    share = np.arange(1, problem.COARSE + 1)[:, None] / problem.COARSE
    path = [np.zeros((1, 2))]
    for step in problem.STEPS:
        path.append(path[-1][-1] + step * share)
    strain = np.column_stack([np.concatenate(path), np.zeros(8 * problem.COARSE + 1)])
    alone = law.respond(strain, "strain")["stress"][-1]
    stress = results.frames[-1].fields[0].values["S"]
    assert np.abs(stress[..., [0, 1, 3]] - alone).max() < 1e-10 * 5.0


def test_an_element_pressed_inside_out_ends_the_run():
    """All nodes are moved to a mirror image: the step cannot pass the share at which it is flat."""
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 1, 1))
    law = ct.Mises(E=1000.0, nu=0.3, yield_stress=5.0, isotropic=50.0)
    model.section("all", element="Q4I", material=law, local_strain="logarithmic")
    model.fix("left")
    model.fix("right", x=-1.2, y=0.0)
    with pytest.raises(ct.ConvergenceError, match="stopped at step time") as caught:
        ct.solve(model, ct.Static(increments=1), threads=1)
    reached = float(str(caught.value).split("step time ")[1].split()[0])
    assert 0.0 < reached < 1.0 / 1.2
