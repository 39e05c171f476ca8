//! What to compute: the surface, the half-space and where to stop.

use std::fmt;
use std::path::{Path, PathBuf};

use asperity::adhesion::{AdhesivePath, Direction};
use asperity::contact::ContactState;
use asperity::kernel::Layering;
use asperity::loading::History;
use asperity::record::{AdhesiveRecord, LoadingRecord};
use asperity::surface::{HeightMap, Topography};
use asperity::{
    AdhesionError, Boundary, ContactRule, ContactTarget, Error, Grid, InfluenceKernel,
    LoadingSolver, LoadingState, Warning,
};
use nalgebra::DMatrix;
use serde_json::{Value, json};

use super::Solver;
use super::generated::{Generated, generate};
use super::joint::Pair;
use super::options::Options;
use super::parts::Parts;
use super::progress::Progress;
use super::source::{fingerprint, read};
use super::updater::{Updater, no_room};
use crate::adhesion::Law;
use crate::at::At;
use crate::elasticity::Bodies;
use crate::reading::Reading;
use crate::settings::Settings;
use asperity_cli::half_space::{Periodic, boundary};
use asperity_cli::note;
use asperity_cli::number::{counted, quantity, significant};
use asperity_cli::outcome::{Failure, is_same};

/// Contact area over nominal area at which a path ends if nobody says where.
const AREA_FRACTION: f64 = 0.1;

/// How far two surfaces and moduli may be apart that are one, relative to sides, heights and moduli.
const SAME: f64 = 1e-9;

/// A surface on its grid and what is asked of it.
pub(super) struct Job {
    surface: Topography,
    name: String,
    rms_gradient: f64,
    bodies: Bodies,
    periodic: Option<Periodic>,
    /// Of each node \[Pa\], if nodes yield.
    hardness: Option<DMatrix<f64>>,
    hardness_in_words: String,
    /// The law of adhesion, if the surfaces stick.
    law: Option<Law>,
    rule: ContactRule,
    updater: Updater,
    memory_budget: Option<usize>,
    /// Where the path ends, whichever comes first.
    targets: Vec<ContactTarget>,
    /// States of which there is to be more.
    at: Vec<At>,
    /// What there is of the path already.
    begun: Option<History>,
    begun_with_adhesion: Option<AdhesiveRecord>,
    /// Where its record goes.
    record: Option<PathBuf>,
    settings: Settings,
}

impl Job {
    /// Makes or reads the surface, or the record of a path.
    pub(super) fn new(options: &Options) -> Result<Self, Failure> {
        if let Some(file) = &options.resume {
            return Self::resumed(file, options);
        }
        let bodies = options.bodies()?;
        let (surface, name, source) = match &options.surface {
            Some(file) => read(file, options)?,
            None => generate(options)?,
        };
        let grid = *surface.grid();
        if options.surface.is_some() {
            Reading::check_row(&surface, options.boundary())?;
        }
        let hardness = hardness(options, &grid)?;
        let contact = Contact {
            bodies: &bodies,
            periodic: options.periodic,
            hardness: hardness.as_ref(),
            law: options.sticking.law(),
        };
        check_kept(options.record.as_deref(), &surface, &contact)?;
        Ok(Self {
            name,
            hardness_in_words: options
                .greatest_pressure()?
                .map_or_else(String::new, |hardness| hardness.to_string()),
            rms_gradient: rms_gradient(&surface)?,
            periodic: options.periodic,
            rule: options.rule.into(),
            updater: options.updater,
            memory_budget: options.memory_budget,
            targets: targets(options, &grid),
            at: options.at.clone(),
            begun: None,
            begun_with_adhesion: None,
            record: options.record.clone(),
            settings: settings(options, (&bodies, &grid), source)?,
            hardness,
            bodies,
            surface,
            law: options.sticking.law(),
        })
    }

