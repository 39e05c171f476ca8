//! The state of contact to find: by load, mean pressure, approach, mean gap or area.

/// The state of contact to find: by load, mean pressure, approach, mean gap or area.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ContactTarget {
    /// This load \[N\].
    Load(f64),
    /// This load over the nominal area \[Pa\]: a path takes it for the load that it is.
    MeanPressure(f64),
    /// This approach \[m\] from first touch.
    Approach(f64),
    /// As many nodes in contact as fit into this fraction (above 0, at most 1) of the nominal area:
    /// [`Grid::nodes_in`](crate::Grid::nodes_in).
    ///
    /// Nodes that touch at the same load, as on symmetric shapes, make some numbers unreachable: a path then takes them
    /// one after the other, and the solver for one load the nearest number there is; of fewer nodes than touch first
    /// that is theirs, under some load that is too small for others to touch. On a body whose contact shrinks again
    /// ([`ContactGrowth::Unknown`](crate::ContactGrowth::Unknown)) more load need not mean more nodes: there the solver
    /// for one load may take the nearest number at another load, where this one is jumped over, or end in
    /// [`Error::NoConvergence`](crate::Error::NoConvergence), and a path finds the number. For more nodes than are ever
    /// in contact it ends so, too.
    AreaFraction(f64),
    /// This mean gap \[m\], below that of surfaces that just touch.
    ///
    /// The solver for one load finds it as exactly as the gaps of its solutions are: to its tolerance times the
    /// approach, or times C(0, 0) p̄ on a body whose mean displacement is
    /// [arbitrary](crate::kernel::MeanDisplacement::Arbitrary), if that is more; but to no less than 10⁻¹⁴ of the mean
    /// gap without load, which is rounding. Where contact shrinks again
    /// ([`ContactGrowth::Unknown`](crate::ContactGrowth::Unknown)) the mean gap may grow again with the load: near the
    /// least one, and below it, the solver ends in [`Error::NoConvergence`](crate::Error::NoConvergence); a path finds
    /// what there is.
    MeanGap(f64),
}
