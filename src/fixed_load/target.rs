//! What a state is asked to have.

/// What a state of contact is asked to have; a plain number is a load.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum ContactTarget {
    /// This load \[N\].
    Load(f64),
    /// This approach \[m\] from first touch.
    Approach(f64),
    /// The number of contact nodes nearest to this fraction (above 0, at most 1) of all.
    ///
    /// Nodes that touch at the same load, as on symmetric shapes, make some numbers unreachable: then
    /// it is the nearest reachable one.
    AreaFraction(f64),
    /// This mean gap \[m\], between 0 and that of surfaces that just touch, to the tolerance of the
    /// solver for gaps.
    MeanGap(f64),
}

impl From<f64> for ContactTarget {
    fn from(load: f64) -> Self {
        Self::Load(load)
    }
}
