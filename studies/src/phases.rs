//! Where the time of a path went.

use std::time::Duration;

use asperity::loading::LoadingTimings;
use asperity::updater::CholeskyTimings;

/// Prints the phases of a path with a Cholesky updater, a line each.
pub fn print(loading: LoadingTimings, updater: CholeskyTimings) {
    for (name, time) in [
        ("forward substitution", updater.forward),
        ("Schur complements", updater.schur),
        ("solutions on the contact", updater.solve),
        ("rows of the factor", updater.commit),
        ("displacements for the choice of nodes", loading.convolution),
        ("choice of the watched nodes", loading.choice),
        ("events", loading.events),
    ] {
        line(name, time);
    }
    println!("  {} windows", loading.windows);
}

fn line(name: &str, time: Duration) {
    println!("  {name:<38} {:8.3} s", time.as_secs_f64());
}
