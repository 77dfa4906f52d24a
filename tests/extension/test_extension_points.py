"""What can be added from outside the package, each in one place: its registry."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp

import corota as ct
from corota.analysis.evaluation import Evaluation
from corota.analysis.increment_loop import Accepted, IncrementLoop
from corota.analysis.linear.solvers import SOLVERS
from corota.analysis.terms.term import TERMS, StatePoint, Term
from corota.errors import InputError
from corota.io.deck.cards.material import open_material
from corota.io.deck.drafts import Draft
from corota.io.deck.keywords import KEYWORDS, Keyword
from corota.io.writers import WRITERS
from corota.mesh.data import Cells
from corota.model.schemes import SCHEMES, Scheme
from corota.results.derived import DERIVED, Derived

YOUNG, NU = 1000.0, 0.3
ELASTICITY = (
    YOUNG / (1 - NU**2) * np.array([[1.0, NU, 0.0], [NU, 1.0, 0.0], [0.0, 0.0, 0.5 * (1 - NU)]])
)


def strip(material: Any, element: str = "Q4I", nx: int = 6) -> ct.Model:
    """A clamped strip 6 x 1 under a force at its end."""
    model = ct.Model(ct.mesh.rectangle(6.0, 1.0, nx, 1))
    model.section("all", element=element, material=material)
    model.fix("left", rotation=True if element == "Q4D" else None)
    model.force(model.mesh.nodes_of("right"), y=0.2)
    return model


def elastic(rho: float = 0.0) -> ct.Elastic:
    return ct.Elastic(E=YOUNG, nu=NU, rho=rho)


def own_elastic(strain: Any, state: Any, plane: str) -> Any:
    stress = strain @ ELASTICITY
    return stress, np.broadcast_to(ELASTICITY, (*strain.shape, 3)), state


# -- materials -----------------------------------------------------------------------------


@pytest.mark.filterwarnings("ignore:local strain")
@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q4D"])
@pytest.mark.parametrize(
    "scheme", ["static", "newmark", "hht", "generalized_alpha", "energy_momentum"]
)
def test_python_material_gives_what_the_same_law_of_the_core_gives(
    scheme: str, element: str
) -> None:
    """An elastic law in Python, of whole energy, under every scheme; large rotation."""
    step: Any = ct.Static(increments=4)
    if scheme != "static":
        step = ct.Dynamic(period=0.4, increments=10, scheme=scheme, tolerance=1e-11)
    found = [
        ct.solve(strip(material, element), step, threads=1)
        for material in (elastic(1e-3), ct.UserMaterial(own_elastic, rho=1e-3))
    ]
    core, own = (np.array([f.U for f in r.frames]) for r in found)
    largest = np.abs(core).max()
    assert largest > 0.2
    assert own == pytest.approx(core, abs=1e-7 * largest)
    if scheme == "energy_momentum":
        energy = np.array(found[1].history("ETOTAL"))
        assert np.ptp(energy) < 1e-7 * np.array(found[1].history("ALLSE")).max()


def yielding(strain: Any, state: Any, plane: str) -> Any:
    """Von Mises plasticity with linear hardening in plane strain, by radial return.

    Source: Simo and Hughes, Computational Inelasticity (1998), box 3.1; the history is the
    plastic strain xx, yy, zz, xy (tensor) and the equivalent one.
    """
    shear, bulk = YOUNG / (2 * (1 + NU)), YOUNG / (3 * (1 - 2 * NU))
    full = np.zeros((*strain.shape[:2], 4))
    full[..., [0, 1]], full[..., 3] = strain[..., :2], 0.5 * strain[..., 2]
    one = np.array([1.0, 1.0, 1.0, 0.0])
    weight = np.array([1.0, 1.0, 1.0, 2.0])
    volume = full[..., :3].sum(axis=-1)
    trial = 2 * shear * (full - volume[..., None] / 3 * one - state[..., :4])
    size = np.sqrt((weight * trial**2).sum(axis=-1))
    over = size - np.sqrt(2 / 3) * (20.0 + 50.0 * state[..., 4])
    flows = over > 0.0
    step = np.where(flows, over / (2 * shear + 2 / 3 * 50.0), 0.0)
    normal = trial / np.where(size > 0.0, size, 1.0)[..., None]
    stress = bulk * volume[..., None] * one + trial - 2 * shear * step[..., None] * normal
    theta = 1 - 2 * shear * step / np.where(size > 0.0, size, 1.0)
    bar = np.where(flows, 1 / (1 + 50.0 / (3 * shear)) - (1 - theta), 0.0)
    deviator = np.diag([1.0, 1.0, 1.0, 0.5]) - np.outer(one, one) / 3
    tangent = bulk * np.outer(one, one) + 2 * shear * theta[..., None, None] * deviator
    tangent = (
        tangent - 2 * shear * bar[..., None, None] * normal[..., :, None] * normal[..., None, :]
    )
    keep = [0, 1, 3]
    new = state.copy()
    new[..., :4] += step[..., None] * normal
    new[..., 4] += np.sqrt(2 / 3) * step
    return stress[..., keep], tangent[..., keep, :][..., keep], new, {"stress_zz": stress[..., 2]}


@pytest.mark.filterwarnings("ignore:local strain", "ignore:plastic flow")
@pytest.mark.parametrize("scheme", ["static", "newmark", "hht", "energy_momentum"])
def test_python_plasticity_gives_what_mises_of_the_core_gives(scheme: str) -> None:
    """Radial return in Python beside the core's, where most points yield."""
    step: Any = ct.Static(increments=8)
    if scheme != "static":
        count = 100 if scheme == "energy_momentum" else 20
        step = ct.Dynamic(period=0.4, increments=count, scheme=scheme, tolerance=1e-10)
    found = []
    for material in (
        ct.Mises(E=YOUNG, nu=NU, yield_stress=20.0, isotropic=50.0, rho=1e-3),
        ct.UserMaterial(yielding, members=5, rho=1e-3),
    ):
        model = ct.Model(ct.mesh.rectangle(6.0, 1.0, 6, 1))
        model.section("all", element="Q4", material=material, plane="strain")
        model.fix("left")
        model.force(model.mesh.nodes_of("right"), y=1.5 if scheme == "static" else 0.75)
        found.append(ct.solve(model, step, threads=1))
    core, own = (np.array([f.U for f in r.frames]) for r in found)
    assert max(found[0].history("PEEQ")) > 0.005
    # Energy-momentum: the core's forces are those along the increment, here the mean of both ends.
    near = 1e-2 if scheme == "energy_momentum" else 1e-6
    assert own == pytest.approx(core, abs=near * np.abs(core).max())


