// SPDX-License-Identifier: BSD-3-Clause
//! Dense kernels of a front: partial LDLᵀ without exchanges, and its update.
//!
//! Large fronts are worked on in tiles of fixed size; which thread does a tile
//! changes nothing in its digits.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::ldlt::factor::{
    LdltParams, LdltRegularization, cholesky_in_place, cholesky_in_place_scratch,
};
use faer::linalg::matmul::triangular::BlockStructure::{Rectangular, TriangularLower};
use faer::linalg::matmul::{matmul, triangular};
use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::{Accum, MatMut, MatRef, Par, Spec};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// Columns eliminated before the rest of the panel is updated.
const BLOCK: usize = 64;
/// Side of the tiles of large fronts.
const TILE: usize = 128;
/// Update work (multiplications) from which tiles are shared among threads.
const SHARE_ABOVE: usize = 4_000_000;

/// Smallest pivot (of a matrix scaled to a diagonal of one) taken without exchanges.
pub const TINY_PIVOT: f64 = 1e-14;
/// Largest growth `l² d` of an update relative to a matrix scaled to one.
pub const GROWTH: f64 = 100.0;

/// Scratch of one thread.
#[derive(Default)]
pub struct Scratch {
    memory: Option<MemBuffer>,
    /// `L D` of a block of columns, or of the rows below.
    product: Vec<f64>,
}

impl Scratch {
    fn prepare(&mut self, product: usize) {
        if self.memory.is_none() {
            let params: Spec<LdltParams, f64> = Spec::default();
            let need: StackReq = cholesky_in_place_scratch::<f64>(BLOCK, Par::Seq, params);
            self.memory = Some(MemBuffer::new(need));
        }
        if self.product.len() < product {
            self.product.resize(product, 0.0);
        }
    }
}

/// Factorizes the first `width` columns of a front of `height` rows, held in `panel`.
///
/// On return the panel holds unit-lower L with D on its diagonal (copied to `d`).
/// `false` says that a pivot or the growth broke the bounds: the panel is spoilt.
pub fn eliminate(
    panel: &mut [f64],
    height: usize,
    width: usize,
    d: &mut [f64],
    scratch: &mut Scratch,
    share: bool,
) -> bool {
    scratch.prepare(height * BLOCK.min(width));
    let mut k = 0;
    while k < width {
        let block = BLOCK.min(width - k);
        let rest = height - k - block;
        let (done, later) = panel.split_at_mut((k + block) * height);
        let columns = MatMut::from_column_major_slice_mut(&mut done[k * height..], height, block);
        let (_, columns) = columns.split_at_row_mut(k);
        let (mut head, mut tail) = columns.split_at_row_mut(block);
        let Some(memory) = &mut scratch.memory else { return false };
        let factored = cholesky_in_place(
            head.as_mut(),
            LdltRegularization::default(),
            Par::Seq,
            MemStack::new(memory),
            Spec::default(),
        );
        if factored.is_err() {
            return false;
        }
        for j in 0..block {
            let pivot = head[(j, j)];
            // A pivot that is not a number is outside any range.
            if !(TINY_PIVOT..1e16).contains(&pivot.abs()) {
                return false;
            }
            d[k + j] = pivot;
            for i in j + 1..block {
                let l = head[(i, j)];
                let growth = l * l * pivot.abs();
                if growth.is_nan() || growth > GROWTH {
                    return false;
                }
            }
        }
        if rest > 0 {
            let shared = share && rest * block * (width - k) >= SHARE_ABOVE / 4;
            let head = head.as_ref();
            let mut left = Some(tail.as_mut());
            let tiles = std::iter::from_fn(|| {
                let rows = left.take()?;
                if rows.nrows() <= TILE {
                    return Some(rows);
                }
                let (tile, rest) = rows.split_at_row_mut(TILE);
                left = Some(rest);
                Some(tile)
            });
            if shared {
                let tiles: Vec<_> = tiles.collect();
                tiles.into_par_iter().for_each(|t| substitute(head, t));
            } else {
                tiles.for_each(|t| substitute(head, t));
            }
            // Keep L D for the update, then turn the rows into L.
            let mut product = MatMut::from_column_major_slice_mut(
                &mut scratch.product[..rest * block],
                rest,
                block,
            );
            for j in 0..block {
                let inverse = 1.0 / d[k + j];
                let bound = GROWTH * d[k + j].abs();
                let ld = product.as_mut().col_mut(j).try_as_col_major_mut();
                let l = tail.as_mut().col_mut(j).try_as_col_major_mut();
                let (Some(ld), Some(l)) = (ld, l) else { return false };
                if keep_and_scale(l.as_slice_mut(), ld.as_slice_mut(), inverse) > bound {
                    return false;
                }
            }
            let more = width - k - block;
            if more > 0 {
                let l = tail.as_ref();
                let product = product.as_ref();
                let first = k + block;
                let tile = |(t, chunk): (usize, &mut [f64])| {
                    let begin = t * TILE;
                    let columns = chunk.len() / height;
                    let target = MatMut::from_column_major_slice_mut(chunk, height, columns);
                    let (_, target) = target.split_at_row_mut(first + begin);
                    update(target, l, product, begin, columns, Accum::Add);
                };
                if shared {
                    later.par_chunks_mut(TILE * height).enumerate().for_each(tile);
                } else {
                    later.chunks_mut(TILE * height).enumerate().for_each(tile);
                }
            }
        }
        k += block;
    }
    true
}

