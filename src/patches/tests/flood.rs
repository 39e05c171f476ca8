//! The oracle: every contact map on its own, by flooding it from node to node. It shares nothing with the disjoint
//! sets.

use std::collections::HashMap;

use crate::surface::Axis;

/// A picture of nodes that are in, or not.
#[derive(Debug, Clone)]
pub(super) struct Picture {
    pub(super) nx: usize,
    pub(super) ny: usize,
    pub(super) is_in: Vec<bool>,
    /// Whether the picture repeats along x and y.
    pub(super) repeats: (bool, bool),
    /// Whether nodes are neighbours across corners.
    pub(super) corners: bool,
}

/// One patch: its nodes, each at the place in the repeated picture at which the flood reached it first.
#[derive(Debug, Clone, Default)]
pub(super) struct Pool {
    pub(super) nodes: HashMap<usize, (i64, i64)>,
    /// Whether the flood came to a node at two places, along x and along y.
    pub(super) endless: (bool, bool),
}

impl Picture {
    /// The node at a place, if the picture reaches there.
    fn at(&self, (x, y): (i64, i64)) -> Option<usize> {
        let (nx, ny) = (self.nx as i64, self.ny as i64);
        let x = if self.repeats.0 { x.rem_euclid(nx) } else { x };
        let y = if self.repeats.1 { y.rem_euclid(ny) } else { y };
        let inside = (0..nx).contains(&x) && (0..ny).contains(&y);
        inside.then_some((x + nx * y) as usize)
    }

    fn place(&self, node: usize) -> (i64, i64) {
        ((node % self.nx) as i64, (node / self.nx) as i64)
    }

    /// All patches, in the order of their first nodes.
    pub(super) fn pools(&self) -> Vec<Pool> {
        let mut pools: Vec<Pool> = Vec::new();
        for node in (0..self.is_in.len()).filter(|&node| self.is_in[node]) {
            if pools.iter().any(|pool| pool.nodes.contains_key(&node)) {
                continue;
            }
            let mut pool = Pool::default();
            pool.nodes.insert(node, self.place(node));
            let mut wet = vec![self.place(node)];
            while let Some((x, y)) = wet.pop() {
                for (dx, dy) in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (dx, dy))) {
                    let place = (x + dx, y + dy);
                    if dx * dy != 0 && !self.corners {
                        continue;
                    }
                    let Some(next) = self.at(place).filter(|&next| self.is_in[next]) else {
                        continue;
                    };
                    match pool.nodes.get(&next) {
                        Some(first) => {
                            pool.endless.0 |= first.0 != place.0;
                            pool.endless.1 |= first.1 != place.1;
                        }
                        None => {
                            pool.nodes.insert(next, place);
                            wet.push(place);
                        }
                    }
                }
            }
            pools.push(pool);
        }
        pools
    }

    /// Whether a patch leads all the way along an axis: without end if the picture repeats, else from end to end.
    pub(super) fn percolates(&self, axis: Axis) -> bool {
        let is_at = |pool: &Pool, end: usize| {
            let index = |node: &usize| match axis {
                Axis::X => node % self.nx,
                Axis::Y => node / self.nx,
            };
            pool.nodes.keys().any(|node| index(node) == end)
        };
        self.pools().iter().any(|pool| match axis {
            Axis::X if self.repeats.0 => pool.endless.0,
            Axis::Y if self.repeats.1 => pool.endless.1,
            Axis::X => is_at(pool, 0) && is_at(pool, self.nx - 1),
            Axis::Y => is_at(pool, 0) && is_at(pool, self.ny - 1),
        })
    }

    /// Sides between nodes that are in and others, of a set of nodes: along x and along y, and on the border along x
    /// and along y.
    pub(super) fn sides(&self, nodes: impl Iterator<Item = usize>) -> [usize; 4] {
        let mut sides = [0; 4];
        for node in nodes {
            let (x, y) = self.place(node);
            for (place, kind) in
                [((x, y - 1), 0), ((x, y + 1), 0), ((x - 1, y), 1), ((x + 1, y), 1)]
            {
                match self.at(place) {
                    None => sides[kind + 2] += 1,
                    Some(other) if !self.is_in[other] => sides[kind] += 1,
                    Some(_) => (),
                }
            }
        }
        sides
    }

    /// The nodes that are not in, as a picture of their own, through sides alone.
    pub(super) fn channels(&self) -> Self {
        Self {
            is_in: self.is_in.iter().map(|is_in| !is_in).collect(),
            corners: false,
            ..self.clone()
        }
    }

    /// The same with two ends along an axis.
    pub(super) fn cut(&self, axis: Axis) -> Self {
        let mut cut = self.clone();
        match axis {
            Axis::X => cut.repeats.0 = false,
            Axis::Y => cut.repeats.1 = false,
        }
        cut
    }
}
