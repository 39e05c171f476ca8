//! `asperity info`: what is in a file of an instrument.
//!
//! Prints what was found, and draws `surface_map.png` and `surface_statistics.png`.

mod picture;
mod summary;

use std::path::PathBuf;

use asperity::Doubt;
use asperity::io::MeasuredSurface;
use asperity::surface::{Estimate, Topography, Trend, Window};
use asperity_cli::number::quantity;
use asperity_cli::outcome::{Failure, Outcome};
use asperity_cli::panel;
use asperity_cli::say;
use clap::Args;
use serde_json::{Value, json};

use crate::reading::Reading;
use summary::Summary;

/// Greatest Hurst exponent that a fit is told with: above 1, but for its error, a map is not self-affine.
const HIGHEST_HURST: f64 = 1.2;

/// What is in a file of an instrument: size, units, missing nodes, roughness, and pictures of it
#[derive(Debug, Args)]
pub(crate) struct Options {
    /// Heights in a file of an instrument (.npy, .gsf, .gwy, .sdf, .x3p, .sur, .al3d, .vk4, text)
    #[arg(value_name = "FILE")]
    file: PathBuf,

    #[command(flatten)]
    reading: Reading,

    /// Print one JSON object with format, nx, ny, side_x, side_y, missing, min, max, mean, sq and rms_gradient (metres; null where
    /// the file does not say), and draw nothing unless --out is given
    #[arg(long)]
    json: bool,

    /// Directory for the pictures, made if it is not there [default: out]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Reads the file, says what is in it, and draws it.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let measured = options.reading.measured(&options.file)?;
    let summary = Summary::of(&measured);
    let surface = whole(&measured);
    if options.json {
        say!("{}", object(&measured, &summary));
    } else {
        print(options, &measured, &summary, surface.as_ref())?;
    }
    let directory = match (&options.out, options.json) {
        (Some(directory), _) => directory.clone(),
        (None, false) => PathBuf::from("out"),
        (None, true) => return Ok(()),
    };
    panel::register_font()?;
    std::fs::create_dir_all(&directory)
        .map_err(|error| Failure::new(format!("cannot make {}", directory.display()), error))?;
    let mut outcome = Outcome::default();
    outcome.written(picture::map(&measured, &summary, &directory));
    let levelled = surface.as_ref().map(|(_, levelled)| levelled);
    outcome.written(picture::statistics(
        &measured, &summary, levelled, &directory,
    ));
    if options.json {
        return outcome.finish_quietly();
    }
    outcome.finish()
}

/// The surface without holes, as it is and without its tilt; `None` where the file does not give its size.
fn whole(measured: &MeasuredSurface) -> Option<(Topography, Topography)> {
    let filled = measured.clone().fill_missing().ok()?;
    let surface = filled.topography().ok()?;
    let levelled = surface.level(Trend::Plane).ok()?;
    Some((surface, levelled))
}

/// One object for programs.
fn object(measured: &MeasuredSurface, summary: &Summary) -> Value {
    let (nx, ny) = measured.heights.shape();
    let side = |n: usize, cell: f64| n as f64 * cell;
    json!({
        "format": measured.format.name(),
        "title": measured.title,
        "nx": nx,
        "ny": ny,
        "side_x": measured.cell.map(|(dx, _)| side(nx, dx)),
        "side_y": measured.cell.map(|(_, dy)| side(ny, dy)),
        "missing": measured.missing,
        "min": summary.min,
        "max": summary.max,
        "mean": summary.mean,
        "sq": summary.sq,
        "rms_gradient": summary.rms_gradient,
        "notes": measured.notes,
    })
}

/// Lines for people.
fn print(
    options: &Options,
    measured: &MeasuredSurface,
    summary: &Summary,
    surface: Option<&(Topography, Topography)>,
) -> Result<(), Failure> {
    let length = |value: f64| quantity(value, "m", 5);
    say!("file          {}", options.file.display());
    say!("found         {measured}");
    if measured.channels.len() > 1 {
        say!("maps          {}", measured.channels.join(", "));
    }
    if !measured.title.is_empty() {
        say!("title         {}", measured.title);
    }
    for note in &measured.notes {
        say!("note          {note}");
    }
    say!(
        "heights       {} to {}, mean {}, Sq {}",
        length(summary.min),
        length(summary.max),
        length(summary.mean),
        length(summary.sq)
    );
    if let Some(gradient) = summary.rms_gradient {
        say!("rms gradient  {gradient:.4}");
    }
    let Some((surface, levelled)) = surface else {
        say!("no statistics: the file does not give the size of the surface; give it with --side");
        return Ok(());
    };
    let tilt = surface.map().rms_height().powi(2) - levelled.map().rms_height().powi(2);
    say!(
        "tilt          {} rms; without it Sq {}",
        length(tilt.max(0.0).sqrt()),
        length(levelled.map().rms_height())
    );
    say!(
        "shape         Ssk {:.3}, Sku {:.3} (normal: 0, 3)",
        levelled.map().skewness(),
        levelled.map().kurtosis()
    );
    // Measured maps do not repeat: without a window their borders make a power law of their own.
    let windowed = levelled.window(Window::Hann);
    if let Ok(fit) = windowed.and_then(|windowed| windowed.fit_self_affine()) {
        let estimate = |name: &str, estimate: Option<Estimate>| {
            estimate.map_or_else(String::new, |estimate| {
                format!(", {name} {}", length(estimate.value))
            })
        };
        if (0.0..=HIGHEST_HURST).contains(&fit.hurst.value) {
            say!(
                "spectrum      Hurst exponent {:.2} ± {:.2}{}{}",
                fit.hurst.value,
                fit.hurst.standard_error,
                estimate("roll-off at", fit.rolloff_wavelength),
                estimate("short cut-off at", fit.short_cutoff_wavelength)
            );
        } else {
            say!("spectrum      not that of a self-affine surface");
        }
    }
    for doubt in Doubt::of_surface(surface) {
        say!("warning       {doubt}");
    }
    Ok(())
}
