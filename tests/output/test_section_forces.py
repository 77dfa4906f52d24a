"""Section forces of cuts and of line elements: statics, closed forms, files, pictures."""

# SPDX-License-Identifier: BSD-3-Clause

import warnings

import numpy as np
import pytest

import corota as ct
from corota import plots
from corota.cli import main
from corota.io.result_reader import read_results
from corota.mesh import Mesh
from corota.mesh.data import Cells
from corota.results.variables import labeled
from support.pairs import cover

KINDS = {"T3": "tri3", "OPT": "tri3", "T6": "tri6", "Q8R": "quad8", "Q8": "quad8", "Q9": "quad9"}
ELEMENTS = ("T3", "T6", "Q4", "Q4I", "Q4S", "Q4R", "Q8", "Q8R", "Q9", "OPT", "Q4D", "Q4DI")
#: Rounding of sums of forces that balance to the tolerance of Newton's method.
EXACT = 1e-8


def cantilever(
    element="Q4I", force=-1e-3, nlgeom=True, increments=1, material=None, keep=None, **options
):
    mesh = ct.mesh.rectangle(10.0, 1.0, nx=20, ny=2, cell=KINDS.get(element, "quad4"))
    model = ct.Model(mesh, name="cantilever")
    material = material or ct.Elastic(E=1e3, nu=0.3)
    model.section("all", element=element, material=material, thickness=0.5, **options)
    model.fix("left")
    model.force("right", y=force, total=True)
    return ct.solve(model, ct.Static(nlgeom=nlgeom, increments=increments), threads=1)


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("x", [4.0, 4.13])
def test_cantilever_has_the_forces_of_statics(element, x):
    results = cantilever(element, nlgeom=False)
    cut = results.section((x, -0.5), (x, 1.0))
    assert cut.method == "element forces"
    assert pytest.approx(0.0, abs=1e-9) == cut.N
    assert pytest.approx(-1e-3, rel=EXACT) == cut.V
    assert pytest.approx(-1e-3 * (10.0 - x), rel=EXACT) == cut.M
    assert cut.length == pytest.approx(1.0)
    assert np.allclose(cut.center, [x, 0.5])


@pytest.mark.parametrize("element", ["T3", "Q4I", "Q9"])
def test_center_of_a_cut_with_nodal_thickness_is_the_centroid_of_its_area(element):
    """Thickness 1 + 0.4 y over 0 <= y <= 1: the centroid is at (1/2 + 0.4/3) / 1.2.

    A force on the end is distributed over its area, so that it acts there and bends nothing.
    """
    mesh = ct.mesh.rectangle(4.0, 1.0, nx=8, ny=2, cell=KINDS.get(element, "quad4"))
    model = ct.Model(mesh)
    material = ct.Elastic(E=1e3, nu=0.3)
    model.section("all", element=element, material=material, thickness=1 + 0.4 * mesh.points[:, 1])
    model.fix("left")
    model.force("right", x=2.0)
    cut = ct.solve(model, ct.Static(nlgeom=False)).section((1.75, 0.0), (1.75, 1.0))
    assert np.allclose(cut.center, [1.75, (0.5 + 0.4 / 3.0) / 1.2])
    assert pytest.approx(0.0, abs=EXACT) == cut.M


def test_a_cut_the_other_way_has_the_same_forces_but_for_the_sides():
    results = cantilever()
    one, other = results.section((4, 0), (4, 1)), results.section((4, 1), (4, 0))
    assert np.allclose(one.force, -other.force, atol=1e-12)
    assert pytest.approx(-one.M, rel=1e-6) == other.M  # stretches the other side
    assert pytest.approx(one.V, rel=1e-6) == other.V


