//! The time that an evaluation spans, for laws that depend on it.
// SPDX-License-Identifier: BSD-3-Clause

/// An increment of time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Clock {
    /// Its length; 0 for an answer about the committed state, in which nothing flows with time.
    pub increment: f64,
    /// The total time at its end.
    pub end: f64,
    /// Whether slow processes take part: creep and relaxation.
    pub lasting: bool,
}
