//! Bounding-volume tree over boxes of the plane.
// SPDX-License-Identifier: BSD-3-Clause

/// Least x, least y, largest x, largest y.
pub type Box2 = [f64; 4];

/// A box made larger by `by` on all sides.
pub fn grown(b: Box2, by: f64) -> Box2 {
    [b[0] - by, b[1] - by, b[2] + by, b[3] + by]
}

fn meet(a: &Box2, b: &Box2) -> bool {
    a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3]
}

fn union(a: &Box2, b: &Box2) -> Box2 {
    [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])]
}

/// Members in a leaf.
const LEAF: usize = 4;

/// Members sorted so that each half of a range is a branch.
pub struct Tree {
    /// Boxes of the branches in the order of a walk that takes the first half first, each with
    /// the number of the next branch beside it.
    branches: Vec<(Box2, usize)>,
    members: Vec<(Box2, u32)>,
}

impl Tree {
    pub fn new(boxes: &[Box2]) -> Self {
        let mut members: Vec<(Box2, u32)> =
            boxes.iter().enumerate().map(|(i, b)| (*b, i as u32)).collect();
        let mut branches = Vec::new();
        split(&mut members, &mut branches);
        Self { branches, members }
    }

    /// Calls `found` with each member whose box meets `b`.
    pub fn query(&self, b: &Box2, found: &mut impl FnMut(u32)) {
        if !self.members.is_empty() {
            self.walk(b, 0..self.members.len(), 0, found);
        }
    }

    /// Walks a branch; returns the number of the one beside it.
    fn walk(
        &self,
        b: &Box2,
        range: std::ops::Range<usize>,
        branch: usize,
        found: &mut impl FnMut(u32),
    ) -> usize {
        let (whole, next) = &self.branches[branch];
        if !meet(whole, b) {
            return *next;
        }
        if range.len() <= LEAF {
            for (member, i) in &self.members[range] {
                if meet(member, b) {
                    found(*i);
                }
            }
            return *next;
        }
        let middle = range.start + range.len() / 2;
        let second = self.walk(b, range.start..middle, branch + 1, found);
        self.walk(b, middle..range.end, second, found)
    }
}

fn split(members: &mut [(Box2, u32)], branches: &mut Vec<(Box2, usize)>) {
    let Some((first, rest)) = members.split_first() else { return };
    let whole = rest.iter().fold(first.0, |a, m| union(&a, &m.0));
    let here = branches.len();
    branches.push((whole, here + 1));
    if members.len() <= LEAF {
        return;
    }
    let axis = usize::from(whole[3] - whole[1] > whole[2] - whole[0]);
    let middle = members.len() / 2;
    let key = |m: &(Box2, u32)| m.0[axis] + m.0[axis + 2];
    members.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.1.cmp(&b.1)));
    let (low, high) = members.split_at_mut(middle);
    split(low, branches);
    split(high, branches);
    branches[here].1 = branches.len();
}
