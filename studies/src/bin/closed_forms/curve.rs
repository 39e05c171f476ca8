//! What is compared, and how its error falls with the mesh.

use asperity::{ContactTarget, Error};
use asperity_studies::order::order;

/// Cells over the radius, or the half-width, of a contact.
pub(crate) const CELLS: [usize; 5] = [4, 8, 16, 32, 64];
/// The same of the square punch, which has no fluctuation to average over.
pub(crate) const PUNCH_CELLS: [usize; 6] = [4, 8, 16, 32, 64, 128];
/// Loads over which an error is averaged, from 3/4 to 5/4 of a target: that of a single state depends on how the edge
/// of contact runs through the cells.
pub(crate) const LOADS: usize = 15;
/// Where the apex is relative to the middle of the grid, in cells: on a node and between nodes, and twice in general
/// position.
pub(crate) const APEXES: [(f64, f64); 4] = [(0.5, 0.5), (0.0, 0.0), (0.21, 0.37), (0.1, 0.43)];
/// Of the solutions, relative to the approach.
pub(crate) const TOLERANCE: f64 = 1e-10;
/// The finest grids, from which orders are fitted.
const FITTED: usize = 4;
/// By how much an order may fall short of the expected one.
pub(crate) const SLACK: f64 = 0.2;
/// The error that may be left, in units of cells to the power of minus the expected order.
pub(crate) const COEFFICIENT: f64 = 1.0;

/// What is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
    Area,
    CorrectedArea,
    Distance,
    Pressure,
    Stiffness,
    Energy,
}

impl Quantity {
    pub(crate) const ALL: [Self; 6] = [
        Self::Area,
        Self::CorrectedArea,
        Self::Distance,
        Self::Pressure,
        Self::Stiffness,
        Self::Energy,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Area => "area",
            Self::CorrectedArea => "area, corrected",
            Self::Distance => "approach, or mean gap",
            Self::Pressure => "pressure",
            Self::Stiffness => "stiffness",
            Self::Energy => "energy",
        }
    }

    /// The order of its error: cells are counted whole, and the stiffness is that of the cells counted.
    pub(crate) fn order(self) -> f64 {
        match self {
            Self::Area | Self::CorrectedArea | Self::Stiffness => 1.0,
            Self::Distance | Self::Pressure | Self::Energy => 2.0,
        }
    }
}

/// Relative errors of the states of one contact on one mesh.
#[derive(Debug, Default)]
pub(crate) struct Errors {
    squares: Vec<(Quantity, f64)>,
}

impl Errors {
    pub(crate) fn add(&mut self, quantity: Quantity, found: f64, exact: f64) {
        self.squares.push((quantity, (found / exact - 1.0).powi(2)));
    }

    /// Root mean square over the states, `None` if the contact does not have the quantity.
    fn rms(&self, quantity: Quantity) -> Option<f64> {
        let of = || self.squares.iter().filter(|(q, _)| *q == quantity);
        let count = of().count();
        (count > 0).then(|| (of().map(|(_, square)| square).sum::<f64>() / count as f64).sqrt())
    }
}

/// Loads around a target.
pub(crate) fn loads(target: f64) -> impl Iterator<Item = ContactTarget> {
    let part = |k| 0.75 + 0.5 * (k as f64 + 0.5) / LOADS as f64;
    (0..LOADS).map(move |k| ContactTarget::Load(target * part(k)))
}

/// The errors on every mesh.
pub(crate) fn on_all(
    errors: impl Fn(usize) -> Result<Errors, Error>,
) -> Result<Vec<(usize, Errors)>, Error> {
    let each = CELLS.iter().map(|&cells| Ok((cells, errors(cells)?)));
    each.collect()
}

/// How the rms error of one quantity of one contact falls.
#[derive(Debug, Clone)]
pub(crate) struct Curve {
    pub(crate) contact: &'static str,
    pub(crate) quantity: Quantity,
    /// The order that theory has.
    pub(crate) expected: f64,
    /// (cells over the radius, rms of the relative error).
    pub(crate) points: Vec<(f64, f64)>,
}

impl Curve {
    /// All quantities of a contact, from its errors on each mesh; `expected` overrides the order of some.
    pub(crate) fn of(
        contact: &'static str,
        meshes: &[(usize, Errors)],
        expected: &[(Quantity, f64)],
    ) -> Vec<Self> {
        let curve = |quantity: Quantity| {
            let point =
                |(cells, errors): &(usize, Errors)| Some((*cells as f64, errors.rms(quantity)?));
            let points: Option<Vec<_>> = meshes.iter().map(point).collect();
            let own = expected.iter().find(|(q, _)| *q == quantity);
            Some(Self {
                contact,
                quantity,
                expected: own.map_or(quantity.order(), |(_, order)| *order),
                points: points?,
            })
        };
        Quantity::ALL.into_iter().filter_map(curve).collect()
    }

    pub(crate) fn order(&self) -> f64 {
        order(&self.points, FITTED)
    }

    /// Error on the finest mesh in units of cells to the power of minus the expected order.
    pub(crate) fn coefficient(&self) -> f64 {
        let last = self.points.last();
        last.map_or(f64::NAN, |(cells, error)| error * cells.powf(self.expected))
    }

    /// The criterion, fixed before any comparison.
    pub(crate) fn agrees(&self) -> bool {
        self.order() >= self.expected - SLACK && self.coefficient() <= COEFFICIENT
    }
}
