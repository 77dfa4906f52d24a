//! Blocks of elements from what the caller says of them, and their chunks by color.
// SPDX-License-Identifier: BSD-3-Clause

use super::chunk::{CHUNK, Chunk, Shared as BlockData};
use super::chunk_of::ChunkOf;
use super::dofs::Dofs;
use super::locality;
use super::registry;
use crate::base::small::Mat;
use crate::elements::{Element, Point, Ring};
use crate::kinematics::integrate::Section;
use crate::kinematics::local_strain::LocalStrain;
use crate::materials::by_temperature::LawTable;
use crate::materials::{Law, Plane, State};
use crate::{for_each_element, for_each_ring};
use std::sync::Arc;

/// Elements of one type with one material and section.
#[derive(Clone, Debug)]
pub struct BlockInput {
    pub element: String,
    pub law: String,
    pub parameters: Vec<f64>,
    pub plane: Plane,
    /// Whether it is a solid of revolution; the plane is then in strain.
    pub ring: bool,
    pub local_strain: String,
    pub thickness: f64,
    /// Thickness of the nodes, element by element; empty where it is the same everywhere.
    pub nodal_thickness: Vec<f64>,
    /// Share of the edge tractions that goes into end moments of drilling elements, by element and
    /// edge; empty where that of the element holds.
    pub sides: Vec<f64>,
    /// Section numbers of line elements.
    pub profile: [f64; 3],
    /// Pairs of elongation and force of nonlinear springs.
    pub table: Vec<[f64; 2]>,
    /// Fibers of beams, see [`Section::fibers`].
    pub fibers: Vec<[f64; 3]>,
    pub rho: f64,
    /// Density of the nodes, element by element; empty where it is the same everywhere.
    pub nodal_density: Vec<f64>,
    /// Temperatures, rising, and the parameters of the law there; empty for a law without.
    pub by_temperature: Vec<(f64, Vec<f64>)>,
    pub options: Options,
    /// Node indices, element by element.
    pub nodes: Vec<u32>,
}

/// Choices of a section that few need.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// Mean dilatation over each element: see [`crate::kinematics::dilatation`].
    pub mean_dilatation: bool,
    /// Weight of the higher-order stiffness of OPT; by default from the elastic moduli.
    pub beta0: Option<f64>,
}

/// What is kept of a block beside its chunks.
#[derive(Clone, Debug)]
pub struct Block {
    pub facts: registry::Facts,
    pub n_elements: usize,
    pub law: Law,
    /// Shape functions at the points, `[p, N]`.
    pub shape: Vec<f64>,
}

impl Block {
    /// Names of the scalars that recovery gives.
    pub fn outputs(&self) -> Vec<&'static str> {
        let of_law = self.law.outputs();
        if !self.facts.line {
            return of_law.to_vec();
        }
        let flow = if self.law.n_state() > 0 { self.facts.flow_outputs } else { &[] };
        [self.facts.outputs, flow, of_law].concat()
    }
}

/// The chunks of one block.
pub fn build(
    index: usize,
    input: &BlockInput,
    x: &[[f64; 2]],
    dofs: &Dofs,
) -> Result<(Block, Vec<Box<dyn Chunk>>), String> {
    fn of<E, Code, const N: usize, const M: usize, const A: usize>(
        index: usize,
        input: &BlockInput,
        x: &[[f64; 2]],
        dofs: &Dofs,
    ) -> Result<(Block, Vec<Box<dyn Chunk>>), String>
    where
        E: Element<N, M, A>,
        Code: Element<N, M, A>,
    {
        let element = ElementType {
            name: E::NAME,
            line: E::LINE,
            memory: E::MEMORY > 0,
            mean_dilatation: E::MEAN_DILATATION,
            points: E::points(&E::rule()),
            mass_points: E::points(&E::mass_rule()),
            parameter: E::parameter,
            parameter_of: E::parameter_of,
            chunk: ChunkOf::<N, M>::new::<Code, A>,
        };
        build_of(index, input, x, dofs, element)
    }
    macro_rules! pick {
        ($e:ty, $n:literal, $m:literal, $a:literal) => {
            if input.element == <$e as Element<$n, $m, $a>>::NAME {
                type Code = <$e as Element<$n, $m, $a>>::Code;
                return of::<$e, Code, $n, $m, $a>(index, input, x, dofs);
            }
        };
    }
    macro_rules! turn {
        ($e:ty, $n:literal, $a:literal) => {
            if input.element == <$e as Element<$n, 2, $a>>::NAME {
                type Code = Ring<<$e as Element<$n, 2, $a>>::Code>;
                return of::<Ring<$e>, Code, $n, 2, $a>(index, input, x, dofs);
            }
        };
    }
    if input.ring {
        for_each_ring!(turn);
        return Err(format!("{} is no element of an axisymmetric body", input.element));
    }
    for_each_element!(pick);
    Err(format!("no element named {:?}", input.element))
}

