// SPDX-License-Identifier: BSD-3-Clause
//! Forward and backward substitution over the tree of fronts.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::delayed_pivots::Special;
use super::multifrontal::Numeric;
use super::symbolic::{Front, Symbolic};

/// Views of a factorization for one solve.
pub struct Backsolve<'a> {
    pub symbolic: &'a Symbolic,
    pub numeric: &'a Numeric,
    pub threads: usize,
}

/// Columns that pass over the rows together, so that these are loaded once for all.
const STRIP: usize = 4;

/// `x <- L⁻¹ x` for the columns of a front; the rest is subtracted from `tail`.
fn forward_front(panel: &[f64], height: usize, x: &mut [f64], tail: &mut [f64]) {
    // Few forces, as those of contact, leave most of the tree at rest.
    if x.iter().all(|&v| v == 0.0) {
        return;
    }
    Arch::new().dispatch(Forward { panel, height, x, tail });
}

/// `x <- L⁻ᵀ (x - below)` for the columns of a front.
fn backward_front(panel: &[f64], height: usize, x: &mut [f64], tail: &[f64]) {
    Arch::new().dispatch(Backward { panel, height, x, tail });
}

struct Forward<'a> {
    panel: &'a [f64],
    height: usize,
    x: &'a mut [f64],
    tail: &'a mut [f64],
}

impl WithSimd for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        forward_columns(self.panel, self.height, self.x, self.tail);
    }
}

struct Backward<'a> {
    panel: &'a [f64],
    height: usize,
    x: &'a mut [f64],
    tail: &'a [f64],
}

impl WithSimd for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        backward_columns(self.panel, self.height, self.x, self.tail);
    }
}

#[inline(always)]
fn forward_columns(panel: &[f64], height: usize, x: &mut [f64], tail: &mut [f64]) {
    let width = x.len();
    let mut j = 0;
    while j + STRIP <= width {
        let (now, later) = x[j..].split_at_mut(STRIP);
        let columns: [&[f64]; STRIP] =
            std::array::from_fn(|k| &panel[(j + k) * height + j..(j + k + 1) * height]);
        for k in 0..STRIP {
            for i in k + 1..STRIP {
                now[i] -= columns[k][i] * now[k];
            }
        }
        let v = [now[0], now[1], now[2], now[3]];
        let inner = width - j;
        subtract_strip(later, columns.map(|c| &c[STRIP..inner]), v);
        subtract_strip(tail, columns.map(|c| &c[inner..]), v);
        j += STRIP;
    }
    for j in j..width {
        let v = x[j];
        let column = &panel[j * height..(j + 1) * height];
        for (y, l) in x[j + 1..].iter_mut().zip(&column[j + 1..width]) {
            *y -= l * v;
        }
        for (y, l) in tail.iter_mut().zip(&column[width..]) {
            *y -= l * v;
        }
    }
}

#[inline(always)]
fn subtract_strip(y: &mut [f64], columns: [&[f64]; STRIP], v: [f64; STRIP]) {
    let [a, b, c, d] = columns.map(|c| &c[..y.len()]);
    for (i, y) in y.iter_mut().enumerate() {
        *y -= (a[i] * v[0] + b[i] * v[1]) + (c[i] * v[2] + d[i] * v[3]);
    }
}

#[inline(always)]
fn backward_columns(panel: &[f64], height: usize, x: &mut [f64], tail: &[f64]) {
    let width = x.len();
    let whole = width - width % STRIP;
    for j in (whole..width).rev() {
        let column = &panel[j * height..(j + 1) * height];
        x[j] -= dot(&column[j + 1..width], &x[j + 1..]) + dot(&column[width..], tail);
    }
    let mut j = whole;
    while j > 0 {
        j -= STRIP;
        let columns: [&[f64]; STRIP] =
            std::array::from_fn(|k| &panel[(j + k) * height + j..(j + k + 1) * height]);
        let (now, later) = x[j..].split_at_mut(STRIP);
        let inner = width - j;
        let near = dot_strip(columns.map(|c| &c[STRIP..inner]), later);
        let far = dot_strip(columns.map(|c| &c[inner..]), tail);
        for k in (0..STRIP).rev() {
            let mut sum = near[k] + far[k];
            for i in k + 1..STRIP {
                sum += columns[k][i] * now[i];
            }
            now[k] -= sum;
        }
    }
}

/// Products of a strip of columns with one vector, summed in eight fixed lanes each.
#[inline(always)]
fn dot_strip(columns: [&[f64]; STRIP], y: &[f64]) -> [f64; STRIP] {
    const LANES: usize = 8;
    let mut sums = [[0.0_f64; LANES]; STRIP];
    let whole = y.len() - y.len() % LANES;
    let [a, b, c, d] = columns.map(|c| &c[..y.len()]);
    for i in (0..whole).step_by(LANES) {
        let part = &y[i..i + LANES];
        for (sum, column) in sums.iter_mut().zip([a, b, c, d]) {
            let column = &column[i..i + LANES];
            for lane in 0..LANES {
                sum[lane] += column[lane] * part[lane];
            }
        }
    }
    let mut out = [0.0; STRIP];
    for ((out, sum), column) in out.iter_mut().zip(&sums).zip([a, b, c, d]) {
        let rest: f64 = column[whole..].iter().zip(&y[whole..]).map(|(p, q)| p * q).sum();
        *out = rest + fold(sum);
    }
    out
}

