//! A material alone, for Python: its answer along a strain path.
// SPDX-License-Identifier: BSD-3-Clause

use crate::kinematics::law_tape::{Number, WIDTH};
use crate::materials::c_function::Call;
use crate::materials::external::{self, Convention};
use crate::materials::umat::Subroutine;
use crate::materials::{Clock, Law, Plane, PointState, State};
use numpy::{IntoPyArray, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// State of stress from its name.
fn stress_state(name: &str) -> PyResult<State> {
    if name == "line" { Ok(State::Line) } else { plane(name).map(State::Plane) }
}

/// Plane from its name.
pub fn plane(name: &str) -> PyResult<Plane> {
    match name {
        "stress" => Ok(Plane::Stress),
        "strain" => Ok(Plane::Strain),
        other => Err(PyValueError::new_err(format!("plane must be stress or strain, not {other}"))),
    }
}

/// Let laws of a convention, ``c_function`` or ``umat``, call the function at an address; returns its
/// handle.
#[pyfunction]
fn register_function(convention: &str, address: usize) -> PyResult<usize> {
    if address == 0 {
        return Err(PyValueError::new_err("there is no function at the address 0"));
    }
    match [Call::NAME, Subroutine::NAME].into_iter().find(|name| *name == convention) {
        Some(name) => Ok(external::register(name, address)),
        None => Err(PyValueError::new_err(format!("no convention {convention:?}"))),
    }
}

/// Answer of a law to a sequence of strains, each committed before the next.
///
/// ``strain`` (n, 3) rows xx, yy, xy (engineering shear); ``state`` the history at the start,
/// empty for a virgin point; ``times`` (n,) the total times of the strains, after ``start``, empty
/// for none; ``lasting`` whether slow processes take part; ``small`` whether displacements are. Returns a dict of flat arrays: stress (n, 3), tangent (n, 3, 3),
/// derivative (n, 3, 3; exact, by forward differentiation), zz (n, 2; strain and stress
/// through the thickness), energy (n), state (n, members) and the outputs by name.
#[pyfunction]
#[pyo3(signature = (law, parameters, plane_name, strain, state, times=Vec::new(), start=0.0, lasting=true, small=false))]
#[allow(clippy::too_many_arguments)]
fn material_path<'py>(
    py: Python<'py>,
    law: &str,
    parameters: Vec<f64>,
    plane_name: &str,
    strain: PyReadonlyArray2<'py, f64>,
    state: PyReadonlyArray1<'py, f64>,
    times: Vec<f64>,
    start: f64,
    lasting: bool,
    small: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let mut law =
        Law::new(law, &parameters, stress_state(plane_name)?).map_err(PyValueError::new_err)?;
    if small {
        law = law.linearized();
    }
    let members = law.n_state();
    let mut old = state.as_slice()?.to_vec();
    old.resize(members, 0.0);
    let mut new = vec![0.0; members];
    let [mut stress, mut tangent, mut derivative, mut zz, mut energy, mut states] =
        [const { Vec::<f64>::new() }; 6];
    let mut outputs = vec![Vec::<f64>::new(); law.outputs().len()];
    // The history as numbers with derivatives, which are zero.
    let (mut numbers, mut answers) =
        (vec![0.0; members * (1 + WIDTH)], vec![0.0; members * (1 + WIDTH)]);
    let mut before = start;
    for (row, e) in strain.as_slice()?.as_chunks::<3>().0.iter().enumerate() {
        let end = times.get(row).copied().unwrap_or(before);
        let clock = Clock { increment: end - before, end, lasting };
        before = end;
        let number: [Number; 3] = std::array::from_fn(|i| Number::variable(e[i], i));
        for (places, v) in numbers.chunks_exact_mut(1 + WIDTH).zip(&old) {
            places[0] = *v;
        }
        let mut point = PointState { old: &numbers, new: &mut answers, stride: 1 + WIDTH, clock };
        let exact = law.update(number, &mut point);
        let mut point = PointState { old: &old, new: &mut new, stride: 1, clock };
        let answer = law.update(*e, &mut point);
        if answer.failed {
            return Err(PyRuntimeError::new_err(format!("no convergence at strain {e:?}")));
        }
        stress.extend(answer.stress);
        tangent.extend(answer.tangent.as_flattened());
        derivative.extend(exact.stress.iter().flat_map(|s| s.d.into_iter().take(3)));
        zz.extend(<[f64; 2]>::from(law.out_of_plane(*e, answer.stress, &new)));
        energy.push(law.energy(*e, answer.stress, &new));
        for (i, values) in outputs.iter_mut().enumerate() {
            values.push(law.output(i, answer.stress, &new));
        }
        states.extend(&new);
        old.copy_from_slice(&new);
    }
    let d = PyDict::new(py);
    d.set_item("stress", stress.into_pyarray(py))?;
    d.set_item("tangent", tangent.into_pyarray(py))?;
    d.set_item("derivative", derivative.into_pyarray(py))?;
    d.set_item("zz", zz.into_pyarray(py))?;
    d.set_item("energy", energy.into_pyarray(py))?;
    d.set_item("state", states.into_pyarray(py))?;
    for (name, values) in law.outputs().iter().zip(outputs) {
        d.set_item(name, values.into_pyarray(py))?;
    }
    Ok(d)
}

/// Strain of plane displacement gradients under a local strain measure, with what follows from
/// a linear law, for verification.
///
/// ``gradient`` (n, 4) rows u,x u,y v,x v,y; ``moduli`` (3, 3) flat. Returns strain (n, 3), the
/// conjugate stress P (n, 4), its tangent (n, 4, 4), and by forward differentiation the
/// derivative of the energy (n, 4) and of P (n, 4, 4).
#[pyfunction]
fn strain_measure<'py>(
    py: Python<'py>,
    name: &str,
    gradient: PyReadonlyArray2<'py, f64>,
    moduli: PyReadonlyArray1<'py, f64>,
) -> PyResult<Bound<'py, PyDict>> {
    use crate::base::Real;
    use crate::kinematics::local_strain::LocalStrain;
    use crate::materials::material::hooke;
    let measure = LocalStrain::new(name).map_err(PyValueError::new_err)?;
    let flat = moduli.as_slice()?;
    if flat.len() != 9 {
        return Err(PyValueError::new_err("the moduli are 9 numbers"));
    }
    let c: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| flat[3 * i + j]));
    let mut parts: [Vec<f64>; 5] = Default::default();
    for h in gradient.as_slice()?.as_chunks::<4>().0 {
        let e = measure.strain(h);
        let s = hooke(&c, e);
        parts[0].extend(e);
        parts[1].extend(measure.pull(h, &s));
        parts[2].extend(measure.tangent(h, &s, &c).as_flattened());
        let dual: [Number; 4] = std::array::from_fn(|i| Number::variable(h[i], i));
        let e = measure.strain(&dual);
        let s = hooke(&c, e);
        let energy = (e[0] * s[0] + e[1] * s[1] + e[2] * s[2]).scale(0.5);
        parts[3].extend(energy.d);
        parts[4].extend(measure.pull(&dual, &s).iter().flat_map(|p| p.d));
    }
    let d = PyDict::new(py);
    for (key, values) in
        ["strain", "stress", "tangent", "energy_derivative", "stress_derivative"].iter().zip(parts)
    {
        d.set_item(key, values.into_pyarray(py))?;
    }
    Ok(d)
}

pub fn register(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_function(wrap_pyfunction!(register_function, m)?)?;
    m.add_function(wrap_pyfunction!(material_path, m)?)?;
    m.add_function(wrap_pyfunction!(strain_measure, m)?)?;
    Ok(())
}
