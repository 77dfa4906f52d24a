//! Python class of the law of a contact pair, and forces of tractions.
// SPDX-License-Identifier: BSD-3-Clause

use super::contact::{bad, rows};
use crate::contact::ContactLaw as Law;
use crate::contact::active_set::{Constraints, Gradients};
use crate::contact::law::pressure::Curve;
use crate::contact::law::{NORMAL, State, TANGENTIAL};
use crate::contact::terms::WIDTH;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray1};
use pyo3::prelude::*;

type Floats<'py> = PyReadonlyArray1<'py, f64>;
type Out<'py> = Bound<'py, PyArray1<f64>>;

/// Weighted gaps and slips, covered and whole areas, areas of pressure laws, stiffness, and the
/// weighted gaps that an increment began with, or None, which constraints do not open, or None, and
/// coefficients of friction, or None: what all methods take as ``at``.
#[derive(FromPyObject)]
struct At<'py>(
    Floats<'py>,
    Floats<'py>,
    Floats<'py>,
    Floats<'py>,
    Floats<'py>,
    Floats<'py>,
    Option<Floats<'py>>,
    Option<PyReadonlyArray1<'py, bool>>,
    Option<Floats<'py>>,
);

impl At<'_> {
    fn constraints(&self, noise: f64) -> PyResult<Constraints<'_>> {
        let found = Constraints {
            gap: self.0.as_slice()?,
            slip: self.1.as_slice()?,
            area: self.2.as_slice()?,
            full: self.3.as_slice()?,
            fixed: self.4.as_slice()?,
            stiffness: self.5.as_slice()?,
            begin: self.6.as_ref().map(|b| b.as_slice()).transpose()?,
            adheres: self.7.as_ref().map(|a| a.as_slice()).transpose()?,
            friction: self.8.as_ref().map(|f| f.as_slice()).transpose()?,
            noise,
        };
        let n = found.len();
        let others = [found.slip, found.area, found.full, found.fixed, found.stiffness];
        for part in others.into_iter().chain(found.begin).chain(found.friction) {
            same(part.len(), n)?;
        }
        same(found.adheres.map_or(n, <[bool]>::len), n)?;
        Ok(found)
    }
}

fn same(found: usize, wanted: usize) -> PyResult<()> {
    if found == wanted {
        return Ok(());
    }
    Err(bad(format!("{found} numbers for {wanted} constraints")))
}

/// The law of the constraints of a contact pair, or of a tie.
///
/// ``at`` are the arrays (gap, slip, area, full, fixed, stiffness, begin, adheres, friction), each of shape (n,): the
/// weighted gap and slip [length^3], the area covered now, the whole one and that of pressure laws
/// [length^2], the pressure per gap by which both are compared [force/length^3], and the weighted
/// gap that the increment began with, or None, which do not open, or None, and coefficients of
/// friction, or None. ``p`` and ``q`` are pressure and shear traction [force/length^2]. States are 0 open, 1 closed (and sticking), 2 slipping.
#[pyclass(module = "corota._core", frozen)]
struct ContactLaw {
    law: Law,
    noise: f64,
}

