//! Where a path is to end, and whether it ends there.

use asperity::loading::{LoadingBuilder, LoadingEnd};
use asperity::updater::LinearUpdater;
use asperity::{Error, Grid, LoadingState, SurfaceError};

use crate::dense::Dense;
use crate::draw::Draw;
use crate::verdict::{Violation, ensure};

/// A limit of a path.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Limit {
    None,
    Load(f64),
    Approach(f64),
    MeanGap(f64),
    Area(f64),
    Nodes(usize),
}

impl Limit {
    /// Draws a limit, mostly one that a path with these states reaches.
    pub(crate) fn draw(draw: &mut Draw<'_>, states: &[LoadingState], grid: &Grid) -> Self {
        let (Some(first), Some(last)) = (states.first(), states.last()) else {
            return Self::None;
        };
        let part = 1.1 * draw.unit();
        // At an event exactly, sometimes.
        let some = states[draw.whole(0, states.len() - 1)];
        let at_event = draw.once_in(3);
        let choose = |between: f64, at: f64| if at_event { at } else { between };
        match draw.whole(0, 5) {
            0 => Self::None,
            1 => Self::Load(choose(part * last.contact.load, some.contact.load)),
            2 => Self::Approach(choose(part * last.contact.approach, some.contact.approach)),
            3 => {
                Self::MeanGap(choose((1.0 - part) * first.contact.mean_gap, some.contact.mean_gap))
            }
            4 => Self::Area(choose(part, some.contact.contact_area_fraction)),
            _ => Self::Nodes(draw.whole(0, grid.nodes() + 1)),
        }
    }

    /// This, or none if it is an approach of mean planes that is nothing but rounding, as on a flat periodic surface.
    /// `states` are those of the whole path.
    pub(crate) fn unless_rounding(self, dense: &Dense, states: &[LoadingState]) -> Self {
        match (self, states.last()) {
            (Self::Approach(approach), Some(last))
                if approach > 0.0
                    && approach
                        < Dense::rounding(dense.nodes())
                            * dense.uniform_displacement(last.contact.load) =>
            {
                Self::None
            }
            _ => self,
        }
    }

    pub(crate) fn set<'a, U: LinearUpdater>(
        self,
        builder: LoadingBuilder<'a, U>,
    ) -> LoadingBuilder<'a, U> {
        match self {
            Self::None => builder,
            Self::Load(load) => builder.max_load(load),
            Self::Approach(approach) => builder.max_approach(approach),
            Self::MeanGap(mean_gap) => builder.min_mean_gap(mean_gap),
            Self::Area(fraction) => builder.max_area_fraction(fraction),
            Self::Nodes(nodes) => builder.max_nodes(nodes),
        }
    }

    /// Whether a builder has to refuse it with this error, of a surface with this mean gap before it is loaded and this
    /// load under which all nodes yield.
    pub(crate) fn deserves(self, error: &Error, grid: &Grid, unloaded: f64, most: f64) -> bool {
        match (self, error) {
            // Sums in whichever order.
            (Self::Load(value), Error::OutOfRange { .. }) => value > most * (1.0 - 1e-13),
            (Self::Load(value) | Self::Approach(value), Error::NotPositive { .. }) => {
                !(value > 0.0 && value.is_finite())
            }
            (Self::MeanGap(value), Error::OutOfRange { .. }) => !(value >= 0.0 && value < unloaded),
            (Self::Area(value), Error::OutOfRange { .. }) => !(value > 0.0 && value <= 1.0),
            // A fraction of one node is one node, whatever its last bits.
            (Self::Area(value), Error::Surface(SurfaceError::LessThanOneNode { .. })) => {
                value * (grid.nodes() as f64) < 1.0 + 1e-12
            }
            (Self::Nodes(nodes), Error::OutOfRange { .. }) => nodes == 0,
            _ => false,
        }
    }

    /// `Ok` if a path with these states ends as the limit says.
    pub(crate) fn check_end(
        self,
        end: Option<LoadingEnd>,
        states: &[LoadingState],
        grid: &Grid,
    ) -> Result<(), Violation> {
        let Some(last) = states.last() else {
            return Err(Violation::new("a path without a state"));
        };
        let full = last.contact.contact_nodes == grid.nodes();
        let nodes_in = |fraction| grid.nodes_in(fraction).unwrap_or(0);
        let is_there = match (end, self) {
            (Some(LoadingEnd::Load), Self::Load(load)) => last.contact.load == load,
            (Some(LoadingEnd::Approach), Self::Approach(approach)) => {
                last.contact.approach == approach
            }
            (Some(LoadingEnd::MeanGap), Self::MeanGap(mean_gap)) => {
                last.contact.mean_gap == mean_gap
            }
            (Some(LoadingEnd::AreaFraction), Self::Area(fraction)) => {
                last.contact.contact_nodes == nodes_in(fraction)
            }
            (Some(LoadingEnd::Nodes), Self::Nodes(nodes)) => last.contact.contact_nodes == nodes,
            // Whether others could yield is asked elsewhere.
            (Some(LoadingEnd::FullContact), _) => full,
            (Some(LoadingEnd::FullyPlastic), _) => {
                full && last.contact.plastic.is_some_and(|p| p.yielded_nodes == grid.nodes())
            }
            // Whether anything closes is asked elsewhere.
            (Some(LoadingEnd::NoMoreEvents), _) => !full,
            _ => false,
        };
        ensure!(is_there, "the end {end:?} of a path to {self:?} at {last:?}");
        let is_within = |state: &LoadingState| match self {
            Self::None => true,
            Self::Load(load) => state.contact.load <= load,
            Self::Approach(approach) => state.contact.approach <= approach,
            Self::MeanGap(mean_gap) => state.contact.mean_gap >= mean_gap,
            Self::Area(fraction) => state.contact.contact_nodes <= nodes_in(fraction),
            Self::Nodes(nodes) => state.contact.contact_nodes <= nodes,
        };
        match states.iter().find(|state| !is_within(state)) {
            None => Ok(()),
            Some(state) => Err(Violation::new(format!("{state:?} is beyond {self:?}"))),
        }
    }
}