    /// What the path of a generated surface is of, without the surface.
    pub(super) fn expected_settings(options: &Options) -> Result<Settings, Failure> {
        let generated = Generated::new(options)?;
        settings(options, (&options.bodies()?, &generated.grid), generated.source())
    }

    /// The path of a record.
    fn resumed(file: &Path, options: &Options) -> Result<Self, Failure> {
        let failed = |error| Failure::new(format!("cannot resume {}", file.display()), error);
        let record = match LoadingRecord::read_npz(file) {
            Err(Error::Adhesion(AdhesionError::Record { .. })) => {
                return Self::resumed_with_adhesion(file, options);
            }
            record => record.map_err(failed)?,
        };
        let (periodic, bodies) = Bodies::of_record(&record).map_err(failed)?;
        let heights = record.heights().matrix().clone();
        let surface =
            Topography::new(record.grid(), heights).map_err(|error| failed(error.into()))?;
        let grid = *surface.grid();
        let targets = options.targets(&grid, &record.settings().targets);
        let (history, passed) = record.history().ending_at(&grid, &targets).map_err(failed)?;
        let kept = match (&options.record, passed) {
            (Some(kept), Some(_)) if is_same(kept, file) => {
                return Err(Failure::request(format!(
                    "{} contains more than the requested path, and the rest would be lost: name another file with --record",
                    file.display()
                )));
            }
            (Some(kept), _) => Some(kept.clone()),
            (None, Some(_)) => None,
            (None, None) => Some(file.to_path_buf()),
        };
        let hardness = record.hardness_map().map_err(failed)?;
        let contact = Contact { bodies: &bodies, periodic, hardness: hardness.as_ref(), law: None };
        check_kept(kept.as_deref(), &surface, &contact)?;
        if let (Some(_), Some(last)) = (passed, record.states().last()) {
            note!(
                "note: {} continues to {}; the requested target lies before that and is read from it",
                file.display(),
                quantity(last.contact.load, "N", 4)
            );
        }
        let source = json!({
            "record": file.display().to_string(),
            "heights_md5": fingerprint(&surface),
        });
        let greatest = hardness.as_ref().map(DMatrix::max);
        let parts = Parts {
            bodies: &bodies,
            periodic,
            hardness: hardness.as_ref(),
            law: None,
            rule: record.settings().rule,
            updater: options.updater,
            targets: &targets,
            unload: options.unload,
        };
        Ok(Self {
            name: format!("{}, {}", file.display(), counted(record.states().len(), "state")),
            rms_gradient: rms_gradient(&surface)?,
            settings: parts.settings(&grid, source)?,
            periodic,
            hardness_in_words: greatest
                .map_or_else(String::new, |h| format!("{}, of the record", quantity(h, "Pa", 4))),
            rule: parts.rule,
            updater: options.updater,
            memory_budget: options.memory_budget,
            targets,
            at: options.at.clone(),
            bodies,
            hardness,
            surface,
            begun: Some(history),
            begun_with_adhesion: None,
            record: kept,
            law: None,
        })
    }

