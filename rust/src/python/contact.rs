//! Python class of a contact pair.
// SPDX-License-Identifier: BSD-3-Clause

use crate::base::pool;
use crate::contact::active_set::Gradients;
use crate::contact::corners;
use crate::contact::discrete_gradient::discrete_gradient;
use crate::contact::discretization::{self, DISCRETIZATIONS, Entry};
use crate::contact::slave::Depth;
use crate::contact::terms::WIDTH;
use crate::contact::{Contact as Pair, Distances, Edge, Rigid, Shape, Surface, Terms};
use numpy::{IntoPyArray, PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

type Floats<'py> = PyReadonlyArray1<'py, f64>;
type Rows<'py> = PyReadonlyArray2<'py, f64>;
type Numbers<'py> = PyReadonlyArray2<'py, i64>;

pub(super) fn bad(text: impl Into<String>) -> PyErr {
    PyValueError::new_err(text.into())
}

/// Rows of `N` numbers.
pub(super) fn rows<'a, const N: usize, T: numpy::Element>(
    array: &'a PyReadonlyArray2<'_, T>,
    name: &str,
) -> PyResult<&'a [[T; N]]> {
    let shape = array.as_array().shape().to_vec();
    if shape[1] != N {
        return Err(bad(format!("{name} has rows of {}, not {N}", shape[1])));
    }
    Ok(array.as_slice()?.as_chunks::<N>().0)
}

/// Edges from their arrays; every fault is one the driver should have reported by name.
pub(super) fn edges(
    x: &[[f64; 3]],
    nodes: &Numbers,
    alpha: &Floats,
    side: &str,
) -> PyResult<Vec<Edge>> {
    let nodes = rows::<3, i64>(nodes, side)?;
    let alpha = alpha.as_slice()?;
    if alpha.len() != nodes.len() || nodes.is_empty() {
        return Err(bad(format!("{side}: {} edges, {} factors", nodes.len(), alpha.len())));
    }
    let edge = |(row, &alpha_b): (&[i64; 3], &f64)| {
        let n_nodes = if row[2] < 0 { 2 } else { 3 };
        let shape = Shape::Element;
        let (nodes, length, sagitta) = ([0; 3], 0.0, 0.0);
        let mut edge = Edge { nodes, shape, n_nodes, alpha_b, length, sagitta, half: None };
        for a in 0..n_nodes {
            edge.nodes[a] = u32::try_from(row[a])
                .ok()
                .filter(|&n| (n as usize) < x.len())
                .ok_or_else(|| bad(format!("{side}: node {} is out of range", row[a])))?;
        }
        let d = edge.place(x).d;
        edge.length = 2.0 * d[0].hypot(d[1]);
        if edge.length.is_nan() || edge.length <= 0.0 {
            return Err(bad(format!("{side}: edge {} - {} has no length", row[0], row[1])));
        }
        Ok(edge)
    };
    nodes.iter().zip(alpha).map(edge).collect()
}

/// Gives edges their shapes: 0 an element edge, 1 a piece of a spline, 2 and 3 halves of a side.
fn shape(edges: &mut [Edge], shapes: &[i64]) -> PyResult<()> {
    if shapes.len() != edges.len() {
        return Err(bad(format!("master: {} edges, {} shapes", edges.len(), shapes.len())));
    }
    for (edge, &shape) in edges.iter_mut().zip(shapes) {
        edge.shape = match (shape, edge.n_nodes) {
            (0, _) => Shape::Element,
            (1, 3) => Shape::Spline,
            (2, 2) => Shape::FirstHalf,
            (3, 2) => Shape::SecondHalf,
            _ => return Err(bad(format!("master: no shape {shape} of {} nodes", edge.n_nodes))),
        };
    }
    Ok(())
}

/// Facts of all discretizations: name, and whether it joins the surfaces or integrates.
#[pyfunction]
fn contact_methods(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    let facts = |entry: &Entry| {
        let d = PyDict::new(py);
        d.set_item("name", entry.name)?;
        d.set_item("joins", entry.joins)?;
        d.set_item("integrates", entry.integrates)?;
        Ok(d)
    };
    DISCRETIZATIONS.iter().map(facts).collect()
}

