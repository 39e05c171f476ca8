//! One surface from first touch to the greatest load: the path, then fixed loads.

use std::path::{Path, PathBuf};
use std::time::Instant;

use asperity::contact::ContactSequence;
use asperity::patches::{Connectivity, PatchHistory, Patches};
use asperity::surface::HeightMap;
use asperity::{
    Boundary, Boussinesq, ContactState, ContactTarget, FixedLoadSolver, LoadingSolver, LoadingState,
};
use nalgebra::DMatrix;

use crate::surfaces::{E_STAR, NOMINAL_AREA, Rough, SQ, grid};
use asperity_cli::outcome::Failure;

/// Greatest load over A₀ E*, Table 1.
pub(crate) const GREATEST_LOAD: f64 = 0.1;
/// Ratio of a fixed load to the one before, at most.
const STEP: f64 = 1.12;
/// Tolerance of the fixed loads, relative to the approach.
pub(crate) const TOLERANCE: f64 = 1e-8;

/// A state of contact without units.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Point {
    /// W / A₀E*.
    pub(crate) load: f64,
    /// A / A₀, cells counted whole.
    pub(crate) area: f64,
    /// A / A₀ with the correction for the staircase around the contact.
    pub(crate) corrected: f64,
    /// Approach / Sq.
    pub(crate) approach: f64,
    /// Mean gap / Sq.
    pub(crate) mean_gap: f64,
    /// dW/dδ · Sq / A₀E*.
    pub(crate) contact_stiffness: f64,
    /// −dW/dḡ · Sq / A₀E*.
    pub(crate) interfacial_stiffness: f64,
    /// Whether it is a state of the path, not a solution for a given load.
    pub(crate) event: bool,
}

/// Relative differences of the two methods where they meet.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Seam {
    pub(crate) area: f64,
    pub(crate) approach: f64,
    pub(crate) mean_gap: f64,
    pub(crate) contact_stiffness: f64,
}

/// A surface under all loads.
#[derive(Debug, Clone)]
pub(crate) struct Run {
    pub(crate) rough: Rough,
    pub(crate) seed: u64,
    /// In the order of loads.
    pub(crate) points: Vec<Point>,
}

impl Run {
    /// Follows the path to `path_nodes` nodes and solves for fixed loads from there.
    pub(crate) fn new(
        rough: Rough,
        seed: u64,
        nodes: usize,
        path_nodes: usize,
    ) -> Result<Self, Failure> {
        let failed = |error: asperity::Error| {
            Failure::new(format!("surface {}, seed {seed}", rough.name()), error)
        };
        let start = Instant::now();
        let grid = grid(nodes).map_err(failed)?;
        let heights = rough.heights(&grid, seed).map_err(failed)?;
        let kernel = Boussinesq::new(grid, E_STAR).map_err(failed)?;
        let mut points = follow(&heights, &kernel, path_nodes).map_err(failed)?;
        let seconds = start.elapsed().as_secs_f64();
        let events = points.len();
        let last = points.last().map_or(GREATEST_LOAD, |point| point.load);
        let loads = loads_beyond(last);
        let newtons = loads.iter().map(|load| load * NOMINAL_AREA * E_STAR);
        let targets = newtons.map(ContactTarget::Load);
        let mut solver = FixedLoadSolver::builder(&heights, &kernel)
            .tolerance(TOLERANCE)
            .build()
            .map_err(failed)?;
        for solution in solver.sweep(targets) {
            let solution = solution.map_err(failed)?;
            let patches = Patches::new(
                &solution.fields.contact_map,
                &grid,
                Boundary::Free,
                Connectivity::Four,
            )
            .map_err(failed)?;
            let areas = patches.patches().iter();
            let areas = areas.map(|patch| patch.perimeter.corrected_area(patch.nodes, &grid));
            points.push(Point::new(&solution.contact, areas.sum(), false));
        }
        eprintln!(
            "  {}, seed {seed}: path to {:.1} % contact in {seconds:.0} s, {} fixed loads to {:.1} % in {:.0} s",
            rough.name(),
            100.0 * points[events - 1].area,
            loads.len(),
            100.0 * points.last().map_or(0.0, |point| point.area),
            start.elapsed().as_secs_f64() - seconds,
        );
        Ok(Self { rough, seed, points })
    }

