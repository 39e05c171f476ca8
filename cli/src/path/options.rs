//! The command line.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use asperity::{Boundary, ContactRule, ContactTarget, Error, Grid};
use asperity_cli::half_space::{Periodic, boundary};
use asperity_cli::number::quantity;
use asperity_cli::outcome::{Failure, check_input, is_device, is_same};
use clap::{Arg, ArgGroup, Args, Parser, ValueEnum};

use super::fields::{Format, RESIDUAL_SURFACES};
use super::joint::Joint;
use super::roughness::Roughness;
use super::shift::Shift;
use super::updater::{Updater, no_room};
use crate::adhesion::Sticking;
use crate::at::At;
use crate::elasticity::{Bodies, Elasticity};
use crate::ensemble::{Ensemble, Member};
use crate::hardness::{GreatestPressure, Hardness};
use crate::reading::Reading;
use crate::values::{FORCE, LENGTH, PRESSURE, bytes, fraction};

/// An option whose help says what a generated surface has without it.
fn generated(arg: Arg, value: &str) -> Arg {
    let help = arg.get_help().map_or_else(String::new, ToString::to_string);
    arg.help(format!("{help} [generated surface: {value}]"))
}

/// The loading path of a rough surface: area, load, approach, gap and stiffness at each node that touches, in exact
/// order
///
/// Prints a table of states at loads spread over the path, or of those of --at, and the residuals of the last state.
/// Writes path.csv (one line for each state), loading_curve.svg and contact_map.png. Numbers are in SI units, or have a
/// unit: 5MPa, 1.024mm, 250N, 10%, 60HRC.
///
/// The model is a rigid rough surface with small slopes on an elastic half-space, without friction. If both bodies are
/// elastic, E* contains both. With --layer and --base one body has layers. With --hardness cells yield at that pressure:
/// it does not harden, and volume is lost. With --work-of-adhesion the surfaces stick. The problem with one pressure for each cell of the grid is
/// solved to rounding; on long paths approach_error estimates the remaining error. No solver can restore what the grid
/// does not resolve: corrected_contact_area removes the excess of whole cells from the area, and the program warns if
/// contact patches or wavelengths are only a few cells wide.
///
/// Without --surface the program generates a self-affine surface: 256 x 256 nodes on 10 mm x 10 mm, rms height 50 µm,
/// Hurst exponent 0.8, roll-off at 2.5 mm, as in Zhang, Zhang & Jin, Friction 8 (2020) 970, Table 1, but with a
/// shortest wavelength that the grid resolves. Their mesh and their shortest wavelength are --nodes 512 --short-cutoff
/// 78.125um.
#[derive(Debug, Clone, Parser)]
#[command(group(ArgGroup::new("kept").multiple(true)))]
#[command(mut_arg("side", |arg| generated(arg, "1e-2")), mut_arg("material", |arg| generated(arg, "steel")))]
pub(crate) struct Options {
    /// File with heights, positive towards the half-space (`asperity formats` lists what is read): the rows of
    /// an image are y; a NumPy array is [ix, iy]
    #[arg(long, value_name = "FILE", conflicts_with_all = ["nodes", "seed"])]
    pub(super) surface: Option<PathBuf>,

    /// File with the heights of the other body, if both are rough: on the same grid, seen from outside like the first.
    /// It is turned over about y, so that both face each other; --fill, --level and the other options for a file apply
    /// to both
    // clap does not ask for what an option requires beside another one that excludes it: so these are excluded, too.
    #[arg(long, value_name = "FILE", requires = "surface", conflicts_with_all = ["nodes", "seed", "seeds", "sq", "rms_gradient", "hurst", "rolloff", "short_cutoff", "anisotropy"], help_heading = "Bodies")]
    pub(super) against_surface: Option<PathBuf>,

    /// Turn that surface by 180° in its plane
    #[arg(long, requires = "against_surface", help_heading = "Bodies")]
    pub(super) against_turned: bool,

    /// Move that surface by so many nodes along x and y, as it faces the other; it has to repeat there, and what leaves
    /// at one edge comes in at the opposite one
    #[arg(long, value_name = "IX,IY", requires = "against_surface", value_parser = Shift::parse, help_heading = "Bodies")]
    pub(super) against_shift: Option<Shift>,

    #[command(flatten)]
    pub(super) reading: Reading,

    #[command(flatten)]
    elasticity: Elasticity,

    #[command(flatten)]
    pub(super) hardness: Hardness,

    #[command(flatten)]
    pub(super) sticking: Sticking,

    /// Repeat surface and half-space periodically, with this kernel [default: a free half-space, which carries no
    /// pressure outside the surface]; with love and spectral a half-space has the approach of the mean planes, and the
    /// interfacial stiffness only
    #[arg(long, value_enum)]
    pub(super) periodic: Option<Periodic>,

    /// States for the table, the maps (contact_map_5MPa.png) and --fields: mean pressures, loads or contact areas, as
    /// in 5MPa,50MPa or 10N or 2mm2 or 10%. A bare number is a mean pressure in Pa. Without another end the path ends
    /// at the last of them
    #[arg(long, value_name = "STATE,...", value_delimiter = ',')]
    pub(super) at: Vec<At>,

