"""The table of output variables, one row each; every other list of them is derived from it.

Names of components, invariants, dimensions, descriptions, arrays of result files, requests and
titles of decks, blocks of ``.frd`` files. Variables that users define
(:data:`corota.results.derived.DERIVED`) are rows like the others.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass

from corota.results.derived import DERIVED
from corota.results.invariants import OF_STRAIN, OF_STRESS, Invariant

STRESS, ENERGY_DENSITY = "force/length^2", "energy/length^3"


@dataclass(frozen=True)
class Variable:
    """An output variable: numbers at the nodes, or at the quadrature points.

    Parameters
    ----------
    name : str
        Key of the values at points; name in requests of decks, unless `request` differs.
    parts : tuple of (str, str)
        Name and description of each component, in the order of its columns.
    dimension : str
        Such as ``force/length^2``; empty for a number without one.
    frame : str
        Attribute of frames that contains it at the nodes; empty for a variable at points.
    first : int
        Its first column there.
    size : tuple of (str, str)
        Name and description of the length of a vector, which is its size; empty for none.
    array : str
        Name in result files; `name` by default.
    shear : float
        Factor from the stored shear of a tensor to its component.
    invariants : tuple of Invariant
    positive : bool
        Whether it is negative nowhere: extrapolated values are not, either.
    request : str
        Name in requests of decks.
    title, total : str
        Titles of its table in ``.dat`` files and of the sum there; empty for none.
    block, letter : str
        Block of ``.frd`` files, and first letter of the names of its components.
    force : bool
        Whether several nodes have the sum of its values, not their mean.
    """

    name: str
    parts: tuple[tuple[str, str], ...]
    dimension: str = ""
    frame: str = ""
    first: int = 0
    size: tuple[str, str] = ("", "")
    array: str = ""
    shear: float = 1.0
    invariants: tuple[Invariant, ...] = ()
    positive: bool = False
    request: str = ""
    title: str = ""
    total: str = ""
    block: str = ""
    letter: str = ""
    force: bool = False

    @property
    def stored(self) -> str:
        """Name of the array in result files."""
        return self.array or self.name

    @property
    def tensor(self) -> bool:
        """Whether it has the components xx, yy, zz, xy at points."""
        return not self.frame and len(self.parts) == 4

    @property
    def names(self) -> list[str]:
        """Components, size and invariants."""
        found = [name for name, _ in (*self.parts, self.size) if name]
        return found + [item.name for item in self.invariants]


def _vector(name: str, what: str, dimension: str, **more: object) -> Variable:
    parts = ((f"{name}1", f"{what} x"), (f"{name}2", f"{what} y"))
    size = (name, {"velocity": "speed"}.get(what, f"size of the {what}"))
    return Variable(name, parts, dimension, **{"frame": name, "size": size, "array": what, **more})  # type: ignore[arg-type]


def _tensor(name: str, what: str, last: str, dimension: str = "", **more: object) -> Variable:
    parts = (*((f"{name}{i}{i}", f"{what} {a}{a}") for i, a in zip("123", "xyz", strict=True)),)
    return Variable(name, (*parts, (f"{name}12", last)), dimension, **more)  # type: ignore[arg-type]


def _number(name: str, what: str, dimension: str = "", **more: object) -> Variable:
    return Variable(name, ((name, what),), dimension, **more)  # type: ignore[arg-type]


_ROWS = (
    _vector("U", "displacement", "length", title="displacements (vx,vy,vz)", block="DISP",
            letter="D"),
    Variable("UR", (("UR3", "drilling rotation"),), "rad", "UR", array="rotation",
             title="rotations (rx,ry,rz)"),
    _vector("RF", "reaction", "force", force=True, title="forces (fx,fy,fz)",
            total="total force (fx,fy,fz)", block="FORC", letter="F"),
    _number("RM3", "reaction moment", "force*length", frame="RF", first=2, force=True,
            array="reaction moment", request="RF"),
    _vector("F", "external force", "force", force=True),
    _number("M3", "external moment", "force*length", frame="F", first=2, force=True,
            array="external moment", request="F"),
    _vector("V", "velocity", "length/time", title="velocities (vx,vy,vz)", block="VELO",
            letter="V"),
    _number("VR3", "angular velocity", "rad/time", frame="V", first=2, array="angular velocity",
            request="V"),
    _vector("A", "acceleration", "length/time^2"),
    _number("AR3", "angular acceleration", "rad/time^2", frame="A", first=2,
            array="angular acceleration", request="A"),
    _number("NT", "temperature", "temperature", frame="T", array="temperature", block="NDTEMP",
            letter="T", title="temperatures"),
    _number("CPRESS", "contact pressure", STRESS, frame="C", positive=True, request="CSTR"),
    _number("CSHEAR", "contact shear traction", STRESS, frame="C", first=1, request="CSTR"),
    _number("COPEN", "contact gap", "length", frame="C", first=2, request="CDIS"),
    _number("CSLIP", "contact slip", "length", frame="C", first=3, request="CDIS"),
    _number("CSTATUS", "contact status: 0 open, 1 closed, 2 slipping", frame="C", first=4,
            request="CDIS"),
    _number("UA1", "amplitude of the displacement x", "length", frame="H", positive=True,
            request="PU"),
    _number("UA2", "amplitude of the displacement y", "length", frame="H", first=1, positive=True,
            request="PU"),
    _number("UP1", "phase of the displacement x", "rad", frame="H", first=2, request="PU"),
    _number("UP2", "phase of the displacement y", "rad", frame="H", first=3, request="PU"),
    _number("RFA1", "amplitude of the reaction x", "force", frame="H", first=4, positive=True,
            request="PRF"),
    _number("RFA2", "amplitude of the reaction y", "force", frame="H", first=5, positive=True,
            request="PRF"),
    _tensor("S", "Cauchy stress", "Cauchy stress xy", STRESS, array="stress",
            invariants=OF_STRESS,
            title="stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) ", block="STRESS",
            letter="S"),
    _tensor("SA", "amplitude of the stress", "amplitude of the stress xy", STRESS, request="PHS"),
    _number("MISESA", "largest von Mises stress over a period", STRESS, positive=True,
            request="PHS"),
    _tensor("E", "strain", "shear strain (angle)", array="strain", shear=0.5,
            invariants=OF_STRAIN, block="TOSTRAIN", letter="E",
            title="strains (elem, integ.pnt.,exx,eyy,ezz,exy,exz,eyz) "),
    _number("PEEQ", "equivalent plastic strain", positive=True, block="PE",
            title="equivalent plastic strain (elem, integ.pnt.,pe)"),
    _number("ENER", "strain energy density", ENERGY_DENSITY, positive=True, block="ENER",
            title="internal energy density (elem, integ.pnt.,energy) "),
    _number("YRATIO", "equivalent over yield stress", positive=True),
    _tensor("PE", "plastic strain", "plastic shear strain (angle)", shear=0.5),
    _tensor("ALPHA", "back-stress deviator", "back-stress deviator xy", STRESS),
    _number("PWORK", "plastic work density", ENERGY_DENSITY, positive=True),
    _number("PDISS", "plastic dissipation density", ENERGY_DENSITY, positive=True),
    _number("CEEQ", "equivalent creep strain", positive=True),
    _number("CWORK", "work of creep density", ENERGY_DENSITY, positive=True),
    _number("DMENER", "energy density lost by softening", ENERGY_DENSITY, positive=True),
    _number("TRISE", "rise of the temperature by plastic work", "temperature", positive=True),
    _number("EKEDEN", "kinetic energy density", ENERGY_DENSITY, positive=True),
    _number("STH", "current thickness", "length", positive=True),
    _number("N", "axial force", "force"),
    _number("M1", "moment at the first end", "force*length"),
    _number("M2", "moment at the second end", "force*length"),
    _number("SR1", "axial stress of a beam on the right at its first end", STRESS),
    _number("SL1", "axial stress of a beam on the left at its first end", STRESS),
    _number("SR2", "axial stress of a beam on the right at its second end", STRESS),
    _number("SL2", "axial stress of a beam on the left at its second end", STRESS),
    _number("PR1", "plastic rotation of the first half", "rad"),
    _number("PR2", "plastic rotation of the second half", "rad"),
)  # fmt: skip
#: The rows by their names.
TABLE: dict[str, Variable] = {row.name: row for row in _ROWS}


def variables() -> dict[str, Variable]:
    """All rows, with those of :data:`corota.results.derived.DERIVED`."""
    return TABLE | {name: _user_defined(name) for name in DERIVED}


def requests() -> dict[str, Variable]:
    """Rows that output requests of decks name: :func:`variables`, and invariants."""
    rows = {n: _printed(n, item.meaning, DIMENSIONS[n]) for n, (_, item) in INVARIANTS.items()}
    return variables() | rows


def markdown() -> list[str]:
    """Lines of the table of variables in the documents."""
    lines = ["| name | meaning | dimension | where |", "| --- | --- | --- | --- |"]
    for row in _ROWS:
        meaning = row.parts[0][1]
        if len(row.parts) > 1:
            meaning = meaning.removesuffix(" xx").removesuffix(" x")
        of_array = {item.array: item.meaning for item in row.invariants if item.column < 0}
        lists = {meaning: [name for name, _ in (*row.parts, row.size) if name]}
        for item in row.invariants:
            lists.setdefault(of_array.get(item.array, item.array), []).append(item.name)
        where = "nodes" if row.frame else "points, averages"
        for what, names in lists.items():
            lines.append(f"| `{' '.join(names)}` | {what} | {DIMENSIONS[names[0]]} | {where} |")
    return lines


def _user_defined(name: str) -> Variable:
    text = DERIVED[name].meaning
    inside = text.partition("[")[2].partition("]")[0]
    return _printed(name, text, inside if inside in {row.dimension for row in _ROWS} else "")


def _printed(name: str, text: str, dimension: str) -> Variable:
    title = f"{(text.partition(' [')[0] or name).lower()} (elem, integ.pnt.,{name.lower()}) "
    return _number(name, text, dimension, title=title, block=name[:8])


#: Description of each component, size and invariant.
MEANING: dict[str, str] = {
    name: text
    + f" [{row.dimension}]" * (row.dimension in ("length", "force", "force*length", "rad"))
    for row in _ROWS
    for name, text in (*row.parts, row.size, *((i.name, i.meaning) for i in row.invariants))
    if name
}
#: Dimension of each.
DIMENSIONS: dict[str, str] = {name: row.dimension for row in _ROWS for name in row.names} | {
    item.name: item.dimension for r in _ROWS for item in r.invariants if item.dimension is not None
}
#: Nodal variables: name to (attribute of a frame, column); -1 is the size.
NODAL: dict[str, tuple[str, int]] = {
    name: (row.frame, column)
    for row in _ROWS
    if row.frame
    for name, column in [
        *((part, row.first + i) for i, (part, _) in enumerate(row.parts)),
        *([(row.size[0], -1)] if row.size[0] else []),
    ]
}
#: Columns of the contact values at nodes.
CONTACT = tuple(row.name for row in _ROWS if row.frame == "C")
#: Columns of the amplitudes of a harmonic response at nodes.
HARMONIC = tuple(row.name for row in _ROWS if row.frame == "H")
#: Tensors at points, rows xx, yy, zz, xy.
TENSORS = tuple(row.name for row in _ROWS if row.tensor)
#: Components of the tensors at points: name to (tensor, column).
COMPONENTS: dict[str, tuple[str, int]] = {
    part: (row.name, i) for row in _ROWS if row.tensor for i, (part, _) in enumerate(row.parts)
}
#: Invariants: name to (tensor, its entry).
INVARIANTS: dict[str, tuple[str, Invariant]] = {
    item.name: (row.name, item) for row in _ROWS for item in row.invariants
}
#: Variables that are negative nowhere, sizes of vectors among them.
POSITIVE = frozenset(
    [row.name for row in _ROWS if row.positive]
    + [row.size[0] for row in _ROWS if row.size[0]]
    + [name for name, (_, item) in INVARIANTS.items() if item.positive]
)
