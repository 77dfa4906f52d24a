// SPDX-License-Identifier: BSD-3-Clause
//! The smallest vertex separator in a band of a graph, by a maximum flow.
//!
//! Vertices of the band carry a flow of one each from what lies before the band to what lies
//! behind it. Source: Dinic, *Soviet Math. Doklady* 11 (1970) 1277-1280, on the graph of Menger's
//! theorem, in which each vertex is an arc from its entry to its exit.

/// No vertex, the side before the band, the side behind it.
const FREE: u32 = u32::MAX;
const BEFORE: u32 = u32::MAX - 1;
const BEHIND: u32 = u32::MAX - 2;

/// A band of vertices with local numbers, and the flow through it.
#[derive(Default)]
pub struct Band {
    /// Start of each vertex's list of neighbors in the band, and the lists.
    pub start: Vec<u32>,
    pub list: Vec<u32>,
    /// Whether a vertex touches the side before the band, and the side behind it.
    pub touches: Vec<[bool; 2]>,
    /// Vertex before and after on the path of flow; `FREE` where there is none.
    from: Vec<u32>,
    to: Vec<u32>,
    /// Distance of entry (even) and exit (odd) from the side before; next arc to try.
    level: Vec<u32>,
    next: Vec<u32>,
    queue: Vec<u32>,
}

impl Band {
    /// Removes all vertices.
    pub fn clear(&mut self) {
        self.start.clear();
        self.start.push(0);
        self.list.clear();
        self.touches.clear();
    }

    /// Finds the largest flow, or one of `limit`; its size is that of the smallest separator.
    pub fn saturate(&mut self, limit: usize) -> usize {
        let n = self.touches.len();
        for v in [&mut self.from, &mut self.to] {
            v.clear();
            v.resize(n, FREE);
        }
        let mut flow = 0;
        while flow < limit && self.levels() {
            self.next.clear();
            self.next.resize(2 * n, 0);
            for v in 0..n as u32 {
                if self.touches[v as usize][0]
                    && self.from[v as usize] != BEFORE
                    && self.augment(2 * v)
                {
                    flow += 1;
                }
            }
        }
        flow
    }

    /// Distances from the side before; whether the side behind is reached.
    fn levels(&mut self) -> bool {
        let n = self.touches.len();
        self.level.clear();
        self.level.resize(2 * n, FREE);
        self.queue.clear();
        for v in 0..n {
            if self.touches[v][0] {
                self.level[2 * v] = 0;
                self.queue.push(2 * v as u32);
            }
        }
        let (mut at, mut last) = (0, FREE);
        while at < self.queue.len() {
            let node = self.queue[at];
            at += 1;
            let level = self.level[node as usize] + 1;
            if level > last {
                break;
            }
            let v = node as usize / 2;
            if node % 2 == 1 && self.touches[v][1] && self.to[v] != BEHIND {
                last = level;
            }
            let mut k = 0;
            while let Some(other) = self.arc(node, k) {
                k += 1;
                if other != FREE && self.level[other as usize] == FREE {
                    self.level[other as usize] = level;
                    self.queue.push(other);
                }
            }
        }
        last != FREE
    }

    /// Arc `k` of an entry or exit: where it leads, `FREE` if it is saturated, none after the last.
    #[inline]
    fn arc(&self, node: u32, k: u32) -> Option<u32> {
        let v = node as usize / 2;
        if node.is_multiple_of(2) {
            return match (k, self.from[v]) {
                (0, FREE) => Some(node + 1),
                (0, BEFORE) => None,
                (0, from) => Some(2 * from + 1),
                _ => None,
            };
        }
        let at = self.start[v] + k;
        if at < self.start[v + 1] {
            let u = self.list[at as usize];
            return Some(if self.to[v] == u { FREE } else { 2 * u });
        }
        (at == self.start[v + 1]).then_some(if self.from[v] == FREE { FREE } else { node - 1 })
    }

    /// Sends one more unit from the entry of a vertex along rising levels, if it can.
    fn augment(&mut self, root: u32) -> bool {
        self.queue.clear();
        self.queue.push(root);
        while let Some(&node) = self.queue.last() {
            let v = node as usize / 2;
            if node % 2 == 1 && self.touches[v][1] && self.to[v] != BEHIND {
                self.push();
                return true;
            }
            let level = self.level[node as usize] + 1;
            let step = loop {
                let k = self.next[node as usize];
                let Some(other) = self.arc(node, k) else { break None };
                if other != FREE && self.level[other as usize] == level {
                    break Some(other);
                }
                self.next[node as usize] += 1;
            };
            if let Some(other) = step {
                self.queue.push(other);
            } else {
                self.level[node as usize] = FREE;
                self.queue.pop();
            }
        }
        false
    }