    #[command(flatten)]
    ends: Ends,

    /// Rule that chooses the node that touches next
    #[arg(long, value_enum, default_value_t = Rule::FirstContact, help_heading = "Solver")]
    pub(super) rule: Rule,

    /// Solver of the linear systems; the order of events is the same
    #[arg(long, value_enum, default_value_t = Updater::Auto, help_heading = "Solver")]
    pub(super) updater: Updater,

    /// Save the path in this file; numpy.load opens it, and --resume continues the path from it
    #[arg(long, value_name = "FILE.npz", group = "kept", help_heading = "Records and files")]
    pub(super) record: Option<PathBuf>,

    /// Write report.html: the contact at every state under a slider, charts and tables, in one page for a browser
    #[arg(long)]
    pub(super) report: bool,

    /// Directory for the files, created if it does not exist
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub(super) out: PathBuf,

    /// Write pressure and gap of the last state
    #[arg(long, value_enum, value_name = "FORMAT", help_heading = "Records and files")]
    pub(super) fields: Option<Format>,

    /// Unload from the last state of a path with a hardness: write unloading.csv, and the surface that is left as
    /// residual_surface.npy and .x3p. With adhesion: pull off, until no node is pulled any more; path.csv, chart and record
    /// have both branches
    #[arg(long, help_heading = "Records and files")]
    pub(super) unload: bool,

    /// Save the record each time that many states have been added, and not only at the end
    #[arg(long, value_name = "STATES", requires = "kept", help_heading = "Records and files")]
    pub(super) save_every: Option<NonZeroUsize>,

    /// Continue the path of a record, to its own target unless another one is given, and extend the record, unless
    /// --record names another file. A target before the end of the record is read from it, unless the record has
    /// adhesion
    #[arg(long, value_name = "FILE.npz", group = "kept", conflicts_with_all = ["surface", "against_surface", "against_turned", "against_shift", "nodes", "seed", "sq", "rms_gradient", "hurst", "rolloff", "short_cutoff", "anisotropy", "side", "side_y", "height_unit", "lateral_unit", "channel", "layout", "rows_are_y", "ignore_mask", "fill", "level", "invert", "e_star", "material", "against", "layer", "base", "hardness", "typical", "work_of_adhesion", "adhesion_range", "cohesive_stress", "periodic", "rule"], help_heading = "Records and files")]
    pub(super) resume: Option<PathBuf>,

    /// Greatest memory of the path in bytes, for example 2e9 [default: three quarters of the memory]
    #[arg(long, value_name = "BYTES", value_parser = bytes, help_heading = "Solver")]
    pub(super) memory_budget: Option<usize>,

    #[command(flatten)]
    pub(super) joint: Joint,

    #[command(flatten)]
    pub(super) roughness: Roughness,

    #[command(flatten)]
    pub(super) ensemble: Ensemble,

    /// Print about how much time and memory the path takes, or each path of --seeds, and stop; no file is written
    #[arg(long, help_heading = "Solver")]
    pub(super) dry_run: bool,

    /// Print one JSON object instead of the table: states, ended_by, seconds, the scalars of the last state,
    /// max_pressure, warnings, and in `at` the scalars of each state of --at (SI units; null where there is no number);
    /// one line for each seed, which it names
    #[arg(long, help_heading = "Records and files")]
    pub(super) json: bool,
}

/// Where the path ends.
#[derive(Debug, Clone, Args)]
struct Ends {
    /// End the path at exactly this load over nominal area
    #[arg(long, value_name = "PA", value_parser = PRESSURE.positive(), conflicts_with = "max_load")]
    mean_pressure: Option<f64>,

    /// End the path at exactly this load
    #[arg(long, value_name = "NEWTONS", value_parser = FORCE.positive(), help_heading = "Where the path ends")]
    max_load: Option<f64>,

    /// End the path at exactly this approach; surfaces that stick begin below 0
    #[arg(long, value_name = "METRES", value_parser = LENGTH.any(), help_heading = "Where the path ends")]
    max_approach: Option<f64>,

    /// End the path at exactly this mean gap
    #[arg(long, value_name = "METRES", value_parser = LENGTH.positive(), help_heading = "Where the path ends")]
    min_mean_gap: Option<f64>,

    /// End the path at this contact area over nominal area [default: 0.1 if no other end is given]
    #[arg(long, value_name = "F", value_parser = fraction, help_heading = "Where the path ends")]
    max_area_fraction: Option<f64>,
}

impl Ends {
    /// Whether nobody says where.
    fn are_open(&self) -> bool {
        let loads = self.mean_pressure.or(self.max_load);
        loads.or(self.max_approach).or(self.min_mean_gap).or(self.max_area_fraction).is_none()
    }