# -- terms of the equation -------------------------------------------------------------------


class Bedding(Term):
    """Springs from the nodes of a set to the ground, in both directions."""

    name = "bedding"

    def __init__(self, system: Any, nodes: str, stiffness: float) -> None:
        self.system, self.stiffness = system, stiffness
        found = system.model.mesh.nodes_of(nodes)
        self.dofs = np.concatenate([system.dofs(found, 0), system.dofs(found, 1)])
        self.u, self.last = np.zeros((2, system.n_dofs))

    def add(self, point: StatePoint, at: Evaluation) -> None:
        force = np.zeros(self.system.n_dofs)
        force[self.dofs] = self.stiffness * point.u[self.dofs]
        at.internal = at.internal + force
        at.scale += np.abs(force)
        if len(at.values):
            at.values[self.system.pattern.diagonal[self.dofs]] += point.weights[0] * self.stiffness
        self.last = point.u if point.between is None else point.between[1]

    def commit(self) -> None:
        self.u = self.last.copy()

    def energies(self) -> dict[str, float]:
        return {"ALLSE": 0.5 * self.stiffness * float(self.u[self.dofs] @ self.u[self.dofs])}


def bedded(monkeypatch: pytest.MonkeyPatch, own: bool) -> ct.Model:
    """A free strip 4 x 1 on its bottom's springs: of a term, or as elements."""
    mesh = ct.mesh.rectangle(4.0, 1.0, 4, 1)
    springs = [np.arange(100 * i, 100 * i + 5) for i in (1, 2)]
    if own:
        monkeypatch.setitem(TERMS, "bedding", lambda system: Bedding(system, "bottom", 30.0))
    else:
        monkeypatch.delitem(TERMS, "bedding", raising=False)
        mesh.cells += [Cells("point1", np.arange(5)[:, None], labels) for labels in springs]
    model = ct.Model(mesh)
    model.section(np.arange(4), element="Q4I", material=elastic(1e-3))
    if not own:
        model.spring(np.arange(4, 9), 30.0, "x")
        model.spring(np.arange(9, 14), 30.0, "y")
    return model