#[pymethods]
impl ContactLaw {
    /// The law across (``normal``, with pressures and overclosures) and along the surfaces.
    #[new]
    #[pyo3(signature = (
        normal, pressures, overclosures, tangential="frictionless", coefficients=vec![], *, noise=0.0
    ))]
    fn new(
        normal: &str,
        pressures: Vec<f64>,
        overclosures: Vec<f64>,
        tangential: &str,
        coefficients: Vec<f64>,
        noise: f64,
    ) -> PyResult<Self> {
        let law = Law::new(normal, &pressures, &overclosures, tangential, &coefficients);
        Ok(Self { law: law.map_err(bad)?, noise })
    }

    /// The law of a tie.
    #[staticmethod]
    #[pyo3(signature = (*, noise=0.0))]
    fn joined(noise: f64) -> Self {
        Self { law: Law::Joined, noise }
    }

    /// Overclosure at which a pressure law begins [length].
    #[getter]
    fn start(&self) -> f64 {
        self.law.curve().map_or(0.0, Curve::start)
    }

    /// Pressure, slope and energy per area of a pressure law at overclosures above its start.
    fn curve<'py>(&self, py: Python<'py>, overclosure: Floats<'_>) -> PyResult<[Out<'py>; 3]> {
        let curve = self.law.curve().ok_or_else(|| bad("the law is no pressure law"))?;
        Ok(three(py, overclosure.as_slice()?, |w| curve.at(w)))
    }

    /// Pressure, slope and energy per area at gaps [length]; none where the law has not begun.
    fn pressure<'py>(&self, py: Python<'py>, gap: Floats<'_>) -> PyResult<[Out<'py>; 3]> {
        Ok(three(py, gap.as_slice()?, |gap| self.law.pressure(gap)))
    }

    /// Mean pressure between two gaps [length], whose work is the change of energy, and its slope by
    /// the last overclosure.
    fn mean<'py>(
        &self,
        py: Python<'py>,
        begin: Floats<'_>,
        end: Floats<'_>,
    ) -> PyResult<(Out<'py>, Out<'py>)> {
        let (begin, end) = (begin.as_slice()?, end.as_slice()?);
        same(end.len(), begin.len())?;
        let found = begin.iter().zip(end).map(|(&a, &b)| self.law.mean(a, b));
        let (mean, slope): (Vec<f64>, Vec<f64>) = found.map(|[p, s]| (p, s)).unzip();
        Ok((mean.into_pyarray(py), slope.into_pyarray(py)))
    }

    /// Gap [length] and trial pressure of each constraint; not covered: infinitely open.
    fn trial<'py>(
        &self,
        py: Python<'py>,
        at: At<'_>,
        p: Floats<'_>,
    ) -> PyResult<(Out<'py>, Out<'py>)> {
        let (all, p) = (at.constraints(self.noise)?, p.as_slice()?);
        same(p.len(), all.len())?;
        let found = (0..all.len()).map(|i| self.law.trial(&all.at(i, p[i], 0.0)));
        let (gap, push): (Vec<f64>, Vec<f64>) = found.unzip();
        Ok((gap.into_pyarray(py), push.into_pyarray(py)))
    }

    /// Trial shear traction of each constraint.
    fn shear<'py>(&self, py: Python<'py>, at: At<'_>, q: Floats<'_>) -> PyResult<Out<'py>> {
        let (all, q) = (at.constraints(self.noise)?, q.as_slice()?);
        same(q.len(), all.len())?;
        let shear: Vec<f64> = (0..all.len()).map(|i| all.at(i, 0.0, q[i]).shear()).collect();
        Ok(shear.into_pyarray(py))
    }

    /// State that each constraint asks for; ``last`` are those of the last correction.
    #[pyo3(signature = (at, p, q, last=None))]
    fn states<'py>(
        &self,
        py: Python<'py>,
        at: At<'_>,
        p: Floats<'_>,
        q: Floats<'_>,
        last: Option<PyReadonlyArray1<'_, i8>>,
    ) -> PyResult<Bound<'py, PyArray1<i8>>> {
        let (all, p, q) = (at.constraints(self.noise)?, p.as_slice()?, q.as_slice()?);
        let last = last.as_ref().map(|l| l.as_slice()).transpose()?;
        same(p.len(), all.len())?;
        same(q.len(), all.len())?;
        same(last.map_or(all.len(), <[i8]>::len), all.len())?;
        Ok(all.states(&self.law, p, q, last).into_pyarray(py))
    }

    /// Error of the conditions of each constraint, as a force.
    fn residual<'py>(
        &self,
        py: Python<'py>,
        at: At<'_>,
        p: Floats<'_>,
        q: Floats<'_>,
    ) -> PyResult<Out<'py>> {
        let (all, p, q) = (at.constraints(self.noise)?, p.as_slice()?, q.as_slice()?);
        same(p.len(), all.len())?;
        same(q.len(), all.len())?;
        Ok(all.residual(&self.law, p, q).into_pyarray(py))
    }

    /// The constraints linearized: diagonals and right-hand sides of p and q, and, of what slips,
    /// dq/dp and q at no pressure. A closed row reads ``-dG du + d dp = rhs``; an open one ``d dp = rhs`` alone.
    /// ``directions`` are the signs of slipping tractions.
    fn rows<'py>(
        &self,
        py: Python<'py>,
        at: At<'_>,
        p: Floats<'_>,
        q: Floats<'_>,
        states: PyReadonlyArray1<'_, i8>,
        directions: Floats<'_>,
    ) -> PyResult<[Out<'py>; 6]> {
        let (all, p, q) = (at.constraints(self.noise)?, p.as_slice()?, q.as_slice()?);
        let (states, directions) = (states.as_slice()?, directions.as_slice()?);
        for n in [p.len(), q.len(), states.len(), directions.len()] {
            same(n, all.len())?;
        }
        let rows = all.rows(&self.law, p, q, states, directions);
        let column = |f: fn(&crate::contact::law::Rows) -> f64| -> Out<'py> {
            rows.iter().map(f).collect::<Vec<f64>>().into_pyarray(py)
        };
        Ok([
            column(|r| r.p[0]),
            column(|r| r.p[1]),
            column(|r| r.q[0]),
            column(|r| r.q[1]),
            column(|r| r.follow),
            column(|r| r.level),
        ])
    }

    /// Energy that a pressure law stores at each constraint [force*length].
    fn energy<'py>(&self, py: Python<'py>, at: At<'_>) -> PyResult<Out<'py>> {
        let all = at.constraints(self.noise)?;
        let energy: Vec<f64> =
            (0..all.len()).map(|i| self.law.energy(&all.at(i, 0.0, 0.0))).collect();
        Ok(energy.into_pyarray(py))
    }
}

