//! What to compute: the surface, the half-space and where to stop.

use std::fmt;
use std::path::Path;

use asperity::kernel::KernelOrigin;
use asperity::record::LoadingRecord;
use asperity::reference::AreaLoadLaw;
use asperity::surface::{HeightMap, SelfAffine, Topography};
use asperity::updater::Handover;
use asperity::{
    Boundary, ContactRule, ContactTarget, Doubt, Grid, InfluenceKernel, LoadingSolver, LoadingState,
};

use super::Solver;
use super::options::{AREA_FRACTION, Options, Updater};
use super::progress::{Progress, total};
use crate::elasticity::Bodies;
use crate::ensemble::Expected;
use asperity_cli::half_space::{Periodic, half_space};
use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;

/// Side \[m\] and nodes a side of the generated surface, its seed, and cells of its shortest wave, if not given.
const SIDE: f64 = 1e-2;
const NODES: usize = 256;
const SEED: u64 = 1;
const CELLS_OF_SHORTEST_WAVE: f64 = 8.0;

/// Memory of a path besides its factor, for each node of the grid: 256 MB on 512 × 512 nodes.
const BYTES_A_NODE: f64 = 1000.0;

/// A surface on its grid and what is asked of it.
pub(super) struct Job {
    surface: Topography,
    name: String,
    rms_gradient: f64,
    bodies: Bodies,
    periodic: Option<Periodic>,
    rule: ContactRule,
    updater: Updater,
    memory_budget: Option<usize>,
    /// Where the path ends, whichever comes first.
    targets: Vec<ContactTarget>,
    /// What there is of the path already.
    begun: Option<LoadingRecord>,
}

impl Job {
    /// Makes or reads the surface, or the record of a path.
    pub(super) fn new(options: &Options) -> Result<Self, Failure> {
        if let Some(file) = &options.resume {
            return Self::resumed(file, options);
        }
        let bodies = match &options.surface {
            Some(_) => options.elasticity.required()?,
            None => options.elasticity.or_steel()?,
        };
        let (surface, name, rms_gradient) = match &options.surface {
            Some(file) => read(file, options)?,
            None => generate(options)?,
        };
        let otherwise = [ContactTarget::AreaFraction(AREA_FRACTION)];
        let targets = options.targets(surface.grid(), &otherwise);
        Ok(Self {
            surface,
            name,
            rms_gradient,
            bodies,
            periodic: options.periodic,
            rule: options.rule.into(),
            updater: options.updater,
            memory_budget: options.memory_budget,
            targets,
            begun: None,
        })
    }

    /// The path of a record.
    fn resumed(file: &Path, options: &Options) -> Result<Self, Failure> {
        let failed = |error| Failure::new(format!("cannot go on from {}", file.display()), error);
        let record = LoadingRecord::read_npz(file).map_err(failed)?;
        let (periodic, e_star) = match record.kernel().origin {
            KernelOrigin::Boussinesq { e_star } => (None, e_star),
            KernelOrigin::PeriodicBoussinesq { e_star } => (Some(Periodic::Love), e_star),
            KernelOrigin::Spectral { e_star } => (Some(Periodic::Spectral), e_star),
            _ => return Err(failed(asperity::Error::ForeignKernel)),
        };
        let heights = record.heights().matrix().clone();
        let surface = options
            .reading
            .untouched()
            .and_then(|()| Topography::new(record.grid(), heights).map_err(failed))?;
        let rms_gradient = surface.map().rms_gradient(surface.grid()).map_err(failed)?;
        Ok(Self {
            name: format!("{}, {} states", file.display(), record.states().len()),
            rms_gradient,
            bodies: Bodies::of_modulus(e_star, "composite modulus of the record"),
            periodic,
            rule: record.settings().rule,
            updater: options.updater,
            memory_budget: options.memory_budget,
            targets: options.targets(surface.grid(), &record.settings().targets),
            surface,
            begun: Some(record),
        })
    }

    /// The events that the path had already, in a record.
    pub(super) fn begun(&self) -> &[LoadingState] {
        let record = self.begun.as_ref();
        record.map_or(&[], |record| record.history().events())
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
        if let Some(budget) = self.memory_budget {
            builder = builder.memory_budget(budget);
        }
        match &self.begun {
            None => builder.build(),
            Some(record) => builder.resume(record.history()),
        }
        .map_err(|error| Failure::new("the path cannot begin", error))
    }

    pub(super) fn grid(&self) -> Grid {
        *self.surface.grid()
    }

    pub(super) fn heights(&self) -> &HeightMap {
        self.surface.map()
    }

    pub(super) fn e_star(&self) -> f64 {
        self.bodies.e_star
    }

    pub(super) fn boundary(&self) -> Boundary {
        boundary(self.periodic)
    }

    /// What looks wrong before anything is computed.
    pub(super) fn doubts(&self) -> Vec<Doubt> {
        let mut doubts = Doubt::of_surface(&self.surface);
        doubts.extend(Doubt::of_modulus(self.e_star()));
        doubts
    }

    pub(super) fn rule(&self) -> ContactRule {
        self.rule
    }

    /// How far a state is on the way to the nearest target: load grows about in proportion to nodes.
    pub(super) fn progress(&self, state: &LoadingState) -> Progress {
        let shares = self.targets.iter().map(|target| match *target {
            ContactTarget::Load(load) => state.load / load,
            ContactTarget::Approach(approach) => state.approach / approach,
            ContactTarget::AreaFraction(fraction) => state.contact_area_fraction / fraction,
            _ => 0.0,
        });
        let share = shares.fold(state.contact_area_fraction, f64::max).min(1.0);
        let nodes = self.grid().nodes();
        Progress::new(state.contact_nodes, share, |contact| {
            self.updater.event_cost(nodes, contact)
        })
    }

