# SPDX-License-Identifier: BSD-3-Clause
"""Which parts of boundaries meet: search, sight, self-contact, hand-over; slip across edges."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from corota._core import Contact
from corota.model.contact import METHODS

Array = NDArray[np.float64]


def path(points: Array, first: int = 0, closed: bool = False) -> NDArray[np.int64]:
    """Straight edges through points in their order."""
    n = len(points)
    start = np.arange(n if closed else n - 1)
    return np.column_stack([start, (start + 1) % n, np.full(len(start), -1 - first)]) + first


def nodes(*parts: Array) -> Array:
    points = np.vstack(parts)
    return np.column_stack([points, np.zeros(len(points))])


def flat(x: Array, y: float) -> Array:
    return np.column_stack([x, np.full(len(x), y)])


def pair(slave: Array, master: Array, **options: object) -> tuple[Array, Contact]:
    X = nodes(slave, master)
    s, m = path(slave), path(master, len(slave))
    options = {"reach": 0.5, "margin": 0.5, **options}
    ones = np.ones(len(s))
    return X, Contact.edges(X, s, 0 * ones, ones, m, np.zeros(len(m)), **options)


def gap_of(contact: Contact, x: Array, old: Array | None = None) -> dict[str, Array]:
    contact.search(x)
    d = contact.evaluate(x, old)
    with np.errstate(invalid="ignore"):
        d["mean"] = d["total_gap"] / d["total_area"]
        d["path"] = d["total_slip"] / d["total_area"]
    return d


def test_partly_covered_edges_integrate_only_the_covered_part() -> None:
    """One edge from 1 to 0 under a master from 0.25 on, gap 0.1 + 0.2 x.

    It ends on both sides: its gaps are those at the ends of the covered part, on half of it each.
    """
    slave = flat(np.array([1.0, 0.0]), 0.0)
    master = np.array([[0.25, 0.15], [2.25, 0.55]])
    X, contact = pair(slave, master, reach=2.0)
    d = gap_of(contact, X)
    for k, end in enumerate((1.0, 0.25)):
        np.testing.assert_allclose(d["total_area"][k], 0.375, rtol=1e-14)
        np.testing.assert_allclose(d["total_gap"][k], 0.375 * (0.1 + 0.2 * end), rtol=1e-13)
    np.testing.assert_allclose(contact.full_area, 0.5)


@pytest.mark.parametrize("method", METHODS)
def test_offset_is_taken_off_the_gap(method: str) -> None:
    slave = flat(np.linspace(1, 0, 4), 0.0)
    X, contact = pair(slave, flat(np.linspace(-0.3, 1.4, 5), 0.25), method=method)
    contact.offset = 0.1 * X[contact.nodes, 0]
    d = gap_of(contact, X)
    if not METHODS[method]["integrates"]:
        np.testing.assert_allclose(d["mean"], 0.25 - contact.offset)
    np.testing.assert_allclose(d["total_gap"].sum(), 0.25 - 0.05)


@pytest.mark.parametrize("method", METHODS)
def test_slip_runs_on_across_edges_and_a_rigid_motion_gives_none(method: str) -> None:
    """A slave that slides over several master edges, itself carried away and turned."""
    slave = flat(np.linspace(1, 0, 5), 0.0)
    X, contact = pair(slave, flat(np.linspace(-2, 3, 40), 0.0), method=method, reach=2.0)
    angle = 2.0
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    x = X.copy()
    x[:5, 0] -= 0.77  # along the tangent of the slave edges, which run to the left
    x[:, :2] = x[:, :2] @ turn + [5, -3]
    d = gap_of(contact, x, X)
    np.testing.assert_allclose(d["path"], 0.77, rtol=1e-13)
    np.testing.assert_allclose(d["mean"], 0.0, atol=1e-14)
    x = X.copy()
    x[:, :2] = X[:, :2] @ turn + [5, -3]
    np.testing.assert_allclose(gap_of(contact, x, X)["path"], 0.0, atol=1e-14)


def test_search_finds_what_all_pairs_find() -> None:
    rng = np.random.default_rng(5)
    s = np.cumsum(rng.normal(size=(60, 2)), axis=0)
    m = np.cumsum(rng.normal(size=(70, 2)), axis=0)
    reach, margin = 0.4, 0.2
    X, contact = pair(s, m, reach=reach, margin=margin)
    contact.search(X)
    found = {tuple(row) for row in contact.candidates()}

    def boxes(p: Array) -> tuple[Array, Array]:
        return np.minimum(p[:-1], p[1:]), np.maximum(p[:-1], p[1:])

    (a0, a1), (b0, b1) = boxes(s), boxes(m)
    grow = reach + margin
    meet = ((a0[:, None] - grow <= b1) & (b0 <= a1[:, None] + grow)).all(axis=2)
    unit = [np.diff(p, axis=0) for p in (s, m)]
    unit = [u / np.linalg.norm(u, axis=1)[:, None] for u in unit]
    meet &= unit[0] @ unit[1].T < 0.7
    assert found == {tuple(row) for row in np.argwhere(meet)}
    assert 0 < len(found) < 0.2 * meet.size


def test_candidates_stay_while_nothing_moved_far() -> None:
    X, contact = pair(flat(np.linspace(1, 0, 4), 0.0), flat(np.linspace(-2, 3, 40), 0.1))
    assert contact.search(X)
    x = X.copy()
    x[:4, 0] += 0.24
    assert not contact.search(x)
    x[:4, 0] += 0.24
    assert contact.search(x)


def test_a_turn_alone_renews_the_candidates() -> None:
    """A short edge that turns on the spot from looking away to facing the master."""
    X, contact = pair(flat(np.array([0.5, 0.51]), 0.0), flat(np.array([0.0, 1.0]), 0.1))
    contact.search(X)
    assert len(contact.candidates()) == 0
    x = X.copy()
    x[:2, 0] = 0.51, 0.5
    assert contact.search(x)
    assert gap_of(contact, x)["mean"] == pytest.approx(0.1)


def test_the_nearer_of_two_masters_hides_the_other() -> None:
    slave = flat(np.linspace(1, 0, 3), 0.0)
    near, far = flat(np.linspace(0.5, 3, 3), 0.1), flat(np.linspace(-1, 3, 3), 0.4)
    X = nodes(slave, near, far)
    m = np.vstack([path(near, 3), path(far, 6)])
    ones = np.ones(2)
    contact = Contact.edges(X, path(slave), 0 * ones, ones, m, np.zeros(4), reach=1.0, margin=0.1)
    d = gap_of(contact, X)
    np.testing.assert_allclose(d["total_area"], contact.full_area)
    np.testing.assert_allclose(d["total_gap"].sum(), 0.5 * 0.1 + 0.5 * 0.4)


@pytest.mark.parametrize("method", METHODS)
def test_strip_folded_on_itself_meets_its_face_not_its_back(method: str) -> None:
    """A U-shaped strip of thickness 0.1 whose legs are 0.05 apart: only the inner faces meet."""
    n = 20
    outer, inner = np.linspace(0, 2, n + 1), np.linspace(0.2, 2, n + 1)
    lower = [flat(outer, 0.0), flat(inner[::-1], 0.1)]
    upper = [flat(inner, 0.15), flat(outer[::-1], 0.25)]
    ring = np.vstack(lower + upper)
    X, e = nodes(ring), path(ring, closed=True)
    ones = np.ones(len(e))
    contact = Contact.itself(X, e, 0 * ones, ones, method=method, reach=0.4, margin=0.1)
    d = gap_of(contact, X)
    seen = d["total_area"] > 1e-12
    met = X[contact.nodes[seen]]
    # The later face of the contour is the slave, so that each pair counts once.
    np.testing.assert_allclose(met[:, 1], 0.15)
    assert seen.sum() >= n - 1
    np.testing.assert_allclose(d["mean"][seen], 0.05, rtol=1e-12)


def test_side_of_a_tilted_block_is_not_its_foot() -> None:
    """A rigid block that stands on one corner, 8 degrees askew: only its foot faces the slave."""
    slave = flat(np.linspace(2, -2, 9), 0.0)
    X = np.vstack([nodes(slave), [[0.0, 0.0, 0.0]]])
    e = path(slave)
    ones = np.ones(len(e))
    rows = np.array([[-1, 1, -1, 0, 0, 0, 0], [-1, 0, 1, 0, 0, 0, 0], [1, 0, 1, 1, 0, 0, 0]], float)
    contact = Contact.rigid(
        X, e, 0 * ones, ones, rows, len(slave), (0.0, 0.0), reach=1.0, margin=0.5
    )
    x = X.copy()
    x[-1, 2] = angle = np.radians(8.0)
    d = gap_of(contact, x)
    np.testing.assert_allclose(d["total_area"].sum(), 2 * np.cos(angle), rtol=1e-12)
    np.testing.assert_allclose(d["total_gap"].sum(), 0.0, atol=1e-12)


def test_nodes_keep_their_edge_until_clearly_past_its_end() -> None:
    """A node beside a vertex of a bent master: the edge it had holds it for a twentieth."""
    master = np.array([[-1.0, 0.1], [0.0, 0.0], [1.0, 0.1]])  # valley seen from below: ridge
    slave = np.array([[0.2, -0.05], [-0.2, -0.05]])
    X, contact = pair(slave, master, method="node_to_segment")

    def edge(x0: float) -> int:
        x = X.copy()
        x[0, 0] = x0
        contact.search(x)
        d = contact.evaluate(x)
        return int(contact.candidates()[d["pair"][d["constraint"] == 0][0], 1])

    assert edge(0.1) == 1
    contact.commit()
    assert edge(0.0) == 1
    assert edge(-0.01) == 1
    assert edge(-0.1) == 0
    assert edge(0.01) == 0
    contact.restore()
    assert edge(0.0) == 1


def test_short_edges_far_from_the_origin_stay_covered() -> None:
    """A quadratic edge of length 0.08 at 8 and at 800, under the joint of two pieces of a disc."""
    rng = np.random.default_rng(6)
    for shift in (0.0, 8.0, 800.0):
        X = nodes(np.array([[0.05, 0.0], [-0.03, 0.0], [0.01, 0.0], [0.0, 1.0]]))
        X[:, 0] += shift
        rows = np.array([[shift + 1, 1, 0, 0, shift, 1, 2 * np.pi]])
        edge = np.array([[0, 1, 2]])
        contact = Contact.rigid(
            X, edge, np.zeros(1), np.ones(1), rows, 3, (0.0, 0.0), reach=0.4, margin=0.2
        )
        for _ in range(20):
            x = X.copy()
            x[:3, :2] += 1e-3 * rng.normal(size=(3, 2))
            d = gap_of(contact, x)
            np.testing.assert_allclose(d["total_area"], contact.full_area, rtol=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_threads_do_not_change_a_bit(method: str) -> None:
    x = np.linspace(1, 0, 101)
    slave = np.column_stack([x, 0.03 * x * x])
    X, contact = pair(slave, flat(np.linspace(-0.01, 1.02, 88), 0.02), method=method, reach=0.1)
    results = []
    for threads in (1, 2, 3):
        contact.threads = threads
        contact.search(X)
        results.append(contact.evaluate(X, X))
    for other in results[1:]:
        for key, value in results[0].items():
            assert np.array_equal(value, other[key])


def test_bad_input_is_named() -> None:
    slave, master = flat(np.linspace(1, 0, 3), 0.0), flat(np.linspace(0, 1, 3), 0.1)
    with pytest.raises(ValueError, match="no contact discretization"):
        pair(slave, master, method="dual")
    with pytest.raises(ValueError, match="reach and depth"):
        pair(slave, master, reach=-1.0)
    with pytest.raises(ValueError, match="edge 0 - 1 has no length"):
        pair(0 * slave, master)
    X, edges = nodes(slave), path(slave)
    none, ones = np.zeros(len(edges)), np.ones(len(edges))
    with pytest.raises(ValueError, match="tie joins two boundaries"):
        Contact.itself(X, edges, none, ones, method="tie", reach=1.0, margin=1.0)
