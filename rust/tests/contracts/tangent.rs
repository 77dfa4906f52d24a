//! The force is the gradient of the strain energy, the tangent the derivative of the force.
// SPDX-License-Identifier: BSD-3-Clause

use super::common::{
    Random, cell, dense, evaluate, largest, norm, section, state, strains, variables,
};
use corota::base::{Dual, Real};
use corota::elements::{Element, Operator};
use corota::for_each_planar_element;
use corota::kinematics::integrate::{Section, gradient};
use corota::kinematics::local_strain::LocalStrain;
use corota::kinematics::per_point::PerPoint;
use corota::materials::Plane;

const EXACT: f64 = 1e-10;

/// Visit states of large rotation and up to 20 % strain, in turning and fixed frames.
///
/// Quadratic strains have no minimum with respect to internal modes under strong compression;
/// such states are refused, and only such, one in twenty at most.
fn states<E: Element<N, M, A>, const N: usize, const M: usize, const A: usize>(
    mut visit: impl FnMut(&[[f64; 2]; N], &[[f64; M]; N], &Section<N>, bool),
) {
    let mut random = Random::new(7);
    let (mut visited, mut refused) = (0, 0);
    for strain in strains() {
        for plane in [Plane::Stress, Plane::Strain] {
            let section = section::<E, N, M, A>(plane, strain);
            for nlgeom in [true, false] {
                for _ in 0..12 {
                    let x = cell::<N>(E::CELL, &mut random, 0.05);
                    // A fixed frame is for small rotations.
                    let angle = if nlgeom { 10.0 * random.signed() } else { 0.1 };
                    let u = state::<N, M>(&x, &mut random, angle, 0.2);
                    if evaluate::<E, f64, N, M, A>(&x, &u, &section, nlgeom).failed {
                        assert!(A > 0 && strain != LocalStrain::Linear, "{}", E::NAME);
                        refused += 1;
                        continue;
                    }
                    visited += 1;
                    visit(&x, &u, &section, nlgeom);
                }
            }
        }
    }
    assert!(19 * refused <= visited, "{}: refused {refused}", E::NAME);
}

fn check<E, const N: usize, const M: usize, const A: usize, const D: usize>()
where
    E: Element<N, M, A>,
{
    let name = E::NAME;
    let mut worst = 0.0_f64;
    states::<E, N, M, A>(|x, u, section, nlgeom| {
        let plain = evaluate::<E, f64, N, M, A>(x, u, section, nlgeom);
        let v = variables::<N, M, D>(u);
        let dual = evaluate::<E, Dual<D>, N, M, A>(x, &v, section, nlgeom);
        let k = dense(&plain.stiffness);
        let (size, stiff) = (largest(plain.force.as_flattened()), norm(&k));
        for r in 0..D {
            let f = dual.force[r / M][r % M];
            let error = (f.v - plain.force[r / M][r % M]).abs();
            assert!(error <= 1e-12 * size, "{name}: number types differ by {error:e}");
            for c in 0..D {
                worst = worst.max((k[r][c] - f.d[c]).abs() / stiff);
                assert!((k[r][c] - k[c][r]).abs() <= 1e-13 * stiff, "{name}: not symmetric");
            }
        }
    });
    assert!(worst <= EXACT, "{name}: tangent off by {worst:e}");
}

/// Strain of a displacement gradient, written again from its definition.
fn definition<const D: usize>(kind: LocalStrain, h: &[Dual<D>; 4]) -> [Dual<D>; 3] {
    if kind == LocalStrain::Linear {
        return [h[0], h[3], h[1] + h[2]];
    }
    let (f11, f12, f21, f22) = (h[0] + Dual::one(), h[1], h[2], h[3] + Dual::one());
    let (c11, c22, c12) = (f11 * f11 + f21 * f21, f12 * f12 + f22 * f22, f11 * f12 + f21 * f22);
    if kind == LocalStrain::GreenLagrange {
        return [(c11 - Dual::one()).scale(0.5), (c22 - Dual::one()).scale(0.5), c12];
    }
    // Half the logarithm of C by its eigenvalues and their projections.
    let (mean, half) = ((c11 + c22).scale(0.5), (c11 - c22).scale(0.5));
    let radius = (half * half + c12 * c12).sqrt();
    let (high, low) = ((mean + radius).ln().scale(0.5), (mean - radius).ln().scale(0.5));
    let slope = (high - low) / radius.scale(2.0);
    let middle = (high + low).scale(0.5);
    [middle + slope * half, middle - slope * half, slope * c12.scale(2.0)]
}

