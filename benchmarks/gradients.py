"""Gradients of random models against extrapolated differences of whole analyses.

``python -m benchmarks.gradients [--count N] [--first SEED]`` draws models from all elements,
strains, planes, laws, loads, constraints and paths, and compares the gradient of each measure by
each parameter with a difference of sixth order, with the step that agrees best with half of it.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import warnings
from collections import Counter
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

import corota as ct
from corota import gradients
from corota.gradients.runs import Run

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

CELLS = {
    "T3": "tri3", "T6": "tri6", "Q4": "quad4", "Q4I": "quad4", "Q4S": "quad4", "Q4R": "quad4",
    "Q8": "quad8", "Q8R": "quad8", "Q9": "quad9", "OPT": "tri3", "Q4D": "quad4", "Q4DI": "quad4",
}  # fmt: skip
#: Laws by name: their constants, of a modulus of about 1000, and whether they flow.
LAWS: dict[str, tuple[Callable[[float], Any], str]] = {
    "elastic": (lambda k: ct.Elastic(E=1000.0 * k, nu=0.3, expansion=1e-4, rho=0.1), "any"),
    "orthotropic": (
        lambda k: ct.Orthotropic(1000.0 * k, 500.0, 700.0, 0.25, 0.2, 0.3, 250.0, rho=0.1),
        "any",
    ),
    "ramberg_osgood": (lambda k: ct.RambergOsgood(1000.0, 0.3, 20.0 * k, 5.0, 0.4), "any"),
    "neo_hooke": (lambda k: ct.NeoHooke(C10=170.0 * k, D1=0.004, rho=0.1), "rubber"),
    "mooney_rivlin": (lambda k: ct.MooneyRivlin(C10=100.0, C01=70.0 * k, D1=0.004), "rubber"),
    "yeoh": (lambda k: ct.Yeoh(C10=170.0, C20=20.0 * k, C30=5.0, D1=0.004), "rubber"),
    "ogden": (
        lambda k: ct.Ogden(mu=[300.0, 40.0], alpha=[2.0, -2.0 * k], D=[0.004, 0.0]),
        "rubber",
    ),
    "arruda_boyce": (lambda k: ct.ArrudaBoyce(mu=300.0, limit=3.0 * k, D=0.004), "rubber"),
    "mises": (lambda k: ct.Mises(1000.0, 0.3, yield_stress=8.0 * k, isotropic=60.0), "flows"),
    "voce": (
        lambda k: ct.Mises(1000.0, 0.3, yield_stress=8.0, isotropic=ct.Voce(6.0 * k, 20.0)),
        "flows",
    ),
    "kinematic": (
        lambda k: ct.Mises(1000.0, 0.3, yield_stress=8.0, isotropic=20.0, kinematic=60.0 * k),
        "flows",
    ),
    "chaboche": (
        lambda k: ct.Mises(1000.0, 0.3, yield_stress=8.0, chaboche=[(400.0 * k, 40.0)]),
        "flows",
    ),
}  # fmt: skip
LOADS = ("force", "pressure", "traction", "gravity", "centrifugal", "support", "temperature",
         "follower")  # fmt: skip
CONSTRAINTS = ("none", "none", "rigid", "equation", "axes", "straight")
PATHS = ("one increment", "increments", "linear", "displacement control", "two steps")
#: Names of the parameters of all models.
NAMES = ("bend", "height", "thickness", "constant", "load", "position")


@dataclass
class Case:
    """A random model as a function of its parameters, with measures.

    Parameters
    ----------
    seed : int
        Of the imperfections of the mesh.
    choice : dict of str to str
        Element, law, plane, strain, load, constraint and path.
    """

    seed: int
    choice: dict[str, str]

    @property
    def flows(self) -> bool:
        """Whether its law has a history."""
        return LAWS[self.choice["law"]][1] == "flows"

    def build(self, x: Floats) -> ct.Model:
        """The model of parameters near one."""
        bend, height, thickness, constant, load, position = x
        c = self.choice
        mesh = ct.mesh.rectangle(4.0, 1.0, nx=4, ny=2, cell=CELLS[c["element"]])
        p = mesh.points.copy()
        shift = np.random.default_rng(self.seed).uniform(-0.04, 0.04, 2)
        # Middle nodes stay middle: the shift is smooth.
        p[:, 0] += 0.05 * np.sin(2.0 * p[:, 1] + shift[0]) * p[:, 0] * (4.0 - p[:, 0]) / 4.0
        p[:, 1] = height * p[:, 1] + 0.15 * bend * np.sin(0.7 * p[:, 0] + shift[1])
        p[:, 0] += 0.05 * position * p[:, 0]
        model = ct.Model(replace(mesh, points=p))
        material = LAWS[c["law"]][0](constant)
        options: dict[str, Any] = {}
        if c["law"] == "orthotropic":
            options["orientation"] = 0.4
        if c["strain"]:
            options["local_strain"] = c["strain"]
        model.section(
            "all", element=c["element"], material=material, thickness=0.8 * thickness,
            plane=c["plane"], **options,
        )  # fmt: skip
        model.fix("left")
        self._constrain(model)
        self._load(model, load)
        nlgeom = c["path"] != "linear"
        count = 4 if self.flows or c["path"] == "increments" else 1
        # A tight tolerance: differences see what is left of a residual.
        step = ct.Static(nlgeom=nlgeom, increments=count, fixed_increments=True, tolerance=1e-13)
        if c["path"] == "displacement control":
            control = ct.DisplacementControl("right", "y", -0.3 - 0.05 * position, increments=4)
            step = ct.Static(path=control, tolerance=1e-13)
        model.steps = [step]
        if c["path"] == "two steps":
            back = ct.Static(nlgeom=nlgeom, increments=count, fixed_increments=True,
                             tolerance=1e-13)  # fmt: skip
            back.force("right", x=1.5 * load)
            model.steps.append(back)
        return model

    def _constrain(self, model: ct.Model) -> None:
        right = model.mesh.node_sets["right"]
        kind = self.choice["constraint"]
        if kind == "rigid":
            model.rigid(right, int(right[0]))
        elif kind == "equation":
            model.equation((int(right[0]), "x", 1.0), (int(right[1]), "x", -0.7))
        elif kind == "straight":
            model.straight(right[1:-1], int(right[0]), int(right[-1]))
        elif kind == "axes":
            model.local_axes("right", angle=0.3)

    def _load(self, model: ct.Model, load: float) -> None:
        kind = self.choice["load"]
        if kind == "force":
            model.force("right", y=-1.6 * load, x=0.5)
        elif kind == "pressure":
            model.pressure("top", 0.5 * load)
        elif kind == "traction":
            model.traction("top", x=0.3, y=-0.5 * load)
        elif kind == "gravity":
            model.gravity(y=-6.0 * load)
        elif kind == "centrifugal":
            model.centrifugal(4.0 * load, about=(-2.0, 0.5))
            model.force("right", y=-1.0)
        elif kind == "support":
            model.fix("right", x=None, y=-0.25 * load)
        elif kind == "temperature":
            model.temperature(60.0 * load, nodes="top")
            model.force("right", y=-1.0)
        elif kind == "follower":
            model.shear("top", 0.4 * load)

    def measures(self) -> list[gradients.Measure]:
        """Smooth measures of the last state."""
        right = "right"
        found: list[gradients.Measure] = [
            gradients.Displacement(right, "y"),
            gradients.Displacement(right, "x") / gradients.Displacement(right, "y"),
            gradients.Stress(p=6.0),
            gradients.Reaction("left", "y"),
        ]
        if not self.flows:
            found.append(gradients.StrainEnergy())
        if self.choice["path"] == "displacement control":
            found[0] = gradients.LoadFactor()
        return found


def draw(seed: int) -> Case:
    """A random case; pairs that the program refuses are drawn again."""
    rng = np.random.default_rng(seed)
    while True:
        choice = {
            "element": str(rng.choice(list(CELLS))),
            "law": str(rng.choice(list(LAWS))),
            "plane": str(rng.choice(["stress", "strain"])),
            "strain": str(rng.choice(["linear", "logarithmic", "green_lagrange"])),
            "load": str(rng.choice(LOADS)),
            "constraint": str(rng.choice(CONSTRAINTS)),
            "path": str(rng.choice(PATHS)),
        }
        kind = LAWS[choice["law"]][1]
        if kind == "rubber":
            choice["strain"] = ""
        if kind == "flows" and choice["strain"] == "green_lagrange":
            choice["strain"] = "logarithmic"
        if kind == "flows" and choice["element"] == "Q4R" and choice["path"] == "two steps":
            continue
        if kind == "rubber" and choice["element"] in ("OPT", "Q4R", "Q4S"):
            continue
        if choice["element"] in ("Q4R", "Q4S") and kind != "any":
            continue
        if choice["load"] == "temperature" and choice["law"] != "elastic":
            continue
        if choice["load"] in ("gravity", "centrifugal") and choice["law"] not in (
            "elastic", "orthotropic", "neo_hooke",
        ):  # fmt: skip
            continue
        if choice["load"] == "support" and choice["path"] in ("displacement control", "two steps"):
            continue
        if choice["load"] == "support" and choice["constraint"] != "none":
            continue
        if choice["path"] == "displacement control" and choice["load"] in (
            "temperature", "centrifugal", "follower",
        ):  # fmt: skip
            continue
        return Case(seed, choice)


def values(case: Case, x: Floats) -> Floats:
    """Values of the measures by a new analysis."""
    results = ct.solve(case.build(x), threads=1, fields=False)
    return Run(results, case.measures(), adjoint=False).values


def difference(case: Case, x: Floats, k: int, step: float) -> Floats:
    """Derivative by a parameter by differences of sixth order."""
    total = np.zeros(len(case.measures()))
    for offset, weight in ((1, 0.75), (2, -0.15), (3, 1.0 / 60.0)):
        for sign in (1, -1):
            moved = x.copy()
            moved[k] += sign * offset * step
            total += sign * weight * values(case, moved)
    return total / step


def compare(case: Case, parameters: list[int] | None = None) -> float:
    """Largest error of the gradients of a case, relative to the largest derivative of a measure.

    Reactions that balance to zero are compared with a ten-thousandth of the loads.
    """
    rng = np.random.default_rng(case.seed)
    x = 1.0 + rng.uniform(-0.05, 0.05, len(NAMES))
    measures = case.measures()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found, exact = ct.value_and_grad(case.build, measures, threads=1)(x)
        chosen = range(len(NAMES)) if parameters is None else parameters
        size = np.maximum(np.abs(exact).max(axis=1), 1e-3 * np.abs(found) + 1e-4)
        worst = 0.0
        for k in chosen:
            errors = []
            for step in (4e-3, 1e-3, 3e-4):
                errors.append(
                    float((np.abs(difference(case, x, k, step) - exact[:, k]) / size).max())
                )
                if errors[-1] < 2e-8:
                    break
            worst = max(worst, min(errors))
    return worst


def main() -> None:
    """Compare some cases and print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--parameters", type=int, default=2, help="drawn for each model")
    given = parser.parse_args()
    counts: Counter[str] = Counter()
    failed = 0
    for seed in range(given.first, given.first + given.count):
        case = draw(seed)
        what = " ".join(f"{v:14s}" for v in case.choice.values())
        try:
            drawn = np.random.default_rng(seed).permutation(len(NAMES))[: given.parameters]
            error = compare(case, drawn.tolist())
        except ct.CorotaError as problem:
            print(f"{seed:4d} {what} {type(problem).__name__}: {problem}"[:220], flush=True)
            counts["not comparable"] += 1
            continue
        counts["compared"] += 1
        failed += error > 1e-7
        print(f"{seed:4d} {what} {error:.1e}{' <--' if error > 1e-7 else ''}", flush=True)
    print(f"{counts['compared']} models compared, {failed} beyond 1e-7, "
          f"{counts['not comparable']} not comparable")  # fmt: skip


if __name__ == "__main__":
    main()
