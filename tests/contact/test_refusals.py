"""What cannot be contact is refused with names and a way out."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct


def model_of(gap=0.0, shared=False):
    low = ct.mesh.rectangle(2.0, 1.0, 4, 2)
    up = ct.mesh.rectangle(2.0, 1.0, 3, 2, origin=(0.0, 1.0 + gap))
    mesh = low if shared else ct.mesh.assembly(low=low, up=up)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("bottom" if shared else "low.bottom")
    return model


def refused(model, match):
    with pytest.raises(ct.InputError, match=match):
        ct.solve(model, threads=1)


def test_unknown_surface():
    with pytest.raises(ct.InputError, match=r"no edge set named 'nose'; the mesh has: low"):
        model_of().contact("nose", "low.top")


@pytest.mark.parametrize("names", [("nose", "low.top"), ("low.top", "UP.BOTTOM")])
@pytest.mark.parametrize("kind", [ct.ContactPair, ct.Tie])
def test_unknown_surface_of_an_object(names, kind):
    model = model_of()
    (model.contacts if kind is ct.ContactPair else model.ties).append(kind(*names))
    refused(model, r"no surface named '(nose|UP.BOTTOM)'; there are: low.bottom")


def test_edges_inside_a_body():
    model = model_of()
    model.mesh.edge_sets["cut"] = np.array([[0, 2], [1, 2]])
    model.contact("up.bottom", "cut")
    refused(model, r"surface 'cut' is not on the boundary: 2 of its 2 edges .* element 1")


def test_common_edges():
    model = model_of()
    model.mesh.edge_sets["more"] = model.mesh.edge_sets["low.top"][:2]
    model.contact("more", "low.top")
    refused(model, r"2 edges are on both surfaces, 'more' and 'low.top'")


def test_common_nodes():
    model = model_of(shared=True)
    model.contact("top", "right")
    refused(model, r"share node \d+, so they cannot separate there")


def test_surfaces_that_look_away():
    model = model_of()
    model.contact("up.top", "low.bottom")
    refused(model, r"no edge of 'up.top' faces any edge of 'low.bottom'")


def test_reference_node_that_is_not_there():
    model = model_of()
    model.contact("up.bottom", ct.RigidCurve.line((-1, 1), (3, 1), reference=999))
    refused(model, r"reference node index 999")


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"method": "magic"}, "no contact method 'magic'"),
        ({"friction": -0.1}, "friction of a contact pair must be a number >= 0"),
        ({"friction": None}, "friction of a contact pair must be a number >= 0"),
        ({"start": "now"}, "no start .now.; there are keep, adjust, ramp"),
        ({"clearance": np.nan}, "clearance of a contact pair must be finite"),
    ],
)
def test_bad_numbers(options, match):
    with pytest.raises(ct.InputError, match=match):
        model_of().contact("up.bottom", "low.top", **options)


def test_bad_curves_and_laws():
    with pytest.raises(ct.InputError, match="has no length"):
        ct.RigidCurve.line((1, 1), (1, 1))
    with pytest.raises(ct.InputError, match=r"fillet 0\.9 does not fit at point 2"):
        ct.RigidCurve.polyline([(0, 0), (1, 0), (1, 1)], fillet=0.9)
    with pytest.raises(ct.InputError, match="must increase strictly"):
        ct.PressureLaw("tabular", [0.0, 2.0, 1.0], [0.0, 0.1, 0.2])
    with pytest.raises(ct.InputError, match="no pressure law 'soft'; there are linear"):
        ct.PressureLaw("soft", 1.0)


def test_a_body_that_nothing_holds_sideways():
    model = model_of()
    model.traction("up.top", y=-1.0)
    model.contact("up.bottom", "low.top")
    with pytest.raises(ct.SingularError, match="unconstrained"):
        ct.solve(model, threads=1)
