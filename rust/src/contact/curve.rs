//! Element edges as curves: straight, quadratic, or bulged by the rotations of drilling nodes.
//!
//! All three are `m + d r + b (1 - r^2)`, `r` from -1 to 1, with `m` and `d` from the corners;
//! `b` is zero, the offset of the middle node, or `alpha_b l0 / 8` times the difference of the
//! rotations along the chord's outward normal (the bulge of `loads::edge`; l0 is the undeformed
//! length, so that a nominal pressure gives the moments `alpha_b p t l0^2 / 12`). Linear edges of a
//! round boundary have its height over their chord besides (`rounds`).
// SPDX-License-Identifier: BSD-3-Clause

use crate::base::Smooth;

/// A vector of the plane.
pub type Vec2<T> = [T; 2];

pub fn add<T: Smooth>(a: Vec2<T>, b: Vec2<T>) -> Vec2<T> {
    [a[0] + b[0], a[1] + b[1]]
}
pub fn sub<T: Smooth>(a: Vec2<T>, b: Vec2<T>) -> Vec2<T> {
    [a[0] - b[0], a[1] - b[1]]
}
pub fn dot<T: Smooth>(a: Vec2<T>, b: Vec2<T>) -> T {
    a[0] * b[0] + a[1] * b[1]
}
pub fn times<T: Smooth>(a: Vec2<T>, k: T) -> Vec2<T> {
    [a[0] * k, a[1] * k]
}
/// Turned by a right angle to the right: from tangent to outward normal.
pub fn outward<T: Smooth>(t: Vec2<T>) -> Vec2<T> {
    [t[1], -t[0]]
}
pub fn unit<T: Smooth>(a: Vec2<T>) -> Vec2<T> {
    let length = dot(a, a).sqrt();
    [a[0] / length, a[1] / length]
}
/// A constant vector.
pub fn fixed<T: Smooth>(a: Vec2<f64>) -> Vec2<T> {
    a.map(T::real)
}
/// Values of a vector.
pub fn values<T: Smooth>(a: Vec2<T>) -> Vec2<f64> {
    a.map(Smooth::value)
}

/// Mean of the points with these coordinates, one after the other.
pub fn middle_of<T: Smooth>(coordinates: &[T]) -> Vec2<T> {
    let (points, _) = coordinates.as_chunks::<2>();
    let sum = points.iter().fold([T::real(0.0); 2], |sum, p| add(sum, *p));
    sum.map(|c| c.scale(1.0 / points.len() as f64))
}

/// A parabola `m + d r + b (1 - r^2)`.
#[derive(Clone, Copy, Debug)]
pub struct Curve<T> {
    pub m: Vec2<T>,
    pub d: Vec2<T>,
    pub b: Vec2<T>,
    pub straight: bool,
}

impl<T: Smooth> Curve<T> {
    /// The straight line between two points.
    pub fn line(p: Vec2<T>, q: Vec2<T>) -> Self {
        let m = add(p, q).map(|c| c.scale(0.5));
        let d = sub(q, p).map(|c| c.scale(0.5));
        Self { m, d, b: [T::real(0.0); 2], straight: true }
    }

    pub fn at(&self, r: T) -> Vec2<T> {
        let p = add(self.m, times(self.d, r));
        if self.straight {
            return p;
        }
        add(p, times(self.b, T::real(1.0) - r * r))
    }

    /// Derivative with respect to the parameter.
    pub fn slope(&self, r: T) -> Vec2<T> {
        if self.straight {
            return self.d;
        }
        sub(self.d, times(self.b, r.scale(2.0)))
    }

    /// Point of the curve continued along its tangents beyond the ends.
    pub fn extended(&self, r: T) -> Vec2<T> {
        if self.straight || r.value().abs() <= 1.0 {
            return self.at(r);
        }
        let end = T::real(r.value().signum());
        add(self.at(end), times(self.slope(end), r - end))
    }

    /// The curve without derivatives.
    pub fn value(&self) -> Curve<f64> {
        Curve { m: values(self.m), d: values(self.d), b: values(self.b), straight: self.straight }
    }

    /// Parameter where the normal of the curve, continued along its end tangents, meets a point.
    pub fn foot(&self, p: Vec2<T>) -> T {
        if self.straight {
            return dot(sub(p, self.m), self.d) / dot(self.d, self.d);
        }
        let (plain, q) = (self.value(), values(p));
        for end in [-1.0, 1.0] {
            if plain.foot_residual(q, end).0 * end > 0.0 {
                let (end, slope) = (T::real(end), self.slope(T::real(end)));
                return end + dot(sub(p, self.at(end)), slope) / dot(slope, slope);
            }
        }
        let start = dot(sub(q, plain.m), plain.d) / dot(plain.d, plain.d);
        let r = newton(start, |r| plain.foot_residual(q, r));
        polish(r, |r| self.foot_residual(p, r))
    }

    fn foot_residual(&self, p: Vec2<T>, r: T) -> (T, T) {
        let (away, slope) = (sub(p, self.at(r)), self.slope(r));
        (dot(away, slope), -dot(slope, slope) - dot(away, self.b).scale(2.0))
    }

    /// Parameter where the line through `p` across the direction `t` meets the curve; not a
    /// number if it does not.
    pub fn crossing(&self, p: Vec2<T>, t: Vec2<T>) -> T {
        if self.straight {
            return dot(sub(p, self.m), t) / dot(self.d, t);
        }
        let (plain, q, s) = (self.value(), values(p), values(t));
        let start = dot(sub(q, plain.m), s) / dot(plain.d, s);
        let r = newton(start, |r| (dot(sub(plain.at(r), q), s), dot(plain.slope(r), s)));
        polish(r, |r| (dot(sub(self.at(r), p), t), dot(self.slope(r), t)))
    }
}

