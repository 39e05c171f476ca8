//! What several studies need: fits, spreads, sections of pages, and where time and memory went.

pub mod contact_area;
pub mod findings;
pub mod line;
pub mod order;
pub mod page;
pub mod peak_memory;
pub mod phases;
pub mod spread;
