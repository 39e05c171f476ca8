//! How many depths are done.

use std::time::Duration;

use asperity_cli::number::{counted, quantity};
use asperity_cli::speech;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A line that counts depths, and is gone at its end.
pub(super) struct Progress(ProgressBar);

impl Progress {
    pub(super) fn new() -> Self {
        let bar = ProgressBar::new_spinner();
        if let Ok(style) = ProgressStyle::with_template("{spinner:.blue} {msg}  {elapsed}") {
            bar.set_style(style);
        }
        if speech::is_quiet() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(bar)
    }

    /// One more is done.
    pub(super) fn passed(&self, depth: f64) {
        self.0.inc(1);
        let done = counted(self.0.position() as usize, "depth");
        self.0.set_message(format!("{done}, the last at {}", quantity(depth, "m", 3)));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