    /// The path of a record with adhesion, to the end that is given, or else to where its loading was to end.
    fn resumed_with_adhesion(file: &Path, options: &Options) -> Result<Self, Failure> {
        let failed = |error| Failure::new(format!("cannot resume {}", file.display()), error);
        let record = AdhesiveRecord::read_npz(file).map_err(failed)?;
        let (periodic, bodies) = Bodies::of_kernel(&record.kernel().origin, &[]).map_err(failed)?;
        let heights = record.heights().matrix().clone();
        let surface =
            Topography::new(record.grid(), heights).map_err(|error| failed(error.into()))?;
        let own = match record.pending() {
            Some((Direction::Loading, targets)) => targets,
            _ => &[],
        };
        let targets = options.targets(surface.grid(), own);
        let law = Some(Law::of(record.adhesion()));
        let contact = Contact { bodies: &bodies, periodic, hardness: None, law };
        check_kept(options.record.as_deref(), &surface, &contact)?;
        let source = json!({
            "record": file.display().to_string(),
            "heights_md5": fingerprint(&surface),
        });
        let parts = Parts {
            bodies: &bodies,
            periodic,
            hardness: None,
            law,
            rule: ContactRule::FirstContact,
            updater: options.updater,
            targets: &targets,
            unload: options.unload,
        };
        let states = counted(record.states().states().len(), "state");
        Ok(Self {
            name: format!("{}, {states}", file.display()),
            rms_gradient: rms_gradient(&surface)?,
            settings: parts.settings(surface.grid(), source)?,
            periodic,
            hardness: None,
            hardness_in_words: String::new(),
            law,
            rule: parts.rule,
            updater: options.updater,
            memory_budget: options.memory_budget,
            targets,
            at: options.at.clone(),
            bodies,
            surface,
            begun: None,
            begun_with_adhesion: Some(record),
            record: Some(options.record.clone().unwrap_or_else(|| file.to_path_buf())),
        })
    }

    /// What there is of a path with adhesion already.
    pub(super) fn begun_with_adhesion(&self) -> Option<&AdhesiveRecord> {
        self.begun_with_adhesion.as_ref()
    }

    /// The events that the path had already, in a record.
    pub(super) fn begun(&self) -> &[LoadingState] {
        self.begun.as_ref().map_or(&[], History::events)
    }

    /// Where its record goes, if anywhere.
    pub(super) fn record(&self) -> Option<&Path> {
        self.record.as_deref()
    }

    /// Where the record of a path that is interrupted goes: into its folder if nowhere else, beside records of other
    /// surfaces and bodies.
    pub(super) fn record_if_interrupted(&self, folder: &Path) -> PathBuf {
        if let Some(record) = &self.record {
            return record.clone();
        }
        let mut place = folder.join("interrupted.npz");
        let mut number = 1;
        let contact = Contact {
            bodies: &self.bodies,
            periodic: self.periodic,
            hardness: self.hardness.as_ref(),
            law: self.law,
        };
        while check_kept(Some(&place), &self.surface, &contact).is_err() {
            number += 1;
            place = folder.join(format!("interrupted_{number}.npz"));
        }
        place
    }

    /// Everything that determines the path.
    pub(super) fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The path, at its beginning or where it was interrupted.
    pub(super) fn solver(&self) -> Result<Solver, Failure> {
        let kernel = self.kernel()?;
        let mut builder = LoadingSolver::builder(&self.surface, &kernel)
            .updater(self.updater.make())
            .rule(self.rule);
        for &target in &self.targets {
            builder = builder.until(target);
        }
        if let Some(hardness) = &self.hardness {
            builder = builder.hardness_map(hardness);
        }
        if let Some(budget) = self.memory_budget {
            builder = builder.memory_budget(budget);
        }
        match &self.begun {
            None => builder.build(),
            Some(history) => builder.resume(history),
        }
        .map(LoadingSolver::into_path)
        .map_err(|error| {
            no_room(
                "cannot set up the path".to_string(),
                error,
                (self.updater, kernel.boundary(), self.memory_budget),
            )
        })
    }

    /// The path with adhesion, at its beginning or where it was interrupted.
    pub(super) fn adhesive_path(&self) -> Result<AdhesivePath, Failure> {
        if let Some(record) = &self.begun_with_adhesion {
            let kernel = record.make_kernel();
            let path = kernel.and_then(|kernel| record.path_on(&kernel, self.memory_budget));
            return path.map_err(|error| Failure::new("cannot resume", error));
        }
        let kernel = self.kernel()?;
        let Some(law) = self.law else {
            return Err(Failure::request("nothing sticks here: give --work-of-adhesion"));
        };
        let mut builder = AdhesivePath::builder(&self.surface, &kernel, law.adhesion());
        let at = self.at.iter().map(|at| at.target(self.grid().nominal_area()));
        for target in self.targets.iter().copied().chain(at) {
            builder = builder.until(target);
        }
        if let Some(budget) = self.memory_budget {
            builder = builder.memory_budget(budget);
        }
        builder.build().map_err(|error| Failure::new("cannot set up the path with adhesion", error))
    }

