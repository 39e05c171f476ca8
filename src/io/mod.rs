//! Files of heights and other fields.

mod npy;

pub use npy::{read_npy, write_npy};
