// SPDX-License-Identifier: BSD-3-Clause
//! What a linear solver can refuse, each with the equation it is about.

use std::fmt;

use crate::base::memory::Shortage;

/// Reasons for which a factorization or a solve gives no answer.
#[derive(Debug, Clone, PartialEq)]
pub enum LinearError {
    /// The pattern or the shape of an argument is not what the interface asks for.
    Pattern(String),
    /// An entry is not a finite number; `row` and `column` in the caller's numbering.
    NotFinite { row: usize, column: usize },
    /// The right-hand side has a value that is not finite.
    RhsNotFinite { equation: usize },
    /// The matrix is singular to working precision.
    Singular(Singular),
    /// The residual stayed above what the guard allows after refinement.
    Inaccurate { backward_error: f64, growth: f64 },
    /// A method was called before the one it needs.
    Order(&'static str),
    /// There is not enough memory.
    Memory(Shortage),
}

impl From<Shortage> for LinearError {
    fn from(shortage: Shortage) -> Self {
        Self::Memory(shortage)
    }
}

/// A singular matrix: where the pivot vanished and which motion costs nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct Singular {
    /// Equation whose motion is largest in the first null vector.
    pub equation: usize,
    /// Pivot met there, as a fraction of the (scaled) diagonal.
    pub pivot: f64,
    /// Number of null vectors found, 0 if only a bound is known.
    pub nullity: usize,
    /// Null vectors in the caller's numbering, one after the other, largest entry one.
    pub modes: Vec<f64>,
}

impl fmt::Display for LinearError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pattern(text) => write!(f, "matrix pattern: {text}"),
            Self::NotFinite { row, column } => {
                write!(f, "matrix entry ({row}, {column}) is not a finite number")
            }
            Self::RhsNotFinite { equation } => {
                write!(f, "right-hand side at equation {equation} is not a finite number")
            }
            Self::Singular(s) => write!(
                f,
                "matrix is singular: pivot {:.1e} of the diagonal at equation {}, \
                 {} motion(s) without stiffness",
                s.pivot, s.equation, s.nullity
            ),
            Self::Inaccurate { backward_error, growth } => write!(
                f,
                "solution refused: backward error {backward_error:.1e} after refinement, \
                 growth {growth:.1e}"
            ),
            Self::Order(text) => f.write_str(text),
            Self::Memory(shortage) => shortage.fmt(f),
        }
    }
}

impl std::error::Error for LinearError {}