    /// The law of adhesion, if the surfaces stick.
    pub(super) fn law(&self) -> Option<Law> {
        self.law
    }

    /// The surface.
    pub(super) fn surface(&self) -> &Topography {
        &self.surface
    }

    /// What surface it is of.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    pub(super) fn grid(&self) -> Grid {
        *self.surface.grid()
    }

    pub(super) fn heights(&self) -> &HeightMap {
        self.surface.map()
    }

    pub(super) fn rms_gradient(&self) -> f64 {
        self.rms_gradient
    }

    pub(super) fn targets(&self) -> &[ContactTarget] {
        &self.targets
    }

    /// The states that are asked for.
    pub(super) fn at(&self) -> &[At] {
        &self.at
    }

    pub(super) fn updater(&self) -> Updater {
        self.updater
    }

    pub(super) fn memory_budget(&self) -> Option<usize> {
        self.memory_budget
    }

    pub(super) fn e_star(&self) -> f64 {
        self.bodies.e_star
    }

    /// The record of its path so far.
    pub(super) fn record_of(
        &self,
        solver: &Solver,
        states: &[LoadingState],
    ) -> Result<LoadingRecord, Error> {
        let bodies: Vec<_> = self.bodies.elastic.iter().map(|&[e, nu]| (e, nu)).collect();
        LoadingRecord::new(solver, states.iter().copied().collect())?.with_bodies(&bodies)
    }

    /// What they are made of.
    pub(super) fn layering(&self) -> Layering {
        self.bodies.layering(self.boundary())
    }

    /// What a joint needs to know of the bodies.
    pub(super) fn pair(&self) -> Pair<'_> {
        Pair {
            e_star: self.bodies.e_star,
            elastic: &self.bodies.elastic,
            layering: self.layering(),
            has_hardness: self.has_hardness(),
        }
    }

    pub(super) fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    pub(super) fn boundary(&self) -> Boundary {
        boundary(self.periodic)
    }

    /// What looks wrong before anything is computed.
    pub(super) fn warnings(&self) -> Vec<Warning> {
        let mut warnings = Warning::of_surface(&self.surface);
        warnings.extend(self.bodies.warnings(self.surface.grid()));
        let softest = self.hardness.as_ref().map(DMatrix::min);
        warnings.extend(softest.and_then(|h| Warning::of_hardness(h, self.bodies.e_star)));
        warnings
    }

    /// How far a state is on the way to the nearest target: load grows about in proportion to nodes.
    pub(super) fn progress(&self, contact: &ContactState) -> Progress {
        let shares = self.targets.iter().map(|target| match *target {
            ContactTarget::Load(load) => contact.load / load,
            ContactTarget::Approach(approach) => contact.approach / approach,
            ContactTarget::AreaFraction(fraction) => contact.contact_area_fraction / fraction,
            _ => 0.0,
        });
        let share = shares.fold(contact.contact_area_fraction, f64::max).min(1.0);
        let nodes = self.grid().nodes();
        Progress::new(contact.contact_nodes, share, |contact| {
            self.updater.event_seconds(nodes, contact)
        })
    }

    /// How far unloading is that began with so many nodes in contact.
    pub(super) fn progress_back(&self, contact: usize, most: usize) -> Progress {
        let nodes = self.grid().nodes();
        Progress::back(contact, most, |contact| self.updater.event_seconds(nodes, contact))
    }

    /// A load or an approach that was asked for and not reached, in words.
    pub(super) fn missed(&self, state: Option<LoadingState>) -> Option<String> {
        let state = state?;
        self.targets.iter().find_map(|target| match *target {
            ContactTarget::Load(load) if state.contact.load < load => Some(format!(
                "the requested load of {}, at {}",
                quantity(load, "N", 4),
                quantity(state.contact.load, "N", 4)
            )),
            ContactTarget::Approach(approach) if state.contact.approach < approach => {
                Some(format!(
                    "the requested approach of {}, at {}",
                    quantity(approach, "m", 4),
                    quantity(state.contact.approach, "m", 4)
                ))
            }
            _ => None,
        })
    }

    pub(super) fn periodic(&self) -> Option<Periodic> {
        self.periodic
    }

    /// Whether nodes yield.
    pub(super) fn has_hardness(&self) -> bool {
        self.hardness.is_some()
    }

    /// The hardness of each node \[Pa\].
    pub(super) fn hardness_map(&self) -> Option<&DMatrix<f64>> {
        self.hardness.as_ref()
    }

    pub(super) fn kernel(&self) -> Result<Box<dyn InfluenceKernel>, Failure> {
        self.bodies
            .kernel(self.periodic, self.grid())
            .map_err(|error| Failure::new("cannot make the half-space", error))
    }
}

