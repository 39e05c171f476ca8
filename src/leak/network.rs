//! The nodes out of contact as a network of channels: conductances between neighbours, and which of them the fluid
//! flows through.

use nalgebra::DMatrix;

use crate::surface::Axis;
use crate::{Boundary, Error, Grid};

/// A gap that is so small beside the greatest one counts as closed. Pressures of 64 digits resolve the flow through
/// conductances of 36 decades to 10⁻²⁰ of itself, and what 10⁸ nodes lose together to less than may be lost.
const CLOSED: f64 = 1e-12;
/// Greatest ratio of the sides of a cell, for the same reason.
const ASPECT: f64 = 1e6;
/// Overlap of nodes out of contact, beside the greatest gap, that iterations and rounding may leave; it counts as
/// closed.
const OVERLAP: f64 = 1e-4;

/// What lies beyond a face of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Beyond {
    /// Another node.
    Node(usize),
    /// The edge at which the fluid enters.
    Inlet,
    /// The edge at which it leaves.
    Outlet,
    /// Nothing: the border is closed.
    Wall,
}

/// The faces of a cell: before it and behind it along the flow, and at both sides.
pub(super) const BEFORE: usize = 0;
pub(super) const BEHIND: usize = 1;
pub(super) const LEFT: usize = 2;
pub(super) const RIGHT: usize = 3;

/// Where the nodes lie, in the direction of the flow and across it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    /// Number of nodes along the flow and across it.
    pub(super) nodes: [usize; 2],
    /// Steps of the index of a node in these directions.
    steps: [usize; 2],
    /// Whether the border across the flow is periodic.
    wraps: bool,
    /// Sides of a cell along the flow and across it \[m\].
    pub(super) cell: [f64; 2],
}

impl Layout {
    fn new(grid: &Grid, boundary: Boundary, along: Axis) -> Self {
        let (nx, ny) = grid.shape();
        let [x_repeats, y_repeats] = boundary.repeats();
        match along {
            Axis::X => {
                let cell = [grid.dx(), grid.dy()];
                Self { nodes: [nx, ny], steps: [1, nx], wraps: y_repeats, cell }
            }
            Axis::Y => {
                let cell = [grid.dy(), grid.dx()];
                Self { nodes: [ny, nx], steps: [nx, 1], wraps: x_repeats, cell }
            }
        }
    }

    /// Whether a mean flow across is free to be.
    pub(super) fn wraps(&self) -> bool {
        self.wraps
    }

    /// Places of a node along the flow and across it.
    pub(super) fn place(&self, node: usize) -> [usize; 2] {
        [0, 1].map(|k| node / self.steps[k] % self.nodes[k])
    }

    /// What lies beyond the four faces of a node.
    pub(super) fn beyond(&self, node: usize) -> [Beyond; 4] {
        let [along, across] = self.place(node);
        let [na, nc] = self.nodes;
        let [sa, sc] = self.steps;
        let around = (nc - 1) * sc;
        let border = |other: usize| if self.wraps { Beyond::Node(other) } else { Beyond::Wall };
        [
            if along == 0 { Beyond::Inlet } else { Beyond::Node(node - sa) },
            if along + 1 == na { Beyond::Outlet } else { Beyond::Node(node + sa) },
            if across == 0 { border(node + around) } else { Beyond::Node(node - sc) },
            if across + 1 == nc { border(node - around) } else { Beyond::Node(node + sc) },
        ]
    }

    /// Width of a face over the distance of the nodes on both its sides.
    pub(super) fn shape_of(&self, face: usize) -> f64 {
        let [along, across] = self.cell;
        if face <= BEHIND { across / along } else { along / across }
    }
}

/// What becomes of the fluid at a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// There is none.
    Closed,
    /// It flows from one edge to the other.
    Flowing,
    /// It rests, at the pressure of the edge where the fluid enters.
    AtInlet,
    /// It rests, at the pressure of the edge where the fluid leaves.
    AtOutlet,
    /// It is cut off from both edges.
    Pool,
}

/// The network.
#[derive(Debug, Clone)]
pub(super) struct Network {
    pub(super) layout: Layout,
    /// The greatest gap \[m\].
    pub(super) greatest_gap: f64,
    /// Cube of the gap at each node over that of the greatest one, 0 where it is closed.
    pub(super) conductivity: Vec<f64>,
    pub(super) places: Vec<Place>,
    /// Number of pools: sets of nodes that hang together and are cut off from both edges.
    pub(super) pools: usize,
}

