//! The leak through one gap map, and what can be said of it.

use nalgebra::DMatrix;

use super::Seal;
use super::flow::Flow;
use super::mean_field::bruggeman;
use super::network::{BEHIND, Beyond, LEFT, Network, Place, RIGHT};
use crate::patches;
use crate::surface::Axis;
use crate::{Boundary, Error, Grid, LoadingPath, LoadingState};

/// Nodes on each side of the critical constriction that count as its surroundings.
const AROUND: usize = 4;
/// How many times as wide as the greatest gap of nodes in contact, or as rounding of the initial one, a gap may be that
/// is none. On exact paths on 8 × 8 to 64 × 64 nodes it was up to 1.7 times as wide where nodes touch together.
const MARGIN: f64 = 10.0;
/// How many times the error of the approach nodes may overlap by: where they touch together it was up to 1.2 times.
const OF_APPROACH: f64 = 4.0;
/// What a rate is that neither over- nor underflows.
const IN_RANGE: &str = "positive and finite in the units of the input";

/// The leak through a gap map.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Leak {
    /// Leak rate Q \[m³/s\] through the whole width of the grid: exactly 0 if no channel leads from edge to edge. Of a
    /// [gas](Seal::with_gas) it is the volume at the pressure of the outlet.
    pub leak_rate: f64,
    /// Permeability along the flow, $`K_{aa} = Q L_a / (L_c \Delta p)`$ \[m³/(Pa s)\], with the sides of the grid along
    /// and across, and the leak rate of a liquid: of a gap g everywhere it is g³/12η.
    pub permeability: f64,
    /// Permeability across, $`K_{ca}`$ \[m³/(Pa s)\]: the mean flux across the flow over the mean pressure gradient
    /// along it. `None` on a free boundary, whose sides let nothing pass.
    pub transverse_permeability: Option<f64>,
    /// Bruggeman's estimate of the leak rate \[m³/s\]: that of a uniform gap with the conductivity of a random mixture
    /// of these gaps.
    pub mean_field_leak_rate: f64,
    /// The narrowest place of the widest channel; `None` if nothing leaks.
    pub constriction: Option<CriticalConstriction>,
    /// Fluid pressure \[Pa\] at each node above that of the outlet, between the pressure drop at the edge where the
    /// fluid enters and 0. NaN where there is no fluid and in pools that are cut off from both edges, whose pressure is
    /// any. Where the fluid rests it is that of its edge.
    pub pressure: DMatrix<f64>,
    /// Flux \[m²/s\], volume per time and width, along x.
    pub flux_x: DMatrix<f64>,
    /// The same along y.
    pub flux_y: DMatrix<f64>,
    /// Leak rate \[m³/s\] through each section across the flow, from edge to edge: one more than there are nodes along
    /// it. They are equal as far as the fluid is conserved.
    pub sections: Vec<f64>,
    /// What is lost at all nodes together over the leak rate: at most 10⁻¹¹. No section has another leak rate by more,
    /// and the leak rate is off by no more from that of the exact solution of these equations.
    pub imbalance: f64,
    /// Number of nodes through which the fluid flows.
    pub flowing_nodes: usize,
    /// Number of pools: places with fluid that no channel joins to either edge. They are left out.
    pub pools: usize,
    /// Iterations of the solver; 0 where elimination needs none.
    pub iterations: usize,
}

/// The narrowest place of the widest channel: the fluid has to pass one that is no wider, whichever way it takes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct CriticalConstriction {
    /// The node, (ix, iy).
    pub node: (usize, usize),
    /// The gap there \[m\].
    pub gap: f64,
    /// The share of the pressure drop from one side of its cell to the other: the greatest difference between its
    /// sides. Of a [gas](Seal::with_gas) it is the share of the drop of p².
    pub pressure_drop: f64,
    /// The share of the power Q Δp that is lost in the square of 9 × 9 cells about it. If all of the fluid passes here,
    /// it is the share of the pressure drop that falls there.
    pub dissipation: f64,
}

