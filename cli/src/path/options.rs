//! The command line.

use std::path::PathBuf;

use asperity::ContactRule;
use asperity_cli::half_space::Periodic;
use clap::{Parser, ValueEnum};

use crate::values::{fraction, positive};

/// The exact loading path of a rough surface: one state of contact for each node that touches
///
/// Writes path.csv, loading_curve.svg and contact_map.png, and prints a short table.
///
/// Without --surface, a self-affine surface with the spectrum of Zhang, Zhang & Jin (2020), Table 1:
/// rms height 50 µm, Hurst exponent 0.8, roll-off at 2.5 mm, short cut-off at 78.125 µm.
#[derive(Debug, Parser)]
pub(crate) struct Options {
    /// Heights [m] in a NumPy file, positive towards the half-space; element [ix, iy] is the node
    /// (ix, iy), x along the first axis
    #[arg(long, value_name = "FILE.npy", requires = "side", conflicts_with_all = ["nodes", "seed"])]
    pub(super) surface: Option<PathBuf>,

    /// Side of the nominal area along x [default: 1e-2 for the generated surface]
    #[arg(long, value_name = "METRES", allow_negative_numbers = true, value_parser = positive)]
    pub(super) side: Option<f64>,

    /// Side along y [default: as many square cells as there are nodes]
    #[arg(long, value_name = "METRES", allow_negative_numbers = true, value_parser = positive, requires = "side")]
    pub(super) side_y: Option<f64>,

    /// Composite modulus E* = E / (1 - ν²) against a rigid body
    #[arg(long, value_name = "PA", allow_negative_numbers = true, value_parser = positive, default_value = "1")]
    pub(super) e_star: f64,

    /// Repeat surface and half-space with the nominal area, with this kernel [default: a free
    /// half-space, which goes on without pressure]; approaches are then those of the mean planes, and
    /// there is no contact stiffness but the interfacial one
    #[arg(long, value_enum)]
    pub(super) periodic: Option<Periodic>,

    /// Contact area over nominal area at which the path ends
    #[arg(long, value_name = "F", allow_negative_numbers = true, value_parser = fraction, default_value = "0.1")]
    pub(super) max_area_fraction: f64,

    /// Which node touches next
    #[arg(long, value_enum, default_value_t = Rule::FirstContact)]
    pub(super) rule: Rule,

    /// Nodes along each side of the generated surface [default: 256]
    #[arg(long, value_name = "N")]
    pub(super) nodes: Option<usize>,

    /// Seed of the generated surface [default: 1]
    #[arg(long, value_name = "S")]
    pub(super) seed: Option<u64>,

    /// Directory for the files, made if it is not there
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub(super) out: PathBuf,
}

/// [`ContactRule`] on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum Rule {
    /// The node whose gap closes first: exact
    FirstContact,
    /// The node with the smallest gap, as in the paper: not exact
    SmallestGap,
}

impl From<Rule> for ContactRule {
    fn from(rule: Rule) -> Self {
        match rule {
            Rule::FirstContact => Self::FirstContact,
            Rule::SmallestGap => Self::SmallestGap,
        }
    }
}
