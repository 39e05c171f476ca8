//! `asperity info`: what is in a file of an instrument.
//!
//! Prints what was found, and draws `surface_map.png` and `surface_statistics.png`.

mod picture;
mod summary;

use std::path::PathBuf;

use asperity::Warning;
use asperity::io::MeasuredSurface;
use asperity::surface::{
    self, ArealParameters, Estimate, HeightMap, ProfileParameters, Topography, Trend, Window,
};
use asperity_cli::number::{counted, quantity, significant};
use asperity_cli::outcome::{self, Failure, Outcome, of_program};
use asperity_cli::panel;
use asperity_cli::{answer, say, speech};
use clap::Args;
use serde_json::{Value, json};

use crate::advice;
use crate::reading::Reading;
use crate::values::LENGTH;
use summary::Whole;

/// Greatest Hurst exponent that a fit is told with: above 1, but for its error, a map is not self-affine.
const HIGHEST_HURST: f64 = 1.2;

/// Greatest dispersion that a fit is told with. It is 1 of a random surface, below 10 of most measured ones, and above
/// of steps, lays and scratches, to which a power law says nothing.
const FARTHEST: f64 = 10.0;

/// Describe the file of an instrument: size, units, missing nodes, roughness, pictures, and warnings of what looks
/// wrong
///
/// All figures are those of the surface that would be pressed: missing nodes are filled, and the surface is levelled or
/// inverted if the options say so. Warnings concern units, tilt, and wavelengths that the grid does not resolve.
#[derive(Debug, Args)]
pub(crate) struct Options {
    /// File with heights (`asperity formats` lists what is read)
    #[arg(value_name = "FILE")]
    file: PathBuf,

    #[command(flatten)]
    reading: Reading,

    /// Cut-off wavelength of the roughness of a profile, as 0.8mm, for Ra, Rz, ... [default: Pa, Pz, ... of the
    /// primary profile]
    #[arg(long, value_name = "METRES", value_parser = LENGTH.positive())]
    cutoff: Option<f64>,

    /// Print one JSON object with format, title, understood, nx, ny, side_x, side_y, missing (in the file), min, max,
    /// mean, sa, sq, sz, rms_gradient, texture (of a map without its tilt: ssk, sku, sdr, sal, str, sk, spk, svk, smrk1,
    /// smrk2), profile (of a file with one row or one column: cutoff, evaluation_length, ra, rq, rz, rt, rsk, rku, rsm),
    /// notes and warnings (metres; null where the file does not say), and draw nothing unless --out is given
    #[arg(long)]
    json: bool,

    /// Directory for the pictures, created if it does not exist [default: out]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Reads the file, says what is in it, and draws it.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    if options.json {
        speech::be_quiet();
    }
    let measured = options.reading.measured(&options.file)?;
    let whole = Whole::of(&options.file, &measured, &options.reading)?;
    let profile = profile(&whole, options.cutoff)?;
    let texture = texture(&whole)?;
    let found = (texture.as_ref(), profile.as_ref());
    if options.json {
        answer!("{}", object(&measured, &whole, found));
    } else {
        print(options, &measured, &whole, found)?;
    }
    let Some(directory) = outcome::directory(options.out.as_deref(), options.json) else {
        return Ok(());
    };
    panel::register_font()?;
    outcome::create_folder(directory)?;
    let mut outcome = Outcome::default();
    outcome.written(picture::map(&whole, directory));
    outcome.all_written(picture::statistics(&whole, directory));
    outcome.finish()
}

/// What looks wrong; without a size there are no slopes.
fn warnings(measured: &MeasuredSurface, whole: &Whole) -> Vec<String> {
    let warnings = Warning::of_surface(&whole.surface).into_iter();
    let known = warnings.filter(|warning| {
        whole.has_size || !matches!(warning, Warning::Surface(surface::Warning::Steep { .. }))
    });
    let filled = surface::Warning::of_filling(measured.missing, measured.heights.len());
    known.chain(filled.map(Warning::Surface)).map(|warning| advice::told(&warning)).collect()
}

/// The parameters of a map whose size is known, and of a profile.
type Found<'a> = (Option<&'a ArealParameters>, Option<&'a ProfileParameters>);