@pytest.mark.parametrize("kind", ["static", "newmark", "hht", "energy_momentum", "frequency"])
def test_term_of_the_equation(monkeypatch: pytest.MonkeyPatch, kind: str) -> None:
    """Springs as a term beside springs as elements: displacements, energy, frequencies."""
    found = []
    for own in (True, False):
        model = bedded(monkeypatch, own)
        step: Any = ct.Static(increments=3)
        if kind == "frequency":
            results = ct.solve(model, ct.Frequency(modes=4), threads=1)
            found.append((results.modes[0].factors, np.zeros(1)))
            continue
        if kind == "static":
            model.force([0, 4], y=-8.0)
        else:
            model.velocity("top", x=20.0)
            step = ct.Dynamic(period=0.2, increments=20, scheme=kind, tolerance=1e-12)
        results = ct.solve(model, step, threads=1)
        energy = np.array([results.history("ALLSE"), results.history("ETOTAL")])
        found.append((np.array([f.U for f in results.frames]), energy))
    (one, energy), (two, other) = found
    size = np.abs(two).max()
    assert one == pytest.approx(two, abs=1e-8 * size)
    assert energy == pytest.approx(other, abs=1e-8 * max(np.abs(other).max(), 1e-300))


# -- contact -------------------------------------------------------------------------------


def test_parameter_set_of_a_contact_law() -> None:
    """A softening law as a table: two blocks approach by p / stiffness and by the law."""
    overclosure = np.linspace(0.0, 0.1, 101)
    law = ct.PressureLaw("tabular", 40.0 * np.sqrt(overclosure), overclosure)
    lower, upper = (ct.mesh.rectangle(1.0, 1.0, 2, 2, origin=(0.0, y)) for y in (0.0, 1.0))
    model = ct.Model(ct.mesh.assembly(lower=lower, upper=upper))
    model.section("all", element="Q4", material=ct.Elastic(E=YOUNG, nu=0.0))
    model.fix("lower.bottom")
    model.fix("upper.top", x=0.0, y=-0.05)
    model.contact("upper.bottom", "lower.top", law=law)
    results = ct.solve(model, ct.Static(nlgeom=False, increments=4), threads=1)
    pressure = -results.frames[-1].fields[0].values["S"][..., 1].mean()
    closed = np.interp(pressure, law.pressure, law.overclosure)
    assert 2.0 * pressure / YOUNG + closed == pytest.approx(0.05, rel=1e-6)


# -- time schemes --------------------------------------------------------------------------