/// A pair of boundaries that may touch, or are tied.
///
/// Gap and slip of each constraint (a node of the slave side), the directions of their tractions as
/// functions of the nodal positions, and the exact derivatives of these. Edges are rows corner, corner, middle (-1 for
/// none) with the element on the left; configurations are arrays (n_nodes, 3) of x, y and
/// rotation; a variable is ``3 * node + component``.
#[pyclass(module = "corota._core")]
pub struct Contact {
    pair: Pair,
    n_nodes: usize,
    terms: Vec<Terms>,
    threads: usize,
}

/// Depths of the slave's edges: thicknesses, 0 for a circumference.
pub(super) fn depths(thickness: &Floats<'_>) -> PyResult<Vec<Depth>> {
    let depth = |&t: &f64| if t == 0.0 { Depth::Circumference } else { Depth::Thickness(t) };
    Ok(thickness.as_slice()?.iter().map(depth).collect())
}

fn sides(
    x: &[[f64; 3]],
    nodes: &Numbers,
    alpha: &Floats,
    thickness: &Floats,
) -> PyResult<(Vec<Edge>, Vec<Depth>)> {
    let edges = edges(x, nodes, alpha, "slave")?;
    let thickness = depths(thickness)?;
    if thickness.len() != edges.len() {
        return Err(bad(format!("{} edges, {} thicknesses", edges.len(), thickness.len())));
    }
    Ok((edges, thickness))
}

impl Contact {
    fn wrap(
        x: &[[f64; 3]],
        slave: (Vec<Edge>, Vec<Depth>),
        master: Option<Surface>,
        method: &str,
        distances: Distances,
        corners: bool,
    ) -> PyResult<Self> {
        let Distances { reach, margin, depth } = distances;
        if !(reach > 0.0 && margin >= 0.0 && depth > 0.0 && reach.is_finite()) {
            return Err(bad("reach and depth are positive, margin is not negative"));
        }
        let entry = discretization::find(method).map_err(bad)?;
        if entry.joins && !matches!(master, Some(Surface::Edges(_))) {
            return Err(bad(format!("{method} joins two boundaries of the mesh")));
        }
        Ok(Self::of(Pair::new(x, slave, master, entry, distances, corners), x.len()))
    }

    pub(super) fn of(pair: Pair, n_nodes: usize) -> Self {
        Self { pair, n_nodes, terms: Vec::new(), threads: 1 }
    }

    fn configuration<'a>(&self, x: &'a Rows<'_>, name: &str) -> PyResult<&'a [[f64; 3]]> {
        let x = rows::<3, f64>(x, name)?;
        if x.len() != self.n_nodes {
            return Err(bad(format!("{name} has {} rows for {} nodes", x.len(), self.n_nodes)));
        }
        Ok(x)
    }

    fn workers(&self) -> usize {
        if self.threads == 0 { pool::available() } else { self.threads }
    }
}

