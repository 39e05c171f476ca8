//! The short table, and how exact the last state is.

use asperity::loading::{History, LoadingEnd};
use asperity::patches::ContactEdge;
use asperity::{Certificate, Error, LoadingState, Warning};

use super::Solver;
use super::job::Job;
use crate::columns::{Column, print as print_columns};
use crate::resolution::Resolution;
use asperity_cli::half_space::is_of_mean_planes;
use asperity_cli::number::{counted, quantity, scientific};
use asperity_cli::outcome::Failure;
use asperity_cli::{say, speech};
pub(super) use asperity_report::reason;

/// Loads of the rows, as fractions of the last.
const LOADS: [f64; 10] = [1e-4, 1e-3, 0.01, 0.03, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0];

/// Prints rows at loads spread over the path, and the certificate of its last state.
pub(super) fn print(
    job: &Job,
    solver: &mut Solver,
    states: &[LoadingState],
    seconds: f64,
) -> Result<(), Failure> {
    let Some(last) = states.last() else {
        return Ok(());
    };
    if speech::is_quiet() {
        warnings(job, solver)?.iter().for_each(speech::warn);
        return verify(solver);
    }
    say!("{} in {seconds:.2} s", counted(states.len(), "state"));
    if let Some(end) = solver.end() {
        say!("ended by: {}", reason(end));
    }
    say!();
    let corrected = corrected_areas(job, states)
        .map_err(|error| Failure::new("cannot compute the corrected contact area", error))?;
    let rows = rows(states, last);
    let mut failed = Ok(());
    let mut greatest = Vec::new();
    for state in &rows {
        greatest.push(match solver.fields_at(state).map(|fields| fields.pressure) {
            Ok(pressure) => pressure.iter().copied().fold(0.0, f64::max),
            Err(error) => {
                failed = Err(Failure::new("cannot compute a pressure for the table", error));
                f64::NAN
            }
        });
    }
    table(job, &rows, &greatest, &corrected);
    failed?;
    let resolution = Resolution::of(&solver.contact_map(), &job.grid(), job.boundary())
        .map_err(|error| Failure::new("cannot find the patches of the last state", error))?;
    say!("mesh: at the last state {resolution}");
    warnings(job, solver)?.iter().for_each(speech::warn);
    let certificate = solver
        .certificate()
        .map_err(|error| Failure::new("cannot compute the residuals of the last state", error))?;
    exactness(&certificate, last);
    verify(solver)
}

/// `Ok` if the last state fulfils the conditions of contact.
pub(super) fn verify(solver: &mut Solver) -> Result<(), Failure> {
    let wrong = |error| Failure::new("the last state violates the contact conditions", error);
    solver.verify().map_err(wrong)
}

/// The corrected contact area \[m²\] after each event.
pub(super) fn corrected_areas(job: &Job, states: &[LoadingState]) -> Result<Vec<f64>, Error> {
    let mut edge = ContactEdge::new(job.grid(), job.boundary());
    let events = states.iter().map(|state| {
        edge.follow(state.event, state.node)?;
        Ok(edge.corrected_area())
    });
    events.collect()
}

