//! Contact of viscoelastic bodies: against an independent solver in steps of time, closed forms, and itself on another
//! way.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

mod any_history;
mod cost;
mod cycles;
mod ends;
mod growing;
mod hostile;
mod prony;
mod references;
mod sphere;
mod stepping;
mod unloading;
