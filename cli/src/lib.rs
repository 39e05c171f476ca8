//! What the program `asperity` and the studies of this repository share: charts, numbers for people,
//! and the half-space that a command line asks for.

pub mod axis;
pub mod chart;
pub mod contour;
pub mod field_map;
pub mod half_space;
pub mod number;
pub mod outcome;
pub mod panel;
pub mod picture;

/// Prints a line. If nobody reads any more (`asperity … | head`), it is lost, and the work goes on.
#[macro_export]
macro_rules! say {
    ($($text:tt)*) => {{
        use std::io::Write as _;
        let _ = writeln!(std::io::stdout(), $($text)*);
    }};
}