/// What the build of a block asks of an element type.
struct ElementType<const N: usize, const M: usize> {
    name: &'static str,
    line: bool,
    memory: bool,
    mean_dilatation: bool,
    points: Vec<Point<N>>,
    mass_points: Vec<Point<N>>,
    parameter: fn(&Mat<f64, 3>) -> f64,
    parameter_of: fn(f64) -> Option<f64>,
    chunk: fn(&Arc<BlockData<N>>, &[u32], &[[u32; N]], &Dofs) -> ChunkOf<N, M>,
}

/// The chunks of a block of an element type.
fn build_of<const N: usize, const M: usize>(
    index: usize,
    input: &BlockInput,
    x: &[[f64; 2]],
    dofs: &Dofs,
    element: ElementType<N, M>,
) -> Result<(Block, Vec<Box<dyn Chunk>>), String> {
    let state = if element.line { State::Line } else { State::Plane(input.plane) };
    let mut law = Law::new(&input.law, &input.parameters, state)?;
    if LocalStrain::new(&input.local_strain)? != LocalStrain::Logarithmic {
        law = law.linearized();
    }
    if element.line && element.memory && law.n_state() > 0 && input.fibers.is_empty() {
        return Err(format!("{} with {} needs the fibers of its profile", element.name, input.law));
    }
    if input.options.mean_dilatation && (!element.mean_dilatation || input.plane == Plane::Stress) {
        return Err(format!(
            "mean dilatation is for quadrilaterals without incompatible modes in plane strain, \
             not for {} in plane {}",
            element.name,
            if input.plane == Plane::Stress { "stress" } else { "strain" },
        ));
    }
    let section = Section {
        points: element.points,
        strain: if element.line {
            LocalStrain::Linear
        } else {
            LocalStrain::new(&input.local_strain)?
        },
        thickness: input.thickness,
        parameter: match input.options.beta0 {
            Some(beta0) => (element.parameter_of)(beta0)
                .ok_or_else(|| format!("{} has no parameter beta0", element.name))?,
            None => (element.parameter)(&law.moduli()),
        },
        law: law.clone(),
        plane: input.plane,
        ring: input.ring,
        profile: input.profile,
        table: input.table.clone(),
        fibers: input.fibers.clone(),
        mean_dilatation: input.options.mean_dilatation,
        finite: true,
    };
    for nodal in [&input.nodal_thickness, &input.nodal_density, &input.sides] {
        if !nodal.is_empty() && nodal.len() != input.nodes.len() {
            return Err("values of the nodes do not fit the elements".into());
        }
    }
    let table = match input.by_temperature.as_slice() {
        [] => None,
        rows => Some(LawTable::new(&input.law, state, rows)?),
    };
    let shape = section.points.iter().flat_map(|p| p.n).collect();
    let (linear, stressed) = (section.linearized(), section.stressed());
    let shared = BlockData {
        block: index,
        section,
        linear,
        stressed,
        rho: input.rho,
        table,
        weighted: input.options.beta0.is_some(),
        nodal_thickness: input.nodal_thickness.clone(),
        sides: input.sides.clone(),
        nodal_density: input.nodal_density.clone(),
        mass_points: element.mass_points,
    };
    let shared = Arc::new(shared);
    let nodes: Vec<[u32; N]> = input.nodes.as_chunks::<N>().0.to_vec();
    let order = locality::order(x, &input.nodes, N, CHUNK);
    let chunks = order.chunks(CHUNK).map(|elements| {
        let chunk = (element.chunk)(&shared, elements, &nodes, dofs);
        Box::new(chunk) as Box<dyn Chunk>
    });
    let facts = registry::find(element.name)?;
    Ok((Block { facts, n_elements: nodes.len(), law, shape }, chunks.collect()))
}

/// Greedy coloring: chunks of a color share no node.
pub fn color(chunks: Vec<Box<dyn Chunk>>, n_nodes: usize) -> Vec<Vec<Box<dyn Chunk>>> {
    let mut colors: Vec<Vec<Box<dyn Chunk>>> = Vec::new();
    // Colors seen at each node, 64 at a time; more fall into colors of their own.
    let mut seen = vec![0u64; n_nodes];
    for chunk in chunks {
        let nodes = chunk.nodes();
        let taken = nodes.iter().fold(0u64, |m, &n| m | seen[n as usize]);
        let free = (!taken).trailing_zeros() as usize;
        if free >= 64 {
            colors.resize_with(colors.len().max(64), Vec::new);
            colors.push(vec![chunk]);
            continue;
        }
        for &n in &nodes {
            seen[n as usize] |= 1 << free;
        }
        if colors.len() <= free {
            colors.resize_with(free + 1, Vec::new);
        }
        colors[free].push(chunk);
    }
    colors.retain(|c| !c.is_empty());
    colors
}
