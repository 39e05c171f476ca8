//! How far the second of two rough surfaces is moved.

/// Nodes along x and y.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shift(pub(super) isize, pub(super) isize);

impl Shift {
    /// Two integers.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let (ix, iy) = text.split_once(',').ok_or("a shift is IX,IY: nodes along x and y")?;
        let node = |text: &str| {
            text.trim().parse().map_err(|_| format!("'{text}' is no whole number of nodes"))
        };
        Ok(Self(node(ix)?, node(iy)?))
    }
}