    /// The state at a load, interpolated between computed ones: approach and mean gap by the cubics that
    /// have their exact tangents, areas and stiffnesses linearly.
    pub(crate) fn at_load(&self, load: f64) -> Option<Point> {
        let after = self.points.partition_point(|point| point.load < load);
        let (b, a) = (self.points.get(after)?, self.points.get(after.max(1) - 1)?);
        let length = b.load - a.load;
        if length <= 0.0 {
            return Some(*b);
        }
        let t = (load - a.load) / length;
        let linear = |value: fn(&Point) -> f64| (1.0 - t) * value(a) + t * value(b);
        let cubic = |value: fn(&Point) -> f64, slope: fn(&Point) -> f64| {
            let (from, to) = (length * slope(a), length * slope(b));
            let rise = value(b) - value(a);
            let bend = (1.0 - t) * (from - rise) - t * (to - rise);
            value(a) + t * (rise + (1.0 - t) * bend)
        };
        Some(Point {
            load,
            area: linear(|p| p.area),
            corrected: linear(|p| p.corrected),
            approach: cubic(|p| p.approach, |p| 1.0 / p.contact_stiffness),
            mean_gap: cubic(|p| p.mean_gap, |p| -1.0 / p.interfacial_stiffness),
            contact_stiffness: linear(|p| p.contact_stiffness),
            interfacial_stiffness: linear(|p| p.interfacial_stiffness),
            event: b.event,
        })
    }

    /// The state at a fraction of the nominal area.
    pub(crate) fn at_area(&self, area: f64) -> Option<Point> {
        let after = self.points.partition_point(|point| point.area < area);
        let (b, a) = (self.points.get(after)?, self.points.get(after.max(1) - 1)?);
        let t = if b.area > a.area { (area - a.area) / (b.area - a.area) } else { 1.0 };
        self.at_load((1.0 - t) * a.load + t * b.load)
    }

    /// States at `count` loads, evenly spaced up to `greatest`; the first is one step above `from`.
    pub(crate) fn evenly(&self, from: f64, greatest: f64, count: usize) -> Vec<Point> {
        let loads = (1..=count).map(|k| from + (greatest - from) * k as f64 / count as f64);
        loads.filter_map(|load| self.at_load(load)).collect()
    }

    /// The state under the greatest load.
    pub(crate) fn last(&self) -> Option<&Point> {
        self.points.last()
    }

    /// How the last state of the path and the fixed load at the same place differ, `None` if the
    /// path went all the way.
    pub(crate) fn seam(&self) -> Option<Seam> {
        let first = self.points.iter().position(|point| !point.event)?;
        let (a, b) = (self.points.get(first.checked_sub(1)?)?, self.points[first]);
        let relative = |a: f64, b: f64| (b / a - 1.0).abs();
        Some(Seam {
            area: relative(a.area, b.area),
            approach: relative(a.approach, b.approach),
            mean_gap: relative(a.mean_gap, b.mean_gap),
            contact_stiffness: relative(a.contact_stiffness, b.contact_stiffness),
        })
    }

    fn file(directory: &Path, rough: Rough, nodes: usize, seed: u64) -> PathBuf {
        directory.join(format!("run_{}_{nodes}_{seed}.csv", rough.key()))
    }

    /// Writes the points for [`Self::read`].
    pub(crate) fn write(&self, directory: &Path, nodes: usize) -> Result<(), Failure> {
        let name = Self::file(directory, self.rough, nodes, self.seed);
        let rows = self.points.iter().map(|p| {
            [
                p.load,
                p.area,
                p.corrected,
                p.approach,
                p.mean_gap,
                p.contact_stiffness,
                p.interfacial_stiffness,
                f64::from(u8::from(p.event)),
            ]
            .map(|value| value.to_string())
        });
        crate::table::write_csv(
            &name,
            &[
                "load",
                "area",
                "corrected_area",
                "approach",
                "mean_gap",
                "contact_stiffness",
                "interfacial_stiffness",
                "event",
            ],
            rows,
        )
    }

    /// Reads what [`Self::write`] wrote, `None` if there is no such file.
    pub(crate) fn read(directory: &Path, rough: Rough, nodes: usize, seed: u64) -> Option<Self> {
        let name = Self::file(directory, rough, nodes, seed);
        let mut reader = csv::Reader::from_path(name).ok()?;
        let rows = reader.deserialize::<[f64; 8]>();
        let points = rows.map(|row| {
            row.map(|row| Point {
                load: row[0],
                area: row[1],
                corrected: row[2],
                approach: row[3],
                mean_gap: row[4],
                contact_stiffness: row[5],
                interfacial_stiffness: row[6],
                event: row[7] == 1.0,
            })
        });
        Some(Self { rough, seed, points: points.collect::<Result<_, _>>().ok()? })
    }
}