    /// `Ok` if no state is known to lie beyond one of them.
    fn check_at(&self, all: &[At]) -> Result<(), Failure> {
        let ends = [
            ("--mean-pressure", self.mean_pressure.map(At::MeanPressure)),
            ("--max-load", self.max_load.map(At::Load)),
            ("--max-area-fraction", self.max_area_fraction.map(At::AreaFraction)),
        ];
        for (option, end) in ends.iter().filter_map(|(option, end)| Some((option, (*end)?))) {
            if let Some(at) = all.iter().find(|at| at.is_beyond(end)) {
                return Err(Failure::request(format!("--at {at} is beyond {option} {end}")));
            }
        }
        Ok(())
    }
}

/// The tables of a path, be they asked for or not.
const TABLES: [&str; 4] = ["path.csv", "conductance.csv", "interface.csv", "unloading.csv"];

impl Options {
    /// `Ok` if the states that are asked for make sense together, and no surface is replaced.
    pub(super) fn check(&self) -> Result<(), Failure> {
        At::check(&self.at, self.has_open_end())?;
        self.ends.check_at(&self.at)?;
        let is_left = self.unload && self.sticking.law().is_none();
        let left: &[&str] = if is_left { &RESIDUAL_SURFACES } else { &[] };
        let states = [String::new()].into_iter().chain(self.at.iter().map(|at| at.ending()));
        let fields = states.flat_map(|ending| self.fields.map(|format| format.files(&ending)));
        let tables = TABLES.iter().chain(left).map(ToString::to_string);
        let written: Vec<String> = tables.chain(fields.flatten()).collect();
        for file in [&self.surface, &self.against_surface].into_iter().flatten() {
            if self.record.as_ref().is_some_and(|kept| is_same(kept, file)) {
                return Err(Failure::request(format!(
                    "--record would replace the surface {}: name another file",
                    file.display()
                )));
            }
            check_input(file, &self.out, &written)?;
        }
        // No other file of a path has such a name. A device has any.
        let is_record = |file: &PathBuf| file.extension().is_some_and(|end| end == "npz");
        match self.record.as_ref().filter(|file| !is_device(file) && !is_record(file)) {
            Some(file) => Err(Failure::request(format!(
                "--record {}: the name of a record ends with .npz",
                file.display()
            ))),
            None => Ok(()),
        }
    }

    /// Whether no option says where the path ends.
    pub(super) fn has_open_end(&self) -> bool {
        self.ends.are_open()
    }

    /// `Ok` if a path without adhesion gets to the approach at which it is to end.
    pub(super) fn check_approach(&self) -> Result<(), Failure> {
        match self.ends.max_approach {
            Some(approach) if approach <= 0.0 => Err(Failure::request(format!(
                "--max-approach {} must be positive: only with --work-of-adhesion anything happens before 0",
                quantity(approach, "m", 5)
            ))),
            _ => Ok(()),
        }
    }

    /// Those of one path of many.
    pub(super) fn of(&self, member: &Member) -> Self {
        Self {
            roughness: self.roughness.with_seed(member.seed),
            out: member.unfinished(),
            ensemble: Ensemble::default(),
            ..self.clone()
        }
    }

    /// What surrounds the nominal area.
    pub(super) fn boundary(&self) -> Boundary {
        boundary(self.periodic)
    }

    /// The bodies: a generated surface is of steel if nothing is said of them.
    pub(super) fn bodies(&self) -> Result<Bodies, Failure> {
        match &self.surface {
            Some(_) => self.elasticity.required(),
            None => self.elasticity.or_steel(),
        }
    }

    /// Their hardness, if there is to be one.
    pub(super) fn greatest_pressure(&self) -> Result<Option<GreatestPressure>, Failure> {
        self.hardness.of(&self.bodies()?)
    }

    /// What there is no room for.
    pub(super) fn no_room(&self, what: String, error: Error) -> Failure {
        no_room(what, error, (self.updater, self.boundary(), self.memory_budget))
    }

    /// Where the path ends, whichever comes first: at `otherwise` if nothing is said.
    pub(super) fn targets(&self, grid: &Grid, otherwise: &[ContactTarget]) -> Vec<ContactTarget> {
        let ends = &self.ends;
        let pressure = ends.mean_pressure.map(|p| p * grid.nominal_area());
        let given = [
            pressure.map(ContactTarget::Load),
            ends.max_load.map(ContactTarget::Load),
            ends.max_approach.map(ContactTarget::Approach),
            ends.min_mean_gap.map(ContactTarget::MeanGap),
            ends.max_area_fraction.map(ContactTarget::AreaFraction),
        ];
        let mut targets: Vec<ContactTarget> = given.into_iter().flatten().collect();
        if targets.is_empty() {
            targets.extend(At::furthest(&self.at, grid.nominal_area()));
        }
        if targets.is_empty() {
            targets.extend(otherwise);
        }
        targets
    }
}

/// [`ContactRule`] on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum Rule {
    /// The node whose gap closes first: exact
    FirstContact,
    /// The same, but faster without a factor: nodes that touch almost together may be in the wrong order
    ApproximateOrder,
}

impl From<Rule> for ContactRule {
    fn from(rule: Rule) -> Self {
        match rule {
            Rule::FirstContact => Self::FirstContact,
            Rule::ApproximateOrder => Self::ApproximateOrder,
        }
    }
}