def test_three_point_bending():
    mesh = ct.mesh.rectangle(10.0, 1.0, nx=20, ny=4)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))

    def at(x, y):
        return [int(np.argmin(np.hypot(*(mesh.points - [x, y]).T)))]

    model.fix(at(0, 0))
    model.fix(at(10, 0), x=None, y=0.0)
    model.force(at(5, 1), y=-1e-3)
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    found = results.section_diagram([(0, 0.5), (10, 0.5)], 2.0, cuts=20)
    x = found.distance
    assert np.allclose(found.M, 0.5e-3 * np.minimum(x, 10 - x), atol=1e-10)
    assert np.allclose(found.V, np.where(x < 5, -0.5e-3, 0.5e-3), atol=1e-10)
    assert np.allclose(found.N, 0.0, atol=1e-10)


def ring(force, full):
    """A ring under two opposite forces that pull it apart along y."""
    mesh = ct.mesh.annulus(9.5, 10.5, n_radial=2, n_around=96, cell="quad8")
    model = ct.Model(mesh, name="ring")
    model.section("all", element="Q8R", material=ct.Elastic(E=1e4, nu=0.3))

    def at(x, y):
        return [int(np.argmin(np.hypot(*(mesh.points - [x, y]).T)))]

    for node in (at(0, 10.5), at(0, -10.5)):
        model.fix(node, x=0.0, y=None)
    for node in (at(9.5, 0), at(-9.5, 0)):
        model.fix(node, x=None, y=0.0)
    model.force(at(0, 10.5), y=force)
    model.force(at(0, -10.5), y=-force)
    return ct.solve(model, ct.Static(nlgeom=full), threads=1)


def test_one_leg_of_a_ring_has_the_closed_form():
    """A cut through one leg severs nothing: the forces are of the elements (Timoshenko 1956)."""
    force, radius, depth = 1e-3, 10.0, 1.0
    results = ring(force, full=False)
    cut = results.section((9.0, 0.0), (11.0, 0.0))
    assert cut.method == "element forces"
    assert pytest.approx(-0.5 * force * -1.0, rel=1e-6) == cut.N
    assert pytest.approx(0.0, abs=1e-6 * force) == cut.V
    shift = depth**2 / (12 * radius)  # of the neutral axis of a curved bar
    closed = 0.5 * force * radius * (1 - 2 / np.pi + 2 / np.pi * shift / radius)
    assert abs(cut.M) == pytest.approx(closed, rel=2e-3)
    # Below the load the arm of the other force is a radius longer.
    top = results.section((0.0, 9.0), (0.0, 11.0))
    assert abs(top.M) == pytest.approx(0.5 * force * radius - closed, rel=2e-3)


def test_both_legs_of_a_ring_in_large_displacements():
    results = ring(2.0, full=True)
    cut = results.section((-11.0, 0.0), (11.0, 0.0))
    assert np.allclose(cut.force, [0.0, -2.0], atol=2.0 * EXACT)
    assert np.allclose(cut.center, 0.0, atol=1e-6)


@pytest.mark.parametrize("element", ["Q4I", "Q8R", "Q4D", "T6"])
def test_large_rotation_balances_in_the_deformed_body(element):
    results = cantilever(element, force=-0.35, increments=2)
    frame = results.frame()
    load = results.model.mesh.points + frame.U
    cut = results.section((4.13, -1), (4.13, 2))
    assert np.allclose(cut.force, [0.0, -0.35], atol=EXACT)
    arm = load - cut.center
    moment = arm[:, 0] * frame.F[:, 1] - arm[:, 1] * frame.F[:, 0] + frame.F[:, 2]
    assert pytest.approx(moment.sum(), rel=EXACT) == cut.M
    assert np.hypot(cut.N, cut.V) == pytest.approx(0.35, rel=EXACT)
    assert cut.N > 0.08


@pytest.mark.parametrize("strain", ["linear", "logarithmic"])
@pytest.mark.parametrize("element", ["Q4I", "T6", "Q8R", "Q4", "OPT", "Q4R", "Q4D"])
def test_plastic_elements_balance(element, strain):
    material = ct.Mises(E=1e3, nu=0.3, yield_stress=2.0, isotropic=20.0)
    results = cantilever(element, force=-0.03, increments=6, material=material, local_strain=strain)
    for x in (0.4, 4.13):
        cut = results.section((x, -1), (x, 2))
        assert cut.method == "element forces"
        assert np.allclose(cut.force, [0.0, -0.03], atol=0.03 * EXACT)


