//! What a joint conducts, and its laws for finite elements: columns of `path.csv`, `conductance.csv` and `interface.*`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use asperity::LoadingState;
use asperity::joint::{FeProgram, FeUnits, InterfaceTable};
use asperity::kernel::{Layering, Theory};
use asperity::loading::History;
use asperity_cli::outcome::{self, Failure};
use asperity_cli::units::{self, Units};
use clap::{Args, ValueEnum};

use crate::conduction::{Conduct, Named};
use crate::values::{LENGTH, SHARE, part, positive};

/// The bodies of a joint.
pub(super) struct Pair<'a> {
    pub(super) e_star: f64,
    /// Young's modulus \[Pa\] and Poisson's ratio of each elastic body that is known.
    pub(super) elastic: &'a [[f64; 2]],
    pub(super) layering: Layering,
    pub(super) has_hardness: bool,
}

/// Conduction and tables for finite elements.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Joint")]
pub(super) struct Joint {
    #[command(flatten)]
    pub(super) conduct: Conduct,

    /// Write conductance.csv, with bounds for a surface that has more roughness than the grid, of at most this height
    /// from valley to peak
    #[arg(long, value_name = "METRES", value_parser = LENGTH.positive())]
    unresolved_roughness: Option<f64>,

    /// Write the laws of the interface for finite elements, per nominal area: pressure over overclosure (what the mean
    /// gap closes); conductance, if there is one, and with --friction tangential stiffness and slip limit over pressure
    #[arg(long, value_enum, value_name = "PROGRAM")]
    fe_table: Option<Program>,

    /// Greatest relative error of linear interpolation in that table
    #[arg(long, value_name = "E", value_parser = part, default_value_t = 0.01, requires = "fe_table")]
    fe_error: f64,

    /// Coefficient of friction for that table
    #[arg(long, value_name = "MU", value_parser = SHARE.positive(), requires = "fe_table")]
    friction: Option<f64>,

    /// Tangential over normal compliance, E*/G* [default: of --material and --against; (2 - ν)/(2 - 2ν) for one of
    /// them]
    #[arg(long, value_name = "KAPPA", value_parser = positive, requires = "friction")]
    compliance_ratio: Option<f64>,
}

/// [`FeProgram`] on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Program {
    /// interface.inp for Abaqus
    Abaqus,
    /// interface.inp for CalculiX
    Calculix,
    /// interface.i, functions for MOOSE
    Moose,
    /// interface.csv
    Csv,
}

impl Program {
    fn named(self) -> (FeProgram, &'static str) {
        match self {
            Self::Abaqus => (FeProgram::Abaqus, "interface.inp"),
            Self::Calculix => (FeProgram::CalculiX, "interface.inp"),
            Self::Moose => (FeProgram::Moose, "interface.i"),
            Self::Csv => (FeProgram::Csv, "interface.csv"),
        }
    }
}

impl Joint {
    /// What is to be conducted between bodies of a composite modulus.
    pub(super) fn conductions(&self, e_star: f64) -> Result<Vec<Named>, Failure> {
        let all = self.conduct.conductions(e_star)?;
        if self.unresolved_roughness.is_some() && all.is_empty() {
            return Err(Failure::request(
                "--unresolved-roughness bounds a conductance: give --resistivity or --conductivity too",
            ));
        }
        if self.fe_table.is_some() && all.len() > 1 {
            return Err(Failure::request(
                "--fe-table has one conductance: give --resistivity or --conductivity, not both",
            ));
        }
        Ok(all)
    }

    /// Whether anything is asked for.
    pub(super) fn is_asked(&self, conductions: &[Named]) -> bool {
        !conductions.is_empty() || self.unresolved_roughness.is_some() || self.fe_table.is_some()
    }

    /// Whether anything is asked for that follows from the stiffness of the contact.
    pub(super) fn needs_stiffness(&self, conductions: &[Named]) -> bool {
        !conductions.is_empty() || self.friction.is_some()
    }

