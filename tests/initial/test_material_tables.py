"""Constants that follow the temperature: closed forms, equal models, the state that stays."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from support.models import ELEMENTS, cell
from support.pairs import cover

COLD, HOT = 20.0, 420.0
E0, E1, NU, ALPHA = 1000.0, 600.0, 0.3, 1e-3


def elastic(**keys: Any) -> ct.MaterialTable:
    return ct.MaterialTable([(COLD, ct.Elastic(E0, NU)), (HOT, ct.Elastic(E1, NU))], **keys)


def mises(**keys: Any) -> ct.MaterialTable:
    cold = ct.Mises(E0, NU, yield_curve=[(5.0, 0.0), (7.0, 0.1)])
    hot = ct.Mises(E1, NU, yield_curve=[(2.0, 0.0), (2.5, 0.05), (2.6, 0.2)])
    return ct.MaterialTable([(COLD, cold), (HOT, hot)], **keys)


def orthotropic(**keys: Any) -> ct.MaterialTable:
    cold = ct.Orthotropic(1000.0, 300.0, 200.0, 0.25, 0.2, 0.3, 150.0)
    hot = ct.Orthotropic(700.0, 150.0, 120.0, 0.2, 0.2, 0.25, 60.0)
    return ct.MaterialTable([(COLD, cold), (HOT, hot)], **keys)


def ramberg_osgood(**keys: Any) -> ct.MaterialTable:
    cold = ct.RambergOsgood(E0, NU, 5.0, 4.0, 0.5)
    hot = ct.RambergOsgood(E1, NU, 2.0, 6.0, 0.4)
    return ct.MaterialTable([(COLD, cold), (HOT, hot)], **keys)


def kinematic(**keys: Any) -> ct.MaterialTable:
    cold = ct.Mises(E0, NU, yield_stress=5.0, isotropic=ct.Voce(2.0, 20.0), chaboche=[(50.0, 3.0)])
    hot = ct.Mises(E1, NU, yield_stress=2.0, isotropic=4.0, kinematic=20.0)
    return ct.MaterialTable([(COLD, cold), (HOT, hot)], **keys)


LAWS = [elastic, mises, orthotropic, ramberg_osgood, kinematic]


def sheet(element: str, material: Any, plane: str = "stress", n: int = 3, **keys: Any) -> ct.Model:
    mesh = ct.mesh.rectangle(3.0, 2.0, nx=n, ny=2, cell=cell(element))
    model = ct.Model(mesh)
    model.section(element=element, material=material, plane=plane, **keys)  # type: ignore[arg-type]
    return model


def pulled(element: str, material: Any, plane: str, temperature: float) -> ct.Frame:
    """Load, then more of it at one temperature in the whole run."""
    model = sheet(element, material, plane)
    model.fix("left", rotation=0.0)
    model.initial_temperature(temperature)
    steps = [ct.Static(fixed_increments=True, first_increment=0.25, nlgeom=False) for _ in range(2)]
    for step, load in zip(steps, (0.006, 0.002), strict=True):
        step.fix("right", x=load, y=0.3 * load)
        model.steps.append(step)
    return ct.solve(model, threads=1).frames[-1]


@pytest.mark.parametrize(
    ("element", "plane", "law"),
    cover(
        ELEMENTS,
        ["stress", "strain"],
        LAWS,
        # Its hourglass would stay elastic.
        allowed=lambda element, _, law: (element, law) != ("Q4R", ramberg_osgood),
    ),
)
def test_at_one_temperature_it_is_the_material_there(element: str, plane: str, law: Any) -> None:
    for temperature in (-100.0, 150.0, 500.0):
        table = law()
        got = pulled(element, table, plane, temperature)
        want = pulled(element, table.at(temperature), plane, temperature)
        size = np.abs(want.U).max()
        assert pytest.approx(want.U, abs=1e-10 * size) == got.U
        for a, b in zip(got.fields, want.fields, strict=True):
            for name, values in b.values.items():
                scale = max(float(np.abs(values).max()), 1e-6)
                assert a.values[name] == pytest.approx(values, abs=1e-8 * scale), name


def clamped(element: str, n: int, table: ct.MaterialTable, heat: Any) -> ct.Model:
    """A bar between two walls, free to move across."""
    mesh = ct.mesh.rectangle(4.0, 0.5, nx=n, ny=1, cell=cell(element))
    model = ct.Model(mesh)
    model.section(element=element, material=table)
    model.fix("left", y=None)
    model.fix("right", y=None)
    for side in ("left", "right"):
        if element in ("Q4D", "Q4DI", "OPT"):
            model.fix(side, x=None, y=None, rotation=0.0)
    model.fix([0], x=None)
    model.initial_temperature(COLD)
    model.temperature(heat(mesh.points[:, 0]))
    return model


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_heated_bar_between_walls(element: str) -> None:
    """Uniform: - E(T) alpha (T - T0). Linear along the bar: - alpha dT_m / (mean of 1 / E(T))."""
    table = ct.MaterialTable(
        [(COLD, ct.Elastic(E0)), (HOT, ct.Elastic(E1))], expansion=ALPHA / 100.0
    )
    step = ct.Static(nlgeom=False)
    frame = ct.solve(clamped(element, 8, table, lambda x: 0 * x + 220.0), step, threads=1).frames[
        -1
    ]
    stress = np.concatenate([f.values["S"][..., 0].ravel() for f in frame.fields])
    assert stress == pytest.approx(-800.0 * 200.0 * ALPHA / 100.0, rel=1e-9)
    model = clamped(element, 16, table, lambda x: 20.0 + 100.0 * x)
    frame = ct.solve(model, step, threads=1).frames[-1]
    force = frame.RF[model.mesh.points[:, 0] > 3.999, 0].sum()
    softness = np.log(E0 / E1) / (E0 - E1)
    assert force == pytest.approx(-ALPHA / 100.0 * 200.0 / softness * 0.5, rel=1e-3)


@pytest.mark.parametrize("kind", ["truss", "beam"])
def test_trusses_and_beams_have_the_modulus_at_their_temperature(kind: str) -> None:
    """F l / E A and F l^3 / 3 E I, with E at the middle of each element."""
    points = np.stack([np.linspace(0.0, 4.0, 5), np.zeros(5)], axis=1)
    ends = np.stack([np.arange(4), np.arange(1, 5)], axis=1)
    mesh = ct.Mesh(points, [ct.Cells("line2", ends, np.arange(1, 5))])
    model = ct.Model(mesh)
    if kind == "truss":
        model.truss(np.arange(4), material=elastic(), area=2.0)
        model.fix(np.arange(5), x=None)
        model.force([4], x=1.0)
    else:
        model.beam(np.arange(4), material=elastic(), area=2.0, inertia=0.5)
        model.force([4], y=1e-3)
    model.fix([0], rotation=0.0)
    model.initial_temperature(COLD)
    model.temperature(COLD + 100.0 * points[:, 0])
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    modulus = E0 - (E0 - E1) / 4.0 * (np.arange(4) + 0.5)
    if kind == "truss":
        assert frame.U[-1, 0] == pytest.approx(np.sum(1.0 / (modulus * 2.0)), rel=1e-9)
        return
    x = np.arange(4.0)
    # The curvature of a tip load over each element, (4 - x) F / E I, twice integrated.
    part = ((4.0 - x) ** 3 - (3.0 - x) ** 3) / 3.0
    assert frame.U[-1, 1] == pytest.approx(1e-3 * np.sum(part / (modulus * 0.5)), rel=1e-9)


def test_flow_follows_the_yield_stress_and_plastic_strain_stays() -> None:
    """A bar that is pulled, heated and cooled at one strain, against the same in one dimension."""
    table = mises()
    model = sheet("Q8R", table, n=1)
    model.fix("left", y=None)
    model.fix([0], x=None)
    model.initial_temperature(COLD)
    strains, temperatures = (0.008, 0.008, 0.008, 0.0), (COLD, 300.0, COLD, COLD)
    for strain, temperature in zip(strains, temperatures, strict=True):
        step = ct.Static(fixed_increments=True, first_increment=0.1, nlgeom=False)
        step.fix("right", x=3.0 * strain, y=None)
        step.temperature(temperature)
        model.steps.append(step)
    frames = ct.solve(model, threads=1).frames
    e = p = ep = 0.0
    k = 0
    at = COLD
    for strain, temperature in zip(strains, temperatures, strict=True):
        begin, start = e, at
        for share in np.linspace(0.1, 1.0, 10):
            e, at = begin + share * (strain - begin), start + share * (temperature - start)
            law = table.at(at)
            stress = law.E * (e - ep)
            curve = np.array(law.yield_curve)
            low, high = 0.0, 1.0
            if abs(stress) > np.interp(p, curve[:, 1], curve[:, 0]):
                for _ in range(60):
                    dp = 0.5 * (low + high)
                    over = abs(stress) - law.E * dp - np.interp(p + dp, curve[:, 1], curve[:, 0])
                    low, high = (dp, high) if over > 0.0 else (low, dp)
                ep, p = ep + np.sign(stress) * low, p + low
                stress = law.E * (e - ep)
            k += 1
            values = frames[k].fields[0].values
            assert values["S"][..., 0] == pytest.approx(stress, rel=1e-8, abs=1e-8)
            assert values["PEEQ"] == pytest.approx(p, rel=1e-8, abs=1e-12)
    assert p > 0.003


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.__name__)
@pytest.mark.parametrize("plane", ["stress", "strain"])
def test_energy_balances_while_constants_change(law: Any, plane: str) -> None:
    """What heat puts in makes up for the stiffness that it takes, up to the increments."""
    errors = []
    for n in (20, 40):
        model = sheet("Q8R", law(expansion=1e-6), plane)
        model.fix("left")
        model.initial_temperature(COLD)
        first = ct.Static(nlgeom=False, fixed_increments=True, first_increment=1.0 / n)
        first.fix("right", x=0.004)
        second = ct.Static(nlgeom=False, fixed_increments=True, first_increment=1.0 / n)
        second.temperature(COLD + 130.0 * model.mesh.points[:, 0])
        model.steps += [first, second]
        errors.append(abs(ct.solve(model, threads=1).frames[-1].scalars["energy balance error"]))
    assert errors[1] < max(2e-3, 0.6 * errors[0])
    assert errors[1] < 2e-2


@pytest.mark.parametrize("strain", ["logarithmic", "green_lagrange"])
def test_energy_balances_under_large_strain_in_plane_strain(strain: Any) -> None:
    """The stress through the thickness does its work as the stress of the law, not as Cauchy's."""
    errors = []
    for increments in (20, 80):
        model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1))
        material = elastic(expansion=ALPHA)
        options: Any = {"plane": "strain", "local_strain": strain}
        model.section("all", element="Q4", material=material, **options)
        model.fix("left", y=None)
        model.fix("bottom", x=None)
        model.initial_temperature(COLD)
        pulled, cooled = (ct.Static(increments=increments) for _ in range(2))
        pulled.fix("right", x=0.2, y=None)
        pulled.temperature(COLD + 200.0)
        cooled.fix("right", x=0.1, y=None)
        cooled.temperature(COLD)
        frame = ct.solve(model, [pulled, cooled], threads=1).frames[-1]
        errors.append(abs(frame.scalars["energy balance error"]))
    assert errors[1] < 1e-4
    assert errors[1] < 0.2 * errors[0]


