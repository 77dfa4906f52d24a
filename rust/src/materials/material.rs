//! What a material is: a pure function of the strain and the committed state.
// SPDX-License-Identifier: BSD-3-Clause

use super::clock::Clock;
use crate::base::Real;
use crate::base::small::Mat;

/// Kinematic assumption through the thickness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    Stress,
    Strain,
}

/// Stress state in which a law stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// In a plane.
    Plane(Plane),
    /// Along a line: one normal stress, in the first row.
    Line,
}

/// History of one point (of one batch of lanes): the committed values are read, the new ones
/// written. Members lie `stride` apart.
pub struct PointState<'a> {
    pub old: &'a [f64],
    pub new: &'a mut [f64],
    pub stride: usize,
    pub clock: Clock,
}

impl PointState<'_> {
    #[inline(always)]
    pub fn get<T: Real>(&self, member: usize) -> T {
        T::load(&self.old[member * self.stride..])
    }
    #[inline(always)]
    pub fn set<T: Real>(&mut self, member: usize, value: T) {
        value.store(&mut self.new[member * self.stride..]);
    }
}

/// Answer of a material at a point; rows xx, yy, xy, shear strain engineering.
#[derive(Clone, Copy)]
pub struct Response<T: Real> {
    pub stress: [T; 3],
    /// Algorithmic tangent, symmetric.
    pub tangent: Mat<T, 3>,
    /// Lanes in which the update did not converge.
    pub failed: T::Mask,
}

/// Answer of a material with a strain through the thickness; rows xx, yy, xy, zz.
#[derive(Clone, Copy)]
pub struct SolidResponse<T: Real> {
    pub stress: [T; 4],
    /// Algorithmic tangent, symmetric.
    pub tangent: Mat<T, 4>,
    /// Lanes in which the update did not converge.
    pub failed: T::Mask,
}

/// A symmetric tensor of the state, for output.
#[derive(Clone, Copy, Debug)]
pub struct TensorOutput {
    pub name: &'static str,
    /// Whether its shear is engineering shear (twice the tensor's).
    pub engineering: bool,
}

