//! Cylinder and one-dimensional wave against plane strain, eqs. (20) and (21).
//!
//! No path here is plane: every contact is finite, on a free half-space. But far from the ends the
//! pressure on a cross-section is that of plane strain under the section's own load per length, up
//! to an error that falls with the square of the distance to the ends. So pressures are compared on
//! the middle section, on cells that are long in the direction in which nothing changes.

use asperity::loading::{History, LoadingSolver};
use asperity::reference::{HertzLine, Westergaard};
use asperity::surface::{Axis, Cylinder, Wave};
use asperity::{Boussinesq, Grid, Surface};
use nalgebra::DVector;

const E_STAR: f64 = 1e9;
const SAMPLES: usize = 60;

/// Pressures on the middle section at `SAMPLES` loads of a path, evenly spaced from `from` to 1 of
/// its last load. Single states fluctuate, as the edge of contact goes from cell to cell.
fn sections(surface: &dyn Surface, grid: Grid, from: f64, fraction: f64) -> Vec<DVector<f64>> {
    let kernel = Boussinesq::new(grid, E_STAR).unwrap();
    let builder = LoadingSolver::builder(surface, &kernel).max_area_fraction(fraction);
    let mut path = builder.build().unwrap();
    let history: History = path.by_ref().map(Result::unwrap).collect();
    let last = history.states().last().unwrap().contact.load;
    let sections = (0..SAMPLES).map(|sample| {
        let part = from + (1.0 - from) * (sample as f64 + 0.5) / SAMPLES as f64;
        let state = history.at_load(part * last).unwrap();
        let pressure = path.fields_at(&state).unwrap().pressure;
        pressure.column(grid.ny() / 2).into_owned()
    });
    sections.collect()
}

/// Average errors of a cylinder of length `slenderness` times the half-width a, with `cells` cells
/// to a: of the width in cells, of the pressure on the inner 0.6 a over p0 (the worst node).
fn line_errors(cells: usize, slenderness: usize) -> [f64; 2] {
    let (radius, a) = (0.1, 1e-4);
    let hertz = HertzLine::new(radius, E_STAR).unwrap();
    let nx = 2 * (3 * cells / 2) + 1;
    let ny = slenderness | 1;
    let dx = a / cells as f64;
    let grid = Grid::new(nx, ny, dx, slenderness as f64 * a / ny as f64).unwrap();
    // The ridge off the nodes and off the middle between them.
    let ridge = grid.center().0 + 0.3 * dx;
    let cylinder = Cylinder::new(radius, Axis::Y).unwrap();
    let cylinder = cylinder.centered_at(ridge, 0.0).unwrap();
    let mut sums = [0.0; 2];
    // Up to a half-width of about 1.1 a.
    for section in sections(&cylinder, grid, 0.6, 0.75) {
        let load = section.sum() * dx;
        let half_width = hertz.half_width(load);
        let width = section.iter().filter(|p| **p > 0.0).count() as f64;
        let mut worst = 0.0_f64;
        for (ix, p) in section.iter().enumerate() {
            let x = grid.position(ix, 0).0 - ridge;
            if x.abs() < 0.6 * half_width {
                worst = worst.max((p - hertz.pressure(x, load)).abs());
            }
        }
        sums[0] += width - 2.0 * half_width / dx;
        sums[1] += worst / hertz.max_pressure(load);
    }
    sums.map(|sum| sum / SAMPLES as f64)
}

#[test]
fn long_cylinders_are_hertzian_in_the_middle() {
    for slenderness in [5, 10, 20, 40] {
        for cells in [4, 8, 16] {
            let [width, pressure] = line_errors(cells, slenderness);
            // Cells that are in contact by their centre count whole: 0.2 to 0.35 cells too wide.
            assert!(width > 0.1 && width < 0.5, "{cells} {slenderness}: {width}");
            // Second order in the cell, 0.07 to 0.09 (Δ/a)², and at least second order in a/L:
            // 0.11 (a/L)² at L = 5 a, less beyond.
            let (cell, length) = (1.0 / cells as f64, 1.0 / slenderness as f64);
            let bound = 0.12 * cell * cell + 0.12 * length * length;
            assert!(pressure < bound, "{cells} {slenderness}: {pressure} > {bound}");
        }
    }
    // The two errors told apart.
    let [coarse, fine] = [4, 16].map(|cells| line_errors(cells, 40)[1]);
    assert!(fine < coarse / 10.0, "cells: {coarse} to {fine}");
    let [short, long] = [5, 20].map(|slenderness| line_errors(16, slenderness)[1]);
    assert!(long < short / 6.0, "length: {short} to {long}");
}