def test_modes_have_the_modulus_of_the_current_temperature() -> None:
    def first(material: Any, heated: bool) -> float:
        model = sheet("Q8", material)
        model.fix("left")
        model.initial_temperature(COLD)
        if heated:
            step = ct.Static(nlgeom=False)
            step.temperature(220.0)
            model.steps.append(step)
        model.steps.append(ct.Frequency(modes=1))
        return float(ct.solve(model, threads=1).modes[-1].factors[0])

    table = elastic(rho=2.0)
    want = first(ct.Elastic(E0, NU, rho=2.0), False) * np.sqrt(0.8)
    assert first(table, True) == pytest.approx(want, rel=1e-8)


def test_the_mass_is_that_at_the_initial_temperature() -> None:
    table = ct.MaterialTable(
        [(COLD, ct.Elastic(E0, NU, rho=2.0)), (HOT, ct.Elastic(E0, NU, rho=1.0))]
    )
    assert not table.varies
    model = sheet("Q4", table)
    model.fix("left")
    x = model.mesh.points[:, 0]
    model.initial_temperature(COLD + 100.0 * x)
    model.gravity(0.0, -1.0)
    step = ct.Static(nlgeom=False)
    step.temperature(COLD)
    with pytest.raises(ct.ModelError, match="temperatures without effect"):
        ct.solve(model, step, threads=1)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    # The density is 2 - x / 4 over 3 x 2.
    assert frame.RF[:, 1].sum() == pytest.approx(2.0 * (2.0 * 3.0 - 9.0 / 8.0), rel=1e-12)