/// One object for programs.
fn object(measured: &MeasuredSurface, whole: &Whole, (texture, profile): Found<'_>) -> Value {
    let (nx, ny) = measured.heights.shape();
    let side = |n: usize, cell: f64| n as f64 * cell;
    let map = whole.surface.map();
    json!({
        "format": measured.format.name(),
        "title": measured.title,
        "understood": measured.understood,
        "nx": nx,
        "ny": ny,
        "side_x": measured.cell.map(|(dx, _)| side(nx, dx)),
        "side_y": measured.cell.map(|(_, dy)| side(ny, dy)),
        "missing": measured.missing,
        "min": map.min_height(),
        "max": map.max_height(),
        "mean": whole.mean(),
        "sa": map.mean_absolute_height(),
        "sq": map.rms_height(),
        "sz": map.peak_to_valley(),
        "rms_gradient": whole.rms_gradient(),
        "texture": texture.map(|texture| json!({
            "ssk": texture.ssk,
            "sku": texture.sku,
            "sdr": texture.sdr,
            "sal": texture.sal,
            "str": texture.str,
            "sk": texture.core.sk,
            "spk": texture.core.spk,
            "svk": texture.core.svk,
            "smrk1": texture.core.smrk1,
            "smrk2": texture.core.smrk2,
        })),
        "profile": profile.map(|profile| json!({
            "cutoff": profile.cutoff,
            "evaluation_length": profile.evaluation_length,
            "ra": profile.ra,
            "rq": profile.rq,
            "rz": profile.rz,
            "rt": profile.rt,
            "rsk": profile.rsk,
            "rku": profile.rku,
            "rsm": profile.rsm,
        })),
        "notes": measured.notes.iter().map(|note| of_program(note)).collect::<Vec<_>>(),
        "warnings": warnings(measured, whole),
    })
}

/// Lines for people.
fn print(
    options: &Options,
    measured: &MeasuredSurface,
    whole: &Whole,
    (texture, profile): Found<'_>,
) -> Result<(), Failure> {
    let length = |value: f64| quantity(value, "m", 5);
    say!("file          {}", options.file.display());
    say!("found         {measured}");
    if !measured.understood.is_empty() {
        say!("understood    {}", measured.understood);
    }
    if measured.channels.len() > 1 {
        say!("maps          {}", measured.channels.join(", "));
    }
    if !measured.title.is_empty() {
        say!("title         {}", measured.title);
    }
    for note in &measured.notes {
        say!("note          {}", of_program(note));
    }
    if measured.missing > 0 {
        say!(
            "figures       of all nodes, the {} filled from those around them",
            counted(measured.missing, "missing one")
        );
    }
    let map = whole.surface.map();
    say!(
        "heights       {} to {}, mean {}",
        length(map.min_height()),
        length(map.max_height()),
        length(whole.mean())
    );
    let roughness = |map: &HeightMap| {
        format!(
            "Sa {}, Sq {}, Sz {}",
            length(map.mean_absolute_height()),
            length(map.rms_height()),
            length(map.peak_to_valley())
        )
    };
    say!("roughness     {}", roughness(map));
    if let Some(gradient) = whole.rms_gradient() {
        say!("rms gradient  {}", significant(gradient.abs(), 4));
    }
    let failed = |error| Failure::new("cannot remove the tilt", error);
    let levelled = whole.filled_flat.level(Trend::Plane).map_err(failed)?;
    say!("tilt          {} rms; without it {}", length(whole.tilt), roughness(levelled.map()));
    let (skewness, kurtosis) = (levelled.map().skewness(), levelled.map().kurtosis());
    // A plane has none.
    if skewness.is_finite() {
        say!(
            "shape         skewness Ssk {skewness:.3}, kurtosis Sku {kurtosis:.3} (normal: 0, 3), without the tilt"
        );
    }
    if let Some(texture) = texture {
        print_texture(texture);
    }
    if let Some(profile) = profile {
        print_profile(profile);
    }
    if whole.has_size {
        spectrum(&levelled);
    } else {
        say!(
            "no gradients and no spectrum: the file does not contain the size of the surface; give it with --side"
        );
    }
    for warning in warnings(measured, whole) {
        match speech::is_quiet() {
            true => speech::warn(warning),
            false => say!("warning       {warning}"),
        }
    }
    Ok(())
}