def test_time_scheme(monkeypatch: pytest.MonkeyPatch) -> None:
    """Wood, Bossak and Zienkiewicz's scheme (1980): of second order, and dissipative."""

    def wbz(alpha: float, rho: float) -> Scheme:
        a = -0.1
        return Scheme(a, 0.0, 0.25 * (1.0 - a) ** 2, 0.5 - a, "wbz")

    with pytest.raises(InputError, match="no scheme 'wbz'"):
        ct.Dynamic(period=1.0, scheme="wbz")
    monkeypatch.setitem(SCHEMES, "wbz", wbz)

    def tip(n: int) -> float:
        model = strip(elastic(1e-2))
        model.loads.clear()
        time = np.linspace(0.0, 0.4, 401)
        model.amplitudes["push"] = ct.Amplitude(time, np.sin(np.pi * time / 0.4) ** 2)
        model.force(model.mesh.nodes_of("right"), y=0.02, amplitude="push")
        step = ct.Dynamic(period=0.4, increments=n, scheme="wbz", tolerance=1e-11)
        return float(ct.solve(model, step, threads=1).frames[-1].U[-1, 1])

    coarse, middle, fine = (tip(n) for n in (50, 100, 200))
    assert (coarse - middle) / (middle - fine) == pytest.approx(4.0, rel=0.15)


# -- decks ---------------------------------------------------------------------------------

DECK = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*WEIGHT PER VOLUME, G=10.
50.
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
"""


def test_deck_keyword(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A card that gives the density as a weight."""
    path = tmp_path / "block.inp"
    path.write_text(DECK, encoding="ascii")
    with pytest.raises(ct.DeckError, match="unknown keyword"):
        ct.read(path)

    def weight(deck: Any, card: Any) -> None:
        row = next(iter(card.rows()))
        value = row.number(0, "the weight")
        open_material(deck, card).rho = value / card.number("G", 9.81, 0.0)

    monkeypatch.setitem(KEYWORDS, "WEIGHTPERVOLUME", Keyword(weight, "G", place="model"))
    assert ct.read(path).sections[0].material.rho == pytest.approx(5.0)


@pytest.mark.parametrize("stage", ["mesh", "sections", "model"])
def test_deck_keyword_that_changes_the_model(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, stage: Any
) -> None:
    """A card that moves the nodes of a set that stands below it, once all cards are read."""

    def move(targets: Any, drafts: list[Draft]) -> None:
        for draft in drafts:
            nodes = targets.nodes(draft)
            if nodes is not None:
                targets.mesh.points[targets.mesh.node_indices(nodes)] += draft.value

    def shift(deck: Any, card: Any) -> None:
        for row in card.rows():
            by = tuple(row.reals(("x", "y"), start=1))
            deck.later(stage, move, Draft("move", row, row.get(0), by))

    monkeypatch.setitem(KEYWORDS, "NODESHIFT", Keyword(shift, place="model"))
    path = tmp_path / "block.inp"
    cards = "*NODE SHIFT\nTOP, 0.5, 0.25\n2, 1., 0.\n*NSET, NSET=TOP\n3, 4\n"
    path.write_text(DECK.replace("*WEIGHT PER VOLUME, G=10.\n50.\n", "") + cards)
    moved = ct.read(path).mesh.points
    assert moved == pytest.approx(np.array([[0.0, 0.0], [2.0, 0.0], [1.5, 1.25], [0.5, 1.25]]))
    path.write_text(path.read_text().replace("TOP, 0.5", "NONE, 0.5"))
    with pytest.raises(ct.DeckError, match="NONE"):
        ct.read(path)


# -- output --------------------------------------------------------------------------------