@pytest.mark.parametrize("law", [mises, elastic], ids=["mises", "elastic"])
def test_a_resumed_run_goes_on_to_the_bit(law: Any, tmp_path: Path) -> None:
    def build() -> ct.Model:
        model = sheet("Q4I", law(expansion=1e-6), "strain")
        model.fix("left")
        model.initial_temperature(COLD)
        for strain, heat in ((0.006, 120.0), (0.002, 10.0)):
            step = ct.Static(nlgeom=True, fixed_increments=True, first_increment=0.25)
            step.fix("right", x=3.0 * strain)
            step.temperature(COLD + heat * model.mesh.points[:, 0])
            model.steps.append(step)
        return model

    whole = ct.solve(build(), threads=1).frames[-1]
    ct.solve(build(), observers=[ct.JobFiles(tmp_path, checkpoint_every=3)], threads=1)
    found = sorted(tmp_path.glob("*.ckpt*"))
    assert len(found) == 2
    for file in found:
        assert np.array_equal(ct.resume(file, threads=1).frames[-1].U, whole.U)


@pytest.mark.parametrize("scheme", ["hht", "energy_momentum"])
def test_a_hot_body_moves_like_one_of_the_hot_material(scheme: str) -> None:
    def end(material: Any) -> np.ndarray:
        model = sheet("Q4D", material)
        model.fix("left", rotation=0.0)
        model.initial_temperature(COLD)
        heat = ct.Static(nlgeom=True)
        heat.temperature(320.0)
        swing = ct.Dynamic(period=0.5, first_increment=0.05, fixed_increments=True, scheme=scheme)
        swing.traction("right", y=3.0)
        model.steps += [heat, swing]
        return ct.solve(model, threads=1).frames[-1].U

    table = elastic(rho=1.0, expansion=1e-6)
    hot = table.at(320.0)
    assert pytest.approx(end(hot), abs=1e-9) == end(table)


