"""What a step keeps, changes and takes away of the loads before it.

One square element, held at the bottom: the reactions are the loads with the other sign, so the
expected values are sums of what acts. The rules are those of CalculiX 2.20 (``cloads.f``,
``dloads.f``, ``boundarys.f``, ``temperatures.f``, ``tempload.f``) and of Abaqus's manual;
test_family.py compares with CalculiX itself.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from corota.errors import DeckError
from corota.io.formats import write

if TYPE_CHECKING:
    from pathlib import Path

HEAD = """*NODE, NSET=NALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=EALL
1, 1, 2, 3, 4
*ELSET, ELSET=OTHER
1
*NSET, NSET=TOP
3, 4
*SURFACE, NAME=LID
EALL, S3
*SURFACE, NAME=AGAIN
OTHER, S3
*AMPLITUDE, NAME=TOTAL, TIME=TOTAL TIME
0., 0., 4., 4.
*AMPLITUDE, NAME=LOCAL
0., 0., 1., .5
*MATERIAL, NAME=M
*ELASTIC
1e6, 0.
*DENSITY
1.
*EXPANSION
1e-5
*SOLID SECTION, ELSET=EALL, MATERIAL=M
1.
*INITIAL CONDITIONS, TYPE=TEMPERATURE
NALL, 0.
*BOUNDARY
1, 1, 2
2, 1, 2
"""
STEP = "*STEP\n*STATIC\n.5, 1.\n{}\n*END STEP\n"


def run(tmp_path: Path, *steps: str, form: str = STEP) -> ct.Results:
    path = tmp_path / "deck.inp"
    path.write_text(HEAD + "".join(form.format(step) for step in steps))
    return ct.solve(ct.read(path), threads=1)


def carried(results: ct.Results) -> np.ndarray:
    """Force on the structure at the end of every step, shape (n_steps, 2)."""
    last = {frame.step: frame for frame in results.frames}
    return np.array([-last[k].RF[:2, :2].sum(axis=0) for k in sorted(last)])


#: A load of each kind with the force that it makes.
LOADS = {
    "force": ("*CLOAD{op}\n3, 1, {v}", (1.0, 0.0)),
    "pressure": ("*DLOAD{op}\nEALL, P3, {v}", (0.0, -1.0)),
    "surface": ("*DSLOAD{op}\nLID, P, {v}", (0.0, -1.0)),
    "traction": ("*DSLOAD, FOLLOWER=NO{op}\nLID, TRVEC, {v}, 1., 0.", (1.0, 0.0)),
    "gravity": ("*DLOAD{op}\nEALL, GRAV, {v}, 0., -1.", (0.0, -1.0)),
    "spin": ("*DLOAD{op}\nEALL, CENTRIF, {v}, 0., .5, 0., 0., 0., 1.", (0.5, 0.0)),
}


def card(kind: str, value: float, op: str = "") -> str:
    return LOADS[kind][0].format(v=value, op=op)


@pytest.mark.parametrize("renewed", LOADS)
@pytest.mark.parametrize("other", LOADS)
def test_op_new_takes_away_loads_of_its_own_card_only(
    tmp_path: Path, renewed: str, other: str
) -> None:
    """*DLOAD and *DSLOAD are one kind; *CLOAD is another."""
    both = card(other, 3.0) + "\n" + card(renewed, 2.0)
    found = carried(run(tmp_path, both, card(renewed, 1.0, ", OP=NEW")))
    first, second = (np.array(LOADS[name][1]) for name in (renewed, other))
    same_kind = "force" not in (renewed, other) or renewed == other
    wanted = first + (0.0 if same_kind else 3.0) * second
    assert found[1] == pytest.approx(wanted, abs=1e-9)


def test_op_new_on_temperatures_and_supports_keeps_loads(tmp_path: Path) -> None:
    steps = (
        "*CLOAD\n3, 1, 2.\n*TEMPERATURE\nNALL, 50.",
        "*TEMPERATURE, OP=NEW\n1, 0.",
        "*BOUNDARY, OP=NEW\n1, 1, 2\n2, 1, 2",
        "*CLOAD, OP=NEW",
    )
    results = run(tmp_path, *steps)
    assert carried(results)[:, 0] == pytest.approx([2.0, 2.0, 2.0, 0.0], abs=1e-9)
    last = {frame.step: frame for frame in results.frames}
    heated = [last[k].U[2:, 1].mean() for k in (1, 2)]
    assert heated == pytest.approx([50e-5, 0.0], abs=1e-9)


def test_op_new_after_another_card_of_its_kind_is_refused(tmp_path: Path) -> None:
    """CalculiX ignores it there; Abaqus wants it on all cards or none."""
    with pytest.raises(DeckError, match="OP=NEW comes after"):
        run(tmp_path, "*CLOAD\n3, 1, 1.\n*CLOAD, OP=NEW\n4, 1, 1.")
    with pytest.raises(DeckError, match="OP=NEW comes after"):
        run(tmp_path, "*DLOAD\nEALL, P3, 1.\n*DSLOAD, OP=NEW\nLID, P, 1.")


@pytest.mark.parametrize("kind", LOADS)
def test_amplitudes_of_total_time_run_on_and_those_of_step_time_end(
    tmp_path: Path, kind: str
) -> None:
    """A factor of .5 is reached and stays; total time goes 1, 2, 3, 0 (OP=NEW)."""
    for amplitude, wanted in (("LOCAL", (1.0, 1.0, 1.0)), ("TOTAL", (2.0, 4.0, 6.0))):
        first = card(kind, 2.0, f", AMPLITUDE={amplitude}")
        last = "*CLOAD" if kind == "force" else "*DLOAD"
        found = carried(run(tmp_path, first, "", "", last + ", OP=NEW"))
        size = np.abs(found).sum(axis=1) / np.abs(LOADS[kind][1]).sum()
        assert size == pytest.approx([*wanted, 0.0], abs=1e-9)


def test_total_time_runs_on_for_supports_and_temperatures(tmp_path: Path) -> None:
    steps = (
        "*BOUNDARY, AMPLITUDE=TOTAL\n3, 1, 1, 1e-3\n*TEMPERATURE, AMPLITUDE=TOTAL\nNALL, 10.",
        "*CLOAD\n4, 1, 1.",
        "*BOUNDARY\n3, 1, 1, 5e-4",
    )
    last = {frame.step: frame for frame in run(tmp_path, *steps).frames}
    assert [last[k].U[2, 0] for k in (1, 2, 3)] == pytest.approx([1e-3, 2e-3, 5e-4])
    height = [last[k].U[2:, 1].mean() for k in (1, 2, 3)]
    assert height == pytest.approx([1e-4, 2e-4, 3e-4], rel=1e-6)


#: Cards that press on the same edge.
SAME_EDGE = (
    "*DLOAD\n1, P3, {}",
    "*DLOAD\nOTHER, P3, {}",
    "*DSLOAD\nLID, P, {}",
    "*DSLOAD\nAGAIN, P, {}",
)


@pytest.mark.parametrize("first", SAME_EDGE)
@pytest.mark.parametrize("second", SAME_EDGE)
def test_pressure_is_known_by_its_edge(tmp_path: Path, first: str, second: str) -> None:
    """Of one step pressures add up; a later one replaces, whatever set names the edge."""
    together = run(tmp_path, first.format(2.0) + "\n" + second.format(5.0))
    assert carried(together)[0, 1] == pytest.approx(-7.0)
    later = run(tmp_path, first.format(2.0), second.format(5.0))
    assert carried(later)[1, 1] == pytest.approx(-5.0)
    # Half-way it is half-way between the two.
    middle = next(f for f in later.frames if f.step == 2)
    assert -middle.RF[:2, 1].sum() == pytest.approx(-3.5)


def test_gravity_is_known_by_set_and_direction(tmp_path: Path) -> None:
    """A second direction is a second load; the same one again replaces, also by zero."""
    grav = "*DLOAD\nEALL, GRAV, {}, {}, {}"
    found = carried(
        run(
            tmp_path,
            grav.format(2.0, 0.0, -1.0),
            grav.format(3.0, 1.0, 0.0),
            grav.format(5.0, 0.0, -2.0),
            grav.format(1.0, 0.0, 1.0),
            grav.format(0.0, 1.0, 0.0),
            "*DLOAD\nOTHER, GRAV, 1., 0., -1.",
        )
    )
    wanted = [(0, -2), (3, -2), (3, -5), (3, -4), (0, -4), (0, -5)]
    assert found == pytest.approx(np.array(wanted, float), abs=1e-9)


def test_nlgeom_stays_on_in_python_and_says_so() -> None:
    """A bar turned by 90 degrees stays turned; the linear theory would shear it."""
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=20, ny=2))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3))
    model.fix("left")
    model.force("right", y=-2.0, per_node=True)
    with pytest.warns(UserWarning, match="keeps the large rotations"):
        results = ct.solve(model, [ct.Static(increments=4), ct.Static(nlgeom=False)], threads=1)
    last = {frame.step: frame for frame in results.frames}
    assert pytest.approx(last[1].U, abs=1e-7) == last[2].U
    assert any("keeps the large rotations" in note for note in results.notes)


@pytest.mark.parametrize(
    "procedure", ["*DYNAMIC, DIRECT, ALPHA=0.\n.005, .01", "*MODAL DYNAMIC\n.005, .01"]
)
@pytest.mark.parametrize(("how", "share"), [("", 1.0), (", AMPLITUDE=RAMP", 0.5)])
def test_ramps_of_a_step_act_in_motion(
    tmp_path: Path, procedure: str, how: str, share: float
) -> None:
    """The force half-way through the step is half of it with AMPLITUDE=RAMP."""
    modes = "*STEP\n*FREQUENCY\n4\n*END STEP\n" if "MODAL" in procedure else ""
    step = f"*STEP{how}\n{procedure}\n*CLOAD\n3, 1, 8.\n*END STEP\n"
    frames = run(tmp_path, modes + step, form="{}").frames
    assert [f.F[2, 0] for f in frames[-2:]] == pytest.approx([8.0 * share, 8.0])


def test_perturbation_keeps_the_preload(tmp_path: Path) -> None:
    """A strip under tension as a string and a beam: the frequencies grow, by PERTURBATION only.

    Expected: Euler-Bernoulli's cantilever under a tension N, lowest mode by Rayleigh's quotient
    of a fine finite-difference model (1 % of discretization and shear).
    """
    mesh = ct.mesh.rectangle(10.0, 0.1, 40, 1, "quad8")
    model = ct.Model(mesh)
    model.section("all", element="Q8R", material=ct.Elastic(1e6, 0.0, rho=1.0), thickness=0.1)
    model.fix("left")
    path = write(model, tmp_path / "strip.inp")
    right = ", ".join(str(n) for n in mesh.node_labels[mesh.nodes_of("right")])
    load = f"*NSET, NSET=TIP\n{right}\n*STEP\n*STATIC\n*CLOAD\nTIP, 1, 1.\n*END STEP\n"
    text = path.read_text() + load
    found = []
    for how in ("", ", PERTURBATION"):
        path.write_text(text + f"*STEP{how}\n*FREQUENCY\n1\n*END STEP\n")
        found.append(ct.solve(ct.read(path), threads=1).modes[-1].factors[0])
    assert found == pytest.approx([lowest(0.0), lowest(3.0)], rel=1e-2)


def lowest(tension: float) -> float:
    """Lowest frequency of the cantilever 10 x .1 x .1, E = 1e6, rho = 1, by differences."""
    n, length, section, inertia = 400, 10.0, 0.01, 0.1**4 / 12
    h = length / n
    bend = np.diag(np.full(n + 1, -2.0)) + np.diag(np.ones(n), 1) + np.diag(np.ones(n), -1)
    bend = bend[:-1] / h**2  # curvature at nodes 0 to n-1, of which w(-1) = w(1)
    bend[0, 1] = 2.0 / h**2
    weight = np.full(n, h)
    weight[0] = 0.5 * h
    slope = (np.eye(n, n + 1, 1) - np.eye(n, n + 1)) / h
    k = 1e6 * inertia * bend.T @ (weight[:, None] * bend) + tension * h * slope.T @ slope
    mass = np.full(n + 1, section * h)
    mass[-1] *= 0.5
    k, mass = k[1:, 1:], mass[1:]
    root = 1.0 / np.sqrt(mass)
    return float(np.sqrt(np.linalg.eigvalsh(root[:, None] * k * root)[0]) / (2.0 * np.pi))