@pytest.mark.parametrize(
    ("element", "strain"), cover(ELEMENTS, ["linear", "logarithmic"], strength=1)
)
def test_forces_balance_beside_a_rigid_body_with_heat_and_flow(element, strain, tmp_path):
    """No part can be cut free, and no force follows from displacements or stresses alone."""
    mesh = ct.mesh.rectangle(4.0, 1.0, nx=8, ny=2, cell=KINDS.get(element, "quad4"))
    node = ct.mesh.add_node(mesh, 4.5, 0.5)
    model = ct.Model(mesh)
    material = ct.Mises(E=1e3, nu=0.3, yield_stress=3.0, isotropic=10.0, expansion=1e-4)
    model.section("all", element=element, material=material, local_strain=strain)
    model.fix("left")
    model.rigid("right", node)
    model.fix([node], x=0.1, y=0.2, rotation=0.1)
    model.temperature(50.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of strain and of elements
        results = ct.solve(model, ct.Static(increments=4), threads=1)
    assert results.history("PEEQ").max() > 1e-3
    frame, left = results.frame(), mesh.node_sets["left"]
    place = mesh.points + frame.U
    path = results.write(tmp_path / "r.vtkhdf", points=True)
    for x in (2.25, 2.0):
        cut = results.section((x, -1.0), (x, 2.0))
        assert cut.method == "element forces"
        total = -frame.RF[left][:, :2].sum(axis=0)
        assert np.allclose(cut.force, total, atol=1e-6 * np.hypot(*total))
        arm = place[left] - cut.center
        moment = (arm[:, 0] * frame.RF[left, 1] - arm[:, 1] * frame.RF[left, 0]).sum()
        moment += frame.RF[left, 2].sum() if frame.RF.shape[1] > 2 else 0.0
        assert pytest.approx(-moment, abs=1e-6 * np.hypot(*total)) == cut.M
        with read_results(path) as found:
            again = found.section((x, -1.0), (x, 2.0))
        assert np.allclose([again.N, again.V, again.M], [cut.N, cut.V, cut.M], rtol=1e-9)


def test_heated_trusses_across_a_cut_have_their_forces():
    """Between walls: - E A alpha dT each, with small and with large displacements."""
    points = np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 1.0], [2.0, 1.0]])
    lines = Cells("line2", np.array([[0, 1], [2, 3]]), np.array([1, 2]))
    for nlgeom in (False, True):
        model = ct.Model(Mesh(points, [lines]))
        material = ct.Elastic(E=1e3, nu=0.3, expansion=1e-4)
        model.truss([0], material=material, area=0.5)
        model.truss([1], material=material, area=0.25)
        model.fix([0, 1, 2, 3])
        model.temperature(40.0)
        results = ct.solve(model, ct.Static(nlgeom=nlgeom), threads=1)
        cut = results.section((1.0, -1.0), (1.0, 2.0))
        assert cut.method == "element forces"
        assert pytest.approx(-1e3 * 0.75 * 4e-3, rel=1e-2) == cut.N
        assert pytest.approx(results.member_forces().N.sum(), rel=1e-9) == cut.N


def test_flow_in_one_leg_of_a_clamped_frame_balances():
    """No part can be cut free, and the force depends on the history."""
    mesh = ct.mesh.annulus(4.0, 6.0, n_radial=3, n_around=40)
    model = ct.Model(mesh)
    material = ct.Mises(E=1e3, nu=0.3, yield_stress=1.0, isotropic=50.0)
    model.section("all", element="Q4I", material=material)

    def at(x, y):
        return [int(np.argmin(np.hypot(*(mesh.points - [x, y]).T)))]

    model.fix(at(0, -6))
    model.fix(at(0, 6), x=0.0, y=None)
    model.force(at(0, 6), y=-0.8)
    results = ct.solve(model, ct.Static(increments=5), threads=1)
    assert results.history("PEEQ").max() > 1e-4
    legs = [results.section((a, 0.0), (a + 3.0, 0.0)) for a in (-6.5, 3.5)]
    assert {leg.method for leg in legs} == {"element forces"}
    assert np.allclose(legs[0].force + legs[1].force, [0.0, 0.8], atol=0.8 * EXACT)


