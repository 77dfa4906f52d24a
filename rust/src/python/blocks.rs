//! Blocks of elements from the dictionaries that Python gives.
// SPDX-License-Identifier: BSD-3-Clause

use crate::model::build::{BlockInput, Options};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use super::problem::value_error;

/// Name of the plane of solids of revolution.
const RING: &str = "axisymmetric";

/// Numbers that a block may have; none where it has not.
fn numbers(block: &Bound<'_, PyDict>, key: &str) -> PyResult<Vec<f64>> {
    match block.get_item(key)? {
        Some(v) => {
            let v: PyReadonlyArray1<'_, f64> = v.extract()?;
            Ok(v.as_slice()?.to_vec())
        }
        None => Ok(Vec::new()),
    }
}

/// Blocks as `Problem` describes them.
pub fn block_inputs(blocks: &Bound<'_, PyList>) -> PyResult<Vec<BlockInput>> {
    let mut inputs = Vec::new();
    for block in blocks {
        let d = block.cast::<PyDict>()?;
        let get = |key: &str| -> PyResult<Bound<'_, PyAny>> {
            d.get_item(key)?.ok_or_else(|| value_error(format!("a block has no entry {key:?}")))
        };
        let plane: String = get("plane")?.extract()?;
        let nodes: PyReadonlyArray1<'_, u32> = get("nodes")?.extract()?;
        inputs.push(BlockInput {
            element: get("element")?.extract()?,
            law: get("law")?.extract()?,
            parameters: get("parameters")?.extract()?,
            plane: super::material::plane(if plane == RING { "strain" } else { &plane })?,
            ring: plane == RING,
            local_strain: get("local_strain")?.extract()?,
            thickness: get("thickness")?.extract()?,
            profile: match d.get_item("profile")? {
                Some(v) => v.extract()?,
                None => [0.0; 3],
            },
            table: match d.get_item("table")? {
                Some(v) => v.extract()?,
                None => Vec::new(),
            },
            fibers: match d.get_item("fibers")? {
                Some(v) => v.extract()?,
                None => Vec::new(),
            },
            rho: get("rho")?.extract()?,
            nodal_thickness: numbers(d, "nodal_thickness")?,
            sides: numbers(d, "sides")?,
            nodal_density: numbers(d, "nodal_density")?,
            by_temperature: match d.get_item("by_temperature")? {
                Some(v) => v.extract()?,
                None => Vec::new(),
            },
            options: Options {
                mean_dilatation: match d.get_item("mean_dilatation")? {
                    Some(v) => v.extract()?,
                    None => false,
                },
                beta0: match d.get_item("beta0")? {
                    Some(v) => v.extract()?,
                    None => None,
                },
            },
            nodes: nodes.as_slice()?.to_vec(),
        });
    }
    Ok(inputs)
}
