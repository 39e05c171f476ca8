//! Memory of paths, and operations of a step, against what the paper says of them.

use std::f64::consts::PI;

use asperity::surface::Paraboloid;
use asperity::{Boussinesq, LoadingSolver, RecursiveCholesky};

use crate::surfaces::{E_STAR, grid};
use asperity_cli::outcome::Failure;

/// The largest mesh that the paper calls practical, and the areas.
const MESH: usize = 1024;
const AREAS: [f64; 2] = [0.01, 0.1];
/// The headline case of the paper.
const HEADLINE: usize = 256;

pub(crate) struct Effort {
    /// Bytes of the factor of a path to each area on the largest mesh: half of the influence matrix.
    pub(crate) factors: [f64; 2],
    /// Bytes that a path to the headline case holds at its end over those of the whole matrix.
    pub(crate) held: f64,
    /// Multiplications of a step of the paper's recursion with as many nodes, over those of a step in which y₁ and y₂
    /// are solved for anew.
    pub(crate) recursion: f64,
}

impl Effort {
    pub(crate) fn new() -> Result<Self, Failure> {
        let (nodes, held) =
            headline().map_err(|error| Failure::new("the path for its memory", error))?;
        Ok(Self {
            factors: AREAS.map(|area| 4.0 * (area * (MESH * MESH) as f64).floor().powi(2)),
            held,
            recursion: recursion(nodes as f64),
        })
    }
}

/// The sphere to a contact of π/16 of its mesh: its nodes, and the bytes that are held over those of the matrix.
fn headline() -> Result<(usize, f64), asperity::Error> {
    eprintln!("memory: the headline case");
    let kernel = Boussinesq::new(grid(HEADLINE)?, E_STAR)?;
    let sphere = Paraboloid::new(1.0)?;
    let mut path = LoadingSolver::builder(&sphere, &kernel)
        .updater(RecursiveCholesky::new())
        .max_area_fraction(PI / 16.0)
        .build()?;
    let mut nodes = 0;
    for state in path.by_ref() {
        nodes = state?.contact.contact_nodes;
    }
    let matrix = 8.0 * (nodes as f64).powi(2);
    Ok((nodes, path.bytes() as f64 / matrix))
}

/// The multiplications of a step with n nodes, counted: eqs. (10) to (19) against a new solution for each of y₁ and y₂.
fn recursion(n: f64) -> f64 {
    // One substitution with a triangular factor.
    let substitution = 0.5 * n * (n + 1.0);
    // The new row of the factor, x by the transpose of it, products of c with y₁, y₂ and x, and x times two numbers.
    let step = 2.0 * substitution + 5.0 * n;
    // The new row, and two substitutions for each solution.
    let anew = 5.0 * substitution;
    step / anew
}