impl Seal {
    /// The leak through a gap \[m\], where nothing flows through nodes in contact. The sides are open to each other on
    /// a periodic boundary, and closed on a free one.
    ///
    /// A gap that is not positive is closed as well, and so is one below 10⁻¹² of the greatest. It takes some 1 s and
    /// 220 MB on 512 × 512 nodes, 7 s and 1 GB on 1024 × 1024; above that memory is proportional to the grid, as far as
    /// iterations converge.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] for a field of another shape; [`Error::FieldNotFinite`]; [`Error::OutOfRange`] for nodes
    /// out of contact that overlap by more than 10⁻⁴ of the greatest gap, for cells more than 10⁶ times as long as
    /// wide, and for leak rates that over- or underflow; [`Error::NotPositive`] for such a conductivity;
    /// [`Error::NoConvergence`].
    pub fn leak(
        &self,
        gap: &DMatrix<f64>,
        contact_map: &DMatrix<bool>,
        on: (&Grid, Boundary),
    ) -> Result<Leak, Error> {
        Leak::new(self, gap, contact_map, on)
    }

    /// The leak at any state of a path up to the present one. A gap that rounding does not tell from none, as that of
    /// nodes that touch together with the last one, is closed, and so are nodes that overlap by the error of the
    /// approach.
    ///
    /// # Errors
    ///
    /// Those of [`LoadingPath::fields_at`] and of [`Self::leak`].
    pub fn leak_at(&self, path: &mut LoadingPath, state: &LoadingState) -> Result<Leak, Error> {
        let mut gap = path.fields_at(state)?.gap;
        let contact_map = path.contact_map_at(state)?;
        // Nodes in contact have none, but for rounding.
        let in_contact = gap.iter().zip(&contact_map).filter(|(_, is_in_contact)| **is_in_contact);
        let greatest = in_contact.map(|(gap, _)| gap.abs()).fold(0.0, f64::max);
        let none = MARGIN * greatest.max(f64::EPSILON * path.problem().greatest_gap());
        let overlap = none + OF_APPROACH * state.approach_error;
        for gap in gap.iter_mut().filter(|gap| (-overlap..=none).contains(*gap)) {
            *gap = 0.0;
        }
        let on = (&path.grid(), path.problem().boundary());
        self.leak(&gap, &contact_map, on)
    }
}

impl Leak {
    /// Whether nothing leaks: no channel leads from edge to edge.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.leak_rate == 0.0
    }

    pub(super) fn new(
        seal: &Seal,
        gap: &DMatrix<f64>,
        contact_map: &DMatrix<bool>,
        (grid, boundary): (&Grid, Boundary),
    ) -> Result<Self, Error> {
        let on = (grid, boundary);
        let network = Network::new(gap, contact_map, seal.least_gap(), on, seal.along())?;
        let flowing = network.flowing();
        let (nx, ny) = grid.shape();
        let blank = || DMatrix::zeros(nx, ny);
        let transverse = |flux: f64| network.layout.wraps().then_some(flux);
        let layout = network.layout;
        let mut leak = Self {
            leak_rate: 0.0,
            permeability: 0.0,
            transverse_permeability: transverse(0.0),
            mean_field_leak_rate: 0.0,
            constriction: None,
            pressure: resting(&network, seal.pressure_drop(), (nx, ny)),
            flux_x: blank(),
            flux_y: blank(),
            sections: vec![0.0; layout.nodes[0] + 1],
            imbalance: 0.0,
            flowing_nodes: flowing.len(),
            pools: network.pools,
            iterations: 0,
        };
        if network.greatest_gap == 0.0 {
            return Ok(leak);
        }
        // Of a square of the greatest gap.
        let conductance = seal.conductivity(network.greatest_gap)?;
        let scale = conductance * seal.drive();
        let is_one = scale > 0.0 && scale.is_finite();
        Error::require("leak rate of a square of the greatest gap", scale, is_one, IN_RANGE)?;
        let [along, across] = [0, 1].map(|k| layout.nodes[k] as f64 * layout.cell[k]);
        leak.mean_field_leak_rate = bruggeman(&network.conductivity) * (across / along) * scale;
        if flowing.is_empty() {
            return Ok(leak);
        }
        let flow = Flow::through(&network, &flowing)?;
        let rate = flow.rate * scale;
        let is_one = rate > 0.0 && rate.is_finite();
        leak.leak_rate = Error::require("leak rate", rate, is_one, IN_RANGE)?;
        leak.imbalance = flow.lost;
        leak.iterations = flow.iterations;
        leak.permeability = flow.rate * (along / across) * conductance;
        let mut flows = Flows { network: &network, flow: &flow, across_flow: 0.0 };
        flows.fill(&mut leak, seal, &flowing, scale);
        // The flows across, each over the width of a cell, over the area, over the mean gradient.
        let mean = flows.across_flow * (layout.cell[1] / across) * conductance;
        leak.transverse_permeability = transverse(mean);
        leak.constriction = flows.constriction(gap, (grid, boundary), seal.along())?;
        Ok(leak)
    }
}

