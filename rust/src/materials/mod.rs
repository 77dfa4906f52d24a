//! Material laws: one file each, values in and values out.
// SPDX-License-Identifier: BSD-3-Clause

pub mod arruda_boyce;
pub mod by_temperature;
pub mod c_function;
pub mod clock;
pub mod elastic;
pub mod external;
pub mod hardening;
pub mod hill;
pub mod hyperelastic;
pub mod hyperfoam;
pub mod law;
pub mod material;
pub mod mises;
pub mod mullins;
pub mod ogden;
pub mod orthotropic;
pub mod polynomial;
pub mod ramberg_osgood;
pub mod tabulated;
pub mod umat;
pub mod viscoelastic;
pub mod viscoplastic;

pub use clock::Clock;
pub use law::Law;
pub use material::{Material, Plane, PointState, Response, SolidResponse, State, TensorOutput};

/// The list of hyperelastic laws, each by its energy, between others: `Mullins` softens and
/// `Viscoelastic` relaxes all of them.
macro_rules! hyperelastic_laws {
    ($then:ident, [$($before:tt)*], [$($after:tt)*]) => {
        $then![
            $($before)*
            polynomial::Polynomial,
            ogden::Ogden,
            arruda_boyce::ArrudaBoyce,
            hyperfoam::Hyperfoam,
            $($after)*
        ];
    };
}
use hyperelastic_laws;

/// The one list of materials: call `$then![file::Type, ...]`. Elastic is the first.
macro_rules! laws {
    ($then:ident) => {
        $crate::materials::hyperelastic_laws![
            $then,
            [elastic::Elastic,],
            [
                orthotropic::Orthotropic,
                mises::Mises,
                hill::Hill,
                viscoplastic::Viscoplastic,
                viscoelastic::Viscoelastic,
                ramberg_osgood::RambergOsgood,
                mullins::Mullins,
                tabulated::Tabulated,
                c_function::CFunction,
                umat::Umat,
            ]
        ];
    };
}
use laws;