fn three<'py>(py: Python<'py>, at: &[f64], f: impl Fn(f64) -> [f64; 3]) -> [Out<'py>; 3] {
    let found: Vec<[f64; 3]> = at.iter().map(|&x| f(x)).collect();
    let column = |i: usize| found.iter().map(|v| v[i]).collect::<Vec<f64>>().into_pyarray(py);
    [column(0), column(1), column(2)]
}

/// Names of the laws across and along the surfaces.
#[pyfunction]
fn contact_laws() -> (Vec<&'static str>, Vec<&'static str>) {
    (NORMAL.iter().map(|e| e.0).collect(), TANGENTIAL.iter().map(|e| e.0).collect())
}

/// Add the forces of tractions along gradients to ``force``, and the sizes of their parts to
/// ``size``, in place.
///
/// ``constraint`` (m,), ``dofs`` (m, 12) with -1 for none, ``gap`` and ``slip`` (m, 12): gradients;
/// ``p`` and ``q`` by constraint, without ``q`` there are no shear tractions.
#[pyfunction]
#[pyo3(signature = (constraint, dofs, gap, slip, p, q, force, size=None))]
#[allow(clippy::too_many_arguments)]
fn add_contact_forces(
    constraint: PyReadonlyArray1<'_, i64>,
    dofs: PyReadonlyArray2<'_, i64>,
    gap: PyReadonlyArray2<'_, f64>,
    slip: PyReadonlyArray2<'_, f64>,
    p: Floats<'_>,
    q: Option<Floats<'_>>,
    mut force: PyReadwriteArray1<'_, f64>,
    mut size: Option<PyReadwriteArray1<'_, f64>>,
) -> PyResult<()> {
    let gradients = Gradients {
        constraint: constraint.as_slice()?,
        dofs: rows::<WIDTH, i64>(&dofs, "dofs")?,
        gap: rows::<WIDTH, f64>(&gap, "gap")?,
        slip: rows::<WIDTH, f64>(&slip, "slip")?,
    };
    let (p, q) = (p.as_slice()?, q.as_ref().map(|q| q.as_slice()).transpose()?);
    let force = force.as_slice_mut()?;
    let size = size.as_mut().map(|s| s.as_slice_mut()).transpose()?;
    let m = gradients.constraint.len();
    for n in [gradients.dofs.len(), gradients.gap.len(), gradients.slip.len()] {
        same(n, m)?;
    }
    same(q.map_or(p.len(), <[f64]>::len), p.len())?;
    same(size.as_ref().map_or(force.len(), |s| s.len()), force.len())?;
    let inside = |k: &i64| (0..p.len() as i64).contains(k);
    let dof = |d: &i64| *d < force.len() as i64;
    if !gradients.constraint.iter().all(inside) || !gradients.dofs.as_flattened().iter().all(dof) {
        return Err(bad("a constraint or a dof is out of range"));
    }
    gradients.add_forces(p, q, force, size);
    Ok(())
}

pub fn register(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_function(wrap_pyfunction!(contact_laws, m)?)?;
    m.add_function(wrap_pyfunction!(add_contact_forces, m)?)?;
    m.add("OPEN", State::Open as i8)?;
    m.add("CLOSED", State::Closed as i8)?;
    m.add("SLIPPING", State::Slipping as i8)?;
    m.add_class::<ContactLaw>()
}
