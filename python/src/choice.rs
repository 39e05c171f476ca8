//! Arguments that are one word of a few.

use asperity::patches::Connectivity;
use asperity::surface::{Axis, Filter, Interpolation, Trend};

use crate::errors::{Failure, Fallible};

/// What a word stands for.
pub(crate) fn choose<T: Copy>(name: &str, word: &str, choices: &[(&str, T)]) -> Fallible<T> {
    let found = choices.iter().find(|(known, _)| *known == word);
    found.map(|(_, choice)| *choice).ok_or_else(|| {
        let words: Vec<String> = choices.iter().map(|(word, _)| format!("'{word}'")).collect();
        Failure::arguments(format!("{name} must be one of {}, but is '{word}'", words.join(", ")))
    })
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