def test_heated_bar_between_walls():
    mesh = ct.mesh.rectangle(10.0, 1.0, nx=10, ny=2)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.0, expansion=1e-5))
    model.fix("left", y=None)
    model.fix("right", y=None)
    model.fix([0], x=None, y=0.0)
    model.initial_temperature(0.0)
    model.temperature(100.0)
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    cut = results.section((4.6, 0), (4.6, 1))
    assert pytest.approx(-1.0, rel=1e-9) == cut.N
    assert pytest.approx(0.0, abs=1e-9) == cut.M


def test_files_give_the_same(tmp_path):
    results = cantilever(force=-0.35, increments=2)
    wanted = results.section((4.13, -1), (4.13, 2))
    for points, method in ((False, "free body"), (True, "element forces")):
        path = results.write(tmp_path / f"{points}.vtkhdf", points=points)
        with read_results(path) as found:
            cut = found.section((4.13, -1), (4.13, 2))
            assert cut.method == method
            assert pytest.approx([wanted.N, wanted.V, wanted.M], rel=1e-7) == [cut.N, cut.V, cut.M]


def test_one_leg_from_a_file_without_forces_is_integrated_from_the_stress(tmp_path):
    results = ring(1e-3, full=True)
    wanted = results.section((9.0, 0.0), (11.0, 0.0))
    # Relative to the stress of bending, of which the force is a small difference.
    size = results.history("MISES").max() * 1.0
    path = results.write(tmp_path / "nodes.vtkhdf")
    with read_results(path) as found, pytest.warns(UserWarning, match="integrated from stresses"):
        cut = found.section((9.0, 0.0), (11.0, 0.0))
    assert cut.method == "stress"
    assert pytest.approx(wanted.N, abs=0.01 * size) == cut.N
    assert pytest.approx(wanted.M, abs=0.01 * size / 6) == cut.M
    path = results.write(tmp_path / "points.vtkhdf", points=True)
    with read_results(path) as found:
        cut = found.section((9.0, 0.0), (11.0, 0.0))
    assert cut.method == "element forces"
    assert pytest.approx([wanted.N, wanted.V, wanted.M], rel=1e-12) == [cut.N, cut.V, cut.M]


def test_elements_whose_stress_is_not_all_are_refused_from_files(tmp_path):
    mesh = ct.mesh.annulus(9.0, 11.0, n_radial=2, n_around=40)
    model = ct.Model(mesh)
    model.section("all", element="Q4R", material=ct.Elastic(E=1e4, nu=0.3))
    model.fix("inner")
    model.force([0], y=0.1)
    path = ct.solve(model, threads=1).write(tmp_path / "r.vtkhdf")
    with read_results(path) as found, pytest.raises(ct.InputError, match="Q4R"):
        found.section((8.0, 0.1), (12.0, 0.1))


def test_cuts_that_are_none():
    results = cantilever()
    with pytest.raises(ct.InputError, match="begins inside element"):
        results.section((4.0, 0.3), (4.0, 2.0))
    with pytest.raises(ct.InputError, match="ends inside element"):
        results.section((4.1, -1.0), (4.1, 0.3))
    with pytest.raises(ct.InputError, match="meets no element"):
        results.section((14.0, 0.3), (14.0, 2.0))
    with pytest.raises(ct.InputError, match="two different points"):
        results.section((1.0, 1.0), (1.0, 1.0))
    with pytest.raises(ct.InputError, match="no trusses or beams"):
        results.member_forces()


def beam(force=-1e-3, nlgeom=False):
    points = np.column_stack([np.linspace(0.0, 10.0, 11), np.zeros(11)])
    lines = Cells("line2", np.stack([np.arange(10), np.arange(1, 11)], axis=1), np.arange(1, 11))
    model = ct.Model(Mesh(points, [lines]), name="beam")
    material = ct.Elastic(E=1e3, nu=0.3)
    model.beam(np.arange(10), material=material, area=0.5, inertia=0.5 / 12)
    model.fix([0], rotation=True)
    model.force([10], y=force)
    return ct.solve(model, ct.Static(nlgeom=nlgeom, increments=2), threads=1)


