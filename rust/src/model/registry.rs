//! The one list of elements: name, type, sizes (nodes, dofs a node, internal modes).
// SPDX-License-Identifier: BSD-3-Clause

/// Call `$then!(Type, N, M, A)` for every registered planar element.
#[macro_export]
macro_rules! for_each_planar_element {
    ($then:ident) => {
        $then!($crate::elements::t3::T3, 3, 2, 0);
        $then!($crate::elements::t6::T6, 6, 2, 0);
        $then!($crate::elements::q4::Q4, 4, 2, 0);
        $then!($crate::elements::q4i::Q4i, 4, 2, 2);
        $then!($crate::elements::q4s::Q4s, 4, 2, 2);
        $then!($crate::elements::q4r::Q4r, 4, 2, 0);
        $then!($crate::elements::q8::Q8, 8, 2, 0);
        $then!($crate::elements::q8::Q8r, 8, 2, 0);
        $then!($crate::elements::q9::Q9, 9, 2, 0);
        $then!($crate::elements::opt::Opt, 3, 3, 0);
        $then!($crate::elements::q4d::Q4d, 4, 3, 1);
        $then!($crate::elements::q4di::Q4di, 4, 3, 2);
    };
}

/// Call `$then!(Type, N, A)` for every element that can be turned about an axis.
#[macro_export]
macro_rules! for_each_ring {
    ($then:ident) => {
        $then!($crate::elements::t3::T3, 3, 0);
        $then!($crate::elements::t6::T6, 6, 0);
        $then!($crate::elements::q4::Q4, 4, 0);
        $then!($crate::elements::q4i::Q4i, 4, 2);
        $then!($crate::elements::q4s::Q4s, 4, 2);
        $then!($crate::elements::q4r::Q4r, 4, 0);
        $then!($crate::elements::q8::Q8, 8, 0);
        $then!($crate::elements::q8::Q8r, 8, 0);
        $then!($crate::elements::q9::Q9, 9, 0);
    };
}

/// Call `$then!(Type, N, M, A)` for every registered element.
#[macro_export]
macro_rules! for_each_element {
    ($then:ident) => {
        $crate::for_each_planar_element!($then);
        $then!($crate::elements::line::Truss, 2, 2, 0);
        $then!($crate::elements::line::Beam, 2, 3, 0);
        $then!($crate::elements::line::Spring, 2, 2, 0);
        $then!($crate::elements::line::Ground, 1, 2, 0);
        $then!($crate::elements::line::GroundTurn, 1, 3, 0);
        $then!($crate::elements::line::Between, 2, 2, 0);
        $then!($crate::elements::line::BetweenTurn, 2, 3, 0);
    };
}

use crate::elements::Element;

/// Facts of an element that the outside needs.
// Facts are independent of each other: no state machine hides in them.
#[allow(clippy::struct_excessive_bools)]
#[derive(Clone, Debug)]
pub struct Facts {
    pub name: &'static str,
    pub cell: &'static str,
    pub n_nodes: usize,
    pub dofs_per_node: usize,
    pub n_internal_modes: usize,
    pub n_points: usize,
    pub hourglass_modes: usize,
    pub alpha_b: f64,
    /// Whether the volume can stay constant without locking.
    pub free_volume: bool,
    /// Cells through a slender part below which it is too stiff in bending; 0 for none.
    pub bending_cells: usize,
    /// Whether its higher-order stiffness has a weight.
    pub weighted: bool,
    /// Whether nonlinear strains are linear about the mean gradient.
    pub about_mean: bool,
    /// Whether it has one point and a stabilized hourglass.
    pub stabilized: bool,
    /// Whether it can be turned about an axis.
    pub revolved: bool,
    /// Line element.
    pub line: bool,
    /// Line element without mass, section and axial strain.
    pub spring: bool,
    /// Whether its frame turns with it.
    pub turns: bool,
    /// Names of resultants of line elements.
    pub outputs: &'static [&'static str],
    /// What they give beside these where the law has a history.
    pub flow_outputs: &'static [&'static str],
}

/// All registered elements.
pub fn facts() -> Vec<Facts> {
    fn of<E: Element<N, M, A>, const N: usize, const M: usize, const A: usize>() -> Facts {
        Facts {
            name: E::NAME,
            cell: E::CELL,
            n_nodes: N,
            dofs_per_node: M,
            n_internal_modes: A,
            n_points: E::rule().len(),
            hourglass_modes: E::HOURGLASS,
            alpha_b: E::ALPHA_B,
            free_volume: E::FREE_VOLUME,
            bending_cells: E::BENDING_CELLS,
            weighted: E::parameter_of(1.0).is_some(),
            about_mean: E::ABOUT_MEAN,
            stabilized: E::MEMORY > 0 && !E::LINE,
            revolved: false,
            line: E::LINE,
            spring: E::SPRING,
            turns: E::TURNS,
            outputs: E::OUTPUTS,
            flow_outputs: E::FLOW_OUTPUTS,
        }
    }
    let mut all = Vec::new();
    macro_rules! push {
        ($e:ty, $n:literal, $m:literal, $a:literal) => {
            all.push(of::<$e, $n, $m, $a>());
        };
    }
    for_each_element!(push);
    macro_rules! mark {
        ($e:ty, $n:literal, $a:literal) => {
            for facts in &mut all {
                facts.revolved |= facts.name == <$e as Element<$n, 2, $a>>::NAME;
            }
        };
    }
    for_each_ring!(mark);
    all
}

/// Facts of the element of that name.
pub fn find(name: &str) -> Result<Facts, String> {
    facts().into_iter().find(|f| f.name == name).ok_or_else(|| {
        let names: Vec<_> = facts().iter().map(|f| f.name).collect();
        format!("no element named {name:?}; there are {}", names.join(", "))
    })
}

#[cfg(test)]
mod tests {
    use super::Element;
    use crate::kinematics::kernels::Kernels;

    /// Elements that share their code differ in the rule, and in facts that no code reads.
    fn code_fits<E: Element<N, M, A>, const N: usize, const M: usize, const A: usize>() {
        fn read<E: Element<N, M, A>, const N: usize, const M: usize, const A: usize>() -> String {
            let k = Kernels::<N, M>::of::<E, A>();
            let facts =
                (k.modes, k.memory, k.dissipated, k.line, k.spring, k.turns, k.ring, k.drill);
            let edges = (k.alpha_b, k.edge, (k.edge_of)(0.3, 0.7), (k.sides)([0.3, 0.2]));
            let strain = (E::ABOUT_MEAN, E::MEAN_DILATATION);
            let moduli = [[3.0, 1.0, 0.0], [1.0, 3.0, 0.0], [0.0, 0.0, 1.0]];
            let numbers = ((k.parameter)(&moduli), E::shape([0.3, 0.2]), E::mass_rule());
            format!("{facts:?} {edges:?} {strain:?} {numbers:?}")
        }
        assert_eq!(read::<E, N, M, A>(), read::<E::Code, N, M, A>(), "{}", E::NAME);
    }

    #[test]
    fn elements_that_share_their_code_differ_in_the_rule_only() {
        macro_rules! each {
            ($e:ty, $n:literal, $m:literal, $a:literal) => {
                code_fits::<$e, $n, $m, $a>();
            };
        }
        for_each_element!(each);
    }
}