/// Strain that is linear about the mean gradient: `E(H0) + sym(G (H - H0))`.
fn about_mean<const D: usize>(
    kind: LocalStrain,
    mean: &[Dual<D>; 4],
    h: &[Dual<D>; 4],
) -> [Dual<D>; 3] {
    let f = [[mean[0] + Dual::one(), mean[1]], [mean[2], mean[3] + Dual::one()]];
    let det = f[0][0] * f[1][1] - f[0][1] * f[1][0];
    let g = if kind == LocalStrain::GreenLagrange {
        [[f[0][0], f[1][0]], [f[0][1], f[1][1]]]
    } else {
        [[f[1][1] / det, -f[0][1] / det], [-f[1][0] / det, f[0][0] / det]]
    };
    let k = [[h[0] - mean[0], h[1] - mean[1]], [h[2] - mean[2], h[3] - mean[3]]];
    let times = |i: usize, j: usize| g[i][0] * k[0][j] + g[i][1] * k[1][j];
    let e = definition(kind, mean);
    [e[0] + times(0, 0), e[1] + times(1, 1), e[2] + times(0, 1) + times(1, 0)]
}

/// Strain energy with the internal modes held at their values: stationary with respect to
/// them, so its gradient is the nodal force.
fn energy<E, const N: usize, const M: usize, const A: usize, const D: usize>()
where
    E: Element<N, M, A>,
{
    let name = E::NAME;
    states::<E, N, M, A>(|x, u, section, nlgeom| {
        let plain = evaluate::<E, f64, N, M, A>(x, u, section, nlgeom);
        let v = variables::<N, M, D>(u);
        let dual = evaluate::<E, Dual<D>, N, M, A>(x, &v, section, nlgeom);
        let mut modes = [[Dual::<D>::real(0.0); 2]; A];
        for m in 0..A {
            modes[m] = [Dual::real(plain.alpha[2 * m]), Dual::real(plain.alpha[2 * m + 1])];
        }
        let x = x.map(|p| p.map(Dual::<D>::real));
        let prepared = E::prepare(&x, section.parameter, &[Dual::real(E::ALPHA_B); N]);
        let moduli = section.law.moduli();
        let [first, second] =
            E::stabilization(&x, &dual.frame.q, section, &PerPoint::default(), &[]);
        let mut total = first[0] + second[0];
        let mean = (E::ABOUT_MEAN && section.strain != LocalStrain::Linear)
            .then(|| E::mean(&x, &prepared).gradient(&dual.frame.q));
        for point in &section.points {
            let s = E::sample(&x, &prepared, point);
            let h = gradient(&s, &dual.frame.q, &modes);
            let strain = match &mean {
                Some(mean) => about_mean(section.strain, mean, &h),
                None => definition(section.strain, &h),
            };
            let weight = s.weight.scale(section.thickness);
            for i in 0..3 {
                for j in 0..3 {
                    total += strain[i] * strain[j] * weight.scale(0.5 * moduli[i][j]);
                }
            }
            if E::Op::<f64>::DRILL {
                let mut skew = s.op.drill(&dual.frame.q);
                for m in 0..A {
                    let mode = &s.modes[m];
                    skew += (modes[m][1] * mode[0] - modes[m][0] * mode[1]).scale(0.5);
                }
                total += skew * skew * weight.scale(0.5 * section.parameter);
            }
        }
        let size = largest(plain.force.as_flattened());
        for r in 0..D {
            let error = (total.d[r] - plain.force[r / M][r % M]).abs();
            assert!(error <= EXACT * size, "{name}: not the gradient of the energy, {error:e}");
        }
    });
}

#[test]
fn tangent_is_the_derivative_of_the_force() {
    macro_rules! each {
        ($e:ty, $n:literal, $m:literal, $a:literal) => {
            check::<$e, $n, $m, $a, { $n * $m }>();
        };
    }
    for_each_planar_element!(each);
}

#[test]
fn force_is_the_gradient_of_the_energy() {
    macro_rules! each {
        ($e:ty, $n:literal, $m:literal, $a:literal) => {
            energy::<$e, $n, $m, $a, { $n * $m }>();
        };
    }
    for_each_planar_element!(each);
}