impl fmt::Display for Job {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (nx, ny) = self.grid().shape();
        let (lx, ly) = self.grid().sides();
        writeln!(f, "surface    {}", self.name)?;
        writeln!(
            f,
            "grid       {nx} x {ny} nodes on {} x {}, cells of {} x {}",
            quantity(lx, "m", 6),
            quantity(ly, "m", 6),
            quantity(self.grid().dx(), "m", 4),
            quantity(self.grid().dy(), "m", 4)
        )?;
        writeln!(
            f,
            "roughness  rms height Sq {}, rms gradient {}",
            quantity(self.heights().rms_height(), "m", 5),
            significant(self.rms_gradient.abs(), 4)
        )?;
        writeln!(f, "bodies     {}", self.bodies)?;
        if self.hardness.is_some() {
            writeln!(f, "hardness   {}", self.hardness_in_words)?;
        }
        if let Some(law) = self.law {
            writeln!(f, "adhesion   {law}")?;
        }
        match self.periodic {
            None => writeln!(f, "half-space free")?,
            Some(kernel) => writeln!(f, "half-space {}", kernel.in_words())?,
        }
        write!(f, "loading    {}", in_words(self.rule))?;
        for target in &self.targets {
            match *target {
                ContactTarget::Load(load) => write!(f, ", to {}", quantity(load, "N", 6))?,
                ContactTarget::Approach(approach) => {
                    write!(f, ", to an approach of {}", quantity(approach, "m", 6))?;
                }
                ContactTarget::MeanGap(mean_gap) => {
                    write!(f, ", to a mean gap of {}", quantity(mean_gap, "m", 6))?;
                }
                ContactTarget::AreaFraction(fraction) => {
                    write!(f, ", to {:.4} % of the nominal area", 100.0 * fraction)?;
                }
                _ => {}
            }
        }
        writeln!(f)
    }
}

/// How a rule orders the nodes.
fn in_words(rule: ContactRule) -> &'static str {
    match rule {
        ContactRule::FirstContact => "nodes in the exact order in which they touch",
        ContactRule::ApproximateOrder => "nodes nearly in the order in which they touch",
    }
}

/// Everything that the command line says of a path that begins.
fn settings(
    options: &Options,
    (bodies, grid): (&Bodies, &Grid),
    source: Value,
) -> Result<Settings, Failure> {
    let hardness = hardness(options, grid)?;
    Parts {
        bodies,
        periodic: options.periodic,
        hardness: hardness.as_ref(),
        law: options.sticking.law(),
        rule: options.rule.into(),
        updater: options.updater,
        targets: &targets(options, grid),
        unload: options.unload,
    }
    .settings(grid, source)
}

