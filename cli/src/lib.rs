//! What the program `asperity` and the studies of this repository share: charts, numbers for people,
//! and the half-space that a command line asks for.

pub use asperity::number;

pub mod axis;
pub mod chart;
pub mod chart_format;
pub mod contour;
pub mod field_map;
pub mod half_space;
pub mod outcome;
pub mod panel;
pub mod picture;
pub mod speech;
pub mod units;

/// Prints a line for people on stdout, see [`speech`].
#[macro_export]
macro_rules! say {
    () => {
        $crate::say!("")
    };
    ($($text:tt)*) => {
        $crate::speech::print(format_args!($($text)*))
    };
}

/// Prints a line for programs on stdout, see [`speech`].
#[macro_export]
macro_rules! answer {
    ($($text:tt)*) => {
        $crate::speech::answer(format_args!($($text)*))
    };
}

/// Prints a line for people on stderr, see [`speech`].
#[macro_export]
macro_rules! note {
    ($($text:tt)*) => {
        $crate::speech::note(format_args!($($text)*))
    };
}