    /// Changes the flow along the path in the queue.
    fn push(&mut self) {
        let first = self.queue[0] as usize / 2;
        let last = self.queue[self.queue.len() - 1] as usize / 2;
        // Vertices that the path leaves through their entry carry no flow any more.
        for k in 1..self.queue.len() {
            let (a, b) = (self.queue[k - 1], self.queue[k]);
            if a % 2 == 1 && b == a - 1 {
                self.from[a as usize / 2] = FREE;
                self.to[a as usize / 2] = FREE;
            }
        }
        for k in 1..self.queue.len() {
            let (a, b) = (self.queue[k - 1], self.queue[k]);
            if a % 2 == 1 && b != a - 1 {
                self.to[a as usize / 2] = b / 2;
                self.from[b as usize / 2] = a / 2;
            }
        }
        self.from[first] = BEFORE;
        self.to[last] = BEHIND;
    }

    /// Side of each vertex after [`Band::saturate`]: 0 before, 1 behind, 2 in the separator, which
    /// is the one next to the side before, or next to the side behind.
    ///
    /// Both are smallest ones; with a flow that stopped at its limit they are not.
    pub fn sides(&mut self, behind: bool, sides: &mut Vec<u8>) {
        let n = self.touches.len();
        sides.clear();
        if !behind {
            self.levels();
            sides.extend((0..n).map(|v| match (self.level[2 * v], self.level[2 * v + 1]) {
                (_, exit) if exit != FREE => 0,
                (FREE, _) => 1,
                _ => 2,
            }));
            return;
        }
        // The same from the other end: which entries and exits still reach the side behind.
        let mut reaches = vec![false; 2 * n];
        self.queue.clear();
        for v in 0..n {
            if self.touches[v][1] {
                reaches[2 * v + 1] = true;
                self.queue.push(2 * v as u32 + 1);
            }
        }
        while let Some(node) = self.queue.pop() {
            let v = node as usize / 2;
            let mut visit = |other: usize, queue: &mut Vec<u32>| {
                if !reaches[other] {
                    reaches[other] = true;
                    queue.push(other as u32);
                }
            };
            if node % 2 == 1 {
                // Arcs into an exit: from its own entry, and from where its flow goes.
                if self.from[v] == FREE {
                    visit(2 * v, &mut self.queue);
                } else if self.to[v] < BEHIND {
                    visit(2 * self.to[v] as usize, &mut self.queue);
                }
            } else {
                // Arcs into an entry: from the neighbors' exits, and from its own if it has flow.
                if self.from[v] != FREE {
                    visit(2 * v + 1, &mut self.queue);
                }
                for k in self.start[v]..self.start[v + 1] {
                    let u = self.list[k as usize];
                    if self.to[u as usize] != v as u32 {
                        visit(2 * u as usize + 1, &mut self.queue);
                    }
                }
            }
        }
        sides.extend((0..n).map(|v| match (reaches[2 * v], reaches[2 * v + 1]) {
            (true, _) => 1,
            (false, true) => 2,
            (false, false) => 0,
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether the vertices that are left connect the sides.
    fn connected(band: &Band, removed: impl Fn(usize) -> bool) -> bool {
        let n = band.touches.len();
        let mut reached: Vec<bool> = (0..n).map(|v| band.touches[v][0] && !removed(v)).collect();
        let mut stack: Vec<usize> = (0..n).filter(|&v| reached[v]).collect();
        while let Some(v) = stack.pop() {
            if band.touches[v][1] {
                return true;
            }
            for &u in &band.list[band.start[v] as usize..band.start[v + 1] as usize] {
                let u = u as usize;
                if !reached[u] && !removed(u) {
                    reached[u] = true;
                    stack.push(u);
                }
            }
        }
        false
    }

    #[test]
    fn separators_are_the_smallest_of_all() {
        let mut state = 7_u64;
        let mut below = |n: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) % n
        };
        for _ in 0..300 {
            let n = 4 + below(7) as usize;
            let mut edges = vec![vec![]; n];
            for a in 0..n {
                for b in 0..a {
                    if below(10) < 3 {
                        edges[a].push(b as u32);
                        edges[b].push(a as u32);
                    }
                }
            }
            let mut band = Band::default();
            band.clear();
            for list in &edges {
                band.list.extend(list);
                band.start.push(band.list.len() as u32);
                band.touches.push([below(4) == 0, below(4) == 0]);
            }
            let smallest = (0..1_u32 << n)
                .filter(|set| !connected(&band, |v| set >> v & 1 == 1))
                .map(u32::count_ones)
                .min();
            let flow = band.saturate(usize::MAX);
            assert_eq!(Some(flow as u32), smallest);
            for behind in [false, true] {
                let mut sides = Vec::new();
                band.sides(behind, &mut sides);
                let cut = (0..n).filter(|&v| sides[v] == 2).count();
                assert_eq!(cut, flow);
                for v in 0..n {
                    let others = &edges[v];
                    assert!(sides[v] != 0 || others.iter().all(|&u| sides[u as usize] != 1));
                    assert!(sides[v] != 0 || !band.touches[v][1]);
                    assert!(sides[v] != 1 || !band.touches[v][0]);
                }
            }
        }
    }
}
