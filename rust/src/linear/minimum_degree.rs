// SPDX-License-Identifier: BSD-3-Clause
//! Minimum degree for the small parts that a dissection ends with.
//!
//! The vertices that a part touches are eliminated later; they count in the degrees. Rows of the
//! elimination graph are sets of bits, so that all degrees are exact.

use super::dissection::Graph;

/// Bits of a word.
const BITS: usize = 64;

/// Work arrays of a thread.
#[derive(Default)]
pub struct Scratch {
    known: Vec<u32>,
    rows: Vec<u64>,
    pivot: Vec<u64>,
    degree: Vec<u32>,
    found: Vec<u32>,
}

/// Puts a part into the order of its elimination: least degree first, then as it was.
pub fn order(graph: &Graph<'_>, part: &mut [u32], scratch: &mut Scratch) {
    let n = part.len();
    let Scratch { known, rows, pivot, degree, found } = scratch;
    part.sort_unstable();
    // The part itself, then what it touches.
    known.clear();
    for &v in part.iter() {
        known.extend(graph.neighbors(v).iter().filter(|u| part.binary_search(u).is_err()));
    }
    known.sort_unstable();
    known.dedup();
    let words = (n + known.len()).div_ceil(BITS).max(1);
    rows.clear();
    rows.resize(words * n, 0);
    for (i, &v) in part.iter().enumerate() {
        for &u in graph.neighbors(v) {
            let j =
                part.binary_search(&u).unwrap_or_else(|_| n + known.binary_search(&u).unwrap_or(0));
            rows[i * words + j / BITS] |= 1 << (j % BITS);
        }
    }
    degree.clear();
    degree.extend(rows.chunks_exact(words).map(count));
    found.clear();
    for _ in 0..n {
        let mut best = 0;
        for i in 1..n {
            if degree[i] < degree[best] {
                best = i;
            }
        }
        found.push(part[best]);
        degree[best] = u32::MAX;
        pivot.clear();
        pivot.extend_from_slice(&rows[best * words..(best + 1) * words]);
        for w in 0..n.div_ceil(BITS) {
            let mut left = pivot[w];
            if w == n / BITS {
                left &= (1 << (n % BITS)) - 1;
            }
            while left != 0 {
                let i = w * BITS + left.trailing_zeros() as usize;
                left &= left - 1;
                let row = &mut rows[i * words..(i + 1) * words];
                for (r, p) in row.iter_mut().zip(pivot.iter()) {
                    *r |= p;
                }
                row[i / BITS] &= !(1 << (i % BITS));
                row[best / BITS] &= !(1 << (best % BITS));
                degree[i] = count(row);
            }
        }
    }
    part.copy_from_slice(found);
}

fn count(row: &[u64]) -> u32 {
    row.iter().map(|w| w.count_ones()).sum()
}