/// A plain curve as one of constants.
pub fn lift<T: Smooth>(c: &Curve<f64>) -> Curve<T> {
    Curve { m: fixed(c.m), d: fixed(c.d), b: fixed(c.b), straight: c.straight }
}

/// Root of a function given with its derivative, or not a number.
fn newton(start: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut r = start.clamp(-3.0, 3.0);
    for _ in 0..30 {
        let (value, slope) = f(r);
        let step = (value / slope).clamp(-1.0, 1.0);
        r -= step;
        // The next step would be its square. A bound near round-off is not safe: on a short
        // edge far from the origin the digits of the coordinates end before it.
        if step.abs() < 1e-7 {
            return r;
        }
        if r.is_nan() || r.abs() > 10.0 {
            break;
        }
    }
    f64::NAN
}

/// Two steps from a root give its derivatives: the first the gradient, the second the Hessian.
fn polish<T: Smooth>(root: f64, f: impl Fn(T) -> (T, T)) -> T {
    let mut r = T::real(root);
    for _ in 0..2 {
        let (value, slope) = f(r);
        r = r - value / slope;
    }
    r
}

/// Gauss rule on [-1, 1], exact to degree 5.
pub const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// What the nodes of an edge stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// An element edge.
    Element,
    /// Piece of a smoothed boundary round its third node: the quadratic B-spline of the
    /// polygon, from the middle of the side before to the middle of the side behind.
    Spline,
    /// First or second half of the straight side between two nodes.
    FirstHalf,
    SecondHalf,
}

/// One element edge, or a piece of a smoothed boundary.
#[derive(Clone, Debug)]
pub struct Edge {
    /// Corner, corner, middle; element on the left from the first to the second.
    pub nodes: [u32; 3],
    pub shape: Shape,
    /// 2 or 3.
    pub n_nodes: usize,
    /// Bulge factor of drilling elements, 0 for others.
    pub alpha_b: f64,
    /// Undeformed length of the chord.
    pub length: f64,
    /// Height over the chord of an undeformed round boundary, where the edge itself is straight.
    pub sagitta: f64,
    /// Of a line the distance to its surfaces, which are on both sides.
    pub half: Option<f64>,
}

impl Edge {
    pub fn nodes(&self) -> &[u32] {
        &self.nodes[..self.n_nodes]
    }

    /// Variables of the edge as `3 node + component`: corner positions, then the middle's
    /// position or the corners' rotations.
    pub fn variables(&self) -> Vec<i64> {
        let dof = |a: usize, c: i64| 3 * i64::from(self.nodes[a]) + c;
        let mut v = vec![dof(0, 0), dof(0, 1), dof(1, 0), dof(1, 1)];
        if self.n_nodes == 3 {
            v.extend([dof(2, 0), dof(2, 1)]);
        } else if self.alpha_b > 0.0 {
            v.extend([dof(0, 2), dof(1, 2)]);
        }
        v
    }

    /// Variables of the points whose middle is the first or second end.
    pub fn variables_of_end(&self, which: usize) -> Vec<i64> {
        let nodes: &[usize] = match (self.shape, which) {
            (Shape::Element, _) | (Shape::FirstHalf, 0) | (Shape::SecondHalf, 1) => &[which],
            (Shape::Spline, _) => &[which, 2],
            (Shape::FirstHalf | Shape::SecondHalf, _) => &[0, 1],
        };
        let both = |&a: &usize| [0, 1].map(|c| 3 * i64::from(self.nodes[a]) + c);
        nodes.iter().flat_map(both).collect()
    }

    /// The curve at given values of the variables.
    pub fn curve<T: Smooth>(&self, v: &[T]) -> Curve<T> {
        let (p, q) = ([v[0], v[1]], [v[2], v[3]]);
        let middle = |a: Vec2<T>, b: Vec2<T>| add(a, b).map(|c| c.scale(0.5));
        match self.shape {
            Shape::Element => {}
            Shape::FirstHalf => return Curve::line(p, middle(p, q)),
            Shape::SecondHalf => return Curve::line(middle(p, q), q),
            Shape::Spline => {
                let vertex = [v[4], v[5]];
                let mut c = Curve::line(middle(p, vertex), middle(vertex, q));
                c.b = sub(vertex, c.m).map(|b| b.scale(0.5));
                c.straight = false;
                return c;
            }
        }
        let mut c = Curve::line(p, q);
        if self.n_nodes == 3 {
            c.b = sub([v[4], v[5]], c.m);
            c.straight = false;
        } else if self.alpha_b > 0.0 || self.sagitta != 0.0 {
            let mut height = T::real(self.sagitta);
            if self.alpha_b > 0.0 {
                height += (v[5] - v[4]).scale(self.alpha_b * self.length / 8.0);
            }
            c.b = times(unit(outward(c.d)), height);
            c.straight = false;
        }
        c
    }

    /// The curve at positions and rotations of all nodes.
    pub fn place(&self, x: &[[f64; 3]]) -> Curve<f64> {
        let mut v = [0.0; 6];
        let p = |a: usize| x[self.nodes[a] as usize];
        let (i, j) = (p(0), p(1));
        v[..4].copy_from_slice(&[i[0], i[1], j[0], j[1]]);
        if self.n_nodes == 3 {
            let k = p(2);
            v[4..].copy_from_slice(&[k[0], k[1]]);
        } else {
            v[4..].copy_from_slice(&[i[2], j[2]]);
        }
        self.curve(&v)
    }
}
