//! `fluid_pressure_K.png` and `flux_K.png`: the fields of the fluid at one state.

use std::path::{Path, PathBuf};

use asperity::LoadingState;
use asperity::leak::{Leak, Seal};
use asperity::record::LoadingRecord;
use asperity_cli::field_map::{FieldMap, Scale};
use asperity_cli::number::{quantity, scientific};
use asperity_cli::outcome::Failure;

/// Decades of the flux that are shown.
const DECADES: f64 = 1e-5;
/// Contour lines of the pressure.
const LINES: usize = 9;

/// Draws both fields; the flux if there is any.
pub(super) fn draw(
    record: &LoadingRecord,
    (state, leak): (&LoadingState, &Leak),
    seal: &Seal,
    (directory, place): (&Path, usize),
) -> Result<Vec<PathBuf>, Failure> {
    let grid = &record.grid();
    let caption = format!(
        "W = {}, A/A₀ = {:.2} %, leak rate {} m³/s",
        quantity(state.contact.load, "N", 4),
        100.0 * state.contact.contact_area_fraction,
        scientific(leak.leak_rate, 4)
    );
    let drop = seal.pressure_drop();
    let lines: Vec<f64> = (1..=LINES).map(|k| drop * k as f64 / (LINES + 1) as f64).collect();
    // Rounding may leave a trace beyond the edges.
    let pressure = leak.pressure.map(|pressure| pressure.clamp(0.0, drop));
    let pressure = FieldMap {
        grid,
        length_unit: "m",
        values: &pressure,
        range: (0.0, drop),
        scale: Scale::Linear,
        contours: &lines,
        label: ("fluid pressure above the outlet", "Pa"),
    };
    let mut files =
        vec![pressure.write(&directory.join(format!("fluid_pressure_{place}.png")), &caption)?];
    let flux = leak.flux_x.zip_map(&leak.flux_y, f64::hypot);
    let greatest = flux.max();
    if greatest > 0.0 {
        let flux = flux.map(|flux| if flux > 0.0 { flux } else { f64::NAN });
        let map = FieldMap {
            grid,
            length_unit: "m",
            values: &flux,
            range: (DECADES * greatest, greatest),
            scale: Scale::Logarithmic,
            contours: &[],
            label: ("flux", "m²/s"),
        };
        files.push(map.write(&directory.join(format!("flux_{place}.png")), &caption)?);
    }
    Ok(files)
}