impl Point {
    /// A state in SI units, and its contact area without what cells count too much.
    fn new(state: &ContactState, corrected_area: f64, event: bool) -> Self {
        let force = NOMINAL_AREA * E_STAR;
        Self {
            load: state.load / force,
            area: state.contact_area_fraction,
            corrected: corrected_area / NOMINAL_AREA,
            approach: state.approach / SQ,
            mean_gap: state.mean_gap / SQ,
            contact_stiffness: known(state.contact_stiffness) * SQ / force,
            interfacial_stiffness: known(state.interfacial_stiffness) * SQ / force,
            event,
        }
    }

    /// k = A E* h' / W.
    pub(crate) fn ratio(&self, gradient: f64) -> f64 {
        self.area * gradient / self.load
    }

    /// The same with the corrected area.
    pub(crate) fn corrected_ratio(&self, gradient: f64) -> f64 {
        self.corrected * gradient / self.load
    }

    /// −dḡ/d(ln W) / Sq, exact: what the mean gap loses while the load grows by a factor e.
    pub(crate) fn decay(&self) -> f64 {
        self.load / self.interfacial_stiffness
    }
}

/// A stiffness that a free half-space has and that was asked for.
fn known(stiffness: Option<f64>) -> f64 {
    stiffness.unwrap_or(f64::NAN)
}

/// The states of a path, every one up to 500 nodes and one in 500 parts from there.
fn follow(
    heights: &HeightMap,
    kernel: &Boussinesq,
    path_nodes: usize,
) -> Result<Vec<Point>, asperity::Error> {
    let mut path = LoadingSolver::builder(heights, kernel)
        .max_nodes(path_nodes)
        .max_load(GREATEST_LOAD * NOMINAL_AREA * E_STAR)
        .build()?;
    let mut states: Vec<LoadingState> = Vec::new();
    let mut pending = None;
    let mut next = 1;
    for state in path.by_ref() {
        let state = state?;
        pending = Some(state);
        // First touch carries no load and divides nothing.
        if state.step >= next && state.contact.load > 0.0 {
            states.push(state);
            pending = None;
            next = state.step + 1 + state.step / 500;
        }
    }
    states.extend(pending);
    let areas = corrected_areas(&ContactSequence::with_order(path.grid(), path.contact_order())?);
    let points = states.iter().map(|state| {
        let area = areas.get(state.contact.contact_nodes.wrapping_sub(1));
        Point::new(&state.contact, area.copied().unwrap_or_default(), true)
    });
    Ok(points.collect())
}

/// Contact areas without what cells count too much, for every state of a path.
pub(crate) fn corrected_areas(contact: &ContactSequence) -> Vec<f64> {
    let grid = contact.grid();
    PatchHistory::new(contact, Boundary::Free, Connectivity::Four)
        .map(|state| state.corrected_area(&grid))
        .collect()
}

/// Loads from the end of a path to the greatest, evenly spaced in the logarithm; none if the path
/// went all the way.
fn loads_beyond(last: f64) -> Vec<f64> {
    let ratio = GREATEST_LOAD / last;
    // The path ends at this load to rounding.
    if ratio <= 1.0 + 1e-12 {
        return Vec::new();
    }
    let steps = (ratio.ln() / STEP.ln()).ceil();
    (0..=steps as usize).map(|k| last * ratio.powf(k as f64 / steps)).collect()
}

/// Stiffness of the rigid flat punch on the same mesh, K Sq / A₀E*: where the contact stiffness ends.
pub(crate) fn punch_stiffness(nodes: usize) -> Result<f64, asperity::Error> {
    let grid = grid(nodes)?;
    let heights = HeightMap::new(DMatrix::zeros(nodes, nodes))?;
    let kernel = Boussinesq::new(grid, E_STAR)?;
    let solution = FixedLoadSolver::new(&heights, &kernel)?.solve(NOMINAL_AREA * E_STAR)?;
    Ok(known(solution.contact.contact_stiffness) * SQ / (NOMINAL_AREA * E_STAR))
}