/// A material law in the plane.
pub trait Material: Sized {
    const NAME: &'static str;
    /// Parameters that tests try the law with: first all that it can have, for strains of some
    /// tenths; then cases with a symmetric tangent, for strains of some hundredths.
    const EXAMPLES: &'static [&'static [f64]];
    /// Whether the update is a few products, which elements have inlined into their own loops.
    const SHORT: bool = false;

    /// Build from numbers in the order that the law's file documents.
    fn new(parameters: &[f64], plane: Plane) -> Result<Self, String>;
    /// The law of a bar, with one normal stress in the first row: others have no strain and no
    /// stress. Its moduli are Young's (11) and the shear modulus (33).
    fn line(_parameters: &[f64]) -> Result<Self, String> {
        Err(format!("{} is not for trusses and beams", Self::NAME))
    }
    /// The law for infinitesimal displacements.
    fn linearized(self) -> Self {
        self
    }
    /// Members of the history at a point.
    fn n_state(&self) -> usize {
        0
    }
    /// Whether stress is a linear function of strain.
    fn is_linear(&self) -> bool {
        false
    }
    /// Elastic moduli in the plane.
    fn moduli(&self) -> Mat<f64, 3>;
    fn update<T: Real>(&self, strain: [T; 3], state: &mut PointState<'_>) -> Response<T>;
    /// Bulk modulus of an isotropic law whose mean stress is that times the volume strain, whatever
    /// its deviator.
    fn bulk(&self) -> Option<f64> {
        None
    }
    /// Answer of a law for plane strain that has a strain through the thickness as well: a
    /// temperature there, or a hoop. Laws with a bulk modulus have it from [`Material::update`]:
    /// the same deviator with no strain through the thickness, and the rest of the mean stress.
    /// Others give it, or fail.
    #[inline(always)]
    fn update_solid<T: Real>(
        &self,
        strain: [T; 4],
        state: &mut PointState<'_>,
    ) -> SolidResponse<T> {
        let Some(bulk) = self.bulk() else {
            let o = T::zero();
            let failed = o.lt(T::one());
            return SolidResponse { stress: [o; 4], tangent: [[o; 4]; 4], failed };
        };
        let [x, y, xy, z] = strain;
        let plane = self.update([x - z, y - z, xy], state);
        let rest = z.scale(3.0 * bulk);
        let (sx, sy) = (plane.stress[0] + rest, plane.stress[1] + rest);
        let mean = (x + y + z).scale(bulk);
        let mut tangent = [[T::zero(); 4]; 4];
        for i in 0..3 {
            let normal = T::real(if i < 2 { bulk } else { 0.0 });
            for j in 0..3 {
                tangent[i][j] = plane.tangent[i][j];
            }
            // Of the stress through the thickness, which is three times the mean less the others.
            let v = normal.scale(3.0) - plane.tangent[0][i] - plane.tangent[1][i];
            (tangent[3][i], tangent[i][3]) = (v, v);
        }
        let d = &plane.tangent;
        tangent[3][3] = d[0][0] + d[1][1] + d[0][1].scale(2.0) - T::real(3.0 * bulk);
        let stress = [sx, sy, plane.stress[2], mean.scale(3.0) - sx - sy];
        SolidResponse { stress, tangent, failed: plane.failed }
    }
    /// Strain and stress through the thickness (zz) of a state that [`Material::update`] wrote.
    fn out_of_plane(&self, strain: [f64; 3], stress: [f64; 3], state: &[f64]) -> (f64, f64);
    /// Recoverable energy density.
    fn energy(&self, strain: [f64; 3], stress: [f64; 3], state: &[f64]) -> f64;
    /// Stress in the plane of the state that [`Material::update_solid`] asks [`Material::update`]
    /// for, by the answer in the plane and the strain zz: that which [`Material::output`] takes.
    fn without_normal_strain(&self, s: [f64; 3], zz: f64) -> [f64; 3] {
        let rest = 3.0 * self.bulk().unwrap_or(0.0) * zz;
        [s[0] - rest, s[1] - rest, s[2]]
    }
    /// Recoverable energy density of an answer of [`Material::update_solid`]. With a bulk modulus it
    /// is that of the state in plane strain, and the difference in the volume.
    fn energy_solid(&self, e: [f64; 4], s: [f64; 4], state: &[f64]) -> f64 {
        let Some(bulk) = self.bulk() else { return f64::NAN };
        let [x, y, xy, z] = e;
        let plane = self.without_normal_strain([s[0], s[1], s[2]], z);
        let rest = 1.5 * bulk * z * (2.0 * (x + y) - z);
        self.energy([x - z, y - z, xy], plane, state) + rest
    }
    /// Whether an initial stress through the thickness acts in all three directions (so that
    /// the deviator is left alone); else it stands beside what the law gives.
    fn spherical(&self) -> bool {
        false
    }
    /// Energy density that an initial stress through the thickness adds to [`Material::energy`];
    /// `stress` and `normal` are the law's own.
    fn initial_energy(&self, _stress: [f64; 3], _normal: f64, _initial: f64) -> f64 {
        0.0
    }
    /// Named scalars of the state for output.
    fn outputs(&self) -> &'static [&'static str] {
        &[]
    }
    /// Value of the `i`-th output.
    fn output(&self, _i: usize, _stress: [f64; 3], _state: &[f64]) -> f64 {
        0.0
    }
    /// Tensors of the state for output.
    fn tensors(&self) -> &'static [TensorOutput] {
        &[]
    }
    /// Rows 11, 22, 33, 12 of the `i`-th tensor, in the axes of the strain.
    fn tensor(&self, _i: usize, _state: &[f64]) -> [f64; 4] {
        [0.0; 4]
    }
    /// Member of the state that is the equivalent plastic strain.
    fn plastic_member(&self) -> Option<usize> {
        None
    }
    /// Member of the state that is the error of the creep strain of an increment.
    fn creep_error_member(&self) -> Option<usize> {
        None
    }
    /// Whether hardening ends, so that the tangent may have no stiffness along the flow.
    fn ideal(&self) -> bool {
        false
    }
    /// Member of the state that is the plastic work: with [`Material::energy`], the work of the
    /// stress.
    fn work_member(&self) -> Option<usize> {
        None
    }
}

/// Stress of linear elasticity.
#[inline(always)]
pub fn hooke<T: Real>(moduli: &Mat<f64, 3>, strain: [T; 3]) -> [T; 3] {
    let mut s = [T::zero(); 3];
    for i in 0..3 {
        for j in 0..3 {
            s[i] = strain[j].fma(T::real(moduli[i][j]), s[i]);
        }
    }
    s
}

/// Plain moduli as numbers of another kind.
#[inline(always)]
pub fn broadcast<T: Real>(m: &Mat<f64, 3>) -> Mat<T, 3> {
    let mut t = [[T::zero(); 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            t[i][j] = T::real(m[i][j]);
        }
    }
    t
}

/// Tangent in components xx, yy, xy from its upper triangle by sum, difference and shear, of
/// which the rows of sum and difference are halved.
#[inline(always)]
pub fn in_plane<T: Real>(b: &Mat<T, 3>) -> Mat<T, 3> {
    let cross = b[0][0] - b[1][1];
    let straight = b[0][0] + b[1][1];
    let twice = b[0][1].scale(2.0);
    let (d13, d23) = (b[0][2] + b[1][2], b[0][2] - b[1][2]);
    [[straight + twice, cross, d13], [cross, straight - twice, d23], [d13, d23, b[2][2]]]
}