/// The texture of a map whose size is known.
fn texture(whole: &Whole) -> Result<Option<ArealParameters>, Failure> {
    let (nx, ny) = whole.surface.grid().shape();
    let is_map = nx > 1 && ny > 1 && whole.has_size;
    let found = is_map.then(|| whole.filled_flat.areal_parameters()).transpose();
    found.map_err(|error| Failure::new("cannot compute the texture of the map", error))
}

/// In the symbols of ISO 25178-2.
fn print_texture(texture: &ArealParameters) {
    let length = |value: f64| quantity(value, "m", 4);
    let ways = match (texture.sal, texture.str) {
        (Some(sal), Some(str)) => format!("Sal {}, Str {str:.2}", length(sal)),
        _ => "no autocorrelation length".to_string(),
    };
    let core = texture.core;
    say!(
        "texture       Sdr {} %, {ways}, without the tilt (ISO 25178)",
        significant(100.0 * texture.sdr, 4)
    );
    say!(
        "              core Sk {}, peaks Spk {}, dales Svk {}; Smrk1 {:.1} %, Smrk2 {:.1} %",
        length(core.sk),
        length(core.spk),
        length(core.svk),
        100.0 * core.smrk1,
        100.0 * core.smrk2
    );
}

/// The parameters of a profile: of a surface of one row or column whose length is known.
fn profile(whole: &Whole, cutoff: Option<f64>) -> Result<Option<ProfileParameters>, Failure> {
    let (nx, ny) = whole.surface.grid().shape();
    let is_profile = (nx == 1 || ny == 1) && whole.has_size;
    if !is_profile {
        return match cutoff {
            None => Ok(None),
            Some(_) => Err(Failure::request(
                "--cutoff is for a profile, a row of heights whose length is known",
            )),
        };
    }
    let found = match ny {
        1 => whole.filled_flat.profile_parameters(cutoff),
        _ => whole.filled_flat.transpose().profile_parameters(cutoff),
    };
    found
        .map(Some)
        .map_err(|error| Failure::new("cannot compute the roughness of the profile", error))
}

/// In the symbols of ISO 21920: R behind a filter, P without one.
fn print_profile(profile: &ProfileParameters) {
    let length = |value: f64| quantity(value, "m", 4);
    let (letter, of) = match profile.cutoff {
        Some(cutoff) => ("R", format!("roughness, λc {}", length(cutoff))),
        None => ("P", format!("primary profile{}", advised_cutoff(profile.evaluation_length))),
    };
    let spacing = profile.rsm.map_or_else(|| "none".to_string(), length);
    // A line has none.
    let shape = match profile.rsk.is_finite() {
        true => format!(", {letter}sk {:.3}, {letter}ku {:.3}", profile.rsk, profile.rku),
        false => String::new(),
    };
    say!(
        "profile       {letter}a {}, {letter}q {}, {letter}z {}, {letter}t {}, {letter}Sm {spacing}{shape}",
        length(profile.ra),
        length(profile.rq),
        length(profile.rz),
        length(profile.rt)
    );
    say!("              ISO 21920: {of}, evaluated on {}", length(profile.evaluation_length));
}

/// The longest cut-off of ISO 21920 of which a profile has five sections and a half at either end, if it has any.
fn advised_cutoff(length: f64) -> String {
    let millimetres = [8.0, 2.5, 0.8, 0.25, 0.08];
    let fits = |cutoff: &&f64| 6.0 * **cutoff <= 1e3 * length * (1.0 + 1e-9);
    let advised = millimetres.iter().find(fits);
    advised.map_or_else(String::new, |cutoff| format!("; --cutoff {cutoff}mm for R-parameters"))
}

/// The self-affine spectrum that fits.
fn spectrum(levelled: &Topography) {
    let length = |value: f64| quantity(value, "m", 5);
    // Measured maps do not repeat: without a window their borders make a power law of their own.
    let windowed = levelled.window(Window::Hann);
    if let Ok(fit) = windowed.and_then(|windowed| windowed.fit_self_affine()) {
        let estimate = |name: &str, estimate: Option<Estimate>| {
            estimate
                .map_or_else(String::new, |estimate| format!(", {name} {}", length(estimate.value)))
        };
        if (0.0..=HIGHEST_HURST).contains(&fit.hurst.value) && fit.dispersion < FARTHEST {
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
}
