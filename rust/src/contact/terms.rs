//! What one pair gives to its constraints, with derivatives.
// SPDX-License-Identifier: BSD-3-Clause

use crate::base::{Dual, Hyper, Smooth};

/// Most variables of a pair: two edges of six each.
pub const PAIR: usize = 12;
/// Most variables of a term: those of a pair, and of four nodes at ends of other masters.
pub const WIDTH: usize = 20;

/// A gap or a slip: its value, the direction in which its traction acts, and its linearization.
///
/// The direction of a gap is its gradient, and the linearization symmetric.
#[derive(Clone, Debug)]
pub struct Function {
    pub value: f64,
    pub gradient: [f64; WIDTH],
    /// Derivatives of the direction, row by row, of the first `size` variables.
    hessian: Vec<f64>,
    size: usize,
}

impl<const D: usize> From<&Hyper<D>> for Function {
    fn from(x: &Hyper<D>) -> Self {
        let mut gradient = [0.0; WIDTH];
        gradient[..D].copy_from_slice(&x.d);
        Self { value: x.v, gradient, hessian: x.h.as_flattened().to_vec(), size: D }
    }
}

impl Function {
    /// A slip, and the direction of its traction.
    pub fn along<const D: usize>(value: f64, direction: &[Dual<D>; D]) -> Self {
        let mut gradient = [0.0; WIDTH];
        gradient.iter_mut().zip(direction).for_each(|(g, d)| *g = d.v);
        let hessian = direction.iter().flat_map(|d| d.d).collect();
        Self { value, gradient, hessian, size: D }
    }

    /// A function that is zero.
    pub fn none() -> Self {
        Self { value: 0.0, gradient: [0.0; WIDTH], hessian: Vec::new(), size: 0 }
    }

    /// Adds `factor` times the linearization to a full square of `width` variables, which are all that
    /// are in use.
    pub fn add_hessian(&self, factor: f64, width: usize, to: &mut [f64]) {
        if factor == 0.0 {
            return;
        }
        let size = self.size.min(width);
        for i in 0..size {
            for j in 0..size {
                to[i * width + j] += factor * self.hessian[i * self.size + j];
            }
        }
    }
}

/// Share of one pair in one constraint.
#[derive(Clone, Debug)]
pub struct Share {
    pub constraint: usize,
    pub gap: Function,
    pub slip: Function,
    pub area: f64,
}

/// All shares of a pair.
#[derive(Clone, Debug)]
pub struct Terms {
    pub pair: usize,
    /// `3 node + component`, -1 where unused.
    pub variables: [i64; WIDTH],
    pub shares: Vec<Share>,
}

/// Variables of two sides, one after the other.
pub fn join(slave: &[i64], master: &[i64]) -> [i64; WIDTH] {
    let mut v = [-1; WIDTH];
    for (to, from) in v.iter_mut().zip(slave.iter().chain(master)) {
        *to = *from;
    }
    v
}

/// Variables without those that come again, and the place of each among them.
pub fn distinct(variables: &[i64]) -> (Vec<i64>, Vec<usize>) {
    let mut once: Vec<i64> = Vec::with_capacity(variables.len());
    let place = |v: &i64| {
        once.iter().position(|o| o == v).unwrap_or_else(|| {
            once.push(*v);
            once.len() - 1
        })
    };
    let places = variables.iter().map(place).collect();
    (once, places)
}

/// The numbers that `variables` name, as independent variables.
pub fn lifted<const D: usize>(variables: &[i64; WIDTH], x: &[[f64; 3]]) -> [Hyper<D>; D] {
    std::array::from_fn(|i| match usize::try_from(variables[i]) {
        Ok(v) => Hyper::variable(x[v / 3][v % 3], i),
        Err(_) => Hyper::real(0.0),
    })
}