/// Rows with the greatest pressure of each, and the legend.
fn table(job: &Job, rows: &[LoadingState], greatest: &[f64], corrected: &[f64]) {
    let nominal = job.grid().nominal_area();
    let column =
        |name: &'static str, unit: &'static str, quantity: &dyn Fn(&LoadingState) -> f64| {
            Column::new(name, unit, rows.iter().map(quantity))
        };
    let area =
        |state: &LoadingState| corrected.get(state.step - 1).map_or(f64::NAN, |a| a / nominal);
    let stiffness = |stiffness: Option<f64>| stiffness.unwrap_or(f64::NAN);
    let mut columns = vec![
        column("load", "N", &|state| state.contact.load),
        column("pressure", "Pa", &|state| state.contact.mean_pressure()),
        Column::new("greatest", "Pa", greatest.iter().copied()),
        Column::area("area", rows.iter().map(|state| state.contact.contact_area)),
        Column::percent("area", rows.iter().map(|state| state.contact.contact_area_fraction)),
        Column::percent("corrected", rows.iter().map(area)),
        column("approach", "m", &|state| state.contact.approach),
        column("mean gap", "m", &|state| state.contact.mean_gap),
        column("K", "N/m", &|state| stiffness(state.contact.contact_stiffness)),
        column("K_i", "N/m", &|state| stiffness(state.contact.interfacial_stiffness)),
    ];
    if job.has_hardness() {
        let yielded = |state: &LoadingState| {
            state.contact.plastic.map_or(0.0, |plastic| plastic.yielded_area_fraction)
        };
        columns.insert(6, Column::percent("yielded", rows.iter().map(yielded)));
    }
    // A periodic half-space has no contact stiffness.
    let has_k = rows.iter().any(|state| state.contact.contact_stiffness.is_some());
    columns.retain(|column| has_k || column.name() != "K");
    print_columns(&columns);
    say!();
    say!("pressure: load over nominal area; greatest: the greatest pressure of a cell");
    say!(
        "area: cells in contact; corrected: without the excess of whole cells along the edges of patches (somewhat too small)"
    );
    match is_of_mean_planes(job.periodic()) {
        false => say!("approach: from first touch; K: contact stiffness, d load/d approach"),
        true => say!("approach: of the mean planes, from first touch"),
    }
    if job.has_hardness() {
        say!("yielded: cells at the hardness; they count as contact");
    }
    say!("K_i: interfacial stiffness, -d load/d mean gap");
    say!();
}

/// How well the last state solves its equations.
fn exactness(certificate: &Certificate, last: &LoadingState) {
    let gap = |relative: f64| quantity(relative * certificate.length, "m", 2);
    let pressure = last.contact.load / last.contact.contact_area;
    say!();
    say!(
        "solution: residuals of the contact conditions of the last state on this grid, recomputed from its pressure (0 is exact):"
    );
    let left = [
        ("greatest gap in contact", gap(certificate.greatest_contact_gap)),
        // There is none in full contact.
        (
            "least gap out of contact",
            match certificate.least_gap.is_finite() {
                true => gap(certificate.least_gap),
                false => "-".to_string(),
            },
        ),
        ("least pressure in contact", quantity(certificate.least_pressure * pressure, "Pa", 2)),
        (
            "sum of pressures less load",
            quantity(certificate.load_error * last.contact.load, "N", 2),
        ),
        ("estimated error of the approach", quantity(last.approach_error, "m", 2)),
    ];
    let excess = certificate
        .excess_pressure
        .map(|excess| ("pressure beyond the hardness", format!("{} of it", scientific(excess, 2))));
    for (what, value) in left.into_iter().chain(excess) {
        say!("  {what:32} {value}");
    }
}

/// What looks wrong with the end of the path.
pub(super) fn warnings(job: &Job, solver: &mut Solver) -> Result<Vec<String>, Failure> {
    let failed = |error| Failure::new("cannot compute the pressure of the last state", error);
    let pressure = solver.fields().map_err(failed)?.pressure;
    let on = (&job.grid(), job.boundary());
    let of_contact = Warning::of_contact(&pressure, &solver.contact_map(), on).map_err(failed)?;
    // With a hardness it is what was asked for.
    let high = job.bodies().warning_of(pressure.max()).filter(|_| !job.has_hardness());
    let found = high.into_iter().chain(of_contact);
    let mut warnings: Vec<String> = found.map(|warning| crate::advice::told(&warning)).collect();
    if let (Some(LoadingEnd::FullContact | LoadingEnd::NoMoreEvents), Some(target)) =
        (solver.end(), job.missed(solver.state()))
        // A flat surface, whose nodes all touch before there is a load, says nothing of units.
        && pressure.max() > 0.0
    {
        warnings.push(format!(
            "the path ended before {target}. If you did not expect this, check the units: E* is {} Pa",
            scientific(job.e_star(), 3)
        ));
    }
    Ok(warnings)
}

/// States at given loads.
fn rows(states: &[LoadingState], last: &LoadingState) -> Vec<LoadingState> {
    let history: History = states.iter().copied().collect();
    let mut rows: Vec<LoadingState> = Vec::new();
    for load in LOADS.map(|fraction| fraction * last.contact.load) {
        rows.extend(history.at_load(load).filter(|state| rows.last() != Some(state)));
    }
    rows
}
