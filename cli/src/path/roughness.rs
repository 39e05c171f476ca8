//! The roughness of a generated surface, as a command line asks for it.

use asperity::surface::Amplitude;
use clap::Args;

use crate::values::{LENGTH, hurst, positive};

/// Its roughness: that of Zhang et al. (2020), Table 1, but for what is given.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Generated surface")]
pub(super) struct Roughness {
    /// Nodes along each side [default: 256]
    #[arg(long, value_name = "N")]
    pub(super) nodes: Option<usize>,

    /// Seed [default: 1]
    #[arg(long, value_name = "S")]
    pub(super) seed: Option<u64>,

    /// Root mean square height [default: 50 µm, unless --rms-gradient is given]
    #[arg(long, value_name = "METRES", value_parser = LENGTH.positive(), conflicts_with_all = ["surface", "rms_gradient"])]
    sq: Option<f64>,

    /// Root mean square gradient, in place of --sq
    #[arg(long, value_name = "G", value_parser = positive, conflicts_with = "surface")]
    rms_gradient: Option<f64>,

    /// Hurst exponent [default: 0.8]
    #[arg(long, value_name = "H", value_parser = hurst, conflicts_with = "surface")]
    pub(super) hurst: Option<f64>,

    /// Roll-off: the wavelength above which the spectrum is flat [default: 2.5 mm]
    #[arg(long, value_name = "METRES", value_parser = LENGTH.positive(), conflicts_with = "surface")]
    pub(super) rolloff: Option<f64>,

    /// Shortest wavelength [default: eight cells, and without --rolloff not less than 78.125 µm]
    #[arg(long, value_name = "METRES", value_parser = LENGTH.positive(), conflicts_with = "surface")]
    pub(super) short_cutoff: Option<f64>,

    /// Waves are so many times as long along x as they are along y; the other lengths are those along y [default: 1]
    #[arg(long, value_name = "RATIO", value_parser = positive, conflicts_with = "surface")]
    pub(super) anisotropy: Option<f64>,
}

impl Roughness {
    /// That of another seed.
    pub(super) fn with_seed(&self, seed: u64) -> Self {
        Self { seed: Some(seed), ..self.clone() }
    }

    /// Whether nothing but nodes and a seed is given.
    pub(super) fn is_example(&self) -> bool {
        let lengths = self.sq.or(self.rolloff).or(self.short_cutoff);
        lengths.or(self.rms_gradient).or(self.hurst).or(self.anisotropy).is_none()
    }

    /// Height or gradient.
    pub(super) fn amplitude(&self, default: Amplitude) -> Amplitude {
        match (self.sq, self.rms_gradient) {
            (Some(height), _) => Amplitude::RmsHeight(height),
            (None, Some(gradient)) => Amplitude::RmsGradient(gradient),
            (None, None) => default,
        }
    }
}
