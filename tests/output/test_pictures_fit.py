"""Texts stay inside of pictures, and what cannot be negative is drawn so."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import corota as ct
from corota import plots
from corota.io.result_reader import read_results
from corota.plots.contour import Drawing
from corota.plots.figure import finish, look, new_figure
from corota.results.sampling import sampled
from corota.results.table import POSITIVE

if TYPE_CHECKING:
    from pathlib import Path

NAME = "a_rather_long_job_name_of_a_cantilever_under_load_version_2_final"


def bent(width: float = 4.0, height: float = 1.0, name: str = NAME) -> ct.Results:
    """Plastic bending of quadratic elements: steep fronts, on which parabolas undershoot."""
    model = ct.Model(ct.mesh.rectangle(width, height, 8, 4, "quad8"), name=name)
    steel = ct.Mises(210e3, 0.3, yield_stress=250.0, isotropic=1000.0)
    model.section(element="Q8R", material=steel, plane="strain", local_strain="logarithmic")
    tall = height > width
    model.fix("bottom" if tall else "left")
    model.fix("top" if tall else "right", x=0.2 if tall else None, y=None if tall else -0.2)
    return ct.solve(model, ct.Static(increments=3), threads=1)


@pytest.fixture(scope="module")
def results() -> ct.Results:
    return bent()


def outside(figure: Any) -> list[str]:
    """Texts of titles and labels that leave the figure."""
    figure.canvas.draw()
    renderer = figure._get_renderer()
    wide, high = figure.bbox.width, figure.bbox.height
    found = []
    for ax in figure.axes:
        for text in (ax._left_title, ax.xaxis.label, ax.yaxis.label):
            box = text.get_window_extent(renderer)
            # Layouts round to pixels.
            inside = min(box.x0, box.y0) > -2.0 and box.x1 < wide + 2.0 and box.y1 < high + 2.0
            if text.get_text() and not inside:
                found.append(text.get_text())
    return found


PICTURES = {
    "contour": lambda r: r.plot("MISES"),
    "plastic": lambda r: r.plot("PEEQ"),
    "curve": lambda r: r.history("RF2", at="left").plot(against=r.history("U2", at="right")),
    "model": lambda r: r.model.plot(),
    "principal": lambda r: plots.principal(r),
    "flow": lambda r: plots.flow(r),
    "along": lambda r: r.along([(0.5, 0.0), (0.5, 1.0)]).plot("S11"),
}


def test_a_stress_bar_names_the_values_at_points(results: ct.Results) -> None:
    label = results.plot("MISES", path=None).axes[-1].get_xlabel().replace("\n", " ")
    at = results.extremes("MISES")
    assert f"(extrapolated; points {at.smallest.value:.5g} ... {at.largest.value:.5g})" in label
    assert "points" not in results.plot("U1").axes[-1].get_xlabel()


def test_a_rigid_body_is_drawn_with_its_parts() -> None:
    mesh = ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1)
    hub = ct.mesh.add_node(mesh, 12.0, 0.5, name="hub")
    model = ct.Model(mesh)
    model.section(element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.rigid("right", hub)
    model.force("hub", y=-0.1)
    results = ct.solve(model, ct.Static(increments=1), threads=1)
    place = mesh.points[hub] + results.frames[-1].U[hub]
    drawn = results.plot("MISES").axes[0].collections
    paths = [p.vertices for c in drawn if hasattr(c, "get_segments") for p in c.get_paths()]
    assert any(np.allclose(path[-1], place) for path in paths if len(path) == 2)


@pytest.mark.parametrize("picture", PICTURES)
def test_no_text_leaves_the_picture(results: ct.Results, picture: str) -> None:
    assert not outside(PICTURES[picture](results))


@pytest.mark.parametrize("shape", [(0.5, 4.0), (1.0, 1.0), (20.0, 1.0)])
def test_no_text_leaves_pictures_of_any_shape(shape: tuple[float, float]) -> None:
    assert not outside(bent(*shape).plot("MISES"))


def test_a_picture_is_laid_out_until_it_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    from matplotlib.layout_engine import ConstrainedLayoutEngine as Engine

    lay_out, count = Engine.execute, []
    monkeypatch.setattr(Engine, "execute", lambda *a: (count.append(1), lay_out(*a)))
    bent(name="beam").model.plot()
    assert len(count) <= 3  # the last moves nothing, and no text is broken


def test_pictures_of_a_column_fit(results: ct.Results) -> None:
    with plots.width_of(85.0):
        assert not outside(results.plot("MISES"))


def test_axes_of_others_are_left_alone(results: ct.Results) -> None:
    from matplotlib import pyplot

    _figure, (left, right) = pyplot.subplots(1, 2)
    left.set_title("mine and very long, " * 8, loc="left")
    results.plot("MISES", ax=right)
    assert left.get_title(loc="left") == "mine and very long, " * 8


def test_no_variable_is_drawn_below_zero_that_cannot_be(results: ct.Results) -> None:
    undershoot = False
    for name in {*POSITIVE} & {*results.variables()}:
        for per_cell in (False, True):
            if per_cell and name in ("U", "RF", "F"):
                continue
            assert Drawing(results, name, per_cell).range(-1)[0] >= 0.0
        assert results.along([(0.0, 0.13), (4.0, 0.13)], points=200)[name].min() >= 0.0
        part = Drawing(results, name, False).parts[0][1]
        undershoot |= bool(part.values(results.nodal(name)).min() < 0.0)
    assert undershoot  # else the case shows nothing


def test_invariants_between_nodes_are_those_of_the_components(
    results: ct.Results, tmp_path: Path
) -> None:
    """Mises of interpolated stresses, from memory and from a file; at nodes nothing changes."""
    line = results.along([(0.1, 0.3), (3.9, 0.7)], points=50)
    s = {c: line[f"S{c}"] for c in ("11", "22", "33", "12")}
    square = (s["11"] - s["22"]) ** 2 + (s["22"] - s["33"]) ** 2 + (s["33"] - s["11"]) ** 2
    wanted = np.sqrt(0.5 * square + 3.0 * s["12"] ** 2)
    np.testing.assert_allclose(line["MISES"], wanted, rtol=1e-12)
    path = results.write(tmp_path / "a.vtkhdf")
    with read_results(path) as again:
        found = again.along([(0.1, 0.3), (3.9, 0.7)], points=50)["MISES"]
    np.testing.assert_allclose(found, wanted, rtol=1e-9)
    nodes = sampled(results, "MISES", -1, lambda nodal: nodal)
    np.testing.assert_array_equal(nodes, results.nodal("MISES"))


def test_the_plastic_boundary_goes_with_any_variable(results: ct.Results) -> None:
    plain, with_line = (results.plot("MISES", plastic=p) for p in (False, True))
    more = len(with_line.axes[0].collections) - len(plain.axes[0].collections)
    assert more == 1
    labels = [
        "".join(ax.get_xlabel() + ax.get_ylabel() for ax in f.axes) for f in (plain, with_line)
    ]
    assert ["boundary of the flow" in " ".join(text.split()) for text in labels] == [False, True]
    elastic = ct.Model(ct.mesh.rectangle(1.0, 1.0, 2, 2))
    elastic.section(element="Q4", material=ct.Elastic(1.0))
    elastic.fix("left")
    elastic.fix("right", x=0.01, y=None)
    with pytest.raises(ct.InputError, match="no plastic strain"):
        ct.solve(elastic, ct.Static(), threads=1).plot("MISES", plastic=True)


def test_logarithmic_axes_have_plain_numbers(tmp_path: Path) -> None:
    """Texts are not read as mathematics (names may hold a dollar sign), so powers are no markup."""
    with look():
        figure = new_figure(4.0, 3.0, shown=False)
        ax = figure.add_subplot()
        ax.loglog([10.0, 1000.0], [2e-3, 0.5])
        finish(figure, tmp_path / "errors.png", dpi=80.0)
        shown = [t.get_text() for axis in (ax.xaxis, ax.yaxis) for t in axis.get_ticklabels()]
    assert {"0.01", "100"} <= set(shown)
    assert not any("$" in text for text in shown)
