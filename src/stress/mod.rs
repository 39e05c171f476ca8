//! Stress below the surface, under the pressures of a state of a path, of a single load, or any other.
//!
//! | question | items |
//! |---|---|
//! | all six components at a depth | [`Subsurface::at_depth`], [`StressField`] |
//! | von Mises' and Tresca's stress, greatest shear and tension | [`Measure`], [`StressField::map`] |
//! | where each is greatest, over all depths | [`Subsurface::survey`] |
//! | under which load a body begins to yield, and each of its materials | [`Subsurface::first_yield`], [`Subsurface::first_yields`] |
//! | with friction, or tractions along the surface | [`Subsurface::sliding`], [`Subsurface::under_traction`] |
//! | a volume for ParaView | [`Subsurface::write_volume`] |
//!
//! ```
//! use asperity::stress::{Measure, Subsurface};
//! use asperity::{Boussinesq, Grid, LoadingSolver, SelfAffine};
//!
//! # fn main() -> Result<(), asperity::Error> {
//! let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
//! let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space)
//!     .max_load(500.0)
//!     .build()?;
//! let history = path.run()?;
//! let steel = Subsurface::of(&half_space, 0.3)?;
//! let greatest = steel.survey(&path.fields()?.pressure, None)?.greatest(Measure::VonMises);
//! println!("{} Pa at a depth of {} m", greatest.value, greatest.depth);
//! if let Some(first) = steel.first_yield(&mut path, &history, 1e9)? {
//!     println!("yields first under {} N", first.state.contact.load);
//! }
//! # assert!(greatest.value > 1e9 && greatest.depth > 0.0);
//! # Ok(())
//! # }
//! ```
//!
//! # Conventions
//!
//! Tension is positive. x and y run along the surface, z into the body; stresses are those below the centres of the
//! cells. Pressure is uniform on each cell, unless the kernel is one of [waves](crate::Spectral). On the interface of
//! two layers stresses are those of the upper. The page `docs/stress_below_the_surface.md` says what the stresses mean
//! and what they were compared with.
//!
//! # References
//!
//! A. E. H. Love, Phil. Trans. R. Soc. A 228 (1929) 377, for rectangles under pressure; K. L. Johnson, *Contact
//! Mechanics*, §3.2 and §3.6, for point forces; S. Liu & Q. Wang, J. Tribol. 124 (2002) 36, for stresses by fast
//! Fourier transform.

mod across;
mod body;
mod cells;
mod depth;
mod kernel;
mod lanes;
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
