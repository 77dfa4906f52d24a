"""The models of the built-in examples."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from corota import mesh as meshes
from corota.model.contact import RigidCurve
from corota.model.materials import Elastic
from corota.model.model import Model
from corota.model.paths import DisplacementControl
from corota.model.plasticity import Mises
from corota.model.steps import Static


def gripper() -> Model:
    """A compliant gripper, cut from one plate; its pin is pulled until the jaws nearly meet."""
    model = Model(meshes.read(Path(__file__).with_name("gripper.msh")), name="gripper")
    model.section(element="Q4I", material=Elastic(E=1600.0, nu=0.35), thickness=5.0)
    model.fix("bolts")
    model.fix("pin", x=-3.3)
    model.steps = [Static(increments=10)]
    return model


def rollup() -> Model:
    """A thin strip rolled up to a full circle by a moment on its end."""
    model = Model(meshes.rectangle(10.0, 0.1, nx=100, ny=1), name="rollup")
    model.section(element="Q4D", material=Elastic(E=1.2e6, nu=0.0))
    model.fix("left", rotation=True)
    model.force("right", moment=20.0 * np.pi)  # 2 pi E I / L
    model.steps = [Static(increments=20)]
    return model


def hinge() -> Model:
    """A notch hinge bent by a moment on its end."""
    mesh = meshes.rectangle(36.0, 7.0, nx=36, ny=8)
    x, y = mesh.points[:, 0] - 18.0, mesh.points[:, 1] - 3.5
    arc = 1.0 + 2.0 * (6.0 - np.sqrt(np.maximum(36.0 - x**2, 0.0)))
    mesh.points = np.column_stack([x, y * np.minimum(arc, 7.0) / 7.0])
    model = Model(mesh, name="hinge")
    model.section(element="Q4D", material=Elastic(E=3700.0, nu=0.4), thickness=10.0)
    model.fix("left")
    model.force("right", moment=200.0)
    model.steps = [Static(increments=10)]
    return model


def clip() -> Model:
    """A snap-fit clip that is pushed past a rigid catch, with friction and yielding."""
    xs, ys = np.array([(0.0, 2.0), (14.0, 2.0), (15.6, 4.0), (16.0, 4.0), (20.0, 1.4)]).T
    mesh = meshes.mapped(
        [
            lambda t: (20.0 * t, 0.0),
            lambda t: (20.0, 1.4 * t),
            lambda t: (20.0 * t, float(np.interp(20.0 * t, xs, ys))),
            lambda t: (0.0, 2.0 * t),
        ],
        nx=80,
        ny=4,
    )
    mesh.edge_sets["hook"] = np.vstack([mesh.edge_sets["top"], mesh.edge_sets["right"]])
    model = Model(mesh, name="clip")
    polymer = Mises(E=2300.0, nu=0.38, yield_stress=35.0, isotropic=150.0)
    model.section(element="Q4I", material=polymer, thickness=4.0)
    corners = [(20.5, 2.2), (20.5, 5.0), (23.0, 5.0), (23.0, 2.2)]
    catch = RigidCurve.polyline(corners, closed=True, fillet=1.0)
    # The fillet is as small as a few edges of the hook: see "Fillets of the size of an element".
    model.contact("hook", catch, method="node_to_segment", friction=0.2, name="catch")
    push = Static(first_increment=0.05)
    push.fix("left", x=10.0)
    model.steps = [push]
    return model


def bistable() -> Model:
    """A curved beam with clamped ends that snaps to its other shape; its path is followed."""
    length, rise, height = 100.0, 5.0, 2.0

    def arch(y: float) -> Callable[[float], tuple[float, float]]:
        return lambda t: (length * t, y + 0.5 * rise * (1.0 - float(np.cos(2.0 * np.pi * t))))

    sides = [
        arch(0.0),
        lambda t: (length, height * t),
        arch(height),
        lambda t: (0.0, height * t),
    ]
    mesh = meshes.mapped(sides, nx=60, ny=2)
    top = mesh.nodes_of("top")
    mesh.node_sets["crown"] = top[[int(np.argmin(np.abs(mesh.points[top, 0] - length / 2.0)))]]
    model = Model(mesh, name="bistable")
    model.section(element="Q4I", material=Elastic(E=2000.0, nu=0.35), thickness=5.0)
    model.fix("left")
    model.fix("right")
    model.force("crown", y=-1.0)
    model.steps = [Static(path=DisplacementControl("crown", "y", -11.0, increments=30))]
    return model


def seal() -> Model:
    """Half a rubber tube pressed into a groove until its inner walls are in contact."""
    mesh = meshes.annulus(3.2, 4.0, n_radial=3, n_around=40, angle=180.0, start=-90.0)
    rib = meshes.add_node(mesh, 0.0, 5.5, name="rib")
    model = Model(mesh, name="seal")
    rubber = Elastic(E=5.0, nu=0.45)
    model.section(element="Q4S", material=rubber, plane="strain", local_strain="logarithmic")
    model.fix("start", y=None)
    model.fix("end", y=None)
    groove = RigidCurve.polyline([(-4.0, -4.0), (4.6, -4.0), (4.6, 12.0)], fillet=1.0)
    tool = RigidCurve.arc((0.0, 5.5), 1.5, 45.0, -180.0, reference=rib)
    model.contact("outer", groove, name="groove")
    model.contact("outer", tool, name="rib")
    model.contact("inner", "inner", name="inside")
    model.fix("rib", y=None, rotation=True)
    press = Static(first_increment=0.05)
    press.fix("rib", x=None, y=-6.0)
    model.steps = [press]
    return model


#: Examples by name; each function builds one.
MODELS: dict[str, Callable[[], Model]] = {
    "bistable": bistable,
    "clip": clip,
    "gripper": gripper,
    "hinge": hinge,
    "rollup": rollup,
    "seal": seal,
}
