//! Numbering of the degrees of freedom and the sparsity pattern of the symmetric matrix.
// SPDX-License-Identifier: BSD-3-Clause

/// Degrees of freedom by node and the upper triangle by columns.
///
/// A node's dofs are consecutive. The rows of a node's columns are: all dofs of its
/// neighbors with a smaller index, then its own up to the diagonal; so the entries of a node
/// pair are found from one number (see [`Dofs::slot`]).
#[derive(Clone, Debug, Default)]
pub struct Dofs {
    /// First dof of each node, and the total; length `n_nodes + 1`.
    pub start: Vec<u32>,
    /// Column pointers, length `n_dofs + 1`.
    pub indptr: Vec<usize>,
    /// Row indices, sorted in each column.
    pub indices: Vec<u32>,
    /// Number of rows above the diagonal block in the columns of each node.
    pub lead: Vec<u32>,
    /// Neighbors with a smaller index: pointers and nodes.
    below_ptr: Vec<usize>,
    below: Vec<u32>,
    /// Row offset of each such neighbor in the column.
    below_offset: Vec<u32>,
}

impl Dofs {
    /// Number nodes that carry `per_node` dofs (0 for none) and are joined by `cells`
    /// (connectivity and nodes a cell).
    pub fn new(per_node: &[u8], cells: &[(&[u32], usize)]) -> Self {
        let n_nodes = per_node.len();
        let mut start = vec![0u32; n_nodes + 1];
        for n in 0..n_nodes {
            start[n + 1] = start[n] + u32::from(per_node[n]);
        }
        let (below_ptr, below) = neighbors(n_nodes, cells);
        let n_dofs = start[n_nodes] as usize;
        let mut below_offset = vec![0u32; below.len()];
        let mut lead = vec![0u32; n_nodes];
        let mut indptr = Vec::with_capacity(n_dofs + 1);
        indptr.push(0usize);
        for n in 0..n_nodes {
            let mut offset = 0;
            for k in below_ptr[n]..below_ptr[n + 1] {
                below_offset[k] = offset;
                offset += u32::from(per_node[below[k] as usize]);
            }
            lead[n] = offset;
            for j in 0..usize::from(per_node[n]) {
                let last = indptr[indptr.len() - 1];
                indptr.push(last + offset as usize + j + 1);
            }
        }
        let mut indices = Vec::with_capacity(indptr[n_dofs]);
        for n in 0..n_nodes {
            for j in 0..u32::from(per_node[n]) {
                for k in below_ptr[n]..below_ptr[n + 1] {
                    let m = below[k] as usize;
                    indices.extend(start[m]..start[m + 1]);
                }
                indices.extend(start[n]..=start[n] + j);
            }
        }
        Self { start, indptr, indices, lead, below_ptr, below, below_offset }
    }

    pub fn n_dofs(&self) -> usize {
        self.start[self.start.len() - 1] as usize
    }

    pub fn n_nodes(&self) -> usize {
        self.start.len() - 1
    }

    /// Index of the entry (first dof of `low`, first dof of `high`), `low <= high`. Entry
    /// (i, j) of the pair lies at `slot + i + j * lead[high] + j (j + 1) / 2`.
    pub fn slot(&self, low: u32, high: u32) -> u32 {
        let h = high as usize;
        let column = self.indptr[self.start[h] as usize];
        let offset = if low == high {
            self.lead[h]
        } else {
            let range = self.below_ptr[h]..self.below_ptr[h + 1];
            let k = self.below[range.clone()].binary_search(&low).expect("nodes share a cell");
            self.below_offset[range.start + k]
        };
        (column + offset as usize) as u32
    }

    /// Product of the symmetric matrix with these values and a vector.
    pub fn multiply(&self, values: &[f64], x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.n_dofs()];
        for j in 0..self.n_dofs() {
            let mut s = 0.0;
            for k in self.indptr[j]..self.indptr[j + 1] {
                let i = self.indices[k] as usize;
                s += values[k] * x[i];
                if i != j {
                    y[i] += values[k] * x[j];
                }
            }
            y[j] += s;
        }
        y
    }

    /// Values by node, `[n_nodes, 3]`, 0 where a node has no such dof.
    pub fn by_node(&self, vector: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; 3 * self.n_nodes()];
        for (ends, row) in self.start.windows(2).zip(out.chunks_exact_mut(3)) {
            let own = &vector[ends[0] as usize..ends[1] as usize];
            row[..own.len()].copy_from_slice(own);
        }
        out
    }

    /// Node of each dof.
    pub fn node_of_dof(&self) -> Vec<u32> {
        let mut nodes = vec![0; self.n_dofs()];
        for n in 0..self.n_nodes() {
            nodes[self.start[n] as usize..self.start[n + 1] as usize].fill(n as u32);
        }
        nodes
    }
}

/// For each node its neighbors with a smaller index, sorted.
fn neighbors(n_nodes: usize, cells: &[(&[u32], usize)]) -> (Vec<usize>, Vec<u32>) {
    let mut ptr = vec![0usize; n_nodes + 1];
    for &(conn, width) in cells {
        for cell in conn.chunks_exact(width) {
            for &high in cell {
                ptr[high as usize + 1] += cell.iter().filter(|&&low| low < high).count();
            }
        }
    }
    for n in 0..n_nodes {
        ptr[n + 1] += ptr[n];
    }
    let mut list = vec![0u32; ptr[n_nodes]];
    let mut next = ptr.clone();
    for &(conn, width) in cells {
        for cell in conn.chunks_exact(width) {
            for &high in cell {
                for &low in cell.iter().filter(|&&low| low < high) {
                    list[next[high as usize]] = low;
                    next[high as usize] += 1;
                }
            }
        }
    }
    // Sort each row and drop what several cells gave.
    let (mut kept, mut out) = (vec![0usize; n_nodes + 1], 0);
    for n in 0..n_nodes {
        let (from, to) = (ptr[n], ptr[n + 1]);
        list[from..to].sort_unstable();
        let begin = out;
        for k in from..to {
            if out == begin || list[out - 1] != list[k] {
                list[out] = list[k];
                out += 1;
            }
        }
        kept[n + 1] = out;
    }
    list.truncate(out);
    list.shrink_to_fit();
    (kept, list)
}