    /// E*/G* of the bodies: `1/G* = Σ (2 − ν) / (4 G)`.
    fn compliance_ratio(&self, e_star: f64, elastic: &[[f64; 2]]) -> Result<f64, Failure> {
        if let Some(ratio) = self.compliance_ratio {
            return Ok(ratio);
        }
        if elastic.is_empty() {
            return Err(Failure::request(
                "the tangential stiffness needs Poisson's ratio: give --material, or --compliance-ratio (1.21 for 0.3)",
            ));
        }
        let compliance = |[e, nu]: &[f64; 2]| (2.0 - nu) * (1.0 + nu) / (2.0 * e);
        Ok(e_star * elastic.iter().map(compliance).sum::<f64>())
    }

    /// What cannot be done, before the work.
    pub(super) fn check(&self, pair: &Pair<'_>) -> Result<Vec<Named>, Failure> {
        if self.unresolved_roughness.is_some() && pair.has_hardness {
            return Err(Failure::request(
                "--unresolved-roughness needs an elastic path: the approach of a contact that yields is not that of one shape. What is left of it \
                 has bounds: give --unload, and follow residual_surface.npy without a hardness to a load beyond the one of interest",
            ));
        }
        let conductions = self.conductions(pair.e_star)?;
        let layering = &pair.layering;
        let failed = |error| Failure::new("cannot compute what follows from the stiffness", error);
        if !conductions.is_empty() {
            layering.check(Theory::Conductance).map_err(failed)?;
        }
        if self.friction.is_some() {
            layering.check(Theory::TangentialStiffness).map_err(failed)?;
            self.compliance_ratio(pair.e_star, pair.elastic)?;
        }
        Ok(conductions)
    }

    /// Writes the files that were asked for.
    pub(super) fn write(
        &self,
        pair: &Pair<'_>,
        states: &[LoadingState],
        directory: &Path,
    ) -> Result<Vec<PathBuf>, Failure> {
        let conductions = self.conductions(pair.e_star)?;
        let history = states.iter().copied().collect::<History>().on(pair.layering);
        let mut files = Vec::new();
        if let Some(roughness) = self.unresolved_roughness {
            let name = directory.join("conductance.csv");
            let text = bounds(&history, &conductions, roughness);
            let text = text.map_err(|error| Failure::writing(&name, error))?;
            files.push(outcome::write(&name, text)?);
        }
        if let Some(program) = self.fe_table {
            let (program, name) = program.named();
            let name = directory.join(name);
            let mut builder = InterfaceTable::builder(&history).tolerance(self.fe_error);
            if let [(_, conduction)] = conductions[..] {
                builder = builder.conduction(conduction);
            }
            if let Some(friction) = self.friction {
                let ratio = self.compliance_ratio(pair.e_star, pair.elastic)?;
                builder = builder.friction(friction, ratio);
            }
            let table = builder.build().map_err(|error| Failure::writing(&name, error))?;
            files.push(outcome::write(&name, table.text_in(program, fe_units()))?);
        }
        Ok(files)
    }
}

/// Those of tables and charts.
fn fe_units() -> FeUnits {
    match units::chosen() {
        Units::Si => FeUnits::Si,
        Units::Millimetres => FeUnits::Millimetres,
    }
}

/// A line for each state, with each conductance and its bounds.
fn bounds(
    history: &History,
    conductions: &[Named],
    roughness: f64,
) -> Result<String, asperity::Error> {
    let mut text = "step,load,mean_pressure".to_string();
    let mut columns = Vec::new();
    for (name, conduction) in conductions {
        text += &format!(",{name},{name}_lower,{name}_upper");
        columns.push((conduction, conduction.bounds(history, roughness)?));
    }
    text.push('\n');
    for (k, state) in history.states().iter().enumerate() {
        let contact = &state.contact;
        // Writing to a text cannot fail.
        let _ = write!(text, "{},{:e},{:e}", state.step, contact.load, contact.mean_pressure());
        for (conduction, bounds) in &columns {
            let value = conduction.of(contact, history.layering())?.unwrap_or(f64::NAN);
            let _ = write!(text, ",{value:e},{:e},{:e}", bounds[k].lower, bounds[k].upper);
        }
        text.push('\n');
    }
    Ok(text)
}