impl Network {
    /// Nothing flows through gaps up to the least.
    pub(super) fn new(
        gap: &DMatrix<f64>,
        contact_map: &DMatrix<bool>,
        least_gap: f64,
        (grid, boundary): (&Grid, Boundary),
        along: Axis,
    ) -> Result<Self, Error> {
        grid.check_shape(contact_map.shape())?;
        grid.check_finite("gap", gap)?;
        let layout = Layout::new(grid, boundary, along);
        let aspect = layout.cell[0] / layout.cell[1];
        let is_one = (1.0 / ASPECT..=ASPECT).contains(&aspect);
        Error::require("ratio of the sides of a cell", aspect, is_one, "between 1e-6 and 1e6")?;
        let open = || gap.iter().zip(contact_map).filter(|(_, closed)| !**closed).map(|(g, _)| *g);
        let least = open().fold(0.0, f64::min);
        let is_one = least >= -OVERLAP * open().fold(0.0, f64::max);
        Error::require("least gap out of contact", least, is_one, "not negative")?;
        let greatest_gap = open().filter(|gap| *gap > least_gap).fold(0.0, f64::max);
        let conductivity = |(gap, closed): (&f64, &bool)| {
            let relative = gap / greatest_gap;
            let is_open = !*closed && *gap > least_gap && relative >= CLOSED;
            if is_open { relative.powi(3) } else { 0.0 }
        };
        let conductivity: Vec<f64> = gap.iter().zip(contact_map).map(conductivity).collect();
        let mut network = Self { layout, greatest_gap, places: Vec::new(), conductivity, pools: 0 };
        network.find_places();
        Ok(network)
    }

    /// Floods the network from both edges, and then what is left of it.
    fn find_places(&mut self) {
        let nodes = self.conductivity.len();
        let at = |face: usize| -> Vec<usize> {
            let border = [Beyond::Inlet, Beyond::Outlet][face];
            let open = (0..nodes).filter(|&node| self.conductivity[node] > 0.0);
            open.filter(|&node| self.layout.beyond(node)[face] == border).collect()
        };
        let mut from_inlet = vec![false; nodes];
        self.flood(at(BEFORE), &mut from_inlet);
        let mut from_outlet = vec![false; nodes];
        self.flood(at(BEHIND), &mut from_outlet);
        let mut reached: Vec<bool> =
            from_inlet.iter().zip(&from_outlet).map(|(a, b)| *a || *b).collect();
        let places = (0..nodes).map(|node| match (from_inlet[node], from_outlet[node]) {
            (true, true) => Place::Flowing,
            (true, false) => Place::AtInlet,
            (false, true) => Place::AtOutlet,
            (false, false) if self.conductivity[node] > 0.0 => Place::Pool,
            (false, false) => Place::Closed,
        });
        let places: Vec<Place> = places.collect();
        let mut pools = 0;
        for node in 0..nodes {
            if places[node] == Place::Pool && !reached[node] {
                pools += 1;
                self.flood(vec![node], &mut reached);
            }
        }
        self.places = places;
        self.pools = pools;
    }

    /// Marks what hangs together with some nodes.
    fn flood(&self, mut waiting: Vec<usize>, reached: &mut [bool]) {
        for &node in &waiting {
            reached[node] = true;
        }
        while let Some(node) = waiting.pop() {
            for beyond in self.layout.beyond(node) {
                if let Beyond::Node(other) = beyond
                    && self.conductivity[other] > 0.0
                    && !std::mem::replace(&mut reached[other], true)
                {
                    waiting.push(other);
                }
            }
        }
    }

    /// Conductance of half a cell, from its node to a face, relative to that of a square cell of the greatest gap.
    pub(super) fn half(&self, node: usize, face: usize) -> f64 {
        2.0 * self.conductivity[node] * self.layout.shape_of(face)
    }

    /// Conductance of the channel through a face: both halves in series. None leads around a border onto its own node.
    pub(super) fn conductance(&self, node: usize, face: usize, beyond: Beyond) -> f64 {
        let half = self.half(node, face);
        match beyond {
            Beyond::Wall => 0.0,
            Beyond::Inlet | Beyond::Outlet => half,
            Beyond::Node(other) if other == node => 0.0,
            Beyond::Node(other) => {
                let other = self.half(other, face);
                // In the order of their size, so that both nodes find the same bits.
                let (less, more) = if half < other { (half, other) } else { (other, half) };
                if less > 0.0 { less / (1.0 + less / more) } else { 0.0 }
            }
        }
    }

    /// The nodes through which the fluid flows.
    pub(super) fn flowing(&self) -> Vec<usize> {
        let nodes = 0..self.places.len();
        nodes.filter(|&node| self.places[node] == Place::Flowing).collect()
    }
}
