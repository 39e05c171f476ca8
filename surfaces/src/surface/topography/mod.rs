//! Heights on their grid, and what they are prepared by.

mod data;
mod filter;
mod level;
mod resample;
mod shape;
mod window;

pub use self::data::Topography;
pub use self::filter::Filter;
pub use self::level::{FittedTrend, Trend, level_measured};
pub use self::resample::Interpolation;
pub use self::window::Window;
