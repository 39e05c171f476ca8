//! Ctrl-C, and what a batch system sends before it ends a job.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use asperity_cli::outcome::Failure;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// What a shell says of a program that Ctrl-C has ended.
pub(super) const EXIT_CODE: u8 = 128 + SIGINT as u8;

/// The end of a path of many, whose folder is removed: the next time it begins anew.
pub(super) fn of_one_of_many() -> Failure {
    Failure::with_code("interrupted", EXIT_CODE)
}

/// Whether a signal ends the program at once. While a path is followed and written it does not: the first one asks the
/// path to stop, and the second ends the program.
#[derive(Clone)]
pub(super) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Listens to signals, which still end the program at once.
    pub(super) fn listen() -> Result<Self, Failure> {
        let ends = Arc::new(AtomicBool::new(true));
        for signal in [SIGINT, SIGTERM] {
            // In this order: the flag that the first signal sets is what the second one finds.
            flag::register_conditional_shutdown(signal, EXIT_CODE.into(), Arc::clone(&ends))
                .and_then(|_| flag::register(signal, Arc::clone(&ends)))
                .map_err(|error| Failure::new("cannot listen to Ctrl-C", error))?;
        }
        Ok(Self(ends))
    }

    /// From here on a signal asks the path to stop.
    pub(super) fn wait(&self) {
        self.0.store(false, Ordering::Relaxed);
    }

    /// Whether the path is asked to stop.
    pub(super) fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// From here on a signal ends the program; returns whether the path was asked to stop.
    pub(super) fn wait_no_longer(&self) -> bool {
        self.0.swap(true, Ordering::Relaxed)
    }
}