/// The hardness of each node, if there is one.
fn hardness(options: &Options, grid: &Grid) -> Result<Option<DMatrix<f64>>, Failure> {
    let (nx, ny) = grid.shape();
    let greatest = options.greatest_pressure()?;
    Ok(greatest.map(|hardness| DMatrix::from_element(nx, ny, hardness.pascals)))
}

fn targets(options: &Options, grid: &Grid) -> Vec<ContactTarget> {
    options.targets(grid, &[ContactTarget::AreaFraction(AREA_FRACTION)])
}

/// What touches a surface, and how.
struct Contact<'a> {
    bodies: &'a Bodies,
    periodic: Option<Periodic>,
    hardness: Option<&'a DMatrix<f64>>,
    law: Option<Law>,
}

/// `Ok` unless a file where a record goes has the path of another surface, of other bodies, half-space, hardness or
/// adhesion: the work of hours may be in it.
fn check_kept(
    file: Option<&Path>,
    surface: &Topography,
    contact: &Contact<'_>,
) -> Result<(), Failure> {
    let &Contact { bodies, periodic, hardness, law } = contact;
    let Some(file) = file.filter(|file| file.is_file()) else { return Ok(()) };
    let (grid, heights, origin, (other_hardness, adhesion)) = match LoadingRecord::read_npz(file) {
        Ok(record) => {
            let bears = (record.hardness_map(), None);
            (record.grid(), record.heights().clone(), record.kernel().origin.clone(), bears)
        }
        Err(_) => match AdhesiveRecord::read_npz(file) {
            Ok(record) => {
                let bears = (Ok(None), Some(record.adhesion()));
                (record.grid(), record.heights().clone(), record.kernel().origin.clone(), bears)
            }
            // An empty file is a place that somebody has made for the record.
            Err(_) if file.metadata().is_ok_and(|file| file.len() == 0) => return Ok(()),
            Err(_) => {
                return Err(Failure::request(format!(
                    "{} is no record of a path, and would be lost: name another file with --record, or remove it",
                    file.display()
                )));
            }
        },
    };
    // Records count heights from the highest node.
    let shift = surface.map().max_height() - heights.max_height();
    // Far from zero their last bits are no differences.
    let last_bits = 4.0 * f64::EPSILON * surface.heights().amax();
    let rounding = SAME * surface.map().peak_to_valley() + last_bits;
    let is_near = |(a, b): (&f64, &f64)| (a - b - shift).abs() <= rounding;
    let [(x, y), (other_x, other_y)] = [surface.grid(), &grid].map(Grid::sides);
    let is_one_surface = surface.grid().shape() == grid.shape()
        && (x - other_x).abs() <= SAME * x
        && (y - other_y).abs() <= SAME * y
        && surface.heights().iter().zip(heights.matrix()).all(is_near);
    let other = Bodies::of_kernel(&origin, &[]).ok();
    let are_same = |(_, other): &(Option<Periodic>, Bodies)| {
        (bodies.e_star / other.e_star - 1.0).abs() <= SAME && bodies.layered == other.layered
    };
    let what = match () {
        () if !is_one_surface => "another surface",
        () if !other.as_ref().is_some_and(are_same) => "other bodies",
        () if other.is_some_and(|other| other.0 != periodic) => "another half-space",
        () if !other_hardness.is_ok_and(|other| other.as_ref() == hardness) => "another hardness",
        () if law.map(Law::adhesion) != adhesion => "another adhesion",
        () => return Ok(()),
    };
    Err(Failure::request(format!(
        "{} is the record of {what}, which would be lost: name another file with --record, or remove it",
        file.display()
    )))
}

/// From differences of the heights, whatever the surface is from: a record knows nothing else.
fn rms_gradient(surface: &Topography) -> Result<f64, Failure> {
    let gradient = surface.map().rms_gradient(surface.grid());
    gradient.map_err(|error| Failure::new("cannot compute the gradient of the surface", error))
}