#[inline(always)]
fn fold(sum: &[f64; 8]) -> f64 {
    ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]))
}

/// Product of two vectors, summed in eight fixed lanes.
#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    const LANES: usize = 8;
    let mut sum = [0.0_f64; LANES];
    let (ca, cb) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let (ra, rb) = (ca.remainder(), cb.remainder());
    for (p, q) in ca.zip(cb) {
        for i in 0..LANES {
            sum[i] += p[i] * q[i];
        }
    }
    let rest: f64 = ra.iter().zip(rb).map(|(p, q)| p * q).sum();
    rest + fold(&sum)
}

impl Backsolve<'_> {
    /// Solves in elimination order, in place.
    pub fn solve(&self, x: &mut [f64]) {
        if self.numeric.special.iter().any(Option::is_some) {
            self.forward_whole(x);
            self.divide_whole(x);
            self.backward_whole(x);
            return;
        }
        let mut far = Vec::new();
        self.forward_children(&self.symbolic.roots, 0, x, &mut far);
        self.backward_children(&self.symbolic.roots, 0, x, &[], None);
    }

    fn panel(&self, s: usize) -> &[f64] {
        &self.numeric.panels[self.symbolic.panel_range(s)]
    }

    /// Runs `work` for the subtrees of `list` with their parts of `x`, in parallel.
    fn over<T: Send>(
        &self,
        list: &[u32],
        begin: usize,
        x: &mut [f64],
        work: impl Fn(usize, usize, &mut [f64]) -> T + Sync + Send,
    ) -> Vec<T> {
        let fronts = &self.symbolic.fronts;
        let mut rest = x;
        let mut jobs = Vec::with_capacity(list.len());
        let mut at = begin;
        for &c in list {
            let c = c as usize;
            let length = fronts[c].first + fronts[c].width - fronts[at].first;
            let (own, later) = rest.split_at_mut(length);
            jobs.push((c, at, own));
            rest = later;
            at = c + 1;
        }
        if self.threads > 1 && list.len() > 1 {
            jobs.into_par_iter().with_max_len(1).map(|(c, at, x)| work(c, at, x)).collect()
        } else {
            jobs.into_iter().map(|(c, at, x)| work(c, at, x)).collect()
        }
    }

    fn forward_children(&self, list: &[u32], begin: usize, x: &mut [f64], out: &mut Vec<Vec<f64>>) {
        *out = self.over(list, begin, x, |s, at, x| self.forward(s, at, x));
    }

    /// Forward substitution of a subtree; returns what its root subtracts further on.
    fn forward(&self, s: usize, begin: usize, x: &mut [f64]) -> Vec<f64> {
        let sym = self.symbolic;
        let f = &sym.fronts[s];
        let first = sym.fronts[begin].first;
        let mut tail = vec![0.0; f.below];
        if f.top {
            let (inner, own) = x.split_at_mut(f.first - first);
            let mut updates = Vec::new();
            self.forward_children(sym.children(s), begin, inner, &mut updates);
            for (u, &c) in updates.iter().zip(sym.children(s)) {
                collect(u, sym.relative_of(c as usize), own, &mut tail);
            }
            self.forward_one(s, f, own, &mut tail);
            return tail;
        }
        let mut pending: Vec<Vec<f64>> = Vec::new();
        let mut spare: Vec<Vec<f64>> = Vec::new();
        for t in begin..=s {
            let g = &sym.fronts[t];
            let own = &mut x[g.first - first..][..g.width];
            let mut tail = spare.pop().unwrap_or_default();
            tail.clear();
            tail.resize(g.below, 0.0);
            let children = sym.children(t);
            for (u, &c) in pending.drain(pending.len() - children.len()..).zip(children) {
                collect(&u, sym.relative_of(c as usize), own, &mut tail);
                spare.push(u);
            }
            self.forward_one(t, g, own, &mut tail);
            pending.push(tail);
        }
        pending.pop().unwrap_or_default()
    }

    fn forward_one(&self, s: usize, f: &Front, x: &mut [f64], tail: &mut [f64]) {
        forward_front(self.panel(s), f.height(), x, tail);
        for (v, d) in x.iter_mut().zip(&self.numeric.d[f.first..f.first + f.width]) {
            *v /= d;
        }
    }

    fn backward_children(
        &self,
        list: &[u32],
        begin: usize,
        x: &mut [f64],
        above: &[f64],
        parent: Option<usize>,
    ) {
        let sym = self.symbolic;
        self.over(list, begin, x, |s, at, x| {
            let tail: Vec<f64> = match parent {
                Some(_) => sym.relative_of(s).iter().map(|&r| above[r as usize]).collect(),
                None => Vec::new(),
            };
            self.backward(s, at, x, &tail);
        });
    }

    /// Backward substitution of a subtree, given the solution at its root's rows below.
    fn backward(&self, s: usize, begin: usize, x: &mut [f64], tail: &[f64]) {
        let sym = self.symbolic;
        let f = &sym.fronts[s];
        let first = sym.fronts[begin].first;
        if f.top {
            let (inner, own) = x.split_at_mut(f.first - first);
            backward_front(self.panel(s), f.height(), own, tail);
            let all: Vec<f64> = own.iter().chain(tail).copied().collect();
            self.backward_children(sym.children(s), begin, inner, &all, Some(s));
            return;
        }
        // Values at the rows of each front, its parent's being still at hand.
        let end = f.first + f.width;
        let root_rows = sym.rows_of(s);
        let mut rows = Vec::new();
        for t in (begin..=s).rev() {
            let g = &sym.fronts[t];
            rows.clear();
            let mut from = 0;
            for &r in sym.rows_of(t) {
                let r = r as usize;
                if r < end {
                    rows.push(x[r - first]);
                } else {
                    // Both lists rise, so the place is found going forward.
                    while root_rows[from] as usize != r {
                        from += 1;
                    }
                    rows.push(tail[from]);
                }
            }
            let own = &mut x[g.first - first..][..g.width];
            backward_front(self.panel(t), g.height(), own, &rows);
        }
    }

    /// Forward substitution front by front, also through fronts with exchanges.
    fn forward_whole(&self, x: &mut [f64]) {
        let sym = self.symbolic;
        let mut tail = Vec::new();
        for s in 0..sym.fronts.len() {
            if let Some(special) = &self.numeric.special[s] {
                let n = special.equations.len();
                for k in 0..special.pivots {
                    let v = x[special.equations[k] as usize];
                    for i in k + 1..n {
                        x[special.equations[i] as usize] -= special.l[i + k * n] * v;
                    }
                }
                continue;
            }
            let f = &sym.fronts[s];
            tail.clear();
            tail.resize(f.below, 0.0);
            forward_front(self.panel(s), f.height(), &mut x[f.first..f.first + f.width], &mut tail);
            for (v, &r) in tail.iter().zip(sym.rows_of(s)) {
                x[r as usize] += v;
            }
        }
    }

    fn divide_whole(&self, x: &mut [f64]) {
        for (s, f) in self.symbolic.fronts.iter().enumerate() {
            match &self.numeric.special[s] {
                Some(special) => divide_special(special, x),
                None => {
                    for k in f.first..f.first + f.width {
                        x[k] /= self.numeric.d[k];
                    }
                }
            }
        }
    }

    /// `x <- L⁻ᵀ x` front by front; a unit vector gives the motion behind a pivot.
    pub fn backward_whole(&self, x: &mut [f64]) {
        let sym = self.symbolic;
        let mut tail = Vec::new();
        for s in (0..sym.fronts.len()).rev() {
            if let Some(special) = &self.numeric.special[s] {
                let n = special.equations.len();
                for k in (0..special.pivots).rev() {
                    let column = &special.l[k * n..(k + 1) * n];
                    let sum: f64 =
                        (k + 1..n).map(|i| column[i] * x[special.equations[i] as usize]).sum();
                    x[special.equations[k] as usize] -= sum;
                }
                continue;
            }
            let f = &sym.fronts[s];
            tail.clear();
            tail.extend(sym.rows_of(s).iter().map(|&r| x[r as usize]));
            backward_front(self.panel(s), f.height(), &mut x[f.first..f.first + f.width], &tail);
        }
    }
}

/// Adds a child's subtractions to its parent's columns and rows below.
fn collect(update: &[f64], relative: &[u32], own: &mut [f64], tail: &mut [f64]) {
    let width = own.len();
    for (&v, &place) in update.iter().zip(relative) {
        let place = place as usize;
        if place < width {
            own[place] += v;
        } else {
            tail[place - width] += v;
        }
    }
}

fn divide_special(special: &Special, x: &mut [f64]) {
    let mut k = 0;
    while k < special.pivots {
        let i = special.equations[k] as usize;
        if special.e[k] == 0.0 {
            x[i] /= special.d[k];
            k += 1;
        } else {
            let j = special.equations[k + 1] as usize;
            let (a, b, c) = (special.d[k], special.e[k], special.d[k + 1]);
            let (ab, cb) = (a / b, c / b);
            let scale = 1.0 / (b * (ab * cb - 1.0));
            let (p, q) = (x[i], x[j]);
            x[i] = scale * (cb * p - q);
            x[j] = scale * (ab * q - p);
            k += 2;
        }
    }
}
