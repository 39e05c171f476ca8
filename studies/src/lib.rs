//! What several studies need: fits, spreads, and where time and memory went.

pub mod line;
pub mod peak_memory;
pub mod phases;
pub mod spread;
