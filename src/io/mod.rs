//! Files.

#[cfg(feature = "npy")]
mod npy;

#[cfg(feature = "npy")]
pub use npy::{read_npy, write_npy};