def test_output_field(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Pressure as an output variable: in histories, averages at nodes, and result files."""

    def pressure(block: Any) -> Any:
        stress = block.values.get("S")
        return None if stress is None else -stress[..., :3].mean(axis=-1)

    monkeypatch.setitem(DERIVED, "PRESS", Derived(pressure, "mean pressure [stress]"))
    results = ct.solve(strip(elastic()), ct.Static(), threads=1)
    block = results.frames[-1].fields[0]
    assert block.values["PRESS"] == pytest.approx(-block.values["S"][..., :3].mean(axis=-1))
    assert results.history("PRESS")[-1] != 0.0
    results.write(tmp_path / "strip.vtkhdf", points=True)
    again = ct.read_results(tmp_path / "strip.vtkhdf")
    assert again.frames[-1].fields[0].values["PRESS"] == pytest.approx(block.values["PRESS"])
    monkeypatch.setitem(DERIVED, "WRONG", Derived(lambda block: np.zeros(3)))
    with pytest.raises(InputError, match="'WRONG' has shape"):
        ct.solve(strip(elastic()), ct.Static(), threads=1)


def test_result_writer(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A text file of the last displacements."""

    def write(results: ct.Results, path: Path) -> None:
        np.savetxt(path, results.frames[-1].U)

    results = ct.solve(strip(elastic()), ct.Static(), threads=1)
    with pytest.raises(InputError, match="unknown result format"):
        results.write(tmp_path / "strip.txt")
    monkeypatch.setitem(WRITERS, ".txt", write)
    results.write(tmp_path / "strip.txt")
    assert np.loadtxt(tmp_path / "strip.txt") == pytest.approx(results.frames[-1].U)


# -- procedures ----------------------------------------------------------------------------


class Euler:
    """Increments of one solution each: the tangent at their start, no iterations."""

    kind, advice = "", ""

    def __init__(self, loop: IncrementLoop, step: Any) -> None:
        self.system, self.state, self.n = loop.system, loop.state, step.increments
        self.taken = 0

    @property
    def finished(self) -> bool:
        return self.taken == self.n

    @property
    def where(self) -> str:
        return f"increment {self.taken} of {self.n}"

    def memory(self) -> dict[str, object]:
        return {}

    def advance(self) -> Accepted:
        system, state = self.system, self.state
        self.taken += 1
        state.step_time = self.taken / self.n
        moved = np.where(
            system.constrained, system.conditions.supports.at(state.step_time, state.u) - state.u, 0
        )
        correction, _ = system.predict(system.evaluate(state.u, state.step_time), moved)
        state.u = state.u + correction
        state.at = system.evaluate(state.u, state.step_time)
        system.commit()
        return Accepted(self.taken, state.step_time, {})


class Explicit(ct.Static):
    """Statics without iterations."""

    procedure = "forward Euler"

    @staticmethod
    def run(loop: IncrementLoop, step: Any, stops: list[float]) -> None:
        loop.run(Euler(loop, step))


def test_procedure() -> None:
    """What an increment leaves is corrected in the next, so that the error is of second order."""
    wanted = ct.solve(strip(elastic()), ct.Static(increments=4), threads=1).frames[-1].U
    errors = []
    for n in (10, 20, 40):
        results = ct.solve(strip(elastic()), Explicit(increments=n), threads=1)
        assert len(results.frames) == n + 1
        errors.append(np.abs(results.frames[-1].U - wanted).max() / np.abs(wanted).max())
    assert errors[0] < 0.01
    assert errors[0] > 4.0 * errors[1] > 16.0 * errors[2]


# -- linear solvers ------------------------------------------------------------------------


class Dense:
    """Gauss elimination of the full matrix."""

    def __init__(self, symmetric: bool = True) -> None:
        self.symmetric = symmetric

    def analyze(self, indptr: Any, indices: Any, node_of_dof: Any, after: Any = None) -> None:
        self.pattern = (indices.astype(np.int64), indptr.astype(np.int64))

    def factorize(self, data: Any) -> None:
        matrix = sp.csc_array((data, *self.pattern)).toarray()
        self.matrix = matrix + np.triu(matrix, 1).T if self.symmetric else matrix

    def solve(self, rhs: Any) -> Any:
        return np.linalg.solve(self.matrix, rhs)


def test_linear_solver(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InputError, match="no linear solver 'dense'"):
        ct.solve(strip(elastic()), solver="dense")
    monkeypatch.setitem(SOLVERS, "dense", Dense)
    own, usual = (ct.solve(strip(elastic()), solver=s) for s in ("dense", "multifrontal"))
    assert pytest.approx(usual.frames[-1].U, rel=1e-9, abs=1e-12) == own.frames[-1].U