#[pymethods]
impl Contact {
    /// Pair of two boundaries of the mesh.
    #[staticmethod]
    #[pyo3(signature = (
        reference, slave_nodes, slave_bulge, slave_thickness, master_nodes, master_bulge, *,
        master_shapes=None, method="mortar", reach, margin, depth=f64::INFINITY, corners=false
    ))]
    #[allow(clippy::too_many_arguments)]
    fn edges(
        reference: Rows<'_>,
        slave_nodes: Numbers<'_>,
        slave_bulge: Floats<'_>,
        slave_thickness: Floats<'_>,
        master_nodes: Numbers<'_>,
        master_bulge: Floats<'_>,
        master_shapes: Option<PyReadonlyArray1<'_, i64>>,
        method: &str,
        reach: f64,
        margin: f64,
        depth: f64,
        corners: bool,
    ) -> PyResult<Self> {
        let x = rows::<3, f64>(&reference, "reference")?;
        let slave = sides(x, &slave_nodes, &slave_bulge, &slave_thickness)?;
        let mut master = edges(x, &master_nodes, &master_bulge, "master")?;
        if let Some(shapes) = master_shapes {
            shape(&mut master, shapes.as_slice()?)?;
        }
        let master = Surface::Edges(master);
        let distances = Distances { reach, margin, depth };
        Self::wrap(x, slave, Some(master), method, distances, corners)
    }

    /// A boundary with itself; a penetration beyond half the local thickness is no contact.
    #[staticmethod]
    #[pyo3(signature = (
        reference, nodes, bulge, thickness, *, method="mortar", reach, margin, corners=false
    ))]
    #[allow(clippy::too_many_arguments)]
    fn itself(
        reference: Rows<'_>,
        nodes: Numbers<'_>,
        bulge: Floats<'_>,
        thickness: Floats<'_>,
        method: &str,
        reach: f64,
        margin: f64,
        corners: bool,
    ) -> PyResult<Self> {
        let x = rows::<3, f64>(&reference, "reference")?;
        let slave = sides(x, &nodes, &bulge, &thickness)?;
        let distances = Distances { reach, margin, depth: f64::INFINITY };
        Self::wrap(x, slave, None, method, distances, corners)
    }

    /// A boundary and a rigid curve.
    ///
    /// ``segments`` (n, 7) are rows x0, y0, x1, y1, cx, cy, sweep in reference coordinates: for
    /// sweep 0 the line from 0 to 1, else the arc about c from 0 through the angle; the body is
    /// on the left. ``node`` (-1 for none) moves the curve and ``turns`` it about its place.
    #[staticmethod]
    #[pyo3(signature = (
        reference, slave_nodes, slave_bulge, slave_thickness, segments, node, point, *,
        turns=true, method="mortar", reach, margin, depth=f64::INFINITY, corners=false
    ))]
    #[allow(clippy::too_many_arguments)]
    fn rigid(
        reference: Rows<'_>,
        slave_nodes: Numbers<'_>,
        slave_bulge: Floats<'_>,
        slave_thickness: Floats<'_>,
        segments: Rows<'_>,
        node: i64,
        point: [f64; 2],
        turns: bool,
        method: &str,
        reach: f64,
        margin: f64,
        depth: f64,
        corners: bool,
    ) -> PyResult<Self> {
        let x = rows::<3, f64>(&reference, "reference")?;
        let slave = sides(x, &slave_nodes, &slave_bulge, &slave_thickness)?;
        let node = u32::try_from(node).ok();
        let point = match node {
            Some(n) => x
                .get(n as usize)
                .map(|p| [p[0], p[1]])
                .ok_or_else(|| bad(format!("reference node {n} is out of range")))?,
            None => point,
        };
        let segments = rows::<7, f64>(&segments, "segments")?;
        let rigid = Rigid::new(segments, (node, turns), point).map_err(bad)?;
        let distances = Distances { reach, margin, depth };
        Self::wrap(x, slave, Some(Surface::Rigid(rigid)), method, distances, corners)
    }

    /// Mesh node of each constraint: those of nodes, then those of facets by their first node, then
    /// those of corners by the slave node next to them.
    #[getter]
    fn nodes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let nodes = &self.pair.slave().nodes;
        let nodes: Vec<i64> = self.pair.places().iter().map(|&k| nodes[k].into()).collect();
        nodes.into_pyarray(py)
    }

    /// Reference area of each constraint over all its edges.
    #[getter]
    fn full_area<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.pair.full_area().into_pyarray(py)
    }

    /// Mesh node of each corner that has a constraint of its own, -1 for those of a rigid body;
    /// their constraints are the last ones.
    #[getter]
    fn corners<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.pair.corner_nodes().into_pyarray(py)
    }

    /// Distance taken off the gap at each constraint.
    #[getter]
    fn offset<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.pair.offset())
    }

    #[setter]
    fn set_offset(&mut self, offset: Floats<'_>) -> PyResult<()> {
        let offset = offset.as_slice()?;
        if offset.len() != self.pair.offset().len() {
            return Err(bad(format!("the offsets are {} numbers", self.pair.offset().len())));
        }
        self.pair.offset_mut().copy_from_slice(offset);
        Ok(())
    }

    /// Threads to use, 0 for all the machine has; results do not depend on it.
    #[getter]
    fn threads(&self) -> usize {
        self.threads
    }

    #[setter]
    fn set_threads(&mut self, threads: usize) {
        self.threads = threads;
    }

    /// Renew the candidates if something has moved far enough; True if they changed.
    fn search(&mut self, py: Python<'_>, x: Rows<'_>) -> PyResult<bool> {
        let x = self.configuration(&x, "x")?;
        let (threads, pair) = (self.workers(), &mut self.pair);
        Ok(py.detach(|| pool::run(threads, |_| pair.update(x))))
    }

    /// Candidate pairs (P, 2): slave edge (node_to_segment: constraint), master edge or piece.
    fn candidates<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let list = self.pair.candidates();
        let flat = list.iter().flat_map(|&(i, j)| [i as i64, j as i64]).collect();
        matrix(py, flat, [list.len(), 2])
    }

    /// Variables (k, v) and constraints (k, 3), -1 where unused, of the candidate pairs next to given
    /// ones, these included.
    fn near<'py>(
        &self,
        py: Python<'py>,
        pairs: PyReadonlyArray1<'_, i64>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let (pairs, n) = (pairs.as_slice()?, self.pair.candidates().len());
        if pairs.iter().any(|&p| p as usize >= n) {
            return Err(bad(format!("pairs are numbers below {n}")));
        }
        let near = self.pair.near(pairs.iter().map(|&p| p as usize));
        let variables = near.iter().flat_map(|&p| self.pair.variables(p)).collect();
        let number = |k: usize| i64::try_from(k).unwrap_or(-1);
        let constraints = near.iter().flat_map(|&p| self.pair.constraints(p).map(number)).collect();
        Ok((matrix(py, variables, [near.len(), WIDTH])?, matrix(py, constraints, [near.len(), 3])?))
    }

    /// Terms at a configuration, sorted by constraint; without ``old`` the slip is left out. With it,
    /// ``closed`` tells which constraints were (none: not known).
    #[pyo3(signature = (x, old=None, closed=None))]
    fn evaluate<'py>(
        &mut self,
        py: Python<'py>,
        x: Rows<'py>,
        old: Option<Rows<'py>>,
        closed: Option<PyReadonlyArray1<'py, bool>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let x = self.configuration(&x, "x")?;
        let old = match &old {
            Some(o) => Some(self.configuration(o, "old")?),
            None => None,
        };
        let (threads, pair) = (self.workers(), &mut self.pair);
        let closed = match &closed {
            Some(flags) => flags.as_slice()?,
            None => &[],
        };
        self.terms = py.detach(|| pool::run(threads, |_| pair.evaluate(x, old, closed)));
        self.collect(py)
    }

    /// Terms along which tractions act whose work in an increment from ``old`` to ``x`` is that of its
    /// gaps, which change by ``rise`` (n,).
    ///
    /// Gradients are those of ``middle`` where it is ``known`` (n,), else those of ``end``. Gives
    /// constraints, pairs, variables, both gradients, and the slips (n,).
    #[allow(clippy::too_many_arguments)]
    fn discrete_gradient<'py>(
        &self,
        py: Python<'py>,
        middle: TermArrays<'py>,
        end: TermArrays<'py>,
        known: PyReadonlyArray1<'py, bool>,
        rise: Floats<'py>,
        old: Rows<'py>,
        x: Rows<'py>,
        rounding: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let positions = [self.configuration(&old, "old")?, self.configuration(&x, "x")?];
        let (known, rise, parts) = (known.as_slice()?, rise.as_slice()?, [&middle, &end]);
        let n = self.pair.offset().len();
        if known.len() != n || rise.len() != n {
            return Err(bad(format!("known and rise are {n} values each")));
        }
        let mut rows = Vec::new();
        for (part, of) in parts.iter().enumerate() {
            for (row, &k) in of.constraint.as_slice()?.iter().enumerate() {
                let known = known.get(k as usize).ok_or_else(|| bad("no such constraint"))?;
                if *known == (part == 0) {
                    rows.push((part, row));
                }
            }
        }
        let constraint = chosen(&rows, [middle.constraint.as_slice()?, end.constraint.as_slice()?]);
        let pair = chosen(&rows, [middle.pair.as_slice()?, end.pair.as_slice()?]);
        let variables = chosen(&rows, [wide(&middle.variables)?, wide(&end.variables)?]);
        if variables.as_flattened().iter().any(|&v| v >= 3 * positions[0].len() as i64) {
            return Err(bad("variables of nodes that do not exist"));
        }
        let gap = chosen(&rows, [wide(&middle.gap_gradient)?, wide(&end.gap_gradient)?]);
        let slip = chosen(&rows, [wide(&middle.slip_gradient)?, wide(&end.slip_gradient)?]);
        let gradients =
            Gradients { constraint: &constraint, dofs: &variables, gap: &gap, slip: &slip };
        let master = self.pair.master();
        let (gap, slips) = discrete_gradient(master, &gradients, rise, positions, rounding);
        let (d, shape) = (PyDict::new(py), [rows.len(), WIDTH]);
        d.set_item("constraint", constraint.into_pyarray(py))?;
        d.set_item("pair", pair.into_pyarray(py))?;
        d.set_item("variables", matrix(py, variables.concat(), shape)?)?;
        d.set_item("gap_gradient", matrix(py, gap.concat(), shape)?)?;
        d.set_item("slip_gradient", matrix(py, slip.concat(), shape)?)?;
        d.set_item("slip", slips.into_pyarray(py))?;
        Ok(d)
    }

    /// Pairs (h,), variables (h, v) and derivatives (h, v, v) of ``sum_k p_k dG_k + q_k dS_k``, of
    /// the last evaluation; those of slips are not symmetric.
    fn hessian<'py>(
        &self,
        py: Python<'py>,
        p: Floats<'py>,
        q: Floats<'py>,
    ) -> PyResult<(Bound<'py, PyArray1<i64>>, Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let (p, q) = (p.as_slice()?, q.as_slice()?);
        let n = self.pair.offset().len();
        if p.len() != n || q.len() != n {
            return Err(bad(format!("p and q are {n} numbers each")));
        }
        let wanted =
            |t: &&Terms| t.shares.iter().any(|s| p[s.constraint] != 0.0 || q[s.constraint] != 0.0);
        let terms: Vec<&Terms> = self.terms.iter().filter(wanted).collect();
        let used =
            |t: &&Terms| t.variables.iter().rposition(|&v| v >= 0).map_or(0, |last| last + 1);
        let width = terms.iter().map(used).max().unwrap_or(1);
        let mut values = vec![0.0; terms.len() * width * width];
        for (t, square) in terms.iter().zip(values.chunks_mut(width * width)) {
            for share in &t.shares {
                share.gap.add_hessian(p[share.constraint], width, square);
                share.slip.add_hessian(q[share.constraint], width, square);
            }
        }
        let pairs: Vec<i64> = terms.iter().map(|t| t.pair as i64).collect();
        let variables = terms.iter().flat_map(|t| t.variables[..width].to_vec()).collect();
        let h = terms.len();
        Ok((
            pairs.into_pyarray(py),
            matrix(py, variables, [h, width])?,
            matrix(py, values, [h, width, width])?,
        ))
    }

    /// Take which constraints belong to ends of the slave that supports hold from now on.
    fn hold(&mut self, held: Vec<bool>, rough: bool) -> PyResult<()> {
        if held.len() < self.pair.places().len() {
            return Err(bad(format!("there are {} constraints", self.pair.places().len())));
        }
        self.pair.hold(&held, rough);
        Ok(())
    }

    /// Take the nodes whose rotations are those of the bodies of slave and master, if there are any.
    fn carry(&mut self, slave: Option<u32>, master: Option<u32>) {
        self.pair.carry([slave, master]);
    }

    /// Remember the masters of the nodes (node_to_segment).
    fn commit(&mut self) {
        self.pair.commit();
    }

    /// What later evaluations depend on: places of the search, whole numbers, offsets.
    fn state<'py>(
        &self,
        py: Python<'py>,
    ) -> (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<i64>>, Bound<'py, PyArray1<f64>>) {
        let (places, whole) = self.pair.state();
        (
            places.into_pyarray(py),
            whole.into_pyarray(py),
            PyArray1::from_slice(py, self.pair.offset()),
        )
    }

    /// Take what ``state`` gave of the same pair.
    fn restore_state(
        &mut self,
        places: Floats<'_>,
        whole: PyReadonlyArray1<'_, i64>,
        offset: Floats<'_>,
    ) -> PyResult<()> {
        self.set_offset(offset)?;
        if self.pair.resume(places.as_slice()?, whole.as_slice()?) {
            Ok(())
        } else {
            Err(bad("the state does not fit the pair"))
        }
    }

    /// Forget which masters the nodes had, to which they would keep for a while.
    fn forget(&mut self) {
        self.pair.forget();
    }

    /// Return to the masters remembered.
    fn restore(&mut self) {
        self.pair.restore();
    }
}

