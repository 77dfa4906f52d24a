"""Results of an increment: a frame, and the fields of its blocks of elements."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from corota.arrays import Bools, Floats, Ints
from corota.display import Brief


@dataclass(repr=False)
class PointFields(Brief):
    """Values at the quadrature points of the cells of one block (same element, section).

    Parameters
    ----------
    element : str
    cells : ndarray of int, shape (n,)
        Global cell indices.
    points : ndarray, shape (n, p, 2)
        Current positions of the quadrature points [length].
    shape : ndarray, shape (p, k)
        Shape functions at the points, for extrapolation to the k cell nodes.
    frame_rotation : ndarray, shape (n,)
        Rotation of the element frame [rad].
    volume : ndarray, shape (n, p)
        Reference volume of each point [length^3].
    values : dict of str to ndarray
        ``S`` stress (n, p, 4) and ``E`` strain (n, p, 4), rows xx, yy, zz, xy in global axes,
        shear strain engineering; scalars (n, p): ``MISES``, ``ENER``, later ``PEEQ``, ...
    forces : ndarray, shape (n, k, m), or None
        Forces (and moments, m = 3) of the k nodes on each element in global axes; None if they were
        not recorded [force, force*length].
    fibers : ndarray, shape (n, s, f, 3), or None
        Axial stress, total strain and equivalent plastic strain of plastic beams at the stations
        along the axis, the first and the last at the nodes, and at the fibers of the profile.
    """

    element: str
    cells: Ints
    points: Floats
    shape: Floats
    frame_rotation: Floats
    volume: Floats
    values: dict[str, Floats]
    forces: Floats | None = None
    fibers: Floats | None = None


@dataclass(repr=False)
class Frame(Brief):
    """One converged increment.

    Parameters
    ----------
    step, increment : int
        From 1; increment 0 is the state at the start.
    time, step_time : float
        Total and step time [time].
    factor : float
        Load factor: fraction of the step's loads.
    U : ndarray, shape (n_nodes, 2)
        Displacement [length].
    UR : ndarray, shape (n_nodes,)
        Drilling rotation [rad], 0 at nodes without one.
    RF : ndarray, shape (n_nodes, 3)
        Reaction force and moment: internal minus external.
    F : ndarray, shape (n_nodes, 3)
        External force and moment.
    fields : list of PointFields
    scalars : dict of str to float
        ``strain energy``, ``external work``, ``iterations``, ...
    V, A : ndarray, shape (n_nodes, 3), or None
        Velocity and acceleration, the rotation's last; in dynamic steps.
    C : ndarray, shape (n_nodes, 5), or None
        Contact at slave nodes, 0 elsewhere: pressure, shear traction (positive along the slave
        surface, the body on the left), gap, slip so far, status (0 open, 1 closed, 2 slipping);
        tractions per reference area.
    H : ndarray, shape (n_nodes, 6), or None
        Of a harmonic response: amplitudes of the displacements, their phases, amplitudes of the
        reactions, each x and y, without the state that it is about.
    constraint_force : ndarray, shape (n_nodes, 3), or None
        Force and moment of constraints on nodes, and in motion of inertia and damping: the part of
        the internal force that neither loads nor supports carry. Not stored in files.
    pairs : dict of str to ndarray, shape (n_nodes, 5)
        The same for each contact pair, where there are several.
    averages : mapping of str to ndarray
        Stress, strain and others at the nodes by the names they have in result files; of frames
        of files that hold no values at quadrature points.
    cell_averages : mapping of str to ndarray
        The same at the cells, rows of all cells: ``cell stress``, ``cell N``, ...
    section_averages : dict of int to mapping
        The same at the nodes of each section group: ``nodes``, ``S``, ``E``, scalars.
    extremes : mapping of str to ndarray, shape (10,)
        Smallest and largest value at points: value, index of the cell, point from 0, position x
        and y; of frames of files that hold no values at quadrature points.
    T : ndarray, shape (n_nodes,), or None
        Temperature, of models with temperatures.
    cells_with : dict of str to ndarray of bool, shape (n_cells,)
        Cells that have a variable, where there are no values at points.
    absent : frozenset of str
        Attributes that a file does not contain, such as ``RF``; they are NaN.
    """

    step: int
    increment: int
    time: float
    step_time: float
    factor: float
    U: Floats
    UR: Floats
    RF: Floats
    F: Floats
    fields: list[PointFields] = field(default_factory=list)
    scalars: dict[str, float] = field(default_factory=dict)
    V: Floats | None = None
    A: Floats | None = None
    C: Floats | None = None
    constraint_force: Floats | None = None
    pairs: dict[str, Floats] = field(default_factory=dict)
    averages: Mapping[str, Floats] = field(default_factory=dict)
    cell_averages: Mapping[str, Floats] = field(default_factory=dict)
    section_averages: dict[int, Mapping[str, Floats]] = field(default_factory=dict)
    extremes: Mapping[str, Floats] = field(default_factory=dict)
    T: Floats | None = None
    cells_with: dict[str, Bools] = field(default_factory=dict)
    absent: frozenset[str] = frozenset()
    H: Floats | None = None
