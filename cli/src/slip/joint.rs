//! The joint that a command line asks for, and its curves.

use asperity::bed::Bed;
use asperity::kernel::Theory;
use asperity::record::LoadingRecord;
use asperity::slip::{Friction, PartialSlip, SlipCycle, SlipState};
use asperity::{Boundary, Error, SlipError};
use asperity_cli::outcome::Failure;

use super::Options;
use crate::elasticity::Bodies;

/// Points of a curve.
const POINTS: usize = 200;
/// Amplitudes of cycles in a factor of ten, and how many such factors below the limit of friction there are.
const PER_DECADE: usize = 16;
const DECADES: usize = 4;

/// A joint, with all its curves.
pub(super) struct Joint<'a> {
    pub(super) record: &'a LoadingRecord,
    pub(super) slip: PartialSlip<'a>,
    /// The bodies, in words.
    pub(super) bodies: String,
    /// Under the tangential load asked for, which has grown from zero.
    pub(super) state: SlipState,
    /// Between it and its opposite.
    pub(super) cycle: SlipCycle,
    /// The first loading up to sliding.
    pub(super) loading: Vec<SlipState>,
    /// Cycles of growing amplitude up to sliding, of those that slip at all.
    pub(super) cycles: Vec<SlipCycle>,
    /// The dissipation grows as this power of the amplitude, where enough nodes slip.
    pub(super) exponent: Option<f64>,
    pub(super) warnings: Vec<String>,
}

impl<'a> Joint<'a> {
    pub(super) fn new(
        bed: &'a Bed<'a>,
        record: &'a LoadingRecord,
        options: &Options,
    ) -> Result<Self, Failure> {
        let failed = |error| Failure::new("cannot shear the joint", error);
        bed.history().layering().check(Theory::Slip).map_err(failed)?;
        let (friction, bodies) = friction(options, record)?;
        let load = options.load.unwrap_or(bed.last_load());
        if load == 0.0 {
            return Err(Failure::request("the path carries no load: there is nothing to shear"));
        }
        let slip = PartialSlip::new(bed, load, friction).map_err(failed)?;
        let limit = slip.sliding_load();
        let amplitude = options.amplitude.unwrap_or(0.5 * limit);
        let state = slip.monotone(amplitude).map_err(failed)?;
        let cycle = slip.cycle(amplitude).map_err(failed)?;
        let loading = (0..=POINTS).map(|k| slip.monotone(limit * k as f64 / POINTS as f64));
        let loading = loading.collect::<Result<_, _>>().map_err(failed)?;
        let cycles = cycles(&slip).map_err(failed)?;
        let mut warnings = warnings(&slip, &cycle);
        let used = "their ratio of compliances";
        warnings.extend(bodies.as_ref().and_then(|bodies| bodies.warning_of_path(record, used)));
        let bodies = match bodies {
            Some(bodies) => bodies.to_string(),
            None => "ratio of compliances as given".to_string(),
        };
        let exponent = exponent(&cycles, limit);
        Ok(Self { record, slip, bodies, state, cycle, loading, cycles, exponent, warnings })
    }

    /// Whether displacements are of the mean planes.
    pub(super) fn is_periodic(&self) -> bool {
        self.record.kernel().boundary == Boundary::Periodic
    }
}

/// Of the bodies given, or else of those of the record.
fn friction(
    options: &Options,
    record: &LoadingRecord,
) -> Result<(Friction, Option<Bodies>), Failure> {
    let failed = |error| Failure::new("invalid friction", error);
    match (options.compliance_ratio, options.material) {
        (None, Some(first)) => {
            let bodies = Bodies::between(first, options.against)?;
            let second = options.against.map(|body| body.elastic());
            let friction =
                Friction::between(options.friction, first.elastic(), second).map_err(failed)?;
            Ok((friction, Some(bodies)))
        }
        (Some(ratio), _) => Ok((Friction::new(options.friction, ratio).map_err(failed)?, None)),
        (None, None) => {
            let [first, rest @ ..] = record.bodies() else {
                return Err(Failure::request(
                    "the record does not know its bodies: give --material and --against, or --compliance-ratio",
                ));
            };
            let second = rest.first().copied();
            let friction = Friction::between(options.friction, *first, second).map_err(failed)?;
            let (_, bodies) = Bodies::of_record(record).map_err(failed)?;
            Ok((friction, Some(bodies)))
        }
    }
}

/// Cycles at amplitudes of one ratio. The smallest slip nowhere, or are made of errors of the path.
fn cycles(slip: &PartialSlip) -> Result<Vec<SlipCycle>, Error> {
    let count = PER_DECADE * DECADES;
    let share = |k: usize| 10_f64.powf(-((count - k) as f64) / PER_DECADE as f64);
    let all = (0..=count).map(|k| slip.cycle(share(k) * slip.sliding_load()));
    let resolved = all.filter(|cycle| {
        !matches!(cycle, Err(Error::Slip(SlipError::WithinPathError { .. })))
            && !cycle.as_ref().is_ok_and(|cycle| cycle.dissipation == 0.0)
    });
    resolved.collect()
}

/// By least squares of the logarithms, between [`PartialSlip::FEW_NODES`] nodes and half of what friction bears.
fn exponent(cycles: &[SlipCycle], limit: f64) -> Option<f64> {
    let resolved = cycles.iter().filter(|cycle| !cycle.has_few_nodes());
    let small = resolved.filter(|cycle| cycle.amplitude <= 0.5 * limit);
    let points: Vec<(f64, f64)> =
        small.map(|cycle| (cycle.amplitude.ln(), cycle.dissipation.ln())).collect();
    // Fewer than a third of a decade say nothing.
    if points.len() < PER_DECADE / 3 {
        return None;
    }
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let products = points.iter().map(|point| (point.0 - x) * (point.1 - y));
    let squares = points.iter().map(|point| (point.0 - x).powi(2));
    Some(products.sum::<f64>() / squares.sum::<f64>())
}

fn warnings(slip: &PartialSlip, cycle: &SlipCycle) -> Vec<String> {
    let mut warnings = Vec::new();
    let friction = slip.friction();
    if let Some(beta) = friction.dundurs_beta().filter(|_| friction.is_coupled()) {
        warnings.push(format!(
            "Dundurs' β is {beta:.3}: tangential tractions move these surfaces normally too, which is left out. At 0.29 the tangential \
             load of a first loading was up to 6 % less than here, steady cycles dissipated 2 to 10 % more (small ones 9 % less to 29 % \
             more), and the first loading several times a quarter of the dissipation of a cycle"
        ));
    }
    if cycle.has_few_nodes() {
        let nodes = match cycle.slipping_nodes {
            1 => "1 node slips".to_string(),
            count => format!("{count} nodes slip"),
        };
        warnings.push(format!(
            "only {nodes} in this cycle: below some {} of them the dissipation is that of the grid. Larger amplitudes, or a finer \
             grid, tell more",
            PartialSlip::FEW_NODES
        ));
    }
    warnings
}