impl Contact {
    fn collect<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let n = self.pair.offset().len();
        let mut order: Vec<(usize, usize, usize)> = Vec::new();
        for (t, terms) in self.terms.iter().enumerate() {
            for (s, share) in terms.shares.iter().enumerate() {
                order.push((share.constraint, t, s));
            }
        }
        order.sort_unstable();
        let m = order.len();
        let [mut constraint, mut pair] = [const { Vec::<i64>::new() }; 2];
        let mut variables = Vec::with_capacity(m * WIDTH);
        let [mut gap, mut slip, mut area] = [const { Vec::<f64>::new() }; 3];
        let [mut gap_gradient, mut slip_gradient] = [const { Vec::<f64>::new() }; 2];
        let mut totals = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
        for (k, t, s) in order {
            let (terms, share) = (&self.terms[t], &self.terms[t].shares[s]);
            constraint.push(k as i64);
            pair.push(terms.pair as i64);
            variables.extend(terms.variables);
            gap.push(share.gap.value);
            slip.push(share.slip.value);
            area.push(share.area);
            gap_gradient.extend(share.gap.gradient);
            slip_gradient.extend(share.slip.gradient);
            totals[0][k] += share.gap.value;
            totals[1][k] += share.slip.value;
            totals[2][k] += share.area;
        }
        let d = PyDict::new(py);
        d.set_item("constraint", constraint.into_pyarray(py))?;
        d.set_item("pair", pair.into_pyarray(py))?;
        d.set_item("variables", matrix(py, variables, [m, WIDTH])?)?;
        for (name, values) in [("gap", gap), ("slip", slip), ("area", area)] {
            d.set_item(name, values.into_pyarray(py))?;
        }
        d.set_item("gap_gradient", matrix(py, gap_gradient, [m, WIDTH])?)?;
        d.set_item("slip_gradient", matrix(py, slip_gradient, [m, WIDTH])?)?;
        for (name, values) in ["total_gap", "total_slip", "total_area"].iter().zip(totals) {
            d.set_item(name, values.into_pyarray(py))?;
        }
        Ok(d)
    }
}

