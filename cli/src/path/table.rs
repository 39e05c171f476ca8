//! The short table, and how exact the last state is.

use asperity::contact::ContactFields;
use asperity::loading::{History, LoadingEnd};
use asperity::patches::ContactEdge;
use asperity::{Certificate, ContactGrowth, Error, InfluenceKernel, LoadingState, Warning};

use super::Solver;
use super::job::Job;
use super::moments;
use crate::conduction::{Named, conductances};
use crate::resolution::Resolution;
use crate::state_table::{self, Row};
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
    (conductions, seconds): (&[Named], f64),
) -> Result<(), Failure> {
    let Some(last) = states.last() else {
        return Ok(());
    };
    if speech::is_quiet() {
        all_warnings(job, solver, states)?.iter().for_each(speech::warn);
        return verify(solver);
    }
    say!("{} in {seconds:.2} s", counted(states.len(), "state"));
    if let Some(end) = solver.end() {
        say!("ended by: {}", reason(end));
    }
    say!();
    let corrected = corrected_areas(job, states)
        .map_err(|error| Failure::new("cannot compute the corrected contact area", error))?;
    let mut failed = Ok(());
    let shown = rows(job, states, last).into_iter().map(|state| {
        let greatest = solver.fields_at(&state).map(|fields| fields.max_pressure());
        let greatest = greatest.unwrap_or_else(|error| {
            failed = Err(Failure::new("cannot compute a pressure for the table", error));
            f64::NAN
        });
        row(job, &state, greatest, &corrected, conductions)
    });
    let shown: Vec<Row> = shown.collect();
    state_table::print(&shown, &job.grid(), job.periodic());
    failed?;
    let resolution = Resolution::of(&solver.contact_map(), &job.grid(), job.boundary())
        .map_err(|error| Failure::new("cannot find the patches of the last state", error))?;
    say!("mesh: at the last state {resolution}");
    all_warnings(job, solver, states)?.iter().for_each(speech::warn);
    let certificate = solver
        .certificate()
        .map_err(|error| Failure::new("cannot compute the residuals of the last state", error))?;
    exactness(&certificate, last);
    verify(solver)
}

/// A state with its greatest pressure, from the corrected areas of all.
pub(super) fn row(
    job: &Job,
    state: &LoadingState,
    greatest: f64,
    corrected: &[f64],
    conductions: &[Named],
) -> Row {
    let plastic = state.contact.plastic;
    Row {
        contact: state.contact,
        greatest,
        corrected_area: corrected.get(state.step - 1).copied().unwrap_or(f64::NAN),
        yielded: job
            .has_hardness()
            .then(|| plastic.map_or(0.0, |plastic| plastic.yielded_area_fraction)),
        conductances: conductances(conductions, &state.contact, job.layering()),
    }
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
    let beyond = |excess: f64| match excess > 0.0 {
        true => format!("{} of it", scientific(excess, 2)),
        false => "none".to_string(),
    };
    let excess = certificate.excess_pressure;
    let excess = excess.map(|excess| ("pressure beyond the hardness", beyond(excess)));
    for (what, value) in left.into_iter().chain(excess) {
        say!("  {what:32} {value}");
    }
}

/// What looks wrong with the states that are asked for, and with the end of the path.
pub(super) fn all_warnings(
    job: &Job,
    solver: &mut Solver,
    states: &[LoadingState],
) -> Result<Vec<String>, Failure> {
    let mut all = Vec::new();
    let mut end = None;
    for (at, state) in moments::reached(job, states).0 {
        if Some(&state) == states.last() {
            end = Some(at);
            continue;
        }
        let failed = |error| Failure::new(format!("cannot compute the pressure at {at}"), error);
        let fields = solver.fields_at(&state).map_err(failed)?;
        let found = of_fields(job, growth(solver), &fields).map_err(failed)?;
        all.extend(found.into_iter().map(|warning| format!("at {at}: {warning}")));
    }
    let (last, of_path) = of_end(job, solver)?;
    all.extend(last.into_iter().map(|warning| match end {
        Some(at) => format!("at {at}: {warning}"),
        None => warning,
    }));
    all.extend(of_path);
    Ok(all)
}

/// What is known of the contact on the body of a path.
fn growth(solver: &Solver) -> ContactGrowth {
    solver.problem().table().contact_growth()
}

/// What looks wrong with a state.
fn of_fields(
    job: &Job,
    growth: ContactGrowth,
    fields: &ContactFields,
) -> Result<Vec<String>, Error> {
    let on = (&job.grid(), job.boundary());
    let of_contact = Warning::of_contact(&fields.pressure, &fields.contact_map, on)?;
    // With a hardness it is what was asked for.
    let high = job.bodies().warning_of(fields.pressure.max()).filter(|_| !job.has_hardness());
    // On a flat surface the states of `--at` have a load behind the end of the path.
    let is_known =
        |warning: &Warning| matches!(warning, Warning::NoLoad { .. }) && !job.at().is_empty();
    let found = high.into_iter().chain(of_contact).filter(|warning| !is_known(warning));
    Ok(found.map(|warning| crate::advice::told_on(growth, &warning)).collect())
}

/// What looks wrong with the end of the path.
pub(super) fn warnings(job: &Job, solver: &mut Solver) -> Result<Vec<String>, Failure> {
    let (mut warnings, of_path) = of_end(job, solver)?;
    warnings.extend(of_path);
    Ok(warnings)
}

/// What looks wrong with the last state, and with where the path ends.
fn of_end(job: &Job, solver: &mut Solver) -> Result<(Vec<String>, Option<String>), Failure> {
    let failed = |error| Failure::new("cannot compute the pressure of the last state", error);
    let fields = solver.fields().map_err(failed)?;
    let warnings = of_fields(job, growth(solver), &fields).map_err(failed)?;
    let mut of_path = None;
    if let (Some(LoadingEnd::FullContact | LoadingEnd::NoMoreEvents), Some(target)) =
        (solver.end(), job.missed(solver.state()))
        // A flat surface, whose nodes all touch before there is a load, says nothing of units.
        && fields.pressure.max() > 0.0
    {
        let beyond = match (solver.end(), job.at()) {
            (Some(LoadingEnd::FullContact), [_, ..]) => {
                " Beyond full contact its states are those of a straight line."
            }
            _ => "",
        };
        of_path = Some(format!(
            "the path ended before {target}.{beyond} If you did not expect this, check the units of E*, {}, of heights and of sides",
            quantity(job.e_star(), "Pa", 3)
        ));
    }
    Ok((warnings, of_path))
}

/// Those that are asked for and reached, otherwise some at loads spread over the path.
fn rows(job: &Job, states: &[LoadingState], last: &LoadingState) -> Vec<LoadingState> {
    let history: History = states.iter().copied().collect();
    if !job.at().is_empty() {
        return moments::reached(job, states).0.into_iter().map(|(_, state)| state).collect();
    }
    let mut rows: Vec<LoadingState> = Vec::new();
    for load in LOADS.map(|fraction| fraction * last.contact.load) {
        rows.extend(history.at_load(load).filter(|state| rows.last() != Some(state)));
    }
    rows
}
