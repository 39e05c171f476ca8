//! The short table, and how exact the last state is.

use asperity::loading::History;
use asperity::updater::LinearUpdater;
use asperity::{ContactRule, ContactState, InfluenceKernel, LoadingSolver, Surface};

use super::job::Job;
use asperity_cli::outcome::Failure;

/// Loads of the rows, as fractions of the last.
const LOADS: [f64; 10] = [1e-4, 1e-3, 0.01, 0.03, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0];

/// Prints rows at loads spread over the path, and the certificate of its last state.
pub(super) fn print<S: Surface, K: InfluenceKernel, U: LinearUpdater>(
    job: &Job,
    solver: &mut LoadingSolver<S, K, U>,
    states: &[ContactState],
    seconds: f64,
) -> Result<(), Failure> {
    let Some(last) = states.last() else {
        return Ok(());
    };
    println!("{} states in {seconds:.2} s", states.len());
    println!();
    let rms_height = job.heights().rms_height();
    let (length, approach, gap) = if rms_height > 0.0 {
        (rms_height, "approach/Sq", "mean gap/Sq")
    } else {
        (1.0, "approach [m]", "mean gap [m]")
    };
    println!(
        "{:>8} {:>12} {:>12} {:>12} {:>12} {:>12} {:>12} {:>12} {:>12}",
        "nodes", "load [N]", "p_mean/E*", "A/A0", approach, gap, "K [N/m]", "K_i [N/m]", "p_max/E*"
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
        println!(
            "{:>8} {:>12.4e} {:>12.4e} {:>12.4e} {:>12.4e} {:>12.4e} {:>12} {:>12.4e} {:>12.4e}",
            state.contact_nodes,
            state.load,
            state.mean_pressure() / job.e_star(),
            state.contact_area_fraction,
            state.approach / length,
            state.mean_gap / length,
            // Nothing where there is none.
            state
                .contact_stiffness
                .map_or_else(|| "-".to_string(), |stiffness| format!("{stiffness:.4e}")),
            state.interfacial_stiffness,
            greatest / job.e_star(),
        );
    }
    failed?;

    let certificate = solver
        .certificate()
        .map_err(|error| Failure::new("no certificate", error))?;
    println!();
    println!("certificate of the last state, from its pressure alone (0 would be exact):");
    println!(
        "  least pressure in contact   {:>10.1e} of the mean pressure there",
        certificate.least_pressure
    );
    println!(
        "  least gap out of contact    {:>10.1e} of Sq",
        certificate.least_gap
    );
    println!(
        "  greatest gap in contact     {:>10.1e} of Sq",
        certificate.greatest_contact_gap
    );
    println!(
        "  sum of pressures less load  {:>10.1e} of the load",
        certificate.load_error
    );
    Ok(())
}

/// States at given loads: exactly there on an exact path, the next event on the paper's, which is
/// not a function of load.
fn rows(rule: ContactRule, states: &[ContactState], last: &ContactState) -> Vec<ContactState> {
    let history: History = states.iter().copied().collect();
    let mut rows: Vec<ContactState> = Vec::new();
    for load in LOADS.map(|fraction| fraction * last.load) {
        let state = match rule {
            ContactRule::FirstContact => history.at_load(load),
            ContactRule::SmallestGap => states.iter().find(|s| s.load >= load).copied(),
        };
        rows.extend(state.filter(|state| rows.last() != Some(state)));
    }
    rows
}
