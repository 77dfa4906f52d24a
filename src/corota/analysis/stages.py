"""Stages: motion, force and condensed stiffness of the bodies that a model measures."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.linear.factor import Factor
from corota.analysis.terms.linearized import Linearized
from corota.arrays import Floats, Ints, distinct
from corota.errors import InputError, ModelError, SingularError
from corota.model.stages import FATIGUE, Stage
from corota.results.averaging import Averaging, section_of_cells
from corota.results.body_motion import BodyMotion, fit_rigid_motion
from corota.results.extremes import WIDTH, row_of
from corota.results.measures import StagePath, measure_values
from corota.results.table import NODAL, variables

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.model.model import Model
    from corota.results.frame import Frame


#: Distance from a rigid motion, relative to it, up to which constrained nodes are one body.
RIGID = 1e-9


class StageRecorder:
    """Adds the measures of all stages to the scalars of each frame."""

    def __init__(self, system: System, model: Model) -> None:
        self.paths: dict[str, StagePath] = {}
        self._bodies: dict[str, tuple[_Body, _Body | None]] = {}
        #: Nodal averages, in which margins see the surface that the points stay away from.
        self._averaging = Averaging(model.mesh, section_of_cells(model))
        for stage in model.stages:
            _check(stage, model)
            base = None if stage.against is None else _Body(system, stage, stage.against)
            self._bodies[stage.name] = (_Body(system, stage, stage.nodes), base)
            driver = self.paths[stage.input] if stage.input else None
            self.paths[stage.name] = StagePath(stage.direction, stage.place(model.mesh), driver)

    def add(
        self, system: System, u: Floats, frame: Frame, time: float | None, notes: list[str]
    ) -> None:
        """Measure all stages in a committed state, whose frame this is.

        Parameters
        ----------
        u : ndarray, shape (n_dofs,)
        time : float or None
            Step time of an equilibrium; None in motion, which has no stiffness alone.
        notes : list of str
            Gets a note where there is no stiffness.
        """
        stages = system.model.stages
        linear = None
        if time is not None and any(stage.stiffness for stage in stages):
            linear = Linearized(system, u, time=time)
        for stage in stages:
            body, base = self._bodies[stage.name]
            path = self.paths[stage.name]
            where = path.reference
            moved, origin = body.motion(frame, where), np.zeros(3)
            if base is not None:
                origin = base.motion(frame, where)
            # Relative to the base, in axes that move with it.
            turn = _turn(origin[2])
            motion = np.append(turn.T @ (moved[:2] - origin[:2]), moved[2] - origin[2])
            place = where + moved[:2]
            force = body.force(frame, place)
            matrix, free = np.full((3, 3), np.nan), np.eye(3)
            if linear is not None and stage.stiffness:
                at = place if system.nlgeom else where
                try:
                    matrix = condensed_stiffness(linear, body, base, at)
                    free = free_motions(linear, body, at, path.direction, turn)
                except SingularError as error:
                    notes.append(
                        f"stage {stage.name!r}, step {frame.step}, increment {frame.increment}: no "
                        f"stiffness, because the structure beside it is singular: {error}"
                    )
            force[:2] = turn.T @ force[:2]
            matrix[:2] = turn.T @ matrix[:2]
            matrix[:, :2] = matrix[:, :2] @ turn
            path.add(motion, force, matrix, free, self._utilization(stage, frame))
            values = measure_values(path)
            frame.scalars |= {f"{stage.name}: {name}": value for name, value in values.items()}

    def _utilization(self, stage: Stage, frame: Frame) -> Floats:
        """Largest share of an allowable that is used: share, element, x, y; NaN without one."""
        used = np.full(4, np.nan)
        labels = self._averaging.mesh.cell_labels
        for name, limit in stage.allowable.items():
            for value, cell, _, x, y in _candidates(frame, self._averaging, name):
                share = _goodman(value, *limit) if name == FATIGUE else abs(value) / float(limit)
                if not share <= used[0]:
                    used = np.array([share, labels[int(cell)], x, y])
        return used


class _Body:
    """Nodes that move together, and the unknowns that move them."""

    def __init__(self, system: System, stage: Stage, where: str | Ints) -> None:
        mesh = system.model.mesh
        self.name = stage.name
        self.nodes = distinct(mesh.node_indices(where))
        self.points = mesh.points[self.nodes]
        dofs = [system.dofs(self.nodes, component) for component in range(3)]
        #: Whether the nodes lie at different places, so that their displacements give a rotation.
        self.apart = bool(np.ptp(self.points, axis=0).any())
        if not self.apart and (dofs[2] < 0).all():
            raise InputError(
                f"stage {stage.name!r}: a body needs two nodes at different places, or a node that "
                "rotates, such as the reference node of a rigid body"
            )
        self.dofs = np.concatenate(dofs)
        self.dofs = np.sort(self.dofs[self.dofs >= 0])
        #: Independent dofs that move them: those of a rigid body are at its reference node.
        moving = self.dofs
        for _ in range(system.constraints.depth + 1):
            more = [r.masters for r in system.constraints.relations if _meet(r.dependent, moving)]
            moving = distinct(np.concatenate([moving, *more]))
        self.unknowns = moving[system.constraints.place[moving] < 0]
        #: Nodes at which forces on the body may be given.
        self.loaded = distinct(np.concatenate([self.nodes, system.node_of_dof[self.unknowns]]))
        self.loaded_points = mesh.points[self.loaded]

    def motion(self, frame: Frame, where: Floats) -> Floats:
        """Displacement of a point that moves with the body, and rotation, shape (3,)."""
        U, UR = frame.U[self.nodes][None], frame.UR[self.nodes][None]
        if self.apart:
            found = fit_rigid_motion(self.points, U, UR)
        else:
            found = BodyMotion(self.points[0], U.mean(axis=1), UR.mean(axis=1), np.zeros(1))
        return np.append(found.displacement(where)[0], found.rotation[0])

    def force(self, frame: Frame, place: Floats) -> Floats:
        """Force on the body and its moment about a current place, shape (3,)."""
        force = (frame.RF + frame.F)[self.loaded]
        arm = self.loaded_points + frame.U[self.loaded] - place
        moment = arm[:, 0] @ force[:, 1] - arm[:, 1] @ force[:, 0] + force[:, 2].sum()
        return np.array([*force[:, :2].sum(axis=0), moment])


def condensed_stiffness(
    linear: Linearized, body: _Body, base: _Body | None, place: Floats
) -> Floats:
    """Tangent stiffness of a body at a place, shape (3, 3): all other free dofs are condensed.

    Supports of the body are released, a base is fixed. Closed surfaces stay closed and stick, what
    has yielded unloads.

    Parameters
    ----------
    linear : Linearized
        The tangent of all unknowns.
    body : _Body
        Moves as a rigid body.
    place : ndarray, shape (2,)
        Current place of the point that forces act on and moments are about [length].

    Raises
    ------
    SingularError
        If what is condensed has a free motion.
    InputError
        If constraints couple the body with others.
    """
    system = linear.system
    rigid, arm = _rigid_motions(linear, place)
    rows = np.searchsorted(linear.free, body.unknowns)
    z = np.zeros((linear.n, 3))
    z[rows] = rigid[body.unknowns]
    moved = linear.expand(z)
    error = np.abs(moved[body.dofs] - rigid[body.dofs]).max(axis=0, initial=0.0)
    if (error > RIGID * np.abs(rigid[body.dofs]).max(axis=0, initial=0.0)).any():
        raise InputError(
            f"stage {body.name!r}: constraints couple its nodes with other bodies, so that it "
            "cannot move as one body; take the nodes of one body"
        )
    fixed = linear.constrained.copy()
    fixed[rows] = True
    if base is not None:
        fixed[np.searchsorted(linear.free, base.unknowns)] = True
    rest = np.flatnonzero(~fixed)
    stiffness = linear.stiffness.tocsr()
    if len(rest):
        inner = stiffness[rest][:, rest].tocsc()
        threads = getattr(system.linear.solver, "threads", 1)
        factor = Factor(
            inner, linear.symmetric, linear.node[rest], linear.multiplier[rest], threads
        )
        z[rest] = -factor.solve(np.asfortranarray(stiffness[rest] @ z))
    found = z[rows].T @ (stiffness[rows] @ z)
    if system.nlgeom:
        # The arms of the forces on the body turn with it.
        reaction = system.by_node(linear.reaction)[:, :2]
        nodes = distinct(system.node_of_dof[body.unknowns])
        found[2, 2] -= float((reaction[nodes] * arm[nodes]).sum())
    return np.asarray(found)


def free_motions(
    linear: Linearized, body: _Body, place: Floats, direction: Floats, turn: Floats
) -> Floats:
    """Motions of a body that its supports leave free, and the one along its axis, shape (3, k).

    Parameters
    ----------
    turn : ndarray, shape (2, 2)
        Rotation of the axes in which `direction` and the motions are given.
    """
    rigid, arm = _rigid_motions(linear, place)
    length = float(np.abs(arm).max()) or 1.0
    scale = np.array([1.0, 1.0, 1.0 / length])
    supported = body.unknowns[linear.system.constrained[body.unknowns]]
    _, size, rows = np.linalg.svd(rigid[supported] * scale)
    rank = int((size > RIGID * size.max(initial=0.0)).sum())
    axes = np.eye(3)
    axes[:2, :2] = turn.T
    motions = np.column_stack([direction, axes @ (scale[:, None] * rows[rank:].T)])
    # An orthogonal basis: the axis may be among the free motions.
    left, size, _ = np.linalg.svd(motions / scale[:, None], full_matrices=False)
    return np.asarray(scale[:, None] * left[:, size > RIGID * size.max()])


def _rigid_motions(linear: Linearized, place: Floats) -> tuple[Floats, Floats]:
    """Two translations and a rotation about a place, shape (n_dofs, 3), and arms of the nodes."""
    system = linear.system
    points = system.model.mesh.points
    current = points + system.by_node(linear.u)[:, :2] if system.nlgeom else points
    arm = current - place
    return system.rigid_motions(arm), arm


def _meet(some: Ints, others: Ints) -> bool:
    return bool(np.isin(some, others).any())


def _turn(angle: float) -> Floats:
    cos, sin = np.cos(angle), np.sin(angle)
    return np.array([[cos, -sin], [sin, cos]])


def _check(stage: Stage, model: Model) -> None:
    if stage.name in {pair.name for pair in model.contacts}:
        raise ModelError(f"a stage and a contact pair have the same name, {stage.name!r}")
    points = {name for row in variables().values() if not row.frame for name in row.names}
    for name in stage.allowable:
        if name != FATIGUE and name not in points:
            raise InputError(
                f"stage {stage.name!r}: no variable {name!r} at points; there are "
                f"{', '.join(sorted(points - set(NODAL)))}, and {FATIGUE}"
            )


def _candidates(frame: Frame, averaging: Averaging, name: str) -> list[Floats]:
    """Extremes of a variable at points and nodes, for fatigue those of principal stresses.

    Each is value, cell, point (-1 of a nodal value), x, y.
    """
    found = []
    if name == "MISES" and frame.H is not None:
        name = "MISESA"  # at resonance the stress of the instant of the largest load vanishes
    for variable in ("SP1", "SP3") if name == FATIGUE else (name,):
        row = row_of(frame, variable)
        if row is not None:
            found += [row[:WIDTH], row[WIDTH:]]
        for value, cell, node in averaging.extremes(frame.fields or [], variable):
            place = averaging.mesh.points[node] + frame.U[node]
            found.append(np.array([value, cell, -1.0, *place]))
    return found


def _goodman(stress: float, endurance: float, ultimate: float) -> float:
    """Used share of the line of Goodman for a stress between zero and a value."""
    return 0.5 * abs(stress) / endurance + 0.5 * max(stress, 0.0) / ultimate
