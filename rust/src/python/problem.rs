//! `Problem` and the list of elements for Python.
// SPDX-License-Identifier: BSD-3-Clause

use super::blocks::block_inputs;
use super::memory;
use crate::base::Lanes;
use crate::elements::fibers::STATIONS;
use crate::kinematics::inertia::MassKind;
use crate::loads::body::Field;
use crate::materials::{Clock, Law};
use crate::model::chunk::Kinematics;
use crate::model::dynamics::{Between, BodyLoad, Motion};
use crate::model::problem::{Failed, Problem};
use crate::model::registry;
use crate::model::sensitivity::{Wanted, Weights};
use crate::model::sizes;
use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2,
    PyReadonlyArrayDyn, PyReadwriteArray1, PyReadwriteArrayDyn,
};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

pub fn value_error(message: impl Into<String>) -> PyErr {
    PyValueError::new_err(message.into())
}

/// Elements failed: a ``RuntimeError`` whose second argument is the list of (block, element).
fn failed(f: Failed) -> PyErr {
    PyRuntimeError::new_err(("elements could not be evaluated", f.0))
}

/// Arrays of the blocks.
fn of_blocks(values: &[PyReadonlyArray1<'_, f64>]) -> PyResult<Vec<Vec<f64>>> {
    values.iter().map(|v| Ok(v.as_slice()?.to_vec())).collect()
}

/// Discrete model: blocks of elements, dofs, sparsity pattern, assembly.
#[pyclass(name = "Problem")]
pub struct PyProblem {
    inner: Problem,
}

#[pymethods]
impl PyProblem {
    /// Problem(points, blocks, extra_dofs)
    ///
    /// ``points`` (n, 2); ``blocks`` a list of dicts with element, law, parameters, plane,
    /// local_strain, thickness, rho, nodes (flat uint32), and
    /// where wanted profile (3 numbers), table (pairs), fibers (triples), mean_dilatation (bool), beta0 (float or None),
    /// nodal_thickness, nodal_density and sides (flat as nodes; shares of the edges) and by_temperature (pairs of a temperature
    /// and parameters; see ``set_temperatures``); ``extra_dofs`` (n,) uint8 or empty.
    #[new]
    fn new(
        points: PyReadonlyArray2<'_, f64>,
        blocks: &Bound<'_, PyList>,
        extra_dofs: PyReadonlyArray1<'_, u8>,
    ) -> PyResult<Self> {
        let x: Vec<[f64; 2]> = points.as_slice()?.as_chunks::<2>().0.to_vec();
        let inputs = block_inputs(blocks)?;
        let extra = extra_dofs.as_slice()?;
        let inner = Problem::new(x, &inputs, extra).map_err(value_error)?;
        Ok(Self { inner })
    }

    #[getter]
    fn n_dofs(&self) -> usize {
        self.inner.dofs.n_dofs()
    }

    /// First dof of each node and the total, shape (n_nodes + 1,).
    #[getter]
    fn dof_start<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        self.inner.dofs.start.clone().into_pyarray(py)
    }

    /// Node of each dof, shape (n_dofs,).
    #[getter]
    fn node_of_dof<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        self.inner.dofs.node_of_dof().into_pyarray(py)
    }

    /// Column pointers of the upper triangle, shape (n_dofs + 1,).
    #[getter]
    fn indptr<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u64>> {
        let p: Vec<u64> = self.inner.dofs.indptr.iter().map(|&p| p as u64).collect();
        p.into_pyarray(py)
    }

    /// Row indices of the upper triangle.
    #[getter]
    fn indices<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        self.inner.dofs.indices.clone().into_pyarray(py)
    }

    fn set_threads(&mut self, n: usize) {
        self.inner.set_threads(n);
    }

    /// Numbers that kernels treat at once, "best", "scalar", "4" or "8"; returns how many it is.
    fn set_lanes(&mut self, lanes: &str) -> PyResult<usize> {
        let lanes = Lanes::new(lanes).map_err(value_error)?;
        self.inner.set_lanes(lanes);
        Ok(lanes.width())
    }

    /// The time that assemblies span from now on: its length, the total time at its end, and
    /// whether slow processes take part.
    fn set_clock(&mut self, increment: f64, end: f64, lasting: bool) {
        self.inner.set_clock(Clock { increment, end, lasting });
    }

    /// Let only these blocks take part in ``assemble`` and ``inertia``; empty for all.
    fn set_active(&mut self, active: Vec<bool>) {
        self.inner.set_active(active);
    }

    /// Fill ``force``, ``scale`` and, unless it is empty, ``values`` (upper triangle); with
    /// ``stressed`` the tangent has the stiffness of the stress of a linear state.
    #[pyo3(signature = (u, nlgeom, force, scale, values, stressed=false))]
    #[allow(clippy::too_many_arguments)]
    fn assemble(
        &mut self,
        py: Python<'_>,
        u: PyReadonlyArray1<'_, f64>,
        nlgeom: bool,
        mut force: PyReadwriteArray1<'_, f64>,
        mut scale: PyReadwriteArray1<'_, f64>,
        mut values: PyReadwriteArray1<'_, f64>,
        stressed: bool,
    ) -> PyResult<()> {
        let n = self.inner.dofs.n_dofs();
        let kinematics = match (nlgeom, stressed) {
            (true, true) => return Err(value_error("a linear state has no finite displacements")),
            (true, false) => Kinematics::Finite,
            (false, true) => Kinematics::Stressed,
            (false, false) => Kinematics::Linear,
        };
        let (u, f, s, v) =
            (u.as_slice()?, force.as_slice_mut()?, scale.as_slice_mut()?, values.as_slice_mut()?);
        let nnz = self.inner.dofs.indices.len();
        if u.len() != n || f.len() != n || s.len() != n || !(v.is_empty() || v.len() == nnz) {
            return Err(value_error("array lengths do not fit the problem"));
        }
        memory::require_reserve(py)?;
        let inner = &mut self.inner;
        py.detach(|| inner.assemble(u, kinematics, f, s, v)).map_err(failed)
    }

    /// Add inertia forces and effective tangents (see ``Problem::inertia``).
    #[allow(clippy::too_many_arguments)]
    fn inertia(
        &mut self,
        py: Python<'_>,
        u: PyReadonlyArray1<'_, f64>,
        v: PyReadonlyArray1<'_, f64>,
        a: PyReadonlyArray1<'_, f64>,
        kind: &str,
        weights: [f64; 3],
        mut force: PyReadwriteArray1<'_, f64>,
        mut scale: PyReadwriteArray1<'_, f64>,
        mut values: PyReadwriteArray1<'_, f64>,
    ) -> PyResult<()> {
        let kind = MassKind::new(kind).map_err(value_error)?;
        let (u, v, a) = (u.as_slice()?, v.as_slice()?, a.as_slice()?);
        let (f, s, k) = (force.as_slice_mut()?, scale.as_slice_mut()?, values.as_slice_mut()?);
        let n = self.inner.dofs.n_dofs();
        let fits = [u.len(), v.len(), a.len(), f.len(), s.len()].iter().all(|&l| l == n);
        if !fits || !(k.is_empty() || k.len() == self.inner.dofs.indices.len()) {
            return Err(value_error("array lengths do not fit the problem"));
        }
        let motion = Motion { v, a, kind, weights };
        py.detach(|| self.inner.inertia(u, &motion, f, s, k));
        Ok(())
    }

    /// Forces of a conserving step from (u0, v0) to ``u`` (see ``Problem::conserving``).
    #[allow(clippy::too_many_arguments)]
    fn conserving(
        &mut self,
        py: Python<'_>,
        u: PyReadonlyArray1<'_, f64>,
        u0: PyReadonlyArray1<'_, f64>,
        v0: PyReadonlyArray1<'_, f64>,
        dt: f64,
        kind: &str,
        nlgeom: bool,
        mut force: PyReadwriteArray1<'_, f64>,
        mut internal: PyReadwriteArray1<'_, f64>,
        mut scale: PyReadwriteArray1<'_, f64>,
        mut values: PyReadwriteArray1<'_, f64>,
    ) -> PyResult<()> {
        let kind = MassKind::new(kind).map_err(value_error)?;
        let (u, u0, v0) = (u.as_slice()?, u0.as_slice()?, v0.as_slice()?);
        let (f, i) = (force.as_slice_mut()?, internal.as_slice_mut()?);
        let (s, k) = (scale.as_slice_mut()?, values.as_slice_mut()?);
        let n = self.inner.dofs.n_dofs();
        let fits = [u.len(), u0.len(), v0.len(), f.len(), i.len(), s.len()];
        if fits.iter().any(|&l| l != n)
            || !(k.is_empty() || k.len() == self.inner.dofs.indices.len())
        {
            return Err(value_error("array lengths do not fit the problem"));
        }
        let between = Between { u0, v0, dt, kind };
        memory::require_reserve(py)?;
        let inner = &mut self.inner;
        py.detach(|| inner.conserving(u, &between, nlgeom, [f, i, s, k])).map_err(failed)
    }

    /// Begin a motion of the conserving scheme.
    fn start_motion(
        &mut self,
        u: PyReadonlyArray1<'_, f64>,
        v: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<()> {
        self.inner.start_motion(u.as_slice()?, v.as_slice()?);
        Ok(())
    }

    /// Kinetic energy of each element of a block, shape (n,).
    fn kinetic<'py>(
        &self,
        py: Python<'py>,
        block: usize,
        u: PyReadonlyArray1<'_, f64>,
        v: PyReadonlyArray1<'_, f64>,
        kind: &str,
        carried: bool,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let kind = MassKind::new(kind).map_err(value_error)?;
        let each = self.inner.kinetic(block, u.as_slice()?, v.as_slice()?, kind, carried);
        Ok(each.map_err(value_error)?.into_pyarray(py))
    }

    /// (kinetic energy, momentum x, momentum y, angular momentum about the origin, mass).
    fn momenta(
        &self,
        u: PyReadonlyArray1<'_, f64>,
        v: PyReadonlyArray1<'_, f64>,
        kind: &str,
        carried: bool,
    ) -> PyResult<(f64, f64, f64, f64, f64)> {
        let kind = MassKind::new(kind).map_err(value_error)?;
        let m = self.inner.momenta(u.as_slice()?, v.as_slice()?, kind, carried);
        Ok((m.kinetic, m.linear[0], m.linear[1], m.angular, m.mass))
    }

    /// Shape functions of a block at its points, flat (p, nodes).
    fn shape<'py>(&self, py: Python<'py>, block: usize) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let Some(b) = self.inner.blocks.get(block) else {
            return Err(value_error("there is no such block"));
        };
        Ok(b.shape.clone().into_pyarray(py))
    }

    /// Set the initial strain of a block by element and point, shape (n, p, 4) flat: rows xx,
    /// yy, xy; through the thickness a strain in plane stress, a stress in plane strain. Of line
    /// elements the first row is the axial strain. Empty for none.
    fn set_initial(&mut self, block: usize, values: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        self.inner.set_initial(block, values.as_slice()?).map_err(value_error)
    }

    /// Let the law of a block follow temperatures by element and point, shape (n, p) flat.
    fn set_temperatures(
        &mut self,
        block: usize,
        values: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<()> {
        self.inner.set_temperatures(block, values.as_slice()?).map_err(value_error)
    }

    /// Let other nodes of their elements carry the mass of these, flags by node; empty for none.
    fn set_massless(&mut self, massless: PyReadonlyArray1<'_, bool>) -> PyResult<()> {
        self.inner.set_massless(massless.as_slice()?).map_err(value_error)
    }

    /// Set factors on the masses of the elements of a block, shape (n,); empty for one.
    fn set_mass_factors(
        &mut self,
        block: usize,
        factors: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<()> {
        self.inner.set_mass_factors(block, factors.as_slice()?).map_err(value_error)
    }

    /// Take blocks out of the structure; empty for none.
    fn set_removed(&mut self, removed: Vec<bool>) {
        self.inner.set_removed(removed);
    }

    /// Let the elements of a block have no strain at displacements ``u``, shape (n_dofs,).
    fn renew(&mut self, block: usize, u: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        self.inner.renew(block, u.as_slice()?);
        Ok(())
    }

    /// Make the trial history the committed one.
    fn commit(&mut self, py: Python<'_>) {
        let inner = &mut self.inner;
        py.detach(|| inner.commit());
    }

    /// Strains that the materials of a block meet, flat (n, p, 3), with the ``committed``
    /// internal modes or those of the last evaluation.
    fn strains<'py>(
        &self,
        py: Python<'py>,
        block: usize,
        u: PyReadonlyArray1<'py, f64>,
        nlgeom: bool,
        committed: bool,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        if block >= self.inner.blocks.len() || u.as_slice()?.len() != self.inner.dofs.n_dofs() {
            return Err(value_error("the block or the displacements do not fit the problem"));
        }
        Ok(self.inner.strains(block, u.as_slice()?, nlgeom, committed).into_pyarray(py))
    }

    /// Write the committed history of a block, flat (n, p, members).
    fn give(&mut self, block: usize, values: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        if block >= self.inner.blocks.len() {
            return Err(value_error("there is no such block"));
        }
        self.inner.give(block, values.as_slice()?).map_err(value_error)
    }

    /// Committed states of all elements, flat, and the lengths of their parts.
    fn state<'py>(
        &self,
        py: Python<'py>,
    ) -> (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<u64>>) {
        let (values, lengths) = py.detach(|| self.inner.state());
        (values.into_pyarray(py), lengths.into_pyarray(py))
    }

    /// Take the states that ``state`` gave of the same model.
    fn restore_state(
        &mut self,
        values: PyReadonlyArray1<'_, f64>,
        lengths: PyReadonlyArray1<'_, u64>,
    ) -> PyResult<()> {
        self.inner.restore(values.as_slice()?, lengths.as_slice()?).map_err(value_error)
    }

    /// Largest growth of the equivalent plastic strain of the last evaluation.
    fn plastic_increment(&self) -> f64 {
        self.inner.plastic_increment()
    }

    /// Largest error of the creep strain of the last evaluation.
    fn creep_error(&self) -> f64 {
        self.inner.creep_error()
    }

    /// Largest absolute values, each of displacement dofs and of rotations: forces (``scale`` and
    /// ``external``), residual at free dofs, its place, displacements. With ``balance`` the
    /// external forces are taken from ``residual`` first.
    #[allow(clippy::too_many_arguments)]
    fn sizes(
        &self,
        residual: PyReadonlyArray1<'_, f64>,
        scale: PyReadonlyArray1<'_, f64>,
        external: PyReadonlyArray1<'_, f64>,
        u: PyReadonlyArray1<'_, f64>,
        held: PyReadonlyArray1<'_, bool>,
        balance: bool,
    ) -> PyResult<([f64; 2], [f64; 2], [usize; 2], [f64; 2])> {
        let dofs = &self.inner.dofs;
        let (r, s, e) = (residual.as_slice()?, scale.as_slice()?, external.as_slice()?);
        let (u, held) = (u.as_slice()?, held.as_slice()?);
        let n = dofs.n_dofs();
        if [r.len(), s.len(), e.len(), u.len(), held.len()] != [n; 5] {
            return Err(value_error("array lengths do not fit the problem"));
        }
        let sizes = sizes::sizes(dofs, r, s, e, u, held, balance);
        Ok((sizes.scale, sizes.residual, sizes.worst, sizes.displacement))
    }

    /// Product of the symmetric matrix ``values`` with ``x``.
    fn multiply<'py>(
        &self,
        py: Python<'py>,
        values: PyReadonlyArray1<'py, f64>,
        x: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (v, x) = (values.as_slice()?, x.as_slice()?);
        let dofs = &self.inner.dofs;
        if v.len() != dofs.indices.len() || x.len() != dofs.n_dofs() {
            return Err(value_error("array lengths do not fit the problem"));
        }
        Ok(py.detach(|| dofs.multiply(v, x)).into_pyarray(py))
    }

    /// Replace the rows and columns of held dofs by those of a diagonal matrix.
    fn mask(
        &mut self,
        py: Python<'_>,
        mut values: PyReadwriteArray1<'_, f64>,
        held: PyReadonlyArray1<'_, bool>,
    ) -> PyResult<()> {
        let (v, held) = (values.as_slice_mut()?, held.as_slice()?);
        let dofs = &self.inner.dofs;
        if v.len() != dofs.indices.len() || held.len() != dofs.n_dofs() {
            return Err(value_error("array lengths do not fit the problem"));
        }
        let inner = &mut self.inner;
        py.detach(|| inner.mask(v, held));
        Ok(())
    }

    /// Make a linear system for the free dofs, in place: ``values`` as by :meth:`mask`, and from
    /// ``rhs`` (n,) or Fortran-ordered (n, k) the forces of the held dofs' motion ``moved``.
    fn reduce(
        &mut self,
        py: Python<'_>,
        mut values: PyReadwriteArray1<'_, f64>,
        mut rhs: PyReadwriteArrayDyn<'_, f64>,
        moved: PyReadonlyArrayDyn<'_, f64>,
        held: PyReadonlyArray1<'_, bool>,
    ) -> PyResult<()> {
        let (v, held) = (values.as_slice_mut()?, held.as_slice()?);
        let (mut rhs, moved) = (rhs.as_array_mut(), moved.as_array());
        let dofs = &self.inner.dofs;
        let fits = v.len() == dofs.indices.len() && held.len() == dofs.n_dofs();
        let shape = rhs.shape().first() == Some(&dofs.n_dofs()) && rhs.shape() == moved.shape();
        // Transposed, columns lie one after the other.
        let (Some(b), Some(m)) =
            (rhs.view_mut().reversed_axes().into_slice(), moved.t().to_slice())
        else {
            return Err(value_error("right-hand sides must stand one after the other"));
        };
        if !fits || !shape {
            return Err(value_error("array lengths do not fit the problem"));
        }
        let inner = &mut self.inner;
        py.detach(|| inner.reduce(v, b, m, held));
        Ok(())
    }

    /// Values by node, shape (n_nodes, 3), 0 where a node has no such dof.
    fn by_node<'py>(
        &self,
        py: Python<'py>,
        vector: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let v = vector.as_slice()?;
        if v.len() != self.inner.dofs.n_dofs() {
            return Err(value_error("array lengths do not fit the problem"));
        }
        let rows = self.inner.dofs.by_node(v);
        rows.into_pyarray(py).reshape([self.inner.dofs.n_nodes(), 3])
    }

    /// Add to ``force`` a body force at displacements ``u``, and ``share`` times its derivative
    /// to ``values`` (upper triangle) unless that is empty. Unless ``start`` is empty, it is the
    /// mean force of the conserving step from there, and the derivative that of its middle. ``kind`` is gravity with value
    /// (bx, by), or centrifugal with (omega^2, x0, y0); ``mass`` is the mass that it acts on, or
    /// empty for a force per volume; element masks by block.
    #[allow(clippy::too_many_arguments)]
    fn body_force(
        &mut self,
        py: Python<'_>,
        kind: &str,
        value: Vec<f64>,
        mass: &str,
        masks: Vec<PyReadonlyArray1<'_, bool>>,
        u: PyReadonlyArray1<'_, f64>,
        start: PyReadonlyArray1<'_, f64>,
        share: f64,
        mut force: PyReadwriteArray1<'_, f64>,
        mut values: PyReadwriteArray1<'_, f64>,
    ) -> PyResult<()> {
        let field = match (kind, value.as_slice()) {
            ("gravity", &[x, y]) => Field::uniform([x, y]),
            ("centrifugal", &[w2, x, y]) => Field::centrifugal(w2, [x, y]),
            _ => return Err(value_error(format!("no body force {kind:?} with {value:?}"))),
        };
        let start = start.as_slice()?;
        let kind = match mass {
            "" => None,
            name => Some(MassKind::new(name).map_err(value_error)?),
        };
        let load = BodyLoad { field, start, kind, share };
        let masks: Vec<Vec<bool>> = masks.iter().map(|m| m.as_array().to_vec()).collect();
        let fits = masks.iter().zip(&self.inner.blocks).all(|(m, b)| m.len() == b.n_elements);
        let (u, f, k) = (u.as_slice()?, force.as_slice_mut()?, values.as_slice_mut()?);
        let dofs = &self.inner.dofs;
        let lengths = [u.len(), f.len()] == [dofs.n_dofs(); 2]
            && (start.is_empty() || start.len() == u.len());
        if masks.len() != self.inner.blocks.len() || !fits || !lengths {
            return Err(value_error("masks and arrays must fit the problem"));
        }
        if !(k.is_empty() || k.len() == dofs.indices.len()) {
            return Err(value_error("the tangent does not fit the problem"));
        }
        py.detach(|| self.inner.body_force(u, &load, &masks, f, k));
        Ok(())
    }

    /// Gradients of ``force . internal force + state . new state`` at displacements ``u`` from the
    /// committed state, by differentiation of each law at its points.
    ///
    /// ``force`` are weights by dof, ``state`` weights of the histories as ``histories`` gives them,
    /// or empty; ``wanted`` names the inputs among positions, displacements, state, thickness,
    /// initial. Returns a dict: positions (n_nodes, 2), displacements (n_dofs,), state as
    /// ``histories``; thickness and initial are lists by block of (n, p) and (n, p, 4); exact is
    /// whether the tangents of all laws are the derivatives of their stress.
    fn differentiate<'py>(
        &mut self,
        py: Python<'py>,
        u: PyReadonlyArray1<'py, f64>,
        nlgeom: bool,
        force: PyReadonlyArray1<'py, f64>,
        state: Vec<PyReadonlyArray1<'py, f64>>,
        wanted: Vec<String>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let names: Vec<&str> = wanted.iter().map(String::as_str).collect();
        let wanted = Wanted::new(&names).map_err(value_error)?;
        let (u, force) = (u.as_slice()?, force.as_slice()?);
        let n = self.inner.dofs.n_dofs();
        if u.len() != n || force.len() != n {
            return Err(value_error("array lengths do not fit the problem"));
        }
        let state = of_blocks(&state)?;
        let known = self.inner.histories(false);
        let mut pairs = known.iter().zip(&state);
        let fits = known.len() == state.len() && pairs.all(|(k, s)| k.len() == s.len());
        if !(fits || state.is_empty()) {
            return Err(value_error("weights of the histories do not fit the problem"));
        }
        let weights = Weights { force, state: &state, wanted };
        let all = py.detach(|| self.inner.gradients(u, nlgeom, &weights)).map_err(failed)?;
        let d = PyDict::new(py);
        let nodes = self.inner.x.len();
        d.set_item("exact", all.exact)?;
        d.set_item("positions", all.positions.into_pyarray(py).reshape([nodes, 2])?)?;
        d.set_item("displacements", all.displacements.into_pyarray(py))?;
        let state: Vec<_> = all.state.into_iter().map(|s| s.into_pyarray(py)).collect();
        d.set_item("state", state)?;
        let (mut thickness, mut initial) = (Vec::new(), Vec::new());
        for (block, (t, i)) in
            self.inner.blocks.iter().zip(all.thickness.into_iter().zip(all.initial))
        {
            let (n, p) = (block.n_elements, block.facts.n_points);
            thickness.push(t.into_pyarray(py).reshape([n, p])?);
            initial.push(i.into_pyarray(py).reshape([n, p, 4])?);
        }
        d.set_item("thickness", thickness)?;
        d.set_item("initial", initial)?;
        Ok(d)
    }

    /// Histories of the elements of each block, flat (n, members), committed or ``trial``.
    fn histories<'py>(&self, py: Python<'py>, trial: bool) -> Vec<Bound<'py, PyArray1<f64>>> {
        self.inner.histories(trial).into_iter().map(|h| h.into_pyarray(py)).collect()
    }

    /// Make histories as ``histories`` gives them the committed ones.
    fn set_histories(&mut self, values: Vec<PyReadonlyArray1<'_, f64>>) -> PyResult<()> {
        self.inner.set_histories(&of_blocks(&values)?).map_err(value_error)
    }

    /// Point fields of every block: a list of dicts of arrays by element and point.
    fn recover<'py>(
        &mut self,
        py: Python<'py>,
        u: PyReadonlyArray1<'py, f64>,
        nlgeom: bool,
    ) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let u = u.as_slice()?;
        let inner = &mut self.inner;
        let fields = py.detach(|| inner.recover(u, nlgeom));
        let mut all = Vec::new();
        for (f, block) in fields.into_iter().zip(&self.inner.blocks) {
            let (n, p) = (block.n_elements, f.n_points);
            let scalar = |values: Vec<f64>| values.into_pyarray(py).reshape([n, p]);
            let rows = |values: Vec<f64>, k: usize| values.into_pyarray(py).reshape([n, p, k]);
            let d = PyDict::new(py);
            d.set_item("total_energy", f.total_energy())?;
            let artificial = if block.facts.line { 0.0 } else { f.penalty.iter().sum::<f64>() };
            d.set_item("artificial_energy", artificial)?;
            if !f.heat.is_empty() {
                d.set_item("heat", rows(f.heat, 5)?)?;
            }
            if !f.stabilized.is_empty() {
                d.set_item("stabilized", f.stabilized.into_pyarray(py).reshape([n, 3, 2])?)?;
            }
            if !f.fibers.is_empty() {
                let count = f.fibers.len() / (n * STATIONS * 3);
                let fibers = f.fibers.into_pyarray(py).reshape([n, STATIONS, count, 3])?;
                d.set_item("fibers", fibers)?;
            }
            d.set_item("dissipated_energy", f.dissipated.iter().sum::<f64>())?;
            d.set_item("largest_strain", f.largest_strain)?;
            d.set_item("points", rows(f.points, 2)?)?;
            d.set_item("volume", scalar(f.volume)?)?;
            let of_nodes = [n, block.facts.n_nodes, block.facts.dofs_per_node];
            d.set_item("forces", f.forces.into_pyarray(py).reshape(of_nodes)?)?;
            d.set_item("rotation", f.rotation.into_pyarray(py))?;
            let shape = block.shape.clone().into_pyarray(py);
            d.set_item("shape", shape.reshape([p, block.shape.len() / p.max(1)])?)?;
            let values = PyDict::new(py);
            values.set_item("S", rows(f.stress, 4)?)?;
            values.set_item("E", rows(f.strain, 4)?)?;
            values.set_item("MISES", scalar(f.mises)?)?;
            values.set_item("ENER", scalar(f.energy)?)?;
            for (name, output) in block.outputs().iter().zip(f.outputs) {
                values.set_item(name, scalar(output)?)?;
            }
            let tensors = if block.facts.line { &[] } else { block.law.tensors() };
            for (kind, tensor) in tensors.iter().zip(f.tensors) {
                values.set_item(kind.name, rows(tensor, 4)?)?;
            }
            values.set_item("STH", scalar(f.thickness)?)?;
            d.set_item("values", values)?;
            all.push(d);
        }
        Ok(all)
    }
}