/// `kept <- l`, `l <- l * inverse`; returns the largest square of what was kept.
fn keep_and_scale(l: &mut [f64], kept: &mut [f64], inverse: f64) -> f64 {
    Arch::new().dispatch(KeepAndScale { l, kept, inverse })
}

struct KeepAndScale<'a> {
    l: &'a mut [f64],
    kept: &'a mut [f64],
    inverse: f64,
}

impl WithSimd for KeepAndScale<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        keep_and_scale_lanes(self.l, self.kept, self.inverse)
    }
}

#[inline(always)]
fn keep_and_scale_lanes(l: &mut [f64], kept: &mut [f64], inverse: f64) -> f64 {
    const LANES: usize = 8;
    let mut largest = [0.0_f64; LANES];
    let (mut ls, mut ks) = (l.chunks_exact_mut(LANES), kept.chunks_exact_mut(LANES));
    for (a, b) in (&mut ls).zip(&mut ks) {
        for i in 0..LANES {
            let v = a[i];
            b[i] = v;
            a[i] = v * inverse;
            largest[i] = if v * v > largest[i] { v * v } else { largest[i] };
        }
    }
    for (a, b) in ls.into_remainder().iter_mut().zip(ks.into_remainder()) {
        *b = *a;
        largest[0] = largest[0].max(*a * *a);
        *a *= inverse;
    }
    largest.iter().fold(0.0, |m: f64, &v| m.max(v))
}

/// `rows <- rows L⁻ᵀ` with unit-lower L.
fn substitute(head: MatRef<'_, f64>, rows: MatMut<'_, f64>) {
    solve_unit_lower_triangular_in_place(head, rows.transpose_mut(), Par::Seq);
}

/// Lower part of `target -= L[begin.., :] (L D)[begin..begin + columns, :]ᵀ`.
pub fn update(
    target: MatMut<'_, f64>,
    l: MatRef<'_, f64>,
    product: MatRef<'_, f64>,
    begin: usize,
    columns: usize,
    accum: Accum,
) {
    let rows = l.nrows() - begin;
    let depth = l.ncols();
    let l = l.submatrix(begin, 0, rows, depth);
    let right = product.submatrix(begin, 0, columns, depth).transpose();
    let (square, below) = target.split_at_row_mut(columns);
    triangular::matmul(
        square,
        TriangularLower,
        accum,
        l.subrows(0, columns),
        Rectangular,
        right,
        Rectangular,
        -1.0,
        Par::Seq,
    );
    if rows > columns {
        matmul(below, accum, l.subrows(columns, rows - columns), right, -1.0, Par::Seq);
    }
}

/// Writes the lower part of `-L D Lᵀ` of the rows below into `out` (square, side `below`).
pub fn contribution(
    panel: &[f64],
    height: usize,
    width: usize,
    d: &[f64],
    out: &mut [f64],
    scratch: &mut Scratch,
    share: bool,
) {
    let below = height - width;
    scratch.prepare(below * width);
    for j in 0..width {
        let l = &panel[j * height + width..(j + 1) * height];
        for (p, v) in scratch.product[j * below..(j + 1) * below].iter_mut().zip(l) {
            *p = v * d[j];
        }
    }
    let l = MatRef::from_column_major_slice(&panel[..height * width], height, width);
    let l = l.subrows(width, below);
    let product = MatRef::from_column_major_slice(&scratch.product[..below * width], below, width);
    let tile = |(t, chunk): (usize, &mut [f64])| {
        let begin = t * TILE;
        let columns = chunk.len() / below;
        let target = MatMut::from_column_major_slice_mut(chunk, below, columns);
        let (_, target) = target.split_at_row_mut(begin);
        update(target, l, product, begin, columns, Accum::Replace);
    };
    if share && below * below * width / 2 >= SHARE_ABOVE {
        out.par_chunks_mut(TILE * below).enumerate().for_each(tile);
    } else {
        out.chunks_mut(TILE * below).enumerate().for_each(tile);
    }
}
