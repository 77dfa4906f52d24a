"""Small random decks of one or two bodies that may or may not be held.

Bodies are sheared and turned grids, supported or not, that contact, ties, equations, couplings
and rigid bodies join. Who is held is known by construction: the rank of the constraints on the
rigid motions of the bodies.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from random import Random
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

#: Elements by their number of nodes.
TYPES = {
    3: ("CPS3", "CPE3", "OPT"),
    4: ("CPS4", "CPE4", "Q4I", "Q4D"),
    6: ("CPS6", "CPE6"),
    8: ("CPS8", "CPE8"),
}
#: Sides of an element, from 1, on the lower, right, upper and left side of a cell; of triangles
#: also which of the two of a cell it is.
SIDES = {3: ((0, 1), (0, 2), (1, 2), (1, 3)), 4: ((0, 1), (0, 2), (0, 3), (0, 4))}
#: Share of the area that each node carries.
SHARE = {3: [1 / 3] * 3, 4: [0.25] * 4, 6: [0] * 3 + [1 / 3] * 3, 8: [-1 / 12] * 4 + [1 / 3] * 4}
LINKS = ("none", "contact", "stabilized", "tie", "equation", "coupling", "rigid")
SUPPORTS = ("clamped", "clamped", "sliding", "hinge", "roller", "none")


@dataclass
class Body:
    """A grid.

    Parameters
    ----------
    name : str
    points : ndarray, shape (n, 2)
        Of its nodes [length].
    labels : ndarray of int, shape (n,)
        Of its nodes.
    cells : ndarray of int, shape (m, k)
        Labels of the nodes.
    first : int
        Label of its first element.
    grid : ndarray, shape (n, 2)
        Position of the nodes in the grid, from 0 to 1.
    shape : tuple of int
        Cells along and across.
    kind : str
        Type of the element.
    """

    name: str
    points: Floats
    labels: Ints
    cells: Ints
    first: int
    grid: Floats
    shape: tuple[int, int]
    kind: str

    def side(self, number: int) -> Ints:
        """Labels of the nodes on a side (lower, right, upper, left), in order along the grid."""
        across = (1, 0, 1, 0)[number]
        at = np.flatnonzero(np.abs(self.grid[:, across] - (0.0, 1.0, 1.0, 0.0)[number]) < 1e-9)
        order: Ints = self.labels[at[np.argsort(self.grid[at, 1 - across])]]
        return order

    def faces(self, number: int) -> list[tuple[int, int]]:
        """Elements (labels) and their sides that make up a side of the body."""
        nx, ny = self.shape
        cells = [
            list(range(nx)),
            [j * nx + nx - 1 for j in range(ny)],
            [(ny - 1) * nx + i for i in range(nx)],
            [j * nx for j in range(ny)],
        ][number]
        corners = 3 if self.cells.shape[1] in (3, 6) else 4
        half, side = SIDES[corners][number]
        per = 2 if corners == 3 else 1
        return [(self.first + per * c + half, side) for c in cells]


@dataclass
class Deck:
    """A deck and what is known of it.

    Parameters
    ----------
    text : str
    bodies : list of Body
    features : dict
        What was drawn.
    held : bool or None
        Whether constraints alone hold all bodies; None if contact or a tie may as well.
    forces : list of (label, x, y)
        Dead forces at nodes.
    moments : list of (label, m)
    pressures : list of (labels of the side's end nodes, pressure)
        Forces on the left of the way from the first to the second.
    supports : set of (label, dof)
        Dofs that are held or driven.
    driven : float
        Largest prescribed displacement.
    passive : set of int
        Nodes whose written reaction may be any: those that constraints or contact join.
    couples : bool
        Whether equations join nodes at different places: their forces make a couple.
    thickness, modulus : float
    """

    text: str
    bodies: list[Body]
    features: dict[str, Any]
    held: bool | None = True
    forces: list[tuple[int, float, float]] = field(default_factory=list)
    moments: list[tuple[int, float]] = field(default_factory=list)
    pressures: list[tuple[int, int, float]] = field(default_factory=list)
    supports: set[tuple[int, int]] = field(default_factory=set)
    driven: float = 0.0
    passive: set[int] = field(default_factory=set)
    couples: bool = False
    thickness: float = 1.0
    modulus: float = 1.0


def body(
    name: str, box: tuple[float, float, float, float], draw: Random, first: tuple[int, int]
) -> Body:
    """A grid of one kind of element in a box (x, y, width, height)."""
    nx, ny = draw.randint(1, 4), draw.randint(1, 3)
    k = draw.choice((3, 4, 4, 6, 8))
    if k > 4:
        nx, ny = max(nx, 2), min(ny, 2)
    step = 2 if k > 4 else 1
    whole = [(i, j) for j in range(step * ny + 1) for i in range(step * nx + 1)]
    cells: list[list[tuple[int, int]]] = []
    for j in range(ny):
        for i in range(nx):
            a, b, c, d = (
                (step * (i + p), step * (j + q)) for p, q in ((0, 0), (1, 0), (1, 1), (0, 1))
            )
            for cell in [[a, b, c, d]] if k in (4, 8) else [[a, b, c], [a, c, d]]:
                middle = []
                if k > 4:
                    for p, q in zip(cell, cell[1:] + cell[:1], strict=True):
                        middle.append(((p[0] + q[0]) // 2, (p[1] + q[1]) // 2))
                cells.append(cell + middle)
    used = {p for cell in cells for p in cell}
    places = [p for p in whole if p in used]
    number = {p: first[0] + n for n, p in enumerate(places)}
    grid = np.array(places) / [step * nx, step * ny]
    points = grid * box[2:] + box[:2]
    return Body(
        name,
        points,
        np.array([number[p] for p in places]),
        np.array([[number[p] for p in cell] for cell in cells]),
        first[1],
        grid,
        (nx, ny),
        draw.choice(TYPES[k]),
    )


def rigid_rows(points: Floats, which: int, n_bodies: int) -> Floats:
    """Displacement of points by the rigid motions of the bodies, shape (n, 2, 3 n_bodies)."""
    rows = np.zeros((len(points), 2, 3 * n_bodies))
    rows[:, 0, 3 * which] = rows[:, 1, 3 * which + 1] = 1.0
    rows[:, 0, 3 * which + 2], rows[:, 1, 3 * which + 2] = -points[:, 1], points[:, 0]
    return rows


def make(seed: str) -> Deck:
    """The deck of a seed."""
    return _Maker(seed).deck


class _Maker:
    def __init__(self, seed: str) -> None:
        self.draw = draw = Random(seed)
        self.size = 10.0 ** draw.choice((-2, 0, 0, 2))
        self.E = 10.0 ** draw.choice((0, 3, 5, 11))
        self.t = draw.choice((1.0, 1.0, 0.3))
        two = draw.random() < 0.75
        self.link = draw.choice(LINKS) if two else draw.choice(("none", "rigid end"))
        dynamic = draw.random() < 0.1
        self.features = {
            "link": self.link,
            "bodies": 1 + two,
            "nlgeom": draw.random() < 0.6,
            "dynamic": dynamic,
            "friction": draw.random() < 0.4,
        }
        w, h = self.size, self.size * draw.uniform(0.3, 1.0)
        lower = body("A", (0.0, 0.0, w, h), draw, (1, 1))
        self.bodies = [lower]
        if two:
            gap = 0.0
            if self.link in ("contact", "stabilized"):
                gap = draw.choice((0.0, 0.0, 1e-3, 1e-2)) * w
            elif self.link not in ("tie",):
                gap = draw.choice((0.0, 0.05)) * w
            self.features["gap"] = gap / w
            x, width = draw.choice(((0.0, 1.0), (0.1, 0.7), (0.4, 0.4)))
            first = (int(lower.labels[-1]) + 1, lower.first + len(lower.cells))
            box = (x * w, h + gap, width * w, h * draw.uniform(0.3, 1.0))
            self.bodies.append(body("B", box, draw, first))
        shear = draw.choice((0.0, 0.0, 0.15))
        angle = draw.choice((0.0, 0.0, 0.3, 1.0))
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[c, -s], [s, c]]) @ np.array([[1.0, shear], [0.0, 1.0]])
        for b in self.bodies:
            b.points = b.points @ turn.T
        self.reference = int(self.bodies[-1].labels[-1]) + 1
        self.n = 3 * len(self.bodies)
        self.rows: list[Floats] = []
        self.sets: list[str] = []
        self.model: list[str] = []
        self.step: list[str] = []
        self.deck = Deck("", self.bodies, self.features, thickness=self.t, modulus=self.E)
        self.taken: set[int] = set()
        self.join()
        for number in range(len(self.bodies)):
            self.hold(number)
        self.loads()
        self.finish()

    # -- parts -------------------------------------------------------------------------

    def point(self, label: int) -> Floats:
        for b in self.bodies:
            if b.labels[0] <= label <= b.labels[-1]:
                found: Floats = b.points[label - b.labels[0]]
                return found
        raise KeyError(label)

    def move(self, label: int) -> Floats:
        """Rows of a node's displacement, shape (2, n)."""
        which = 0 if label <= self.bodies[0].labels[-1] else 1
        rows: Floats = rigid_rows(self.point(label)[None], which, len(self.bodies))[0]
        return rows

    def surface(self, name: str, which: int, side: int) -> None:
        self.sets.append(f"*SURFACE, NAME={name}")
        self.sets += [f"{e}, S{s}" for e, s in self.bodies[which].faces(side)]

    def nodes(self, name: str, labels: Ints) -> None:
        self.sets.append(f"*NSET, NSET={name}")
        self.sets += [str(n) for n in labels.tolist()]

    def join(self) -> None:
        link, draw, model, deck = self.link, self.draw, self.model, self.deck
        if link in ("contact", "stabilized", "tie"):
            self.surface("SLAVE", 1, 0)
            self.surface("MASTER", 0, 2)
            for label in [*self.bodies[1].side(0).tolist(), *self.bodies[0].side(2).tolist()]:
                self.deck.passive.add(label)
            self.taken |= set(self.bodies[1].side(0).tolist())
            if link == "tie":
                model += ["*TIE, NAME=T, ADJUST=NO", "SLAVE, MASTER"]
                # Glued along a line of some length: no relative motion is left.
                for label in self.bodies[1].side(0)[[0, -1]].tolist():
                    which = rigid_rows(self.point(label)[None], 0, 2)[0]
                    self.rows.append(self.move(label) - which)
                return
            model += ["*SURFACE INTERACTION, NAME=SI"]
            if self.features["friction"]:
                model += ["*FRICTION", f"{draw.choice((0.1, 0.5))}"]
            kind = draw.choice(("SURFACE TO SURFACE", "SURFACE TO SURFACE", "NODE TO SURFACE"))
            self.features["kind"] = kind
            model += [f"*CONTACT PAIR, INTERACTION=SI, TYPE={kind}", "SLAVE, MASTER"]
        elif link == "equation":
            own, other = self.bodies[1].side(0).tolist(), self.bodies[0].side(2).tolist()
            for slave, master in zip(own[: draw.randint(1, 3)], other, strict=False):
                for dof in draw.choice(((0, 1), (0, 1), (1,))):
                    model += ["*EQUATION", "2", f"{slave}, {dof + 1}, 1., {master}, {dof + 1}, -1."]
                    self.rows.append((self.move(slave) - self.move(master))[dof : dof + 1])
                if np.abs(self.point(slave) - self.point(master)).max() > 1e-9 * self.size:
                    deck.couples = True
                self.deck.passive |= {slave, master}
                self.taken.add(slave)
        elif link in ("coupling", "rigid", "rigid end"):
            number = len(self.bodies) - 1
            labels = self.bodies[number].side(2)
            self.features["drive"] = draw.choice(("fixed", "force", "turns", "free"))
            self.deck.passive |= set(labels.tolist()) | {self.reference}
            self.taken |= set(labels.tolist())
            if link == "coupling":
                self.surface("TOP", number, 2)
                how = draw.choice(("*KINEMATIC", "*KINEMATIC", "*DISTRIBUTING"))
                self.features["coupling"] = how
                if how == "*DISTRIBUTING":
                    # It follows the mean of the nodes: it can be loaded, not held.
                    self.features["drive"] = draw.choice(("force", "free"))
                model += [
                    f"*COUPLING, REF NODE={self.reference}, SURFACE=TOP, CONSTRAINT NAME=C",
                    how,
                ]
            else:
                self.nodes("END", labels)
                model += [f"*RIGID BODY, NSET=END, REF NODE={self.reference}"]

    def fix(self, label: int, dof: int, value: float = 0.0) -> None:
        if (label, dof) in self.deck.supports or label in self.taken:
            return
        self.deck.supports.add((label, dof))
        self.rows.append(self.move(label)[dof : dof + 1])
        self.deck.driven = max(self.deck.driven, abs(value))
        where = self.step if value else self.model
        where += ["*BOUNDARY", f"{label}, {dof + 1}, {dof + 1}, {value!r}"]

    def hold(self, number: int) -> None:
        draw, b = self.draw, self.bodies[number]
        how = draw.choice(SUPPORTS if number == 0 else (*SUPPORTS[2:], "none", "none", "left x"))
        self.features[f"support {b.name}"] = how
        side = b.side(0) if number == 0 else b.side(2)
        if how == "clamped":
            for label in side.tolist():
                self.fix(label, 0)
                self.fix(label, 1)
        elif how in ("sliding", "left x"):
            for label in side.tolist() if how == "sliding" else b.side(3).tolist():
                self.fix(label, int(how == "sliding"))
        elif how == "hinge":
            self.fix(int(side[0]), 0)
            self.fix(int(side[0]), 1)
        elif how == "roller":
            self.fix(int(side[-1]), 1)

    def loads(self) -> None:
        draw, deck = self.draw, self.deck
        strain = 10.0 ** draw.uniform(-6, -1.7)
        stress = strain * self.E
        self.features["strain"] = strain
        area = self.size * self.t
        top = self.bodies[-1]
        if "drive" in self.features:
            self.drive(stress * area)
        for _ in range(draw.randint(0 if "drive" in self.features else 1, 2)):
            kind = draw.choice(("force", "force", "pressure", "pressure", "gravity", "driven"))
            b = draw.choice(self.bodies)
            sign = draw.choice((1.0, 1.0, 1.0, -1.0))
            self.features[kind] = True
            if kind == "force":
                label = int(draw.choice(b.labels.tolist()))
                dof, size = draw.randint(0, 1), sign * stress * area * 0.1
                self.step += ["*CLOAD", f"{label}, {dof + 1}, {size!r}"]
                deck.forces.append((label, size * (dof == 0), size * (dof == 1)))
                deck.passive.add(label)
            elif kind == "pressure":
                side = draw.choice((1, 2, 2))
                name = f"P{len(self.sets)}"
                self.surface(name, self.bodies.index(b), side)
                size = sign * stress
                self.step += ["*DSLOAD", f"{name}, P, {size!r}"]
                ends = b.side(side)
                a, z = int(ends[0]), int(ends[-1])
                # Outside lies on the right of the way round the body, against the clock.
                deck.pressures.append((a, z, size) if side == 1 else (z, a, size))
            elif kind == "gravity":
                g = stress / self.size
                self.step += ["*DLOAD", f"E{b.name}, GRAV, {g!r}, 0., {-sign!r}, 0."]
                deck.forces += self.weights(b, -sign * g)
            elif b is top or len(self.bodies) == 1:
                label = int(top.side(2)[0])
                self.fix(label, 1, sign * strain * self.size)

    def weights(self, b: Body, g: float) -> list[tuple[int, float, float]]:
        share, found = SHARE[b.cells.shape[1]], []
        for cell in b.cells:
            corners = b.points[cell[: 3 if len(cell) in (3, 6) else 4] - b.labels[0]]
            x, y = corners.T
            area = 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
            found += [
                (int(n), 0.0, g * area * self.t * part) for n, part in zip(cell, share, strict=True)
            ]
        return found

    def drive(self, force: float) -> None:
        """Hold or load the reference node of a coupling or a rigid body."""
        how, deck = self.features["drive"], self.deck
        at = self.reference_point()
        rows = rigid_rows(at[None], len(self.bodies) - 1, len(self.bodies))[0]
        turn = np.zeros((1, self.n))
        turn[0, -1] = 1.0
        if how in ("fixed", "turns"):
            value = 0.0 if how == "fixed" else 10.0 ** self.draw.uniform(-4, -1)
            self.model += ["*BOUNDARY", f"{self.reference}, 1, 2"]
            where = self.step if value else self.model
            where += ["*BOUNDARY", f"{self.reference}, 6, 6, {value!r}"]
            deck.supports |= {(self.reference, d) for d in range(3)}
            self.rows += [rows, turn]
            deck.driven = max(deck.driven, abs(value) * 2 * self.size)
        elif how == "force":
            self.step += [
                "*CLOAD",
                f"{self.reference}, 1, {0.1 * force!r}",
                f"{self.reference}, 2, {-0.1 * force!r}",
            ]
            moment = 0.01 * force * self.size
            self.step += ["*CLOAD", f"{self.reference}, 6, {moment!r}"]
            deck.forces.append((self.reference, 0.1 * force, -0.1 * force))
            deck.moments.append((self.reference, moment))

    def reference_point(self) -> Floats:
        b = self.bodies[-1]
        middle: Floats = b.points[b.side(2) - b.labels[0]].mean(axis=0)
        return middle + 0.1 * self.size

    # -- text --------------------------------------------------------------------------

    def finish(self) -> None:
        deck, lines = self.deck, ["*NODE"]
        for b in self.bodies:
            lines += [
                f"{n}, {x!r}, {y!r}"
                for n, (x, y) in zip(b.labels.tolist(), b.points.tolist(), strict=True)
            ]
        if "drive" in self.features:
            x, y = self.reference_point().tolist()
            lines.append(f"{self.reference}, {x!r}, {y!r}")
        for b in self.bodies:
            lines.append(f"*ELEMENT, TYPE={b.kind}, ELSET=E{b.name}")
            lines += [
                f"{b.first + k}, " + ", ".join(map(str, cell))
                for k, cell in enumerate(b.cells.tolist())
            ]
        lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"{self.E!r}, .3", "*DENSITY", "1."]
        for b in self.bodies:
            lines += [f"*SOLID SECTION, ELSET=E{b.name}, MATERIAL=M", f"{self.t!r}"]
        lines += [*self.sets, *self.model]
        lines.append("*STEP, NLGEOM, INC=60" if self.features["nlgeom"] else "*STEP, INC=60")
        if self.features["dynamic"]:
            period = self.size / self.E**0.5 * self.draw.choice((3.0, 30.0))
            lines += ["*DYNAMIC", f"{period / 10!r}, {period!r}"]
        else:
            lines += ["*STATIC", self.draw.choice(("1., 1.", ".25, 1."))]
        if self.link == "stabilized":
            lines.append("*CONTACT CONTROLS, STABILIZE")
        deck.text = "\n".join([*lines, *self.step, "*END STEP", ""])
        if self.link in ("contact", "stabilized"):
            deck.held = None
        else:
            # Lengths in sizes of the model: rows of translations and turns compare.
            rows = np.concatenate([np.zeros((1, self.n)), *self.rows])
            rows[:, 2::3] /= self.size
            # A turn that is held is no length.
            values = np.linalg.svd(rows, compute_uv=False)
            top = max(float(values[0]), 1e-300)
            deck.held = int((values > 1e-7 * top).sum()) == self.n


__all__ = ["Body", "Deck", "make"]