/// The pressure where the fluid rests.
fn resting(network: &Network, drop: f64, (nx, ny): (usize, usize)) -> DMatrix<f64> {
    let pressures = network.places.iter().map(|place| match place {
        Place::AtInlet => drop,
        Place::AtOutlet => 0.0,
        Place::Closed | Place::Pool | Place::Flowing => f64::NAN,
    });
    DMatrix::from_iterator(nx, ny, pressures)
}

/// What flows through the faces of a network.
struct Flows<'a> {
    network: &'a Network,
    flow: &'a Flow,
    /// The sum of what flows through all faces across the flow.
    across_flow: f64,
}

impl Flows<'_> {
    /// What flows out of a node through its four faces.
    fn out_of(&self, node: usize) -> [f64; 4] {
        let beyond = self.network.layout.beyond(node);
        [0, 1, 2, 3].map(|face| self.flow.face_flux(self.network, node, (face, beyond[face])))
    }

    /// Fills the fields and sections of a leak.
    fn fill(&mut self, leak: &mut Leak, seal: &Seal, flowing: &[usize], scale: f64) {
        let layout = self.network.layout;
        let [along, across] = layout.cell;
        for &node in flowing {
            let out = self.out_of(node);
            let [place, _] = layout.place(node);
            if layout.beyond(node)[0] == Beyond::Inlet {
                leak.sections[0] -= out[0] * scale;
            }
            leak.sections[place + 1] += out[BEHIND] * scale;
            self.across_flow += 0.5 * (out[RIGHT] - out[LEFT]);
            let [pressure, ..] = self.flow.pressure(node);
            leak.pressure.as_mut_slice()[node] = seal.pressure(pressure);
            // The mean of both faces, over their width.
            let flux = [
                0.5 * (out[BEHIND] - out[0]) * (scale / across),
                0.5 * (out[RIGHT] - out[LEFT]) * (scale / along),
            ];
            let [x, y] = match seal.along() {
                Axis::X => flux,
                Axis::Y => [flux[1], flux[0]],
            };
            leak.flux_x.as_mut_slice()[node] = x;
            leak.flux_y.as_mut_slice()[node] = y;
        }
    }

    /// The critical constriction, with what is lost there.
    fn constriction(
        &self,
        gap: &DMatrix<f64>,
        on: (&Grid, Boundary),
        along: Axis,
    ) -> Result<Option<CriticalConstriction>, Error> {
        let (nx, ny) = gap.shape();
        let is_closed = self.network.places.iter().map(|place| *place != Place::Flowing);
        let closed = DMatrix::from_iterator(nx, ny, is_closed);
        let found = patches::constriction(gap, &closed, on, along)?;
        Ok(found.map(|found| {
            let node = found.node.0 + nx * found.node.1;
            let out = self.out_of(node);
            // Pressures of the sides, from that of the node.
            let sides = [0, 1, 2, 3].map(|face| -out[face] / self.network.half(node, face));
            let most = sides.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let least = sides.iter().copied().fold(f64::INFINITY, f64::min);
            CriticalConstriction {
                node: found.node,
                gap: found.gap,
                pressure_drop: most - least,
                dissipation: self.around(node).into_iter().map(|near| self.dissipated(near)).sum(),
            }
        }))
    }

    /// The share of all power that is lost in a cell: in the halves of four channels.
    fn dissipated(&self, node: usize) -> f64 {
        if self.network.places[node] != Place::Flowing {
            return 0.0;
        }
        let out = self.out_of(node);
        let faces = [0, 1, 2, 3].map(|face| {
            let share = out[face] / self.flow.rate;
            share * (out[face] / self.network.half(node, face))
        });
        faces.iter().sum()
    }

    /// The nodes of a square, on a periodic border around it, each once.
    fn around(&self, node: usize) -> Vec<usize> {
        let mut nodes = vec![node];
        for face in 0..4 {
            // First a line, then each of its nodes sidewards.
            for start in nodes.clone() {
                let mut at = start;
                for _ in 0..AROUND {
                    match self.network.layout.beyond(at)[face] {
                        Beyond::Node(next) => at = next,
                        Beyond::Inlet | Beyond::Outlet | Beyond::Wall => break,
                    }
                    nodes.push(at);
                }
            }
        }
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}
