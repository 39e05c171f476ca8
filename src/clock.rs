//! How long work takes, where there is a clock.

use std::time::Duration;
#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
use std::time::Instant;

/// Runs from when it was made.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stopwatch(
    #[cfg(not(all(target_family = "wasm", target_os = "unknown")))] Instant,
);

impl Stopwatch {
    /// Begins now.
    pub(crate) fn start() -> Self {
        Self(
            #[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
            Instant::now(),
        )
    }

    /// What has passed since; zero in a browser, where the standard library has no clock and asking for one panics.
    pub(crate) fn elapsed(self) -> Duration {
        #[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
        return self.0.elapsed();
        #[cfg(all(target_family = "wasm", target_os = "unknown"))]
        Duration::ZERO
    }
}
