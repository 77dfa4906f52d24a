//! FixedDofs dofs: where their rows and columns lie in the matrix, found once for a set of supports.
// SPDX-License-Identifier: BSD-3-Clause

use super::dofs::Dofs;

/// Places of the rows and columns of held dofs in the upper triangle.
#[derive(Clone, Debug, Default)]
pub struct FixedDofs {
    which: Vec<bool>,
    /// FixedDofs dofs, rising.
    pub dofs: Vec<u32>,
    diagonal: Vec<u32>,
    beside: Vec<u32>,
}

impl FixedDofs {
    /// Places for these dofs; kept as they are if the dofs are the same as before.
    pub fn set(&mut self, dofs: &Dofs, held: &[bool]) {
        if self.which == held {
            return;
        }
        self.which = held.to_vec();
        self.dofs = (0..held.len() as u32).filter(|&d| held[d as usize]).collect();
        self.diagonal.clear();
        self.beside.clear();
        for j in 0..dofs.n_dofs() {
            let (first, last) = (dofs.indptr[j], dofs.indptr[j + 1] - 1);
            if held[j] {
                self.diagonal.push(last as u32);
                self.beside.extend(first as u32..last as u32);
            } else {
                let rows = &dofs.indices[first..last];
                let hit = rows.iter().zip(first as u32..).filter(|(i, _)| held[**i as usize]);
                self.beside.extend(hit.map(|(_, k)| k));
            }
        }
    }

    /// Replace the rows and columns of held dofs by a positive diagonal of their own size, so
    /// that the pattern stays, the scaling is kept and each counts as one positive pivot.
    pub fn mask(&self, values: &mut [f64]) {
        for &k in &self.diagonal {
            let size = values[k as usize].abs();
            values[k as usize] = if size > 0.0 { size } else { 1.0 };
        }
        for &k in &self.beside {
            values[k as usize] = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_positive_diagonal_is_left_of_held_rows_and_columns() {
        let dofs = Dofs::new(&[2, 1, 2], &[(&[0, 1, 2], 3)]);
        let n = dofs.n_dofs();
        let values: Vec<f64> = (0..dofs.indices.len()).map(|k| k as f64 - 6.0).collect();
        let mut places = FixedDofs::default();
        for held in [[false, true, false, true, false], [true, false, false, false, true]] {
            places.set(&dofs, &held);
            let mut masked = values.clone();
            places.mask(&mut masked);
            for j in 0..n {
                for k in dofs.indptr[j]..dofs.indptr[j + 1] {
                    let i = dofs.indices[k] as usize;
                    let size = if values[k] == 0.0 { 1.0 } else { values[k].abs() };
                    let want = match (held[i] || held[j], i == j) {
                        (false, _) => values[k],
                        (true, true) => size,
                        (true, false) => 0.0,
                    };
                    assert_eq!(masked[k].to_bits(), want.to_bits(), "entry ({i}, {j})");
                }
            }
            assert!(places.dofs.iter().all(|&d| held[d as usize]) && places.dofs.len() == 2);
        }
    }
}
