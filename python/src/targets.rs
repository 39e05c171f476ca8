//! Where to look, or to end: a load, a mean pressure, an approach, an area or a mean gap.

use asperity::ContactTarget;

use crate::errors::{Failure, Fallible};

/// What the arguments `load`, `mean_pressure`, `approach`, `area_fraction` and `mean_gap` ask for.
#[derive(Clone, Copy, Default)]
pub(crate) struct Targets {
    pub(crate) load: Option<f64>,
    pub(crate) mean_pressure: Option<f64>,
    pub(crate) approach: Option<f64>,
    pub(crate) area_fraction: Option<f64>,
    pub(crate) mean_gap: Option<f64>,
}

impl Targets {
    /// All of them.
    pub(crate) fn all(&self) -> Fallible<Vec<ContactTarget>> {
        if self.load.is_some() && self.mean_pressure.is_some() {
            return Err(Failure::arguments(
                "load and mean_pressure are the same quantity: give one of them",
            ));
        }
        let given = [
            self.load.map(ContactTarget::Load),
            self.mean_pressure.map(ContactTarget::MeanPressure),
            self.approach.map(ContactTarget::Approach),
            self.mean_gap.map(ContactTarget::MeanGap),
            self.area_fraction.map(ContactTarget::AreaFraction),
        ];
        Ok(given.into_iter().flatten().collect())
    }

    /// The only one.
    pub(crate) fn only(&self) -> Fallible<ContactTarget> {
        match self.all()?[..] {
            [target] => Ok(target),
            _ => Err(Failure::arguments(
                "give one of load, mean_pressure, approach, area_fraction and mean_gap",
            )),
        }
    }
}

/// The name of an argument and its value.
pub(crate) fn named(target: ContactTarget) -> (&'static str, f64) {
    match target {
        ContactTarget::Load(load) => ("load", load),
        ContactTarget::Approach(approach) => ("approach", approach),
        ContactTarget::AreaFraction(fraction) => ("area_fraction", fraction),
        ContactTarget::MeanGap(mean_gap) => ("mean_gap", mean_gap),
        _ => ("other", f64::NAN),
    }
}
