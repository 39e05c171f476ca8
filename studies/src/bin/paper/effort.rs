//! Memory and time of paths, against what the paper says of them.

use std::f64::consts::PI;
use std::time::Instant;

use asperity::surface::Paraboloid;
use asperity::{Boussinesq, LoadingSolver, RecursiveCholesky};

use crate::surfaces::{E_STAR, Rough, grid};
use asperity_cli::outcome::Failure;

/// The meshes that the paper calls practical, and the areas.
const MESHES: [usize; 4] = [128, 256, 512, 1024];
const AREAS: [f64; 2] = [0.01, 0.1];
/// Longer paths than to so many nodes take minutes.
const MOST_NODES: usize = 12_000;
/// The headline case of the paper.
const HEADLINE: usize = 256;
/// A path to an area on a mesh.
pub(crate) struct Path {
    pub(crate) mesh: usize,
    pub(crate) area: f64,
    pub(crate) contact: usize,
    /// Half of the influence matrix, bytes.
    pub(crate) factor: f64,
    /// Wall time, if it was run.
    pub(crate) seconds: Option<f64>,
}

pub(crate) struct Effort {
    pub(crate) paths: Vec<Path>,
    /// Nodes of the headline case, its time, and the bytes it holds at its end over those of the whole matrix.
    pub(crate) headline: (usize, f64, f64),
    /// Multiplications of a step of the paper's recursion with as many nodes, over those of a step in which y₁ and y₂
    /// are solved for anew.
    pub(crate) recursion: f64,
}

impl Effort {
    /// Runs the paths with at most [`MOST_NODES`] in contact, and a tenth of a mesh of `nodes` a side.
    pub(crate) fn new(nodes: usize) -> Result<Self, Failure> {
        let failed = |error: asperity::Error| Failure::new("the paths for memory and time", error);
        let mut paths = Vec::new();
        for mesh in MESHES {
            for area in AREAS {
                let contact = (area * (mesh * mesh) as f64) as usize;
                let run = contact <= MOST_NODES.min(nodes * nodes / 10);
                let seconds = run.then(|| time(mesh, contact)).transpose();
                paths.push(Path {
                    mesh,
                    area,
                    contact,
                    factor: 4.0 * (contact as f64).powi(2),
                    seconds: seconds.map_err(failed)?,
                });
            }
        }
        let headline = headline().map_err(failed)?;
        Ok(Self {
            paths,
            headline,
            recursion: recursion(headline.0 as f64),
        })
    }
}

/// Seconds of the path to so many nodes, Table 1, seed 1.
fn time(mesh: usize, contact: usize) -> Result<f64, asperity::Error> {
    eprintln!("time: {contact} nodes of {mesh} x {mesh}");
    let grid = grid(mesh)?;
    let heights = Rough::Table1.heights(&grid, 1)?;
    let start = Instant::now();
    let kernel = Boussinesq::new(grid, E_STAR)?;
    let path = LoadingSolver::builder(&heights, &kernel).max_nodes(contact);
    for state in path.build()? {
        state?;
    }
    Ok(start.elapsed().as_secs_f64())
}

/// The sphere to a contact of π/16 of its mesh.
fn headline() -> Result<(usize, f64, f64), asperity::Error> {
    eprintln!("time: the headline case");
    let start = Instant::now();
    let kernel = Boussinesq::new(grid(HEADLINE)?, E_STAR)?;
    let sphere = Paraboloid::new(1.0)?;
    let mut path = LoadingSolver::builder(&sphere, &kernel)
        .updater(RecursiveCholesky::new())
        .max_area_fraction(PI / 16.0)
        .build()?;
    let mut nodes = 0;
    for state in path.by_ref() {
        nodes = state?.contact_nodes;
    }
    let matrix = 8.0 * (nodes as f64).powi(2);
    let seconds = start.elapsed().as_secs_f64();
    Ok((nodes, seconds, path.bytes() as f64 / matrix))
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
