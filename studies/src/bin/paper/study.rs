//! The rough surfaces under all loads, every seed.

use crate::options::Options;
use crate::run::{Point, Run, punch_stiffness};
use crate::surfaces::{PAPER_NODES, Rough};
use asperity_cli::outcome::Failure;
use asperity_studies::spread::Spread;

/// One surface, all seeds.
pub(crate) struct Family {
    pub(crate) rough: Rough,
    /// Rms gradient of the sum of waves: the one that all results are reduced with.
    pub(crate) gradient: f64,
    /// The same by central differences on the paper's mesh.
    pub(crate) central_paper: f64,
    pub(crate) runs: Vec<Run>,
}

impl Family {
    /// A number of every run that has it.
    pub(crate) fn spread(&self, value: impl Fn(&Run) -> Option<f64>) -> Spread {
        Spread::of(self.runs.iter().filter_map(value))
    }

    /// A number of the state at an area.
    pub(crate) fn at_area(&self, area: f64, value: impl Fn(&Point) -> f64) -> Spread {
        self.spread(|run| run.at_area(area).map(|point| value(&point)))
    }

    /// A number of the state under the greatest load.
    pub(crate) fn at_end(&self, value: impl Fn(&Point) -> f64) -> Spread {
        self.spread(|run| run.last().map(&value))
    }
}

/// All surfaces.
pub(crate) struct Study {
    pub(crate) nodes: usize,
    pub(crate) seeds: u64,
    pub(crate) path_nodes: usize,
    pub(crate) families: Vec<Family>,
    /// K Sq / A₀E* of the rigid flat punch on this mesh.
    pub(crate) punch: f64,
}

impl Study {
    /// Computes all runs and writes them into a directory, or reads those that are there.
    pub(crate) fn new(options: &Options) -> Result<Self, Failure> {
        let (nodes, seeds) = (usize::from(options.nodes), u64::from(options.seeds));
        let path_nodes = options.path_nodes as usize;
        let directory = &options.out;
        let failed = |error: asperity::Error| Failure::new("the rough surfaces", error);
        eprintln!("rough surfaces: {nodes} x {nodes} nodes, {seeds} seeds each");
        let mut families = Vec::new();
        for rough in Rough::ALL {
            let mut runs = Vec::new();
            for seed in 1..=seeds {
                let found =
                    options.reuse.then(|| Run::read(directory, rough, nodes, seed)).flatten();
                let run = match found {
                    Some(run) => run,
                    None => {
                        let run = Run::new(rough, seed, nodes, path_nodes)?;
                        run.write(directory, nodes)?;
                        run
                    }
                };
                runs.push(run);
            }
            families.push(Family {
                rough,
                gradient: rough.gradient(nodes).map_err(failed)?,
                central_paper: rough.central_gradient(PAPER_NODES).map_err(failed)?,
                runs,
            });
        }
        Ok(Self {
            nodes,
            seeds,
            path_nodes,
            families,
            punch: punch_stiffness(nodes).map_err(failed)?,
        })
    }
}
