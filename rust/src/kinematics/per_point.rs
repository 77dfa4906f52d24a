//! What the elements of a block do not share: thickness, edges, and laws at their temperature.
// SPDX-License-Identifier: BSD-3-Clause

use super::integrate::Section;
use crate::base::Real;
use crate::base::small::Mat;
use crate::materials::Law;
use crate::materials::by_temperature::LawTable;
use std::collections::HashMap;

/// Laws of all points of a chunk at their temperatures; points of one temperature share one.
#[derive(Clone, Debug)]
pub struct PointLaws {
    laws: Vec<Law>,
    /// Law of each point, `[n, p]`.
    index: Vec<u32>,
    /// [`crate::elements::Element::parameter`] of each element.
    parameter: Vec<f64>,
}

impl PointLaws {
    /// At temperatures `[n, p]`; `parameter` gives that of elastic moduli.
    pub fn new(
        table: &LawTable,
        temperatures: &[f64],
        n_points: usize,
        parameter: impl Fn(&Mat<f64, 3>) -> f64,
    ) -> Result<Self, String> {
        let mut laws = Vec::new();
        let mut known = HashMap::new();
        let mut index = Vec::with_capacity(temperatures.len());
        for &t in temperatures {
            let at = if let Some(&at) = known.get(&t.to_bits()) {
                at
            } else {
                laws.push(table.at(t)?);
                let at = laws.len() as u32 - 1;
                known.insert(t.to_bits(), at);
                at
            };
            index.push(at);
        }
        // Summed so that equal values give their value.
        let mean = |points: &[u32]| {
            points.iter().enumerate().fold(0.0, |mean, (k, &l)| {
                mean + (parameter(&laws[l as usize].moduli()) - mean) / (k + 1) as f64
            })
        };
        let parameter = index.chunks_exact(n_points).map(mean).collect();
        Ok(Self { laws, index, parameter })
    }

    /// Laws of an element.
    pub fn of(&self, element: usize) -> ElementLaws<'_> {
        let n_points = self.index.len() / self.parameter.len();
        ElementLaws {
            laws: &self.laws,
            index: &self.index[element * n_points..][..n_points],
            parameter: self.parameter[element],
        }
    }
}

/// Laws of the points of one element.
#[derive(Clone, Copy)]
pub struct ElementLaws<'a> {
    laws: &'a [Law],
    index: &'a [u32],
    parameter: f64,
}

/// What an element (of a batch) has instead of what its section says.
#[derive(Clone, Copy, Default)]
pub struct PerPoint<'a> {
    /// Thickness by point, `stride` apart; empty where that of the section holds.
    pub thickness: &'a [f64],
    /// Shares of the edges, `stride` apart; empty where those of the element hold.
    pub sides: &'a [f64],
    pub stride: usize,
    /// Laws that follow the temperature. Their coefficients are plain numbers, so that batches of
    /// several elements have none.
    pub laws: Option<ElementLaws<'a>>,
}

impl<'a> PerPoint<'a> {
    /// Of the element `e` of a chunk.
    pub fn of(
        thickness: &'a [f64],
        sides: &'a [f64],
        laws: Option<&'a PointLaws>,
        e: usize,
        stride: usize,
    ) -> Self {
        let from = |values: &'a [f64]| if values.is_empty() { values } else { &values[e..] };
        Self { thickness: from(thickness), sides: from(sides), stride, laws: laws.map(|l| l.of(e)) }
    }

    /// Number of each edge for [`crate::elements::Element::prepare`], `edge` unless given.
    #[inline(always)]
    pub fn sides<T: Real, const N: usize>(&self, edge: f64) -> [T; N] {
        if self.sides.is_empty() {
            return [T::real(edge); N];
        }
        std::array::from_fn(|a| T::load(&self.sides[a * self.stride..]))
    }

    /// Thickness at a point.
    #[inline(always)]
    pub fn thickness<T: Real, const N: usize>(&self, p: usize, section: &Section<N>) -> T {
        if self.thickness.is_empty() {
            return T::real(section.thickness);
        }
        T::load(&self.thickness[p * self.stride..])
    }

    /// Law at a point.
    #[inline(always)]
    pub fn law<'s, T: Real, const N: usize>(&self, p: usize, section: &'s Section<N>) -> &'s Law
    where
        'a: 's,
    {
        match self.laws {
            Some(own) if T::LANES == 1 => &own.laws[own.index[p] as usize],
            _ => &section.law,
        }
    }

    /// [`crate::elements::Element::parameter`].
    #[inline(always)]
    pub fn parameter<T: Real, const N: usize>(&self, section: &Section<N>) -> f64 {
        match self.laws {
            Some(own) if T::LANES == 1 => own.parameter,
            _ => section.parameter,
        }
    }
}
