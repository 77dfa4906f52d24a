//! Material laws: one file each, values in and values out.
// SPDX-License-Identifier: BSD-3-Clause

pub mod by_temperature;
pub mod elastic;
pub mod hardening;
pub mod law;
pub mod material;
pub mod mises;
pub mod orthotropic;
pub mod ramberg_osgood;
pub mod tabulated;

pub use law::Law;
pub use material::{Material, Plane, PointState, Response, TensorOutput};

/// The one list of materials: call `$then![file::Type, ...]`.
macro_rules! laws {
    ($then:ident) => {
        $then![
            elastic::Elastic,
            orthotropic::Orthotropic,
            mises::Mises,
            ramberg_osgood::RambergOsgood,
            tabulated::Tabulated,
        ];
    };
}
use laws;
