//! Numbers that stand for missing heights, although the file does not say so.

use crate::number::{counted, significant};

/// How many times the range of all other heights a number has to be away from them: one that programs use as a mark,
/// and any other that occurs more than once, of which a word is said.
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

/// Makes NaN of marks. Returns what is said of each, and of numbers that may be marks of an unusual kind: the ground
/// far below a surface looks the same, so that they stay heights.
pub(super) fn remove(values: &mut [f64]) -> Vec<String> {
    let mut notes = Vec::new();
    while let Some((mark, _)) =
        ends(values).into_iter().find(is_mark).filter(|_| notes.len() < MOST)
    {
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
    for (number, distance) in ends(values).into_iter().filter(|end| end.1 > VERY_FAR) {
        let finite = || values.iter().filter(|value| value.is_finite());
        let count = finite().filter(|value| **value == number).count();
        if count > 1 && finite().count() - count >= ENOUGH {
            notes.push(format!(
                "{} have the number {number:?}, {} times the range of all others away from them, and it is \
                 taken as their height; if it stands for missing heights, write 'NODATA_value {number:?}' in a line \
                 above the numbers",
                counted(count, "node"),
                significant(distance, 3)
            ));
        }
    }
    notes
}

/// Whether a number, so many times the range of all others away from them, is one that programs write for a missing
/// value.
fn is_mark((number, distance): &(f64, f64)) -> bool {
    *distance > FAR && (number.abs() >= HUGE || USUAL.contains(&number.abs()))
}

/// The least and the greatest number, and how many times the range of all others each is away from them. Heights of two
/// values only are steps: their others have no range.
fn ends(values: &[f64]) -> Vec<(f64, f64)> {
    let ends = range(values, f64::NAN).map(|(low, high)| [low, high]);
    let with_distance = |end: f64| {
        let (low, high) = range(values, end)?;
        let distance = (low - end).max(end - high) / (high - low);
        (high > low).then_some((end, distance))
    };
    ends.into_iter().flatten().filter_map(with_distance).collect()
}

/// The least and the greatest of the finite values but one.
fn range(values: &[f64], but: f64) -> Option<(f64, f64)> {
    let others = values.iter().copied().filter(|value| value.is_finite() && *value != but);
    others.fold(None, |range, value| {
        let (low, high) = range.unwrap_or((value, value));
        Some((low.min(value), high.max(value)))
    })
}