/// Arrays of the terms of a pair.
#[derive(FromPyObject)]
struct TermArrays<'py> {
    constraint: PyReadonlyArray1<'py, i64>,
    pair: PyReadonlyArray1<'py, i64>,
    variables: Numbers<'py>,
    gap_gradient: Rows<'py>,
    slip_gradient: Rows<'py>,
}

fn wide<'a, T: numpy::Element>(array: &'a PyReadonlyArray2<'_, T>) -> PyResult<&'a [[T; WIDTH]]> {
    rows::<WIDTH, T>(array, "terms")
}

/// Rows of two arrays.
fn chosen<T: Copy>(rows: &[(usize, usize)], of: [&[T]; 2]) -> Vec<T> {
    rows.iter().map(|&(part, row)| of[part][row]).collect()
}

/// An array with a shape.
fn matrix<T: numpy::Element, const N: usize>(
    py: Python<'_>,
    flat: Vec<T>,
    shape: [usize; N],
) -> PyResult<Bound<'_, PyAny>> {
    Ok(flat.into_pyarray(py).reshape(shape.to_vec())?.into_any())
}

pub fn register(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_function(wrap_pyfunction!(contact_methods, m)?)?;
    m.add("CORNER", corners::LEAST_TURN)?;
    m.add("TURN", corners::LEAST_TURN_AT_CORNERS)?;
    m.add("STEEP", corners::STEEP)?;
    m.add_class::<Contact>()
}
