//! Sizes of residual, forces and displacements, of forces and moments apart, in one pass.
// SPDX-License-Identifier: BSD-3-Clause

use super::dofs::Dofs;

/// Largest absolute values: of displacement dofs first, of rotations second.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sizes {
    /// Of forces: element sums and external ones.
    pub scale: [f64; 2],
    /// Of the residual at dofs that are not held.
    pub residual: [f64; 2],
    /// Where that is.
    pub worst: [usize; 2],
    pub displacement: [f64; 2],
}

/// Largest of both; not a number wins and stays.
fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// Sizes by dof; all arrays have one entry for each dof. With `balance` the residual is what
/// is left of `residual` against the external forces.
pub fn sizes(
    dofs: &Dofs,
    residual: &[f64],
    scale: &[f64],
    external: &[f64],
    u: &[f64],
    held: &[bool],
    balance: bool,
) -> Sizes {
    let mut out = Sizes::default();
    for node in dofs.start.windows(2) {
        for d in node[0] as usize..node[1] as usize {
            let k = usize::from(d == node[0] as usize + 2);
            out.scale[k] = larger(larger(out.scale[k], scale[d].abs()), external[d].abs());
            out.displacement[k] = larger(out.displacement[k], u[d].abs());
            let left = if balance { residual[d] - external[d] } else { residual[d] };
            let r = if held[d] { 0.0 } else { left.abs() };
            if r > out.residual[k] || r.is_nan() {
                out.residual[k] = r;
                out.worst[k] = d;
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_and_moments_are_apart_and_nan_is_seen() {
        let dofs = Dofs::new(&[3, 2], &[]);
        let (residual, scale) = ([1.0, -5.0, 7.0, 9.0, 2.0], [1.0, 2.0, 3.0, 4.0, -8.0]);
        let external = [0.0, -9.0, 1.0, 0.0, 0.0];
        let u = [0.1, -0.2, 0.9, 0.0, 0.0];
        let held = [false, false, false, true, false];
        let s = sizes(&dofs, &residual, &scale, &external, &u, &held, false);
        let want = Sizes {
            scale: [9.0, 3.0],
            residual: [5.0, 7.0],
            worst: [1, 2],
            displacement: [0.2, 0.9],
        };
        assert_eq!(s, want);
        let internal: Vec<f64> = residual.iter().zip(external).map(|(r, e)| r + e).collect();
        assert_eq!(sizes(&dofs, &internal, &scale, &external, &u, &held, true), want);
        let broken = [1.0, f64::NAN, 0.0, 2.0, 3.0];
        let s = sizes(&dofs, &broken, &scale, &external, &u, &held, false);
        assert!(s.residual[0].is_nan());
    }
}