    /// A load or an approach that was asked for and not reached, in words.
    pub(super) fn missed(&self, state: Option<LoadingState>) -> Option<String> {
        let state = state?;
        self.targets.iter().find_map(|target| match *target {
            ContactTarget::Load(load) if state.load < load => Some(format!(
                "the load asked for, {}, at {}",
                quantity(load, "N", 4),
                quantity(state.load, "N", 4)
            )),
            ContactTarget::Approach(approach) if state.approach < approach => Some(format!(
                "the approach asked for, {}, at {}",
                quantity(approach, "m", 4),
                quantity(state.approach, "m", 4)
            )),
            _ => None,
        })
    }

    /// What the path will take, by the load that Persson's theory gives an area.
    pub(super) fn expected(&self) -> Expected {
        let grid = self.grid();
        let nodes = grid.nodes() as f64;
        let pressure = |load: f64| load / grid.nominal_area();
        let share = |target: &ContactTarget| match *target {
            ContactTarget::AreaFraction(fraction) => fraction,
            ContactTarget::Load(load) => AreaLoadLaw::new(self.rms_gradient, self.e_star())
                .map_or(1.0, |law| law.persson(pressure(load))),
            // Not more than all.
            _ => 1.0,
        };
        let share = self.targets.iter().map(share).fold(1.0, f64::min);
        let contact = share * nodes;
        let factor = self.updater.factor_nodes(grid.nodes(), contact as usize) as f64;
        Expected {
            nodes: contact,
            seconds: total(contact, |event| Handover::event_cost(grid.nodes(), event)),
            bytes: BYTES_A_NODE * nodes + 4.0 * factor * factor,
        }
    }

    pub(super) fn periodic(&self) -> Option<Periodic> {
        self.periodic
    }

    fn kernel(&self) -> Result<Box<dyn InfluenceKernel>, Failure> {
        half_space(self.periodic, self.grid(), self.e_star())
            .map_err(|error| Failure::new("no such half-space", error))
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
            "roughness  rms height Sq {}, rms gradient {:.4}",
            quantity(self.heights().rms_height(), "m", 5),
            self.rms_gradient.abs()
        )?;
        writeln!(f, "bodies     {}", self.bodies)?;
        match self.periodic {
            None => writeln!(f, "half-space free")?,
            Some(kernel) => writeln!(f, "half-space periodic, {} kernel", kernel.name())?,
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
        ContactRule::SmallestGap => "smallest gap next, as in Zhang et al. (2020), not exact",
    }
}

fn boundary(periodic: Option<Periodic>) -> Boundary {
    match periodic {
        None => Boundary::Free,
        Some(_) => Boundary::Periodic,
    }
}

/// A surface, its name and its rms gradient.
type Made = (Topography, String, f64);

/// The surface of a file.
fn read(file: &Path, options: &Options) -> Result<Made, Failure> {
    let surface = options.reading.surface(file)?;
    let name = file.display().to_string();
    let rms_gradient = surface
        .map()
        .rms_gradient(surface.grid())
        .map_err(|error| Failure::new(format!("cannot use {name}"), error))?;
    Ok((surface, name, rms_gradient))
}

/// A surface with the spectrum of Zhang et al. (2020), Table 1, but for its shortest wave, which has so many cells that the
/// grid resolves it, unless another one is asked for.
fn generate(options: &Options) -> Result<Made, Failure> {
    let nodes = options.nodes.unwrap_or(NODES);
    let seed = options.seed.unwrap_or(SEED);
    let side = options.reading.side.unwrap_or(SIDE);
    let side_y = options.reading.side_y.unwrap_or(side);
    let failed = |error: asperity::Error| {
        Failure::new(
            format!("cannot put the surface on {nodes} x {nodes} nodes"),
            error,
        )
    };
    let grid = Grid::with_sides(nodes, nodes, side, side_y).map_err(failed)?;
    LoadingSolver::check_room(&grid, boundary(options.periodic), options.memory_budget)
        .map_err(failed)?;
    let paper = SelfAffine::zhang2020(seed);
    let (cell, rolloff) = (grid.dx().max(grid.dy()), paper.rolloff_wavelength());
    if 2.0 * cell > rolloff {
        return Err(Failure::request(format!(
            "{nodes} nodes a side are too few for the roll-off wavelength of {}: two cells are {}",
            quantity(rolloff, "m", 5),
            quantity(2.0 * cell, "m", 5)
        )));
    }
    let resolved = CELLS_OF_SHORTEST_WAVE * cell;
    let least = paper.short_cutoff_wavelength();
    let shortest = options
        .short_cutoff
        .unwrap_or(resolved.max(least).min(rolloff));
    let amplitude = paper.amplitude();
    let surface = SelfAffine::new(paper.hurst(), rolloff, shortest, amplitude, seed);
    let surface = surface.map_err(failed)?;
    let heights = Topography::sample(&surface, grid).map_err(failed)?;
    let rms_gradient = surface.spectrum(&grid).map_err(failed)?.rms_gradient();
    let name = format!(
        "generated as an example: self-affine, Hurst exponent {}, waves of {} ({}) and longer, roll-off at {}, seed {seed}",
        surface.hurst(),
        quantity(shortest, "m", 4),
        quantity(shortest / cell, "cells", 4),
        quantity(rolloff, "m", 4)
    );
    Ok((heights, name, rms_gradient))
}
