//! What is printed.

use asperity::creep::{ControlHistory, CreepState};
use asperity::{BedError, CreepError, Error};
use asperity_cli::number::{at_least, quantity, significant};
use asperity_cli::{say, units};

use super::Options;
use super::course::Task;
use super::cycles::Sweep;
use super::followed::{Followed, Method};
use crate::columns::{self, Column};
use crate::passages::Passage;

/// About as many lines as a table has.
const LINES: usize = 10;

pub(super) fn print(
    options: &Options,
    task: &Task,
    followed: &Followed,
    passages: &[Passage<f64>],
    sweep: Option<&Result<Sweep, Error>>,
) {
    bodies(task);
    course(options, task);
    method(followed);
    table(&followed.states);
    for passage in passages {
        match passage.at {
            Some(time) => say!("{:18} from t = {} on", passage.name, units::time(time)),
            None => say!("{:18} not in this time", passage.name),
        }
    }
    if followed.recedes.is_some() {
        say!("(for the first time: contact that recedes opens again)");
    }
    if let Some(sweep) = sweep {
        cycles(sweep);
    }
}

fn bodies(task: &Task) {
    let term = |time: f64, share: f64| format!("{share} in {}", units::time(time));
    let terms = task.prony.relaxation_terms().iter().map(|t| term(t.time, t.amount));
    let terms: Vec<String> = terms.collect();
    let left = match task.prony.equilibrium_modulus() {
        0.0 => "nothing is left in the end: the bodies flow".to_string(),
        left => format!("{} of it is left in the end", significant(left, 4)),
    };
    match terms.len() {
        0 => say!("bodies     elastic: no part of the modulus relaxes"),
        _ => say!("bodies     of the modulus E* of the path relax {}; {left}", terms.join(", ")),
    }
}

fn course(options: &Options, task: &Task) {
    let put_on = match options.ramp {
        Some(duration) => format!("within {}", units::time(duration)),
        None => "at once".to_string(),
    };
    let end = units::time(task.end);
    match (options.load, options.approach, &options.history) {
        (Some(load), _, _) => {
            say!(
                "history    load of {} put on {put_on} and held, to {end}",
                quantity(load, "N", 4)
            );
        }
        (_, Some(approach), _) => {
            let approach = quantity(approach, "m", 4);
            say!("history    approach of {approach} taken {put_on} and held, to {end}");
        }
        (_, _, Some(file)) => {
            let what = match task.course {
                ControlHistory::Load(_) => "load",
                ControlHistory::Approach(_) => "approach",
            };
            let corners = task.course.corners().corners().len();
            say!("history    {what} with {corners} corners from {}, to {end}", file.display());
        }
        _ => (),
    }
}

fn method(followed: &Followed) {
    match (followed.method, followed.recedes) {
        (Method::Steps { count, halvings, error }, Some(recedes)) => {
            say!("contact    recedes from t = {} on, and is stepped in time", units::time(recedes));
            let halved = match halvings {
                0 => String::new(),
                some => format!(", {some} of them halved"),
            };
            say!(
                "steps      {count}{halved}; they leave an error of about {} of the greatest approach and area",
                significant(error, 1)
            );
        }
        _ => say!(
            "contact    never recedes: it is that of the path at the effective load, in closed form"
        ),
    }
    say!();
}

fn table(states: &[CreepState]) {
    let every = states.len().div_ceil(LINES).max(1);
    let last = states.len().saturating_sub(1);
    let rows = states.iter().enumerate().filter(|(k, _)| k % every == 0 || *k == last);
    let rows: Vec<&CreepState> = rows.map(|(_, state)| state).collect();
    let of = |quantity: fn(&CreepState) -> f64| rows.iter().map(move |state| quantity(state));
    columns::print(&[
        Column::scaled("time", ("s", 1.0), of(|state| state.time)),
        Column::new("effective", "N", of(|state| state.effective_load)),
        Column::new("load", "N", of(|state| state.load)),
        Column::percent("area", of(|state| state.contact_area_fraction)),
        Column::new("approach", "m", of(|state| state.approach)),
        Column::new("mean gap", "m", of(|state| state.mean_gap)),
    ]);
    say!();
    say!("effective: the elastic load of the same contact, as long as it grows");
    say!();
}

fn cycles(sweep: &Result<Sweep, Error>) {
    say!();
    match sweep {
        Ok(sweep) => {
            let Some(worst) = sweep.worst() else {
                say!("cycles     elastic bodies lose nothing");
                return;
            };
            say!(
                "cycles     of ±{} around the load lose most at {}: {}, loss factor {}",
                quantity(worst.amplitude, "N", 3),
                quantity(1.0 / worst.period, "Hz", 2),
                quantity(worst.dissipation, "J", 3),
                significant(worst.loss_factor, 3)
            );
        }
        Err(error) => say!("cycles     {}", no_cycles(error)),
    }
}

/// Why there are no cycles.
pub(super) fn no_cycles(error: &Error) -> String {
    match error {
        Error::Creep(CreepError::NoSteadyCycle { .. }) => {
            "none are steady, for the bodies flow".to_string()
        }
        // Slow cycles press as an elastic body that has relaxed.
        Error::Bed(BedError::PathEndsBefore { quantity: "load", value, end }) => format!(
            "not drawn: slow ones need the path up to {} N, and it ends at {}: continue it with --max-load, or take a smaller --cycle-amplitude",
            at_least(*value, 4),
            quantity(*end, "N", 4)
        ),
        error => format!("not drawn: {error}"),
    }
}

/// That few nodes go in and out of contact in the cycle that loses most.
pub(super) fn coarse(sweep: &Sweep) -> Option<String> {
    let nodes = match sweep.moving_nodes {
        1 => "1 node goes".to_string(),
        count => format!("{count} nodes go"),
    };
    sweep.is_coarse().then(|| {
        format!(
            "in such a cycle only {nodes} in or out of contact; the part of the loss that is theirs depends on the grid"
        )
    })
}
