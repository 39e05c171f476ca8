//! Arguments that are one word of a few.

use asperity::Boundary;
use asperity::kernel::Layering;
use asperity::patches::Connectivity;
use asperity::surface::{Axis, Filter, Interpolation, Trend};
use pyo3::IntoPyObject;

use crate::argument::one_of;
use crate::errors::{Failure, Fallible};

/// What a word stands for.
pub(crate) fn choose<T: Copy>(name: &str, word: &str, choices: &[(&str, T)]) -> Fallible<T> {
    let found = choices.iter().find(|(known, _)| *known == word);
    found.map(|(_, choice)| *choice).ok_or_else(|| {
        let words: Vec<String> = choices.iter().map(|(word, _)| format!("'{word}'")).collect();
        Failure::arguments(format!("{name} must be one of {}, but is '{word}'", words.join(", ")))
    })
}

/// The word of a choice.
pub(crate) fn word<T: PartialEq>(choices: &[(&'static str, T)], choice: &T) -> &'static str {
    choices.iter().find(|(_, known)| known == choice).map_or("", |(word, _)| *word)
}

pub(crate) const BOUNDARIES: [(&str, Boundary); 4] = [
    ("free", Boundary::Free),
    ("periodic", Boundary::Periodic),
    ("x", Boundary::PeriodicX),
    ("y", Boundary::PeriodicY),
];

pub(crate) const LAYERINGS: [(&str, Layering); 5] = [
    ("unknown", Layering::Unknown),
    ("half-space", Layering::HalfSpace),
    ("half-space in a row", Layering::SemiPeriodicHalfSpace),
    ("one material", Layering::OneMaterial),
    ("several", Layering::Several),
];

/// Whether a map repeats with its sides, or the side along which it does.
#[derive(IntoPyObject)]
pub(crate) enum Repeats {
    Sides(bool),
    Along(String),
}
one_of!(Repeats, "True, False, 'x' or 'y'", Sides, Along);

impl Repeats {
    pub(crate) fn of(boundary: Boundary) -> Self {
        match boundary {
            Boundary::Free => Self::Sides(false),
            Boundary::Periodic => Self::Sides(true),
            _ => Self::Along(word(&BOUNDARIES, &boundary).to_string()),
        }
    }

    pub(crate) fn boundary(&self) -> Fallible<Boundary> {
        match self {
            Self::Sides(false) => Ok(Boundary::Free),
            Self::Sides(true) => Ok(Boundary::Periodic),
            Self::Along(side) => choose("periodic", side, &BOUNDARIES[2..]),
        }
    }
}

pub(crate) fn axis(word: &str) -> Fallible<Axis> {
    choose("axis", word, &[("x", Axis::X), ("y", Axis::Y)])
}

pub(crate) fn trend(word: &str) -> Fallible<Trend> {
    let choices = [("mean", Trend::Mean), ("plane", Trend::Plane), ("quadratic", Trend::Quadratic)];
    choose("trend", word, &choices)
}

pub(crate) fn filter(word: &str) -> Fallible<Filter> {
    choose("filter", word, &[("gaussian", Filter::Gaussian), ("sharp", Filter::Sharp)])
}

pub(crate) fn interpolation(word: &str) -> Fallible<Interpolation> {
    let choices = [("fourier", Interpolation::Fourier), ("bilinear", Interpolation::Bilinear)];
    choose("method", word, &choices)
}

pub(crate) fn connectivity(number: usize) -> Fallible<Connectivity> {
    match number {
        4 => Ok(Connectivity::Four),
        8 => Ok(Connectivity::Eight),
        _ => Err(Failure::arguments(format!("connectivity must be 4 or 8, but is {number}"))),
    }
}
