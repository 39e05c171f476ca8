//! Numbers that stand for missing heights, although the file does not say so.

use crate::number::counted;

/// How many times the range of all other heights a number has to be away from them: one that programs use as a mark,
/// and any other that occurs more than once.
const FAR: f64 = 1.0;
const VERY_FAR: f64 = 10.0;

/// What programs write for a missing value, besides numbers that no instrument measures in any unit.
const USUAL: [f64; 10] = [
    999.0,
    9999.0,
    99999.0,
    999_999.0,
    32767.0,
    32768.0,
    65535.0,
    2_147_483_640.0,
    2_147_483_647.0,
    2_147_483_648.0,
];
const HUGE: f64 = 1e30;

/// Fewest other numbers beside which a repeated one is far away.
const ENOUGH: usize = 16;

/// Most different marks in a file: below the heights, above, for what was too dark and what was too bright.
const MOST: usize = 4;

/// Makes NaN of marks. Returns what is said of each.
pub(super) fn remove(values: &mut [f64]) -> Vec<String> {
    let mut notes = Vec::new();
    while let Some(mark) = find(values).filter(|_| notes.len() < MOST) {
        let mut count = 0;
        for value in values.iter_mut().filter(|value| **value == mark) {
            *value = f64::NAN;
            count += 1;
        }
        notes.push(format!(
            "{} with the number {mark:?}, far outside of all others, are taken as missing",
            counted(count, "node")
        ));
    }
    notes
}

/// A number far outside of all others.
fn find(values: &[f64]) -> Option<f64> {
    let (low, high) = range(values, f64::NAN)?;
    [low, high].into_iter().find(|mark| {
        let Some((rest_low, rest_high)) = range(values, *mark) else {
            return false;
        };
        let extent = rest_high - rest_low;
        let distance = (rest_low - mark).max(mark - rest_high);
        let is_usual = mark.abs() >= HUGE || USUAL.contains(&mark.abs());
        let count = |is_it: bool| values.iter().filter(|value| (*value == mark) == is_it).count();
        let is_repeated = || count(true) > 1 && count(false) >= ENOUGH;
        // Heights of two values only are steps.
        extent > 0.0
            && (is_usual && distance > FAR * extent
                || distance > VERY_FAR * extent && is_repeated())
    })
}

/// The least and the greatest of the finite values but one.
fn range(values: &[f64], but: f64) -> Option<(f64, f64)> {
    let others = values.iter().copied().filter(|value| value.is_finite() && *value != but);
    others.fold(None, |range, value| {
        let (low, high) = range.unwrap_or((value, value));
        Some((low.min(value), high.max(value)))
    })
}
