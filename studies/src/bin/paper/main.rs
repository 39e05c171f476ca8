//! The paper, figure by figure: Zhang, Zhang & Jin, Friction 8(5), 970-981 (2020).
//!
//! ```text
//! cargo run --release -p asperity-studies --bin paper
//! cargo run --release -p asperity-studies --bin paper -- --nodes 512 --seeds 3
//! ```
//!
//! Writes for each of Figs. 3 to 8 a picture and the numbers behind it, and `run_*.csv` with the
//! whole loading of every surface. With `--report paper/figure_by_figure.md`, also a page with each number
//! and statement of the paper, our own numbers with their spread over the seeds, and a verdict by a criterion.
//! With `--whole-path`, the path of every node as well.

mod boundary;
mod candidates;
mod conclusions;
mod criteria;
mod effort;
mod figure3;
mod figure4;
mod figure5;
mod figure6;
mod figure7;
mod figure8;
mod findings;
mod fit;
mod iterations;
mod method;
mod misprint;
mod options;
mod page;
mod plane;
mod polonsky_keer;
mod report;
mod rules;
mod run;
mod sections;
mod statements;
mod study;
mod surfaces;
mod table;
mod whole_path;
mod words;

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use asperity_cli::outcome::Failure;
use asperity_cli::panel;

use effort::Effort;
use iterations::Iterations;
use options::Options;
use report::Report;
use rules::Rules;
use study::Study;
use whole_path::WholePath;

fn main() -> ExitCode {
    asperity_studies::study::main(run)
}

fn run(options: &Options) -> Result<(), Failure> {
    let start = Instant::now();
    let out = &options.out;
    std::fs::create_dir_all(out)
        .map_err(|error| Failure::new(format!("cannot make {}", out.display()), error))?;
    panel::register_font()?;

    let mut written: Vec<PathBuf> = Vec::new();
    let figure3 = options.wants(3).then(|| figure3::make(out)).transpose()?;
    written.extend(figure3.iter().map(|figure| figure.picture.clone()));
    if !(4..=8).any(|figure| options.wants(figure)) {
        return finish(&written, start);
    }
    let study = Study::new(options)?;
    let figure4 = options.wants(4).then(|| figure4::make(&study, out));
    let figure4 = figure4.transpose()?;
    written.extend(figure4.iter().map(|figure| figure.picture.clone()));
    let figure5 = options.wants(5).then(|| figure5::make(&study, out));
    let figure5 = figure5.transpose()?;
    written.extend(figure5.iter().map(|figure| figure.picture.clone()));
    let figure6 = options.wants(6).then(|| figure6::make(&study, out));
    let figure6 = figure6.transpose()?;
    written.extend(figure6.iter().map(|figure| figure.picture.clone()));
    let figure7 = options.wants(7).then(|| figure7::make(&study, out));
    let figure7 = figure7.transpose()?;
    written.extend(figure7.iter().map(|figure| figure.picture.clone()));
    let figure8 = options.wants(8).then(|| figure8::make(&study, out));
    let figure8 = figure8.transpose()?;
    written.extend(figure8.iter().map(|figure| figure.picture.clone()));

    let whole_path = options.whole_path.as_ref();
    let whole_path = whole_path.map(|name| WholePath::new(name, &study, out));
    let whole_path = whole_path.transpose()?;
    written.extend(whole_path.iter().map(|path| path.picture.clone()));

    // The page needs all figures.
    let first = figure3.zip(figure4).zip(figure5);
    let others = figure6.zip(figure7).zip(figure8);
    if let Some((((figure3, figure4), figure5), ((figure6, figure7), figure8))) = first.zip(others)
    {
        let report = Report {
            rules: Rules::new(study.nodes)?,
            boundary: boundary::effect()?,
            iterations: Iterations::new(study.nodes)?,
            effort: Effort::new()?,
            whole_path,
            study,
            figure3,
            figure4,
            figure5,
            figure6,
            figure7,
            figure8,
        };
        written.push(report.write(&out.join("figure_by_figure.md"))?);
        written.push(report.write_criteria(&out.join("criteria.md"))?);
        if let Some(name) = &options.report {
            written.push(report.publish(name)?);
        }
    }
    finish(&written, start)
}

/// Says what was written, and how long it took.
fn finish(written: &[PathBuf], start: Instant) -> Result<(), Failure> {
    for file in written {
        println!("wrote {}", file.display());
    }
    eprintln!("{:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}
