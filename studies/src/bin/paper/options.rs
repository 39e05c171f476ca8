//! The command line.

use std::path::PathBuf;

use clap::Parser;

/// Every figure of Zhang, Zhang & Jin, Friction 8(5), 970-981 (2020), computed again: pictures, the
/// numbers behind them, and a verdict on each number that the paper states.
#[derive(Debug, Parser)]
#[command(name = "paper")]
pub(crate) struct Options {
    /// Only this figure; may be given several times [default: all]
    #[arg(long, value_name = "3..8", value_parser = clap::value_parser!(u8).range(3..=8))]
    pub(crate) figure: Vec<u8>,

    /// Nodes a side of the rough surfaces; the paper has 512
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u16).range(16..=4096))]
    pub(crate) nodes: u16,

    /// Seeds of each rough surface, from 1
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u8).range(1..))]
    pub(crate) seeds: u8,

    /// Nodes in contact at which the path ends and fixed loads take over: 4n² bytes
    #[arg(long, value_name = "N", default_value_t = 13_107, value_parser = clap::value_parser!(u32).range(2..))]
    pub(crate) path_nodes: u32,

    /// Directory for the files, made if it is not there
    #[arg(long, value_name = "DIR", default_value = "out/paper")]
    pub(crate) out: PathBuf,

    /// Take the runs that --out holds already of these surfaces, seeds and nodes, instead of computing them
    #[arg(long)]
    pub(crate) reuse: bool,

    /// path.csv of `asperity path --nodes N --short-cutoff 78.125e-6 --e-star 1 --max-area-fraction 1`: draw it and
    /// report on it as well
    #[arg(long, value_name = "FILE.csv", conflicts_with = "figure")]
    pub(crate) whole_path: Option<PathBuf>,

    /// Also write the report into this file, between its markers, and its pictures into images/
    /// next to it; needs all figures
    #[arg(long, value_name = "FILE.md", conflicts_with = "figure")]
    pub(crate) report: Option<PathBuf>,
}

impl Options {
    /// Whether a figure is wanted.
    pub(crate) fn wants(&self, figure: u8) -> bool {
        self.figure.is_empty() || self.figure.contains(&figure)
    }
}
