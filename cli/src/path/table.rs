//! The short table, and how exact the last state is.

use asperity::loading::{History, LoadingEnd};
use asperity::{ContactRule, Doubt, LoadingState};

use super::Solver;
use super::job::Job;
use asperity_cli::number::{quantity, scientific};
use asperity_cli::outcome::Failure;
use asperity_cli::say;

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
    say!("{} states in {seconds:.2} s", states.len());
    if let Some(end) = solver.end() {
        say!("ended by: {}", reason(end));
    }
    say!();
    let rms_height = job.heights().rms_height();
    let (length, approach, gap) = if rms_height > 0.0 {
        (rms_height, "approach/Sq", "mean gap/Sq")
    } else {
        (1.0, "approach [m]", "mean gap [m]")
    };
    say!(
        "{:>8} {:>12} {:>12} {:>12} {:>12} {:>12} {:>12} {:>12} {:>12}",
        "nodes",
        "load [N]",
        "p_mean/E*",
        "A/A0",
        approach,
        gap,
        "K [N/m]",
        "K_i [N/m]",
        "p_max/E*"
    );
    let mut failed = Ok(());
    for state in rows(job.rule(), states, last) {
        let greatest = match solver.pressure_at(&state) {
            Ok(pressure) => pressure.iter().copied().fold(0.0, f64::max),
            Err(error) => {
                failed = Err(Failure::new("no pressure for the table", error));
                f64::NAN
            }
        };
        say!(
            "{:>8} {:>12.4e} {:>12.4e} {:>12.4e} {:>12.4e} {:>12.4e} {:>12} {:>12} {:>12.4e}",
            state.contact_nodes,
            state.load,
            state.mean_pressure() / job.e_star(),
            state.contact_area_fraction,
            state.approach / length,
            state.mean_gap / length,
            printed(state.contact_stiffness),
            printed(state.interfacial_stiffness),
            greatest / job.e_star(),
        );
    }
    failed?;
    for doubt in doubts(job, solver)? {
        say!("\nwarning: {doubt}");
    }

    let certificate = solver
        .certificate()
        .map_err(|error| Failure::new("no certificate", error))?;
    let length = quantity(certificate.length, "m", 4);
    say!();
    say!("certificate of the last state, from its pressure alone (0 would be exact):");
    say!(
        "  least pressure in contact   {:>10.1e} of the mean pressure there",
        certificate.least_pressure
    );
    say!(
        "  least gap out of contact    {:>10.1e} of {length}",
        certificate.least_gap
    );
    say!(
        "  greatest gap in contact     {:>10.1e} of {length}",
        certificate.greatest_contact_gap
    );
    say!(
        "  sum of pressures less load  {:>10.1e} of the load",
        certificate.load_error
    );
    solver
        .verify()
        .map_err(|error| Failure::new("the last state is no state of contact", error))
}

/// What looks wrong with the end of the path.
fn doubts(job: &Job, solver: &mut Solver) -> Result<Vec<String>, Failure> {
    let pressure = solver
        .max_pressure()
        .map_err(|error| Failure::new("no pressure of the last state", error))?;
    let high = Doubt::of_pressure(pressure, job.e_star());
    let mut doubts: Vec<String> = high.iter().map(Doubt::to_string).collect();
    if let (Some(LoadingEnd::FullContact | LoadingEnd::NoMoreEvents), Some(target)) =
        (solver.end(), job.missed(solver.state()))
    {
        doubts.push(format!(
            "the path ended before {target}. If that was not to be expected, look at the units: E* is {} in Pa",
            scientific(job.e_star(), 3)
        ));
    }
    Ok(doubts)
}

/// States at given loads: exactly there on an exact path, the next event on the paper's, which is
/// not a function of load.
fn rows(rule: ContactRule, states: &[LoadingState], last: &LoadingState) -> Vec<LoadingState> {
    let history: History = states.iter().copied().collect();
    let mut rows: Vec<LoadingState> = Vec::new();
    for load in LOADS.map(|fraction| fraction * last.load) {
        let state = match rule {
            ContactRule::FirstContact | ContactRule::ApproximateOrder => history.at_load(load),
            ContactRule::SmallestGap => states.iter().find(|s| s.load >= load).copied(),
        };
        rows.extend(state.filter(|state| rows.last() != Some(state)));
    }
    rows
}

/// A stiffness, or nothing where there is none.
fn printed(stiffness: Option<f64>) -> String {
    stiffness.map_or_else(|| "-".to_string(), |stiffness| format!("{stiffness:.4e}"))
}

/// Why a path has ended, in words.
fn reason(end: LoadingEnd) -> &'static str {
    match end {
        LoadingEnd::FullContact => "full contact",
        LoadingEnd::Load => "the load asked for",
        LoadingEnd::Approach => "the approach asked for",
        LoadingEnd::MeanGap => "the mean gap asked for",
        LoadingEnd::AreaFraction => "the contact area asked for",
        LoadingEnd::Nodes => "the number of nodes asked for",
        LoadingEnd::Memory => "the memory budget",
        LoadingEnd::NoMoreEvents => "no further node that touches",
        _ => "an error",
    }
}
