//! Tables of numbers with a line of names above.

use std::path::Path;

/// The rows of a file of numbers that are separated by commas, without its first line.
#[must_use]
pub fn read(file: impl AsRef<Path>) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(file).unwrap();
    let numbers = |line: &str| line.split(',').map(|number| number.parse().unwrap()).collect();
    text.lines().skip(1).map(numbers).collect()
}
