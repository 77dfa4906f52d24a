# SPDX-License-Identifier: BSD-3-Clause
"""Gaps and slips of contact pairs: derivatives, invariance, and integrals known in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from corota._core import Contact
from corota.model.contact import METHODS

Array = NDArray[np.float64]
BULGE = {"linear": 0.0, "quadratic": 0.0, "drilling": 1.5}

LENGTHS = {"reach": 1.0, "margin": 0.5}


def chain(
    kind: str, points: Array, first: int, bow: float = 0.0
) -> tuple[Array, NDArray[np.int64], Array]:
    """Nodes (n, 3), edges (m, 3) and bulge factors (m,) of a chain of edges through points.

    ``bow`` moves the middle nodes outwards (to the right of the way of the chain).
    """
    n = len(points)
    edges = np.column_stack([np.arange(n - 1), np.arange(1, n), np.full(n - 1, -1 - first)]) + first
    if kind == "quadratic":
        edges[:, 2] = first + n + np.arange(n - 1)
        chord = np.diff(points, axis=0)
        middle = points[:-1] + 0.5 * chord + bow * chord[:, ::-1] * [1, -1]
        points = np.vstack([points, middle])
    nodes = np.column_stack([points, np.zeros(len(points))])
    return nodes, edges.astype(np.int64), np.full(n - 1, BULGE[kind])


def arch(x: Array, rise: float, slope: float = 0.0) -> Array:
    return np.column_stack([x, rise + slope * x + 0.05 * x * x])


def moved(X: Array, rng: np.random.Generator) -> Array:
    """Positions and rotations near the reference ones."""
    return X + rng.normal(size=X.shape) * [0.01, 0.01, 0.05]


def two_bodies(slave: str, master: str, method: str, **more: object) -> tuple[Array, Contact]:
    """A slave of three edges below a master of three that does not match it."""
    s = chain(slave, arch(np.linspace(1, 0, 4), 0.0), 0, 0.02)
    m = chain(master, arch(np.linspace(-0.21, 1.13, 4), 0.02, 0.02), len(s[0]), -0.02)
    X = np.vstack([s[0], m[0]])
    thick = np.full(len(s[1]), 2.0)
    options = {"method": method, **LENGTHS, **more}
    return X, Contact.edges(X, s[1], s[2], thick, m[1], m[2], **options)


def gradients(d: dict[str, Array], contact: Contact, size: int) -> tuple[Array, Array]:
    """Full directions (K, size) of the tractions of gaps and slips."""
    full = [np.zeros((len(contact.nodes), size)) for _ in range(2)]
    for a, key in zip(full, ("gap_gradient", "slip_gradient"), strict=True):
        for k, v, g in zip(d["constraint"], d["variables"], d[key], strict=True):
            np.add.at(a[k], v[v >= 0], g[v >= 0])
            assert not g[v < 0].any()
    return full[0], full[1]


def hessian(contact: Contact, p: Array, q: Array, size: int) -> Array:
    full = np.zeros((size, size))
    for v, h in zip(*contact.hessian(p, q)[1:], strict=True):
        used = v >= 0
        np.add.at(full, np.ix_(v[used], v[used]), h[np.ix_(used, used)])
    return full


def check_derivatives(contact: Contact, x: Array, old: Array, rng: np.random.Generator) -> None:
    """Gradients and Hessians against central differences; round-off over the step 1e-6.

    The gradient of a slip is the direction of its traction, not that of the path so far.
    """
    assert contact.search(x)
    assert not contact.search(x)
    d = contact.evaluate(x, old)
    assert len(d["gap"]) > 0
    n, size = len(contact.nodes), x.size
    p, q = rng.normal(size=(2, n))
    G, _ = gradients(d, contact, size)
    H = hessian(contact, p, np.zeros(n), size)
    assert np.array_equal(H, H.T)
    H = hessian(contact, p, q, size)
    step = 1e-6
    for i in range(size):
        sides = []
        for sign in (1, -1):
            y = x.copy()
            y.flat[i] += sign * step
            d = contact.evaluate(y, old)
            g, s = gradients(d, contact, size)
            sides.append((d["total_gap"], p @ g + q @ s))
        dG, dH = ((a - b) / (2 * step) for a, b in zip(*sides, strict=True))
        np.testing.assert_allclose(G[:, i], dG, atol=1e-8)
        np.testing.assert_allclose(H[:, i], dH, atol=1e-8 * max(1.0, abs(H).max()))


def check_first_slip(contact: Contact, x: Array) -> None:
    """Where contact was closed, a slip begins along the direction of its traction."""
    contact.search(x)
    size = x.size
    _, S = gradients(contact.evaluate(x, x), contact, size)
    closed = np.ones(len(contact.nodes), bool)
    step = 1e-6
    for i in range(size):
        sides = []
        for sign in (1, -1):
            y = x.copy()
            y.flat[i] += sign * step
            sides.append(contact.evaluate(y, x, closed)["total_slip"])
        np.testing.assert_allclose(S[:, i], (sides[0] - sides[1]) / (2 * step), atol=1e-8)


def check_invariance(contact: Contact, x: Array, old: Array) -> None:
    """Forces without resultant or moment about the origin, for any pressures and tractions."""
    contact.search(x)
    rigid = np.zeros((3, len(x), 3))
    rigid[0, :, 0] = rigid[1, :, 1] = rigid[2, :, 2] = 1
    rigid[2, :, 0], rigid[2, :, 1] = -x[:, 1], x[:, 0]
    for gradient in gradients(contact.evaluate(x, old), contact, x.size):
        assert abs(gradient).max() > 0.01
        assert abs(gradient @ rigid.reshape(3, -1).T).max() < 1e-14


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("master", ["linear", "quadratic", "drilling"])
@pytest.mark.parametrize("slave", ["linear", "quadratic", "drilling"])
def test_gap_and_slip_have_exact_derivatives(slave: str, master: str, method: str) -> None:
    rng = np.random.default_rng(1)
    X, contact = two_bodies(slave, master, method)
    x, old = moved(X, rng), moved(X, rng)
    check_derivatives(contact, x, old, rng)
    check_invariance(contact, x, old)
    if METHODS[method]["integrates"] or master == "linear":
        check_first_slip(contact, x)


@pytest.mark.parametrize("master", ["linear", "quadratic", "drilling"])
@pytest.mark.parametrize("slave", ["linear", "quadratic", "drilling"])
def test_ties_have_exact_derivatives_and_no_strain(slave: str, master: str) -> None:
    """The jump stays zero under rigid motion although the meshes do not match."""
    rng = np.random.default_rng(2)
    X, contact = two_bodies(slave, master, "tie")
    d = contact.evaluate(X, X)
    assert abs(d["gap"]).max() < 1e-15
    turn = np.array([[0, -1], [1, 0]])
    x = np.column_stack([X[:, :2] @ turn.T + [3, 4], X[:, 2] + np.pi / 2])
    d = contact.evaluate(x, X)
    assert abs(d["gap"]).max() < 1e-14
    assert abs(d["slip"]).max() < 1e-14
    check_derivatives(contact, moved(X, rng), X, rng)


RIGID = {
    "line": [[-0.3, 0.12, 1.4, 0.1, 0, 0, 0]],
    "chain": [[-0.3, 0.1, 0.4, 0.08, 0, 0, 0], [0.4, 0.08, 1.4, 0.12, 0, 0, 0]],
    "solid": [[0.5, 2.11, 0, 0, 0.5, 1.11, 2 * np.pi]],
    "hollow": [[0.5, 3.05, 0, 0, 0.5, -1.0, -2 * np.pi]],
}


def against_rigid(curve: str, kind: str, method: str, node: bool) -> tuple[Array, Contact]:
    below = curve == "hollow"
    points = arch(np.linspace(1, 0, 4), 3.0 if below else 0.0)
    s = chain(kind, points, 0, 0.02)
    X = np.vstack([s[0], [[0.5, 1.0, 0.0]]])
    thick = np.full(len(s[1]), 2.0)
    rows = np.array(RIGID[curve], dtype=float)
    where = (len(X) - 1, (0.0, 0.0)) if node else (-1, (0.0, 0.0))
    return X, Contact.rigid(X, s[1], s[2], thick, rows, *where, method=method, **LENGTHS)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("kind", ["linear", "quadratic", "drilling"])
@pytest.mark.parametrize("curve", list(RIGID))
def test_rigid_curves_have_exact_derivatives(curve: str, kind: str, method: str) -> None:
    rng = np.random.default_rng(3)
    X, contact = against_rigid(curve, kind, method, node=True)
    x, old = moved(X, rng), moved(X, rng)
    check_derivatives(contact, x, old, rng)
    check_invariance(contact, x, old)
    if METHODS[method]["integrates"] or curve == "line":
        check_first_slip(contact, x)


@pytest.mark.parametrize("method", METHODS)
def test_fixed_curve_equals_one_at_a_still_node(method: str) -> None:
    rng = np.random.default_rng(4)
    results = []
    for node in (True, False):
        X, contact = against_rigid("solid", "quadratic", method, node)
        x = moved(X, np.random.default_rng(4))
        x[-1] = X[-1]
        contact.search(x)
        results.append(contact.evaluate(x, X))
        if not node:
            check_derivatives(against_rigid("solid", "linear", method, node)[1], x[:5], X[:5], rng)
    for key in ("total_gap", "total_slip", "total_area"):
        np.testing.assert_allclose(results[0][key], results[1][key], atol=1e-15)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("kind", ["linear", "quadratic", "drilling"])
def test_self_contact_has_exact_derivatives(kind: str, method: str) -> None:
    """A hairpin: both legs belong to one boundary."""
    rng = np.random.default_rng(7)
    there, back = np.linspace(1, 0, 4), np.linspace(-0.13, 1.1, 4)
    path = np.vstack([arch(there, 0.0), arch(back, 0.05)])
    X, edges, bulge = chain(kind, path, 0)
    ones = np.ones(len(edges))
    contact = Contact.itself(X, edges, bulge, ones, method=method, **LENGTHS)
    x, old = moved(X, rng), moved(X, rng)
    check_derivatives(contact, x, old, rng)
    check_invariance(contact, x, old)
