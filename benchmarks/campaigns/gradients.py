"""Gradients of random models against extrapolated differences of whole analyses.

``python -m benchmarks gradients [--count N] [--first SEED]`` draws models from all elements,
strains, planes, laws, loads, constraints, contacts, paths and time schemes, and compares the
gradient of each measure by some parameters with differences of sixth order, of which the step that
agrees best counts. ``python -m benchmarks gradients --cost`` has the cost beside the forward run.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import resource
import time
import warnings
from collections import Counter
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

import corota as ct
from corota import gradients
from corota.gradients.runs import Run
from corota.mesh import Mesh
from corota.mesh.data import Cells

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

CELLS = {
    "T3": "tri3", "T6": "tri6", "Q4": "quad4", "Q4I": "quad4", "Q4S": "quad4", "Q4R": "quad4",
    "Q8": "quad8", "Q8R": "quad8", "Q9": "quad9", "OPT": "tri3", "Q4D": "quad4", "Q4DI": "quad4",
    "BEAM": "line2", "TRUSS": "line2",
}  # fmt: skip
#: Elements with rotations.
TURN = ("OPT", "Q4D", "Q4DI", "BEAM")


def _mises(k: float, rate: Any = None, **more: Any) -> ct.Mises:
    return ct.Mises(1000.0, 0.3, rho=0.1, rate=rate, **{"yield_stress": 8.0 * k, **more})


def _prony(parent: Any) -> ct.Viscoelastic:
    return ct.Viscoelastic(parent, terms=[(0.3, 0.1, 0.2), (0.1, 0.0, 2.0)])


#: Laws by name: their constants, of a modulus of about 1000, and what they are: any (elastic),
#: rubber, flows (also along lines), hill (which does not), time.
LAWS: dict[str, tuple[Callable[[float], Any], str]] = {
    "elastic": (lambda k: ct.Elastic(E=1000.0 * k, nu=0.3, expansion=1e-4, rho=0.1), "any"),
    "orthotropic": (
        lambda k: ct.Orthotropic(1000.0 * k, 500.0, 700.0, 0.25, 0.2, 0.3, 250.0, rho=0.1),
        "any",
    ),
    "ramberg_osgood": (
        lambda k: ct.RambergOsgood(1000.0, 0.3, 20.0 * k, 5.0, 0.4, rho=0.1), "any"
    ),
    "neo_hooke": (lambda k: ct.NeoHooke(C10=170.0 * k, D1=0.004, rho=0.1), "rubber"),
    "mooney_rivlin": (
        lambda k: ct.MooneyRivlin(C10=100.0, C01=70.0 * k, D1=0.004, rho=0.1), "rubber"
    ),
    "yeoh": (
        lambda k: ct.Yeoh(C10=170.0, C20=20.0 * k, C30=5.0, D1=0.004, rho=0.1), "rubber"
    ),
    "ogden": (
        lambda k: ct.Ogden(mu=[300.0, 40.0], alpha=[2.0, -2.0 * k], D=[0.004, 0.0], rho=0.1),
        "rubber",
    ),
    "arruda_boyce": (
        lambda k: ct.ArrudaBoyce(mu=300.0, limit=3.0 * k, D=0.004, rho=0.1), "rubber"
    ),
    "hyperfoam": (
        lambda k: ct.Hyperfoam(mu=[300.0], alpha=[6.0 * k], nu=[0.2], rho=0.1), "rubber"
    ),
    "mises": (lambda k: _mises(k, isotropic=60.0), "flows"),
    "voce": (lambda k: _mises(1.0, isotropic=ct.Voce(6.0 * k, 20.0)), "flows"),
    "kinematic": (lambda k: _mises(1.0, isotropic=20.0, kinematic=60.0 * k), "flows"),
    "chaboche": (lambda k: _mises(1.0, chaboche=[(400.0 * k, 40.0)]), "flows"),
    "hill": (
        lambda k: ct.Hill(
            R11=1.0, R22=1.1 * k, R33=0.95, R12=1.02, E=1000.0, nu=0.3, yield_stress=8.0,
            isotropic=60.0, rho=0.1,
        ),
        "hill",
    ),
    "cowper_symonds": (
        lambda k: _mises(1.0, ct.CowperSymonds(2.0 * k, 3.0), isotropic=60.0), "time"
    ),
    "yield_ratio": (
        lambda k: _mises(1.0, ct.YieldRatio([(1.0, 0.0), (1.5, 2.0 * k)]), isotropic=60.0), "time"
    ),
    "norton": (
        lambda k: _mises(1.0, ct.Norton(1e-5 * k, 3.0), yield_stress=None), "time"
    ),
    "johnson_cook": (
        lambda k: ct.JohnsonCook(
            E=1000.0, nu=0.3, A=8.0, B=60.0 * k, n=0.5, C=0.05, rate=1.0, rho=0.1
        ),
        "time",
    ),
    "prony": (lambda k: _prony(ct.Elastic(E=1000.0 * k, nu=0.3, rho=0.1)), "time"),
    "prony_neo_hooke": (
        lambda k: _prony(ct.NeoHooke(C10=170.0 * k, D1=0.004, rho=0.1)), "time"
    ),
}  # fmt: skip
#: Laws along lines.
ALONG = (
    "elastic", "mises", "voce", "kinematic", "chaboche", "cowper_symonds", "yield_ratio", "norton",
    "johnson_cook",
)  # fmt: skip
LOADS = ("force", "pressure", "traction", "gravity", "centrifugal", "support", "temperature",
         "follower")  # fmt: skip
CONSTRAINTS = ("none", "none", "rigid", "equation", "axes", "straight")
CONTACTS = ("none", "none", "none", "mortar", "node_to_segment", "friction", "body", "tie")
SCHEMES = ("newmark", "hht", "generalized_alpha")
PATHS = ("one increment", "increments", "linear", "displacement control", "two steps", *SCHEMES)
#: Names of the parameters of all models; `other` is an orientation, a coefficient of friction, a
#: velocity at the start, or how much time passes.
NAMES = ("bend", "height", "thickness", "constant", "load", "position", "other")


@dataclass
class Case:
    """A random model as a function of its parameters, with measures.

    Parameters
    ----------
    seed : int
        Of the imperfections of the mesh.
    choice : dict of str to str
        Element, law, plane, strain, load, constraint, contact and path.
    """

    seed: int
    choice: dict[str, str]

    def __post_init__(self) -> None:
        self.choice.setdefault("contact", "none")
        #: What names of sets begin with.
        self.of = "a." if self.choice["contact"] in ("body", "tie") else ""

    @property
    def kind(self) -> str:
        """What its law is."""
        return LAWS[self.choice["law"]][1]

    @property
    def flows(self) -> bool:
        """Whether its law has a history."""
        return self.kind in ("flows", "hill", "time")

    @property
    def moves(self) -> bool:
        """Whether it has inertia."""
        return self.choice["path"] in SCHEMES

    @property
    def line(self) -> bool:
        """Whether it is a beam or a truss."""
        return CELLS[self.choice["element"]] == "line2"

    @property
    def ring(self) -> bool:
        """Whether it is a solid of revolution."""
        return self.choice["plane"] == "axisymmetric"

    def build(self, x: Floats) -> ct.Model:
        """The model of parameters near one."""
        load, _, other = x[4:]
        c = self.choice
        mesh = self._mesh(x)
        if c["contact"] in ("body", "tie"):
            block = ct.mesh.rectangle(1.6, 0.5, nx=3, ny=2, origin=(2.3, -0.5))
            bottom = mesh.points[mesh.node_sets["bottom"]]
            lift = np.interp(block.points[:, 0], *bottom[np.argsort(bottom[:, 0])].T)
            gap = 0.0 if c["contact"] == "tie" else 0.01 * other
            moved = block.points + np.column_stack([0.0 * lift, lift - gap])
            mesh = ct.mesh.assembly(a=mesh, b=replace(block, points=moved))
        model = ct.Model(mesh)
        self._sections(model, x)
        model.fix(self.of + "left", rotation=c["element"] == "BEAM")
        self._constrain(model)
        self._load(model, load)
        self._touch(model, other)
        self._steps(model, x)
        if self.moves:
            model.velocity(self.of + "right", y=0.6 * other)
        return model

    def _mesh(self, x: Floats) -> Mesh:
        bend, height, thickness, _, _, position, _ = x
        if self.line:
            places = np.linspace(0.0, 4.0, 9)
            points = np.column_stack([places, 0.0 * places])
            chain = np.column_stack([np.arange(8), np.arange(1, 9)])
            mesh = Mesh(points, [Cells("line2", chain, np.arange(1, 9))], np.arange(1, 10))
            ends = {"left": [0], "right": [8], "top": list(range(9))}
            mesh.node_sets.update({k: np.array(v) for k, v in ends.items()})
        else:
            mesh = ct.mesh.rectangle(4.0, 1.0, nx=4, ny=2, cell=CELLS[self.choice["element"]])
        p = mesh.points.copy()
        shift = np.random.default_rng(self.seed).uniform(-0.04, 0.04, 2)
        # Middle nodes stay middle: the shift is smooth.
        p[:, 0] += 0.05 * np.sin(2.0 * p[:, 1] + shift[0]) * p[:, 0] * (4.0 - p[:, 0]) / 4.0
        p[:, 1] = height * p[:, 1] + 0.15 * bend * np.sin(0.7 * p[:, 0] + shift[1])
        p[:, 0] += 0.05 * position * p[:, 0]
        if self.line:
            p[:, 1] *= height
        if self.ring:
            p[:, 0] += thickness
        return replace(mesh, points=p)

    def _sections(self, model: ct.Model, x: Floats) -> None:
        c, thickness = self.choice, float(x[2])
        material = LAWS[c["law"]][0](float(x[3]))
        if c["element"] == "BEAM":
            profile = ct.profiles.rectangle(0.8 * thickness, 0.9)
            model.beam(list(range(8)), material=material, profile=profile)
            return
        if c["element"] == "TRUSS":
            model.truss(list(range(8)), material=material, area=0.7 * thickness)
            ends = np.arange(1, 9)
            # A chain of bars under tension is stiff across it by its force.
            model.fix(ends, x=None, y=0.0)
            return
        options: dict[str, Any] = {}
        if c["law"] in ("orthotropic", "hill"):
            options["orientation"] = 0.4 * float(x[6])
        if c["strain"]:
            options["local_strain"] = c["strain"]
        if not self.ring:
            options["thickness"] = 0.8 * thickness
        cells: Any = "a" if self.of else "all"
        model.section(cells, element=c["element"], material=material, plane=c["plane"], **options)
        if self.of:
            base = ct.Elastic(E=1500.0, nu=0.2)
            model.section("b", element="Q4I", material=base, plane=c["plane"])
            model.fix("b.bottom")

    def _steps(self, model: ct.Model, x: Floats) -> None:
        load, position = float(x[4]), float(x[5])
        c, tight = self.choice, 1e-11 if self.line else 1e-13
        nlgeom = c["path"] != "linear"
        if self.moves:
            mass = "lumped" if c["element"] in TURN else "consistent"
            step: Any = ct.Dynamic(
                period=0.3, increments=8, scheme=c["path"], mass=mass, tolerance=tight,
                ramp=c["load"] == "support", rayleigh=(0.5, 0.0),
            )  # fmt: skip
            model.steps = [step]
            return
        several = self.flows or c["path"] == "increments" or c["contact"] == "friction"
        # A tight tolerance: differences see what is left of a residual.
        options: dict[str, Any] = {
            "nlgeom": nlgeom, "increments": 4 if several else 1, "fixed_increments": True,
            "tolerance": tight,
        }  # fmt: skip
        kind: Any = ct.Static
        if self.kind == "time" and c["path"] != "displacement control":
            kind = ct.Visco
            options["ramp"] = True
        step = kind(**options)
        if c["path"] == "displacement control":
            control = ct.DisplacementControl("right", "y", -0.3 - 0.05 * position, increments=4)
            step = ct.Static(path=control, tolerance=tight)
        model.steps = [step]
        if c["path"] == "two steps":
            back = kind(**options)
            back.force("right", x=1.5 * load)
            model.steps.append(back)

    def _constrain(self, model: ct.Model) -> None:
        right = model.mesh.node_sets[self.of + "right"]
        kind = self.choice["constraint"]
        if kind == "rigid":
            model.rigid(right, int(right[0]))
        elif kind == "equation":
            model.equation((int(right[0]), "x", 1.0), (int(right[1]), "x", -0.7))
        elif kind == "straight":
            model.straight(right[1:-1], int(right[0]), int(right[-1]))
        elif kind == "axes":
            model.local_axes(self.of + "right", angle=0.3)

    def _load(self, model: ct.Model, load: float) -> None:
        kind, right, top = self.choice["load"], self.of + "right", self.of + "top"
        # The circumference of a ring is about thirty.
        more = 20.0 if self.ring else 1.0
        if kind == "force" and self.choice["element"] == "TRUSS":
            model.force(right, x=8.0 * load)
        elif kind == "force":
            model.force(right, y=-1.6 * load * more, x=0.5 * more)
        elif kind == "pressure":
            model.pressure(top, 0.5 * load)
        elif kind == "traction":
            model.traction(top, x=0.3, y=-0.5 * load)
        elif kind == "gravity":
            model.gravity(y=-6.0 * load)
        elif kind == "centrifugal":
            model.centrifugal(4.0 * load, about=(-2.0, 0.5))
            model.force(right, y=-1.0)
        elif kind == "support":
            model.fix(right, x=None, y=-0.25 * load)
        elif kind == "temperature":
            model.temperature(60.0 * load, nodes=top)
            model.force(right, y=-more)
        elif kind == "follower":
            model.shear(top, 0.4 * load)

    def _touch(self, model: ct.Model, other: float) -> None:
        kind = self.choice["contact"]
        if kind == "body":
            model.contact("a.bottom", "b.top")
        elif kind == "tie":
            model.tie("b.top", "a.bottom")
        elif kind != "none":
            table = ct.RigidCurve.line((-1.0, -0.02 * other - 0.05), (7.0, -0.02 * other - 0.05))
            method = "node_to_segment" if kind == "friction" else kind
            friction = 0.2 * other if kind == "friction" else 0.0
            model.contact("bottom", table, method=method, friction=friction)

    def measures(self) -> list[gradients.Measure]:
        """Smooth measures of the last state, and of one before."""
        right, left = self.of + "right", self.of + "left"
        along = "x" if self.choice["element"] == "TRUSS" else "y"
        found: list[gradients.Measure] = [
            gradients.Displacement(right, along),
            gradients.Displacement(right, "x") / gradients.Displacement(right, along),
            gradients.Reaction(left, along),
        ]
        if not self.line:
            found.append(gradients.Stress(p=6.0))
        if self.moves:
            found += [
                gradients.Displacement(right, "y", frame=3), gradients.Velocity(right, along)
            ]  # fmt: skip
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
            "plane": str(rng.choice(["stress", "strain", "axisymmetric"])),
            "strain": str(rng.choice(["linear", "logarithmic", "green_lagrange"])),
            "load": str(rng.choice(LOADS)),
            "constraint": str(rng.choice(CONSTRAINTS)),
            "contact": str(rng.choice(CONTACTS)),
            "path": str(rng.choice(PATHS)),
        }
        case = Case(seed, choice)
        if case.kind == "rubber" or choice["law"] == "prony_neo_hooke":
            choice["strain"] = ""
        elif (case.flows or choice["law"] == "ramberg_osgood") and (
            choice["strain"] == "green_lagrange"
        ):
            choice["strain"] = "logarithmic"
        if case.line:
            choice.update(plane="stress", strain="")
        if not _excluded(case):
            return case


def _excluded(case: Case) -> bool:
    """Whether the program refuses a case, or has no answer."""
    c, kind = case.choice, case.kind
    element, load, path, law = c["element"], c["load"], c["path"], c["law"]
    stretched = kind == "rubber" or law == "prony_neo_hooke"
    if element in ("OPT", "Q4R", "Q4S") and (stretched or kind in ("time", "hill")):
        return True
    if element in ("Q4R", "Q4S") and (kind != "any" or law == "ramberg_osgood"):
        return True
    if load == "temperature" and law != "elastic":
        return True
    if load in ("gravity", "centrifugal") and law not in ("elastic", "orthotropic", "neo_hooke"):
        return True
    if load == "support" and (
        path in ("displacement control", "two steps") or c["constraint"] != "none"
    ):
        return True
    if path == "displacement control" and load in ("temperature", "centrifugal", "follower"):
        return True
    if case.line and (
        law not in ALONG or load != "force" or c["constraint"] != "none" or path == "linear"
    ):
        return True
    if element == "TRUSS" and path == "displacement control":
        return True
    if case.ring and (
        element in TURN or load == "centrifugal" or c["constraint"] in ("straight", "rigid")
        or law in ("orthotropic",)
    ):  # fmt: skip
        return True
    if case.moves and (
        c["constraint"] not in ("none", "axes") or load in ("centrifugal", "temperature")
    ):
        return True
    if c["contact"] == "none":
        return False
    return (
        case.flows or case.moves or case.line or case.ring or c["constraint"] != "none"
        or load not in ("force", "traction", "gravity")
        or path in ("displacement control", "linear")
        or (c["contact"] == "friction" and path == "two steps")
        or (bool(case.of) and path == "two steps")
    )  # fmt: skip


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
            for step in (4e-3, 1.6e-2, 1e-3, 2e-4, 1e-5):
                errors.append(
                    float((np.abs(difference(case, x, k, step) - exact[:, k]) / size).max())
                )
                if errors[-1] < 2e-8:
                    break
            worst = max(worst, min(errors))
    return worst


def kinds_of(case: Case, parameter: str) -> str:
    """What a parameter is in a case."""
    c = case.choice
    if parameter == "load":
        return {"support": "prescribed displacement", "temperature": "temperature"}.get(
            c["load"], "load"
        )
    if parameter == "other":
        if case.moves:
            return "velocity at the start"
        if c["law"] in ("orthotropic", "hill"):
            return "orientation"
        of = {"friction": "friction and gap", "mortar": "gap", "node_to_segment": "gap"}
        return of.get(c["contact"], "gap" if c["contact"] == "body" else "none")
    if parameter == "thickness":
        return "positions" if case.ring else "thickness"
    return "constant of a law" if parameter == "constant" else "positions"


def chosen(case: Case, count: int) -> list[int]:
    """Parameters of a case that are compared; one that does nothing is not."""
    order = np.random.default_rng(case.seed).permutation(len(NAMES)).tolist()
    acts = [k for k in order if kinds_of(case, NAMES[k]) != "none"]
    return acts[:count]


def campaign(first: int, count: int, parameters: int) -> int:
    """Compare some cases and print a table; the number beyond the limit."""
    counts: Counter[str] = Counter()
    parts: Counter[str] = Counter()
    kinds: Counter[str] = Counter()
    failed = 0
    for seed in range(first, first + count):
        case = draw(seed)
        what = " ".join(f"{v:13s}" for v in case.choice.values())
        try:
            which = chosen(case, parameters)
            error = compare(case, which)
        except ct.CorotaError as problem:
            print(f"{seed:4d} {what} {type(problem).__name__}: {problem}"[:240], flush=True)
            counts["not comparable"] += 1
            continue
        counts["compared"] += 1
        parts.update(case.choice.values())
        kinds.update(kinds_of(case, NAMES[k]) for k in which)
        failed += error > 1e-7
        print(f"{seed:4d} {what} {error:.1e}{' <--' if error > 1e-7 else ''}", flush=True)
    print(f"{counts['compared']} models compared, {failed} beyond 1e-7, "
          f"{counts['not comparable']} not comparable")  # fmt: skip
    print("parameters:", ", ".join(f"{k} {n}" for k, n in kinds.most_common()))
    print("models with:", ", ".join(f"{k} {n}" for k, n in parts.most_common() if k != "none"))
    return failed


#: Elements along and across the strips of about 410, 41 thousand and 250 thousand dofs.
SIZES = ((40, 4), (400, 50), (1250, 99))
#: Runs of the smallest, whose median counts.
REPEATS = 9
#: Force at the end of the strips: that of full plastic flow of the second is 0.5.
FORCES = {"elastic": -2.0, "J2": -0.45, "contact": -5.0}


def strip(kind: str, size: tuple[int, int]) -> ct.Model:
    """A clamped strip that is bent: elastic, flowing, or pressed onto a rigid table."""
    nx, ny = size
    mesh = ct.mesh.rectangle(10.0, 1.0, nx=nx, ny=ny)
    model = ct.Model(mesh)
    material: Any = ct.Elastic(E=1000.0, nu=0.3)
    if kind == "J2":
        material = ct.Mises(1000.0, 0.3, yield_stress=20.0, isotropic=50.0)
    model.section("all", element="Q4I", material=material)
    model.fix("left")
    right = mesh.node_sets["right"]
    model.force(right, y=FORCES[kind] / len(right))
    if kind == "contact":
        model.contact("bottom", ct.RigidCurve.line((-2.0, -0.2), (14.0, -0.2)))
    model.steps = [ct.Static(increments=5, fixed_increments=kind != "contact")]
    return model


def cost(kind: str, size: tuple[int, int], threads: int) -> str:
    """One row: times of the run and of the gradient, and what they store."""
    model = strip(kind, size)
    warm = ct.solve(strip(kind, SIZES[0]), threads=threads)
    measure = gradients.Displacement("right", "y")
    wrt: list[Any] = [gradients.Constant("E")]
    if kind != "contact":
        wrt.append(gradients.Positions())
    ct.gradient(warm, measure, wrt)
    fields = [each for each in wrt if isinstance(each, gradients.parameters.Field)]
    times = []
    for _ in range(REPEATS if size == SIZES[0] else 1):
        begin = time.perf_counter()
        results = ct.solve(model, threads=threads, fields=False)
        middle = time.perf_counter()
        used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        run = Run(results, [measure], fields=fields)
        for parameter in wrt:
            run.by(parameter)
        times.append((middle - begin, time.perf_counter() - middle))
    forward, back = np.median(times, axis=0).tolist()
    more = max(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - used, 0) / 1024.0
    count = len(results.frames) - 1
    bytes_of = sum(each.by_node.nbytes + sum(h.nbytes for h in each.histories)
                   for each in run.increments)  # fmt: skip
    dofs = 2 * model.mesh.n_nodes
    return (
        f"{kind:8s} {dofs:8d} {count:4d} {forward:9.3f} {back:9.3f} {back / forward:7.2f} "
        f"{bytes_of / count / 2**20:9.3f} {more:9.1f}"
    )


def main() -> None:
    """Compare some cases, or measure the cost, and print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--parameters", type=int, default=2, help="drawn for each model")
    parser.add_argument("--cost", action="store_true", help="times beside the forward run")
    parser.add_argument("--largest", type=int, default=3, help="of three sizes, with --cost")
    parser.add_argument("--threads", type=int, default=1, help="with --cost")
    given = parser.parse_args()
    if not given.cost:
        raise SystemExit(campaign(given.first, given.count, given.parameters) > 0)
    print("kind         dofs  incr   run [s] gradient [s] ratio  MB/incr   more MB")
    for kind in ("elastic", "J2", "contact"):
        for size in SIZES[: given.largest]:
            print(cost(kind, size, given.threads), flush=True)


if __name__ == "__main__":
    main()