def test_tables_that_do_not_fit_are_refused() -> None:
    one, other = ct.Elastic(E0, NU), ct.Mises(E0, NU, yield_stress=1.0)
    curve = ct.Mises(E0, NU, yield_curve=[(1.0, 0.0)])
    back = ct.Mises(E0, NU, yield_stress=1.0, kinematic=3.0)
    cases = [
        ([], "at least one"),
        ([(0.0, one), (0.0, one)], "twice"),
        ([(0.0, one), (1.0, other)], "one class"),
        ([(0.0, other), (1.0, curve)], "yield curve"),
        ([(0.0, other), (1.0, back)], "back-stresses"),
        ([(0.0, one), (1.0, ct.Elastic(E0, NU, rho=1.0))], "density"),
        (one, "pairs"),
    ]
    for table, words in cases:
        with pytest.raises(ct.InputError, match=words):
            ct.MaterialTable(table)  # type: ignore[arg-type]


def test_a_path_takes_no_temperatures_that_change_the_material() -> None:
    model = sheet("Q4", elastic(expansion=1e-6))
    model.fix("left")
    step = ct.Static(path=ct.ArcLength())
    step.temperature(300.0)
    with pytest.raises(ct.ModelError, match="heat in an earlier static step"):
        ct.solve(model, step, threads=1)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.__name__)
def test_tables_are_written_to_decks_and_read_again(law: Any, tmp_path: Path) -> None:
    if law is kinematic:
        table: Any = ct.MaterialTable(
            [
                (
                    t,
                    ct.Mises(
                        e, NU, yield_stress=s, isotropic=ct.Voce(2.0, 9.0), chaboche=[(c, 3.0)]
                    ),
                )
                for t, e, s, c in ((COLD, E0, 5.0, 50.0), (HOT, E1, 2.0, 20.0))
            ]
        )
    else:
        table = law(rho=2.0, expansion=ct.Expansion((1e-5, 2e-5), (0.0, 300.0), 20.0))
    model = sheet("Q8R", table)
    model.fix("left")
    model.initial_temperature(COLD)
    step = ct.Static()
    step.temperature(100.0 + 50.0 * model.mesh.points[:, 0])
    step.fix("right", x=0.01)
    model.steps.append(step)
    again = ct.read(ct.write(model, tmp_path / "a.inp") or tmp_path / "a.inp")
    got = again.sections[0].material
    assert isinstance(got, ct.MaterialTable)
    assert got.rows_of_parameters() == table.rows_of_parameters()
    assert got.rho == table.rho
    assert got.expansion == table.expansion
    other = ct.solve(again, threads=1).frames[-1].U
    assert pytest.approx(ct.solve(model, threads=1).frames[-1].U, abs=1e-13) == other
