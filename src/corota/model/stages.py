"""Stages: groups of nodes that move as one body, whose motion, force and stiffness are measured."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import shlex
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.display import Brief
from corota.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from corota.arrays import Floats, Ints
    from corota.mesh import Mesh


#: Named axes of a stage: components of its motion along x, along y and about z.
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "rotation": (0.0, 0.0, 1.0)}
#: Key of an allowable for fatigue, beside the names of variables.
FATIGUE = "fatigue"


@dataclass(repr=False)
class Stage(Brief):
    """A group of nodes that moves as one body; every frame gets its measures.

    The measures are explained in docs/measures.md.

    Parameters
    ----------
    name : str
    nodes : str or array_like of int
        Set, selection or node indices: a rigid group, or the reference node of a rigid body.
    axis : {"x", "y", "rotation"} or array_like, shape (2,)
        Wanted motion: a direction, or the rotation. All other motion is parasitic.
    point : array_like, shape (2,), optional
        Undeformed place of the reference point, which moves with the stage [length]; the mean of
        the nodes by default. Displacements and moments are those of this point.
    against : str or array_like of int, optional
        Nodes of another body, or the name of a stage before; motion, force and stiffness are then
        those relative to it, in axes that move with it.
    input : str
        Name of the stage that drives this one, defined before: for ratios and efficiency.
    allowable : mapping of str to float, optional
        Largest allowed size of variables at points, such as ``{"MISES": 400.0}`` or
        ``{"EP1": 0.01}``. ``{"fatigue": (endurance, ultimate)}`` is the line of Goodman for a
        principal stress between zero and its value, compression without benefit.
    stiffness : bool
        Compute the 3 x 3 tangent stiffness of each frame of static steps: one factorization.
    """

    name: str
    nodes: str | Ints
    axis: str | tuple[float, float] = "y"
    point: tuple[float, float] | None = None
    against: str | Ints | None = None
    input: str = ""
    allowable: Mapping[str, Any] = field(default_factory=dict)
    stiffness: bool = True

    def __post_init__(self) -> None:
        if not self.name or ":" in self.name:
            raise InputError(f"a stage needs a name without colons, not {self.name!r}")
        _direction(self.name, self.axis)
        for key, value in self.allowable.items():
            limits = np.atleast_1d(np.asarray(value, dtype=np.float64))
            if len(limits) != (2 if key == FATIGUE else 1) or not (limits > 0.0).all():
                wanted = "(endurance, ultimate)" if key == FATIGUE else "one number"
                raise InputError(f"stage {self.name!r}: the allowable {key} is {wanted} > 0")

    @property
    def direction(self) -> Floats:
        """Components of the wanted motion along x, along y and about z, shape (3,)."""
        return _direction(self.name, self.axis)

    @property
    def text(self) -> str:
        """The stage as a line that :meth:`Stages.add_stage` takes.

        Raises
        ------
        InputError
            If its nodes have no name.
        """
        words = [self.name]
        for key, where in (("nodes", self.nodes), ("against", self.against)):
            if where is None or (key == "nodes" and isinstance(where, str) and where == self.name):
                continue
            if not isinstance(where, str):
                raise InputError(f"stage {self.name!r}: give its nodes a name, as a set")
            words.append(f"{key}={where}")
        words.append(f"axis={self.axis if isinstance(self.axis, str) else _text(self.axis)}")
        if self.point is not None:
            words.append(f"point={_text(self.point)}")
        if self.input:
            words.append(f"input={self.input}")
        words += [f"{key}={_text(value)}" for key, value in self.allowable.items()]
        if not self.stiffness:
            words.append("stiffness=no")
        return shlex.join(words)

    def place(self, mesh: Mesh) -> Floats:
        """Undeformed place of the reference point, shape (2,) [length]."""
        if self.point is not None:
            return np.asarray(self.point, dtype=np.float64)
        return np.asarray(mesh.points[mesh.node_indices(self.nodes)].mean(axis=0))


def _direction(name: str, axis: str | tuple[float, float]) -> Floats:
    """Unit vector of the wanted motion, shape (3,)."""
    if isinstance(axis, str):
        if axis not in AXES:
            raise InputError(
                f"stage {name!r}: the axis is 'x', 'y', 'rotation' or a direction, not {axis!r}"
            )
        return np.array(AXES[axis])
    x, y = np.asarray(axis, dtype=np.float64)
    size = math.hypot(x, y)
    if not 0.0 < size < math.inf:
        raise InputError(f"stage {name!r}: the direction {axis} has no length")
    return np.array([x / size, y / size, 0.0])


def _text(values: Any) -> str:
    return ",".join(repr(float(value)) for value in np.ravel(values))


class Stages:
    """Methods of models that define stages."""

    mesh: Mesh
    stages: list[Stage]

    if TYPE_CHECKING:

        def _nodes(self, where: str | ArrayLike) -> str | Ints: ...

    def stage(
        self,
        name: str,
        nodes: str | ArrayLike | None = None,
        *,
        axis: str | ArrayLike,
        point: ArrayLike | None = None,
        against: str | ArrayLike | None = None,
        input: str = "",
        allowable: Mapping[str, Any] | None = None,
        stiffness: bool = True,
    ) -> None:
        """Measure a body in every frame: motion, force, stiffness, snap loads, margin.

        Parameters
        ----------
        name : str
            For histories: ``results.history("travel", at=name)``.
        nodes : str or array_like of int, optional
            The set of that name by default.
        axis, point, against, input, allowable, stiffness
            See :class:`corota.model.stages.Stage`.

        Raises
        ------
        InputError
            If a set or the stage `input` is unknown, or the name is taken.

        Examples
        --------
        >>> import corota as ct
        >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
        >>> model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.0))
        >>> model.fix("left")
        >>> model.force("right", y=0.001)
        >>> model.stage("tip", "right", axis="y")
        >>> results = ct.solve(model, ct.Static(), threads=1)
        >>> round(float(results.history("stiffness xx", at="tip")[0]), 6)  # E A / L
        100.0
        """
        before = {stage.name: stage.nodes for stage in self.stages}
        if name in before:
            raise InputError(f"there is a stage {name!r} already")
        if isinstance(against, str):
            against = before.get(against, against)
        if input and input not in before:
            raise InputError(f"stage {name!r}: define the stage {input!r} that drives it before")
        self.stages.append(
            Stage(
                name,
                self._nodes(name if nodes is None else nodes),
                axis if isinstance(axis, str) else _pair(axis),
                None if point is None else _pair(point),
                None if against is None else self._nodes(against),
                input,
                {k if k == FATIGUE else k.upper(): v for k, v in (allowable or {}).items()},
                stiffness,
            )
        )

    def add_stage(self, text: str) -> None:
        """Define a stage by a line of text, as the option ``--stage`` does.

        Parameters
        ----------
        text : str
            Name of the stage, which is that of its set, and words as in a shell: ``axis=x``,
            ``y``, ``rotation`` or ``1,0.5``; ``nodes=SET``; ``point=0,0``; ``against=SET``;
            ``input=STAGE``; ``stiffness=no``; allowables such as ``MISES=400`` or
            ``fatigue=200,600``.

        Raises
        ------
        InputError
            If a word is not of this form.

        Examples
        --------
        >>> import corota as ct
        >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
        >>> model.add_stage("right axis=y MISES=400")
        >>> model.stages[0].allowable
        {'MISES': 400.0}
        """
        try:
            name, *words = shlex.split(text)
        except ValueError as error:
            raise InputError(f"stage {text!r}: {error}") from None
        options: dict[str, Any] = {}
        allowable: dict[str, Any] = {}
        for word in words:
            key, sign, value = word.partition("=")
            if not (key and sign and value):
                raise InputError(f"stage {text!r}: {word!r} is not of the form KEY=VALUE")
            if key in ("nodes", "against", "input"):
                options[key] = value
            elif key == "stiffness":
                options[key] = value.lower() not in ("no", "off", "0", "false")
            elif key == "axis" and value in AXES:
                options[key] = value
            else:
                numbers = _numbers(text, word, value)
                if key in ("axis", "point"):
                    options[key] = numbers
                else:
                    allowable[key] = numbers if len(numbers) > 1 else numbers[0]
        if "axis" not in options:
            raise InputError(
                f"stage {text!r}: name the wanted motion: axis=x, y, rotation or a direction 1,0.5"
            )
        self.stage(name, allowable=allowable, **options)


def _numbers(text: str, word: str, value: str) -> tuple[float, ...]:
    try:
        return tuple(float(part) for part in value.split(","))
    except ValueError:
        raise InputError(f"stage {text!r}: {word!r} needs numbers") from None


def _pair(values: ArrayLike) -> tuple[float, float]:
    array = np.asarray(values, dtype=np.float64)
    if array.shape != (2,) or not np.isfinite(array).all():
        raise InputError(f"a point or a direction has two finite components, not {values!r}")
    return float(array[0]), float(array[1])
