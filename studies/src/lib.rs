//! What several studies need: fits, spreads, sections of pages, main functions, the paper's loading path, and where
//! time and memory went.

pub mod contact_area;
pub mod findings;
pub mod golden;
pub mod line;
pub mod order;
pub mod page;
pub mod peak_memory;
pub mod phases;
pub mod smallest_gap;
pub mod spread;
pub mod study;
