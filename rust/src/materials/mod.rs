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

/// The one list of materials: call `$then![file::Type, ...]`.
macro_rules! laws {
    ($then:ident) => {
        $then![
            elastic::Elastic,
            orthotropic::Orthotropic,
            mises::Mises,
            hill::Hill,
            viscoplastic::Viscoplastic,
            viscoelastic::Viscoelastic,
            ramberg_osgood::RambergOsgood,
            polynomial::Polynomial,
            ogden::Ogden,
            arruda_boyce::ArrudaBoyce,
            hyperfoam::Hyperfoam,
            mullins::Mullins,
            tabulated::Tabulated,
            c_function::CFunction,
            umat::Umat,
        ];
    };
}
use laws;
