//! An element type without its type: facts and functions, by which all that is written for single
//! elements is compiled once for each number of nodes and dofs.
// SPDX-License-Identifier: BSD-3-Clause

use super::integrate::{History, Local, PointKinematics, Section, single_into};
use super::law_tape::{Along, Number};
use super::per_point::PerPoint;
use crate::base::small::{Mat, Nodal};
use crate::elements::element::Wanted;
use crate::elements::line::Resultants;
use crate::elements::{Element, Operator, Point};

/// [`Element::respond`].
pub type Respond<T, const N: usize, const M: usize> = fn(
    &Nodal<T, N, 2>,
    &Nodal<T, N, M>,
    &Section<N>,
    &mut History<'_>,
    Wanted,
    &mut Local<T, N, M>,
);

type LocalInto<const N: usize, const M: usize> = fn(
    &Nodal<f64, N, 2>,
    &Nodal<f64, N, M>,
    &Section<N>,
    &mut History<'_>,
    bool,
    &mut Local<f64, N, M>,
);
type Absorbed<const N: usize, const M: usize> =
    fn(&Nodal<f64, N, 2>, &Nodal<f64, N, M>, &Section<N>, &mut History<'_>) -> f64;

/// Facts and functions of an [`Element`], under its names.
// Facts are independent of each other: no state machine hides in them.
#[allow(clippy::struct_excessive_bools)]
pub struct Kernels<const N: usize, const M: usize> {
    /// Internal displacement modes of two components each.
    pub modes: usize,
    pub memory: usize,
    pub dissipated: Option<usize>,
    pub alpha_b: f64,
    pub edge: f64,
    pub line: bool,
    pub spring: bool,
    pub turns: bool,
    pub ring: bool,
    pub drill: bool,
    pub parameter: fn(&Mat<f64, 3>) -> f64,
    pub edge_of: fn(f64, f64) -> f64,
    pub sides: fn([f64; 2]) -> [f64; N],
    pub measure: fn(&Nodal<f64, N, 2>, &Point<N>) -> f64,
    pub respond: Respond<f64, N, M>,
    pub respond_along: Respond<Along, N, M>,
    pub respond_number: Respond<Number, N, M>,
    /// [`single_into`] and [`Element::absorbed_at`]; not of solids of revolution, which have more local
    /// dofs.
    pub in_frame: Option<(LocalInto<N, M>, Absorbed<N, M>)>,
    /// The internal modes one after the other.
    pub kinematics: fn(
        &Nodal<f64, N, 2>,
        &Nodal<f64, N, M>,
        &[f64],
        &Section<N>,
        &PerPoint<'_>,
        bool,
    ) -> Vec<PointKinematics>,
    pub absorbed:
        fn(&Nodal<f64, N, 2>, &Nodal<f64, N, M>, &Section<N>, &mut History<'_>, bool) -> f64,
    pub stabilization: fn(
        &Nodal<f64, N, 2>,
        &Nodal<f64, N, M>,
        &Section<N>,
        &PerPoint<'_>,
        &[f64],
    ) -> [[f64; 2]; 2],
    pub resultants:
        fn(&Nodal<f64, N, 2>, &Nodal<f64, N, M>, &Section<N>, &mut History<'_>) -> Resultants,
}

impl<const N: usize, const M: usize> Kernels<N, M> {
    /// Of an element type.
    pub fn of<E, const A: usize>() -> Self
    where
        E: Element<N, M, A>,
    {
        Self {
            modes: A,
            memory: E::MEMORY,
            dissipated: E::DISSIPATED,
            alpha_b: E::ALPHA_B,
            edge: E::EDGE,
            line: E::LINE,
            spring: E::SPRING,
            turns: E::TURNS,
            ring: E::RING,
            drill: E::Op::<f64>::DRILL,
            parameter: E::parameter,
            edge_of: E::edge,
            sides: E::sides,
            measure: E::measure::<f64>,
            respond: E::respond::<f64>,
            respond_along: E::respond::<Along>,
            respond_number: E::respond::<Number>,
            in_frame: if const { E::RING } {
                None
            } else {
                Some((single_into::<E, f64, N, M, A>, E::absorbed_at))
            },
            kinematics: |x, u, modes, section, own, nlgeom| {
                let (alpha, _) = modes.as_chunks::<2>();
                let alpha = std::array::from_fn(|m| alpha[m]);
                E::kinematics(x, u, &alpha, section, own, nlgeom)
            },
            absorbed: E::absorbed,
            stabilization: E::stabilization::<f64>,
            resultants: E::resultants,
        }
    }
}