/// Facts of all elements: a list of dicts.
#[pyfunction]
fn elements(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    let mut all = Vec::new();
    for f in registry::facts() {
        let d = PyDict::new(py);
        d.set_item("name", f.name)?;
        d.set_item("cell", f.cell)?;
        d.set_item("n_nodes", f.n_nodes)?;
        d.set_item("dofs_per_node", f.dofs_per_node)?;
        d.set_item("n_points", f.n_points)?;
        d.set_item("n_internal_modes", f.n_internal_modes)?;
        d.set_item("hourglass_modes", f.hourglass_modes)?;
        d.set_item("alpha_b", f.alpha_b)?;
        d.set_item("free_volume", f.free_volume)?;
        d.set_item("bending_cells", f.bending_cells)?;
        d.set_item("weighted", f.weighted)?;
        d.set_item("revolved", f.revolved)?;
        d.set_item("about_mean", f.about_mean)?;
        d.set_item("stabilized", f.stabilized)?;
        d.set_item("line", f.line)?;
        d.set_item("spring", f.spring)?;
        d.set_item("turns", f.turns)?;
        all.push(d);
    }
    Ok(all)
}

/// Names of all materials.
#[pyfunction]
fn materials() -> Vec<&'static str> {
    Law::NAMES.to_vec()
}

pub fn register(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PyProblem>()?;
    m.add_function(wrap_pyfunction!(elements, m)?)?;
    m.add_function(wrap_pyfunction!(materials, m)?)?;
    Ok(())
}