def test_beams_have_the_signs_of_cuts():
    members = beam().member_forces()
    ends = members.results.mesh.points[members.nodes][..., 0]
    assert np.allclose(members.V, -1e-3)
    assert np.allclose(members.M, -1e-3 * (10.0 - ends))
    assert np.allclose(members.N, 0.0)
    solid = cantilever(nlgeom=False).section((4.0, 0.0), (4.0, 1.0))
    cut = members.results.section((4.5, -1.0), (4.5, 1.0))
    assert pytest.approx(solid.V, rel=1e-6) == cut.V
    assert pytest.approx(-5.5e-3, rel=1e-6) == cut.M
    assert members.ends("N").shape == (10, 2)


def test_a_cut_through_a_bent_beam_balances():
    results = beam(-3.0, nlgeom=True)
    cut = results.section((4.5, -1.0), (4.5, 1.0))
    assert np.allclose(cut.force, [0.0, -3.0], atol=3e-8)
    members = results.member_forces()
    assert pytest.approx(members.N[4], rel=1e-6) == cut.N
    assert pytest.approx(members.V[4], rel=1e-6) == cut.V
    assert pytest.approx(members.M[4].mean(), rel=1e-6) == cut.M


@pytest.mark.usefixtures("quick_pictures")
def test_history_and_pictures(tmp_path):
    results = cantilever(force=-0.3, increments=3)
    history = results.section_history("M", (4.0, 0.0), (4.0, 1.0))
    assert history[0] == 0.0
    units = ct.Model(results.mesh)
    units.units("mm", "N")
    shear = results.section_history("V", (4.0, 0.0), (4.0, 1.0))
    assert labeled(shear.name, units.unit_system) == "section V [N]"  # no speed
    assert history[-1] == results.section((4.0, 0.0), (4.0, 1.0)).M
    file = results.write(tmp_path / "job.vtkhdf")
    lines = beam().write(tmp_path / "lines.vtkhdf")
    wanted = [
        ([file, "--section", "4", "0", "4", "1"], "section.png"),
        ([file, "--diagram", "0", "0.5", "10", "0.5", "2"], "diagram.png"),
        ([file, "--principal"], "principal.png"),
        ([file, "--flow"], "flow.png"),
        ([file, "--flow", "y", "--width", "85"], "flow85.svg"),
        ([lines, "--forces", "M"], "M.png"),
    ]
    for args, name in wanted:
        target = tmp_path / name
        assert main(["plot", *map(str, args), "-o", str(target), "-q"]) == 0
        assert target.stat().st_size > 2000
    assert main(["plot", str(file), "--width", "3", "-q"]) == 2


def test_principal_axes_of_known_tensors():
    from corota.plots.principal import principal_axes

    values, angle = principal_axes(np.array([[3.0, 1.0, 0.0], [0.0, 0.0, 2.0], [1.0, 3.0, 0.0]]))
    assert np.allclose(values, [[3, 1], [2, -2], [3, 1]])
    assert np.allclose(angle, [0.0, np.pi / 4, np.pi / 2])


def test_lines_of_force_keep_the_force_between_them():
    """In pure tension the lines are straight and even, and none crosses the free sides."""
    from matplotlib.collections import LineCollection

    mesh = ct.mesh.rectangle(10.0, 2.0, nx=20, ny=4)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left", y=None)
    model.fix([0])
    model.traction("right", x=1.0)
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    axes = plots.flow(results, "x", scale=0.0, path=None).axes[0]
    lines = [c for c in axes.collections if isinstance(c, LineCollection)][-1].get_segments()
    ends = np.array(lines)
    assert np.abs(np.diff(ends[..., 1], axis=1)).max() < 1e-6
    assert np.ptp(ends[..., 0]) > 9.5
