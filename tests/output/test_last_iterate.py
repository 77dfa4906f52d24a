# SPDX-License-Identifier: BSD-3-Clause
"""Where the last attempt of a run that stopped ended: in Python, in a file, as a picture."""

import h5py
import numpy as np
import pytest

import corota as ct
from corota import cli


def slope(friction):
    """A block on a slope of 30 degrees: it rests for friction above tan 30 = 0.577."""
    mesh = ct.mesh.move(ct.mesh.rectangle(1.0, 0.4, 4, 2), angle=30.0)
    model = ct.Model(mesh, name="slope")
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
    model.gravity(y=-10.0)
    c, s = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    line = ct.RigidCurve.line((-5 * c, -5 * s), (5 * c, 5 * s))
    model.contact("bottom", line, friction=friction, name="slope")
    return model


def test_a_run_that_stopped_shows_its_last_iterate(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    step = ct.Static(smallest_increment=0.1)
    with pytest.raises(ct.ConvergenceError, match="--last-iterate") as found:
        ct.solve(slope(0.5), step, observers=[ct.JobFiles(tmp_path)], threads=1)
    frame = found.value.results.last_iterate
    assert frame.U.shape == (15, 2)
    assert np.isfinite(frame.U).all()
    assert np.abs(frame.RF[:, :2]).max() > 0.0  # out of balance
    assert (tmp_path / "slope.last_iterate.vtkhdf").exists()
    assert cli.main(["plot", "slope.vtkhdf", "--last-iterate", "--field", "U"]) == 0
    assert len(list(tmp_path.glob("*.png"))) == 1
    # A run that ends well takes the file away, and the command says so.
    results = ct.solve(slope(0.6), step, observers=[ct.JobFiles(tmp_path)], threads=1)
    assert results.last_iterate is None
    assert cli.main(["plot", "slope.vtkhdf", "--last-iterate"]) == 2
    assert "stopped without convergence" in capsys.readouterr().err


def arrays(path):
    """All numbers of a file by their names."""
    found = {}

    def note(name, each):
        if isinstance(each, h5py.Dataset):
            found[name] = each[()]

    with h5py.File(path) as file:
        file.visititems(note)
    return found


@pytest.mark.parametrize(("step", "force"), [(ct.Static, -1.5), (ct.Dynamic, -6.0)])
def test_a_resumed_run_that_stops_at_once_has_its_last_iterate(step, force, tmp_path):
    """The file has the state before it, too, as that of the whole run has.

    First nothing was written, and an empty hidden file was left; then the iterate alone.
    """
    mesh = ct.mesh.rectangle(8.0, 1.0, 8, 2)
    model = ct.Model(mesh, name="job")
    last = 15.0 if step is ct.Dynamic else 8.0
    metal = ct.Mises(E=1000.0, nu=0.3, yield_curve=[(8.0, 0.0), (last, 0.1)], rho=1.0)
    model.section("all", element="Q4", material=metal)
    model.fix("left")
    model.force("right", y=force)
    model.steps = [step(period=1.5, first_increment=0.1, fixed_increments=True)]
    with pytest.raises(ct.ConvergenceError):
        ct.solve(model, observers=[ct.JobFiles(tmp_path, checkpoint_every=1)], threads=1)
    iterate = tmp_path / "job.last_iterate.vtkhdf"
    whole = arrays(iterate)
    iterate.unlink()
    with pytest.raises(ct.ConvergenceError):
        ct.resume(tmp_path / "job", model=model, threads=1)
    resumed = arrays(iterate)
    assert len(resumed["VTKHDF/Steps/Values"]) == 2
    assert resumed.keys() == whole.keys()
    for name, values in whole.items():
        np.testing.assert_array_equal(resumed[name], values, err_msg=name)
    assert not list(tmp_path.glob(".job*"))
