//! The type of all materials together, made from the list of them. A block holds one [`Law`];
//! the branch is uniform over the block.
// SPDX-License-Identifier: BSD-3-Clause

use super::material::{Material, PointState, Response, SolidResponse, State, TensorOutput};
use crate::base::small::Mat;
use crate::base::{Job, Real};

/// [`Material::update`] as a job.
struct Update<'a, 'b, M, T> {
    law: &'a M,
    e: [T; 3],
    state: &'a mut PointState<'b>,
}

impl<M: Material, T: Real> Job for Update<'_, '_, M, T> {
    type Output = Response<T>;
    #[inline(always)]
    fn run(self) -> Response<T> {
        self.law.update(self.e, self.state)
    }
}

/// [`Material::update_solid`] as a job.
struct UpdateSolid<'a, 'b, M, T> {
    law: &'a M,
    e: [T; 4],
    state: &'a mut PointState<'b>,
}

impl<M: Material, T: Real> Job for UpdateSolid<'_, '_, M, T> {
    type Output = SolidResponse<T>;
    #[inline(always)]
    fn run(self) -> SolidResponse<T> {
        self.law.update_solid(self.e, self.state)
    }
}

/// The choice among laws as a job: elements call one instance of it.
struct Chosen<'a, 'b, S> {
    law: &'a Law,
    e: S,
    state: &'a mut PointState<'b>,
}

/// One instance for each law and number type, whatever the elements that call it. Short laws are
/// inlined in the choice, and in batches of elements.
#[inline(always)]
pub(super) fn update<M: Material, T: Real>(
    law: &M,
    e: [T; 3],
    state: &mut PointState<'_>,
) -> Response<T> {
    if const { M::SHORT } { law.update(e, state) } else { T::apart(Update { law, e, state }) }
}

#[inline(always)]
pub(super) fn update_solid<M: Material, T: Real>(
    law: &M,
    e: [T; 4],
    state: &mut PointState<'_>,
) -> SolidResponse<T> {
    if const { M::SHORT } {
        law.update_solid(e, state)
    } else {
        T::apart(UpdateSolid { law, e, state })
    }
}

macro_rules! law {
    ($($file:ident::$name:ident),+ $(,)?) => {
        $(use super::$file::$name;)+

        /// Any registered material.
        #[derive(Clone, Debug)]
        pub enum Law { $($name($name)),+ }

        impl<T: Real> Job for Chosen<'_, '_, [T; 3]> {
            type Output = Response<T>;
            #[inline(always)]
            fn run(self) -> Response<T> {
                let (e, state) = (self.e, self.state);
                match self.law { $(Law::$name(m) => update(m, e, state)),+ }
            }
        }

        impl<T: Real> Job for Chosen<'_, '_, [T; 4]> {
            type Output = SolidResponse<T>;
            #[inline(always)]
            fn run(self) -> SolidResponse<T> {
                let (e, state) = (self.e, self.state);
                match self.law { $(Law::$name(m) => update_solid(m, e, state)),+ }
            }
        }

        impl Law {
            /// Names of all materials.
            pub const NAMES: &'static [&'static str] = &[$($name::NAME),+];

            /// [`Material::EXAMPLES`] of the material of that name.
            pub fn examples(name: &str) -> &'static [&'static [f64]] {
                $(if name == $name::NAME {
                    return $name::EXAMPLES;
                })+
                &[]
            }

            /// Build the material of that name.
            pub fn new(name: &str, parameters: &[f64], state: State) -> Result<Self, String> {
                $(if name == $name::NAME {
                    return match state {
                        State::Plane(plane) => $name::new(parameters, plane),
                        State::Line => $name::line(parameters),
                    }
                    .map(Law::$name);
                })+
                Err(format!("no material named {name:?}; there are {:?}", Self::NAMES))
            }
            pub fn linearized(&self) -> Self {
                match self { $(Law::$name(m) => Law::$name(m.clone().linearized())),+ }
            }
            pub fn n_state(&self) -> usize {
                match self { $(Law::$name(m) => m.n_state()),+ }
            }
            pub fn is_linear(&self) -> bool {
                match self { $(Law::$name(m) => m.is_linear()),+ }
            }
            pub fn moduli(&self) -> Mat<f64, 3> {
                match self { $(Law::$name(m) => m.moduli()),+ }
            }
            #[inline(always)]
            pub fn update<T: Real>(&self, e: [T; 3], state: &mut PointState<'_>) -> Response<T> {
                match self {
                    $(Law::$name(m) if const { $name::SHORT && T::LANES > 1 } => m.update(e, state),)+
                    _ => T::apart(Chosen { law: self, e, state }),
                }
            }
            #[inline(always)]
            pub fn update_solid<T: Real>(
                &self,
                e: [T; 4],
                state: &mut PointState<'_>,
            ) -> SolidResponse<T> {
                match self {
                    $(Law::$name(m) if const { $name::SHORT && T::LANES > 1 } => m.update_solid(e, state),)+
                    _ => T::apart(Chosen { law: self, e, state }),
                }
            }
            pub fn out_of_plane(&self, e: [f64; 3], s: [f64; 3], state: &[f64]) -> (f64, f64) {
                match self { $(Law::$name(m) => m.out_of_plane(e, s, state)),+ }
            }
            pub fn energy(&self, e: [f64; 3], s: [f64; 3], state: &[f64]) -> f64 {
                match self { $(Law::$name(m) => m.energy(e, s, state)),+ }
            }
            pub fn energy_solid(&self, e: [f64; 4], s: [f64; 4], state: &[f64]) -> f64 {
                match self { $(Law::$name(m) => m.energy_solid(e, s, state)),+ }
            }
            pub fn without_normal_strain(&self, s: [f64; 3], zz: f64) -> [f64; 3] {
                match self { $(Law::$name(m) => m.without_normal_strain(s, zz)),+ }
            }
            pub fn spherical(&self) -> bool {
                match self { $(Law::$name(m) => m.spherical()),+ }
            }
            pub fn initial_energy(&self, s: [f64; 3], normal: f64, initial: f64) -> f64 {
                match self { $(Law::$name(m) => m.initial_energy(s, normal, initial)),+ }
            }
            pub fn outputs(&self) -> &'static [&'static str] {
                match self { $(Law::$name(m) => m.outputs()),+ }
            }
            pub fn output(&self, i: usize, s: [f64; 3], state: &[f64]) -> f64 {
                match self { $(Law::$name(m) => m.output(i, s, state)),+ }
            }
            pub fn tensors(&self) -> &'static [TensorOutput] {
                match self { $(Law::$name(m) => m.tensors()),+ }
            }
            pub fn tensor(&self, i: usize, state: &[f64]) -> [f64; 4] {
                match self { $(Law::$name(m) => m.tensor(i, state)),+ }
            }
            pub fn plastic_member(&self) -> Option<usize> {
                match self { $(Law::$name(m) => m.plastic_member()),+ }
            }
            pub fn creep_error_member(&self) -> Option<usize> {
                match self { $(Law::$name(m) => m.creep_error_member()),+ }
            }
            #[inline(always)]
            pub fn ideal(&self) -> bool {
                match self { $(Law::$name(m) => m.ideal()),+ }
            }
            pub fn work_member(&self) -> Option<usize> {
                match self { $(Law::$name(m) => m.work_member()),+ }
            }
        }
    };
}

super::laws!(law);
