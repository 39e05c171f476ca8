//! The loading path: against other solvers, at every event, at its ends, and between events.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

#[path = "../common/mod.rs"]
mod common;

mod areas;
mod continued;
mod ends;
mod flat;
mod foreign_states;
mod handover;
mod hardness;
mod hardness_without_factor;
mod inexact_updaters;
mod layers;
mod long_cells;
mod patches_of_tamaas;
mod path_properties;
mod periodic_paths;
mod physical_mean;
mod pinned;
mod problems;
mod records;
#[cfg(feature = "io")]
mod records_on_disk;
mod reference_paths;
mod releases;
mod resumed;
mod resumed_coats;
mod semi_periodic;
mod small_without_factor;
mod stiff_coats;
mod strips;
mod thick_stiff_coats;
mod ties;
mod undisturbed;
mod where_paths_stop;
mod without_factor;
