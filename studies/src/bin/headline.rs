//! How close the paper's headline case comes to the limit of the machine.
//!
//! A sphere on 256 × 256 nodes up to a contact fraction of π/16, 12 867 nodes: "about 20 min" in the
//! paper. Prints where the time goes, what a plain matrix product of the same work takes, and how much
//! faster the path is than the paper's own procedure; the last line is for programs.

use std::error::Error;
use std::f64::consts::PI;
use std::time::Instant;

use asperity::loading::LoadingBuilder;
use asperity::surface::Paraboloid;
use asperity::updater::RecursiveCholesky;
use asperity::{Boussinesq, Grid, InfluenceKernel, LoadingSolver, LoadingState};
use asperity_studies::peak_memory::peak_memory;
use asperity_studies::phases;
use asperity_studies::smallest_gap::SmallestGap;
use clap::Parser;
use faer::{Accum, Mat, Par};
use indicatif::{ProgressBar, ProgressStyle};

/// Times the exact path of a sphere up to a contact fraction of π/16.
#[derive(Parser)]
struct Options {
    /// Nodes a side of the headline case.
    #[arg(long, default_value_t = 256)]
    nodes: usize,
    /// Nodes a side of the case on which the paper's procedure is timed.
    #[arg(long, default_value_t = 192)]
    paper_nodes: usize,
    /// Time the paper's procedure on the whole headline case (several minutes).
    #[arg(long)]
    paper_full: bool,
}

/// A sphere on a half-space.
struct Sphere {
    surface: Paraboloid,
    kernel: Boussinesq,
}

impl Sphere {
    fn new(nodes: usize) -> Result<Self, asperity::Error> {
        Ok(Self {
            surface: Paraboloid::new(1.0)?,
            kernel: Boussinesq::new(Grid::square(nodes, 1e-2)?, 1.0)?,
        })
    }

    fn path(&self) -> LoadingBuilder<'_, RecursiveCholesky> {
        LoadingSolver::builder(&self.surface, &self.kernel)
            .updater(RecursiveCholesky::new())
            .max_area_fraction(PI / 16.0)
    }

    /// The same by the paper's procedure.
    fn paper(&self) -> Result<SmallestGap, asperity::Error> {
        let most_nodes = self.kernel.grid().nodes_in(PI / 16.0)?;
        SmallestGap::new(&self.surface, &self.kernel, most_nodes)
    }
}

/// A path that was run to its end.
struct Run<P> {
    path: P,
    nodes: usize,
    seconds: f64,
}

fn run<P: Iterator<Item = Result<LoadingState, asperity::Error>>>(
    name: &'static str,
    grid_nodes: usize,
    build: impl FnOnce() -> Result<P, asperity::Error>,
) -> Result<Run<P>, asperity::Error> {
    let expected = (grid_nodes * grid_nodes) as f64 * PI / 16.0;
    let style = ProgressStyle::with_template("{msg:>24} {wide_bar} {pos}/{len} nodes {elapsed}");
    let bar = ProgressBar::new(expected as u64)
        .with_message(name)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let start = Instant::now();
    let mut path = build()?;
    let mut nodes = 0;
    for state in path.by_ref() {
        nodes = state?.contact.contact_nodes;
        if nodes % 64 == 0 {
            bar.set_position(nodes as u64);
        }
    }
    let seconds = start.elapsed().as_secs_f64();
    bar.finish_and_clear();
    Ok(Run { path, nodes, seconds })
}

/// Floating-point operations per second of a plain product of square matrices, on all threads.
fn gemm_rate() -> f64 {
    const SIDE: usize = 3000;
    let value = |i: usize, j: usize| ((i * 31 + j * 17) % 101) as f64 / 101.0;
    let a = Mat::from_fn(SIDE, SIDE, value);
    let b = Mat::from_fn(SIDE, SIDE, |i, j| value(j, i));
    let mut c = Mat::zeros(SIDE, SIDE);
    let mut best = f64::INFINITY;
    for _ in 0..4 {
        let start = Instant::now();
        let threads = Par::rayon(0);
        faer::linalg::matmul::matmul(c.as_mut(), Accum::Replace, &a, &b, 1.0, threads);
        best = best.min(start.elapsed().as_secs_f64());
    }
    2.0 * (SIDE as f64).powi(3) / best
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();

    let sphere = Sphere::new(options.nodes)?;
    let exact = run("path", options.nodes, || sphere.path().build())?;
    let peak = peak_memory().unwrap_or(f64::NAN);
    let n = exact.nodes as f64;
    let flops = n.powi(3) / 3.0;
    let factor_bytes = 4.0 * n * n;
    println!(
        "sphere, {0} x {0} nodes, contact fraction pi/16: {1} nodes in {2:.2} s, {3} thread(s)",
        options.nodes,
        exact.nodes,
        exact.seconds,
        rayon::current_num_threads()
    );
    let updater = exact.path.updater().ok_or("the factor is gone")?;
    phases::print(exact.path.timings(), updater.timings());
    println!(
        "  {:.1} GFLOP/s as n^3/3 a second; peak memory {:.0} MB, factor 4n^2 = {:.0} MB",
        flops / exact.seconds / 1e9,
        peak / 1e6,
        factor_bytes / 1e6
    );
    drop(exact.path);

    let gemm = gemm_rate();
    let gemm_seconds = flops / gemm;
    println!(
        "plain GEMM: {:.1} GFLOP/s, n^3/3 in {gemm_seconds:.2} s; the path takes {:.2} times that",
        gemm / 1e9,
        exact.seconds / gemm_seconds
    );

    let side = if options.paper_full { options.nodes } else { options.paper_nodes };
    let sphere = Sphere::new(side)?;
    let ours = if options.paper_full {
        exact.seconds
    } else {
        run("path, smaller case", side, || sphere.path().build())?.seconds
    };
    let paper = run("the paper's procedure", side, || sphere.paper())?;
    let speedup = paper.seconds / ours;
    println!(
        "the paper's procedure, {side} x {side} nodes: {} nodes in {:.1} s, ours in {ours:.2} s: \
         {speedup:.1} times faster",
        paper.nodes, paper.seconds
    );

    println!(
        "nodes={} seconds={:.3} gemm_seconds={gemm_seconds:.3} ratio_to_gemm={:.3} \
         speedup_over_paper={speedup:.1} peak_over_4n2={:.3}",
        exact.nodes,
        exact.seconds,
        exact.seconds / gemm_seconds,
        peak / factor_bytes
    );
    Ok(())
}