/// Average errors on the middle one of `periods` waves of `cells` cells each: of the contact width
/// in cells, of the pressure over p* on the inner 0.6 a (the worst node), and over the whole period
/// (rms). States with mean pressures from 0.2 p* to 0.4 p*.
fn wave_errors(cells: usize, periods: usize) -> [f64; 3] {
    let (wavelength, amplitude) = (1e-3, 1e-6);
    let westergaard = Westergaard::new(amplitude, wavelength, E_STAR).unwrap();
    let full = westergaard.full_contact_pressure();
    // A square, two cells to a wavelength along the crests.
    let ny = (2 * periods) | 1;
    let side = periods as f64 * wavelength;
    let grid = Grid::with_sides(cells * periods, ny, side, side).unwrap();
    let wave = Wave::new(amplitude, wavelength, Axis::X).unwrap();
    let (mut sums, mut count) = ([0.0; 3], 0.0);
    for section in sections(&wave, grid, 0.0, 0.7) {
        let first = cells * (periods / 2);
        let period = section.rows(first, cells);
        let mean = period.mean();
        if mean < 0.2 * full || mean > 0.4 * full {
            continue;
        }
        let a = westergaard.contact_half_width(mean);
        let width = period.iter().filter(|p| **p > 0.0).count() as f64;
        let (mut worst, mut squares) = (0.0_f64, 0.0);
        for (k, p) in period.iter().enumerate() {
            let x = grid.position(first + k, 0).0 - grid.center().0;
            let error = (p - westergaard.pressure(x, mean)).abs() / full;
            squares += error * error / cells as f64;
            if x.abs() < 0.6 * a {
                worst = worst.max(error);
            }
        }
        sums[0] += width - 2.0 * a / wavelength * cells as f64;
        sums[1] += worst;
        sums[2] += squares.sqrt();
        count += 1.0;
    }
    assert!(count > 20.0, "{count} states");
    sums.map(|sum| sum / count)
}

#[test]
fn waves_are_westergaards_in_the_middle() {
    for (cells, periods) in [(64, 1), (16, 3), (32, 3), (64, 3), (16, 5), (32, 5), (16, 7), (32, 7)]
    {
        let [width, inner, rms] = wave_errors(cells, periods);
        let cell = 1.0 / cells as f64;
        // Neighbours that are missing: the square of their distance, measured 0.034 / periods².
        let ends = 0.045 / (periods * periods) as f64;
        // Cells: second order inside, measured 1.3 to 2.1 / cells².
        assert!(inner < 2.6 * cell * cell + ends, "{cells} {periods}: {inner}");
        // First order with the cells of the edge: measured 0.24 to 0.3 / cells.
        assert!(rms < 0.4 * cell + ends, "{cells} {periods}: {rms}");
        if periods > 1 {
            // Cells that are in contact by their centre count whole: 0.3 to 0.45 cells too wide.
            assert!(width > 0.2 && width < 0.6, "{cells} {periods}: {width}");
        }
    }
    let [one, three] = [1, 3].map(|periods| wave_errors(64, periods)[1]);
    assert!(three < one / 5.0, "periods: {one} to {three}");
    let [three, seven] = [3, 7].map(|periods| wave_errors(32, periods)[1]);
    assert!(seven < three / 2.0, "periods: {three} to {seven}");
    let [coarse, fine] = [16, 32].map(|cells| wave_errors(cells, 7)[2]);
    assert!(fine < coarse / 1.8, "cells: {coarse} to {fine}");
}
