//! Patches against flood fills of every state, against another program, and of made contacts.

mod counted;
mod edges;
mod flood;
mod made;
mod paths;

use proptest::prelude::*;

use super::Connectivity;
use crate::contact::ContactSequence;
use crate::{Boundary, Error, Grid};
use flood::Picture;

/// Nodes that touch one after the other.
#[derive(Debug, Clone)]
struct Case {
    shape: (usize, usize),
    order: Vec<usize>,
    boundary: Boundary,
    connectivity: Connectivity,
}

impl Case {
    fn grid(&self) -> Result<Grid, Error> {
        Ok(Grid::new(self.shape.0, self.shape.1, 2e-6, 3e-6)?)
    }

    fn contact(&self) -> Result<ContactSequence, Error> {
        ContactSequence::with_order(self.grid()?, self.order.iter().copied())
    }

    /// The contact of the first nodes.
    fn picture(&self, contact_nodes: usize) -> Picture {
        let (nx, ny) = self.shape;
        let mut is_in = vec![false; nx * ny];
        for &node in self.order.iter().take(contact_nodes) {
            is_in[node] = true;
        }
        let [x_repeats, y_repeats] = self.boundary.repeats();
        Picture {
            nx,
            ny,
            is_in,
            repeats: (x_repeats, y_repeats),
            corners: self.connectivity == Connectivity::Eight,
        }
    }
}

/// Heights of a few waves and noise, in falling order: patches of several nodes, that merge.
fn by_height(shape: (usize, usize), waves: &[(u8, u8, f64)], noise: &[f64]) -> Vec<usize> {
    let (nx, ny) = shape;
    let height = |node: usize| {
        let (x, y) = ((node % nx) as f64 / nx as f64, (node / nx) as f64 / ny as f64);
        let wave = |&(kx, ky, phase): &(u8, u8, f64)| {
            let turns = f64::from(kx) * x + f64::from(ky) * y + phase;
            (std::f64::consts::TAU * turns).cos()
        };
        waves.iter().map(wave).sum::<f64>() + noise.get(node).copied().unwrap_or_default()
    };
    let mut order: Vec<usize> = (0..nx * ny).collect();
    order.sort_by(|&a, &b| height(b).total_cmp(&height(a)));
    order
}

/// Random orders and random surfaces on grids of up to 8 × 8 nodes, to full contact or not, on all boundaries and with
/// both connectivities.
fn cases() -> impl Strategy<Value = Case> {
    let shapes = (1_usize..=8, 1_usize..=8);
    shapes
        .prop_flat_map(|shape| {
            let nodes = shape.0 * shape.1;
            let random = Just((0..nodes).collect::<Vec<_>>()).prop_shuffle();
            let waves = prop::collection::vec((0_u8..4, 0_u8..4, 0.0..1.0), 1..5);
            let noise = prop::collection::vec(0.0..0.5, nodes);
            let rough =
                (waves, noise).prop_map(move |(waves, noise)| by_height(shape, &waves, &noise));
            let order = prop_oneof![random, rough];
            (Just(shape), order, 0..=nodes, any::<bool>(), 0_usize..4, any::<bool>())
        })
        .prop_map(|(shape, mut order, few, full, boundary, corners)| {
            if !full {
                order.truncate(few);
            }
            Case {
                shape,
                order,
                boundary: [
                    Boundary::Free,
                    Boundary::Periodic,
                    Boundary::PeriodicX,
                    Boundary::PeriodicY,
                ][boundary],
                connectivity: if corners { Connectivity::Eight } else { Connectivity::Four },
            }
        })
}
