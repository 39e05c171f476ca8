//! Stress below the surface (work in progress).

mod body;
mod cells;
mod depth;
mod kernel;
mod load;
mod rectangle;
mod survey;
mod tensor;
mod volume;
mod waves;
mod yielding;

pub use body::Subsurface;
pub use survey::{DepthSurvey, Greatest, Survey};
pub use tensor::{Measure, Stress, StressField};
pub use yielding::FirstYield;
