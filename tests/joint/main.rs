//! Conductance and its bounds, and tables for finite elements.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

mod conductance;
mod hardness;
mod layers;
mod semi_periodic;
mod tables;

use asperity::loading::History;
use asperity::{Error, InfluenceKernel, LoadingSolver, SelfAffine, Surface};

/// The states of a path to an area fraction.
fn history(surface: &dyn Surface, half_space: &dyn InfluenceKernel, area: f64) -> History {
    let builder = LoadingSolver::builder(surface, half_space).max_area_fraction(area);
    builder.build().unwrap().collect::<Result<_, Error>>().unwrap()
}

fn rough() -> SelfAffine {
    SelfAffine::zhang2020(1)
}
