//! Words that say which column has x, y or the heights.

/// Words between those of a name.
const PARTS: &str = ";,/_()[]{}<>\"':=|-#%";

/// What a name says of its column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    X,
    Y,
    Z,
}

pub(super) fn words(text: &str) -> impl DoubleEndedIterator<Item = &str> {
    let parts = |c: char| c.is_whitespace() || PARTS.contains(c);
    text.split(parts).filter(|word| !word.is_empty())
}

pub(super) fn kind(word: &str) -> Option<Kind> {
    match word.to_lowercase().as_str() {
        "x" | "column" | "col" | "ix" => Some(Kind::X),
        "y" | "row" | "iy" => Some(Kind::Y),
        "z" | "height" | "heights" | "value" | "values" | "topography" | "elevation" => {
            Some(Kind::Z)
        }
        _ => None,
    }
}

/// Most words of a line that names x and z, with their units.
const FEW: usize = 6;

/// Whether a line could be one of names: it has both an x and a y, or little else than an x and a z.
pub(super) fn could_be(line: &str) -> bool {
    let has = |wanted| words(line).any(|word| kind(word) == Some(wanted));
    let is_short = || !line.contains([':', '=']) && words(line).count() <= FEW;
    has(Kind::X) && (has(Kind::Y) || has(Kind::Z) && is_short())
}
