//! Each warning against a case that is known.

use super::*;
use crate::kernel::{Base, Layer};
use crate::reference::HertzSphere;
use crate::{Boussinesq, FixedLoadSolver, LoadingSolver};

/// Heights of a sphere over a point near the middle of a grid.
fn ball(grid: &Grid, radius: f64, offset: (f64, f64)) -> Result<Topography, Error> {
    let (nx, ny) = grid.shape();
    let height = |ix: usize, iy: usize| {
        let x = ix as f64 - 0.5 * (nx - 1) as f64 - offset.0;
        let y = iy as f64 - 0.5 * (ny - 1) as f64 - offset.1;
        -((x * grid.dx()).powi(2) + (y * grid.dy()).powi(2)) / (2.0 * radius)
    };
    Ok(Topography::new(*grid, DMatrix::from_fn(nx, ny, height))?)
}

/// Text that has room for so many bytes.
struct Room(usize);

impl fmt::Write for Room {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0 = self.0.checked_sub(text.len()).ok_or(fmt::Error)?;
        Ok(())
    }
}

/// Wherever its text ends too early, a warning that does not fit says so.
#[test]
fn a_warning_that_does_not_fit_is_an_error() {
    use fmt::Write;
    let (pressure, e_star) = (60.0, 115.0);
    for warning in [
        Warning::Surface(surface::Warning::Smooth { rms_height: 1e-13 }),
        Warning::NoLoad { contact_nodes: 7 },
        Warning::SmallPatches { contact_nodes: 7, excess: 0.3 },
        Warning::EdgePeak { pressure, inside: 1.0 },
        Warning::WideCells { cell: 2.0, thickness: 1.0 },
        Warning::SteepLaw { resolution: 0.6, cell: 1e-6, cell_needed: 8e-7 },
        Warning::SmallSummits { cells: 2.0, radius: 1e-6 },
        Warning::StrongAdhesion { work: 50.0 },
        Warning::PressureDrop { pressure_drop: 1.0, mean_pressure: 2.0, states: 3 },
        Warning::Modulus { e_star },
        Warning::Modulus { e_star: 1e-9 },
        Warning::Modulus { e_star: 1e13 },
        Warning::Hardness { hardness: 2.5, e_star: 230e9 },
        Warning::Hardness { hardness: 2.5e-9, e_star: 230e9 },
        Warning::HighPressure { pressure, e_star, hardness: None },
        Warning::HighPressure { pressure, e_star: 1e9, hardness: None },
        Warning::HighPressure { pressure, e_star, hardness: Some(1.0) },
    ] {
        let length = warning.to_string().len();
        for room in 0..length {
            assert!(write!(Room(room), "{warning}").is_err(), "{room} of {length}");
        }
        assert!(write!(Room(length), "{warning}").is_ok());
    }
}

/// Hertz contacts whose radius is 0.9, 1.1 and 1.3 times the distance to the border.
#[test]
fn peaks_of_the_border_are_noticed() -> Result<(), Error> {
    let grid = Grid::square(64, 32.0)?;
    let half_space = Boussinesq::new(grid, 1.0)?;
    let ball = ball(&grid, 100.0, (0.0, 0.0))?;
    let hertz = HertzSphere::new(100.0, 1.0)?;
    let mut solver = FixedLoadSolver::new(&ball, &half_space)?;
    for (part, is_peak) in [(0.9, false), (1.1, false), (1.3, true)] {
        let radius = part * 16.0;
        let approach = radius * radius / 100.0;
        let solved = solver.solve(hertz.load(approach))?;
        let on = (&grid, Boundary::Free);
        let found = Warning::of_contact(&solved.fields.pressure, &solved.fields.contact_map, on)?;
        assert_eq!(found.len(), usize::from(is_peak), "{part} {found:?}");
        // The edge nearly doubles the pressure; inside it is that of Hertz, of a contact that loses a tenth of its load
        // there.
        for warning in found {
            assert!(warning.to_string().contains("at the border of the grid"), "{warning}");
            let greatest = hertz.max_pressure(approach);
            let is_right = matches!(warning, Warning::EdgePeak { pressure, inside }
                if pressure > 1.5 * greatest && inside > 0.9 * greatest && inside < 1.3 * greatest);
            assert!(is_right, "{warning:?} {greatest}");
        }
    }
    Ok(())
}

/// The same pressure where the half-space repeats is no peak, and where all nodes are at the border none is inside.
#[test]
fn only_an_edge_has_peaks() -> Result<(), Error> {
    let peak = |nx: usize, ny: usize, at: (usize, usize), boundary| -> Result<bool, Error> {
        let grid = Grid::new(nx, ny, 1.0, 1.0)?;
        let mut pressure = DMatrix::from_element(nx, ny, 1.0);
        pressure[at] = 2.0;
        let map = DMatrix::from_element(nx, ny, true);
        let found = Warning::of_contact(&pressure, &map, (&grid, boundary))?;
        Ok(found.iter().any(|warning| matches!(warning, Warning::EdgePeak { .. })))
    };
    for (at, boundary, is_peak) in [
        ((0, 3), Boundary::Free, true),
        ((7, 3), Boundary::PeriodicY, true),
        ((3, 7), Boundary::PeriodicX, true),
        ((3, 3), Boundary::Free, false),
        ((0, 3), Boundary::PeriodicX, false),
        ((3, 7), Boundary::PeriodicY, false),
        ((0, 0), Boundary::Periodic, false),
    ] {
        assert_eq!(peak(8, 8, at, boundary)?, is_peak, "{at:?} {boundary:?}");
    }
    assert!(!peak(2, 8, (0, 3), Boundary::Free)?);
    Ok(())
}

#[test]
fn contact_without_a_load_is_noticed() -> Result<(), Error> {
    let grid = Grid::square(16, 1.0)?;
    let of = |nodes: usize, pressure: f64| {
        let map = DMatrix::from_fn(16, 16, |ix, iy| ix + 16 * iy < nodes);
        let pressure = map.map(|is_in| if is_in { pressure } else { 0.0 });
        Warning::of_contact(&pressure, &map, (&grid, Boundary::Periodic))
    };
    assert_eq!(of(100, 0.0)?, [Warning::NoLoad { contact_nodes: 100 }]);
    // Every path begins with one node.
    assert!(!of(1, 0.0)?.contains(&Warning::NoLoad { contact_nodes: 1 }));
    assert_eq!(of(256, 1.0)?, []);
    assert_eq!(of(0, 0.0)?, []);
    Ok(())
}

#[test]
fn maps_of_other_grids_are_refused() -> Result<(), Error> {
    let on = (&Grid::square(4, 1.0)?, Boundary::Free);
    let (pressure, map) = (DMatrix::zeros(4, 4), DMatrix::from_element(4, 4, false));
    let wrong = Warning::of_contact(&DMatrix::zeros(4, 3), &map, on);
    assert!(matches!(wrong, Err(Error::GridMismatch { .. })));
    let wrong = Warning::of_contact(&pressure, &DMatrix::from_element(3, 4, false), on);
    assert!(wrong.is_err());
    Ok(())
}

#[test]
fn one_cell_is_one() {
    let told = |contact_nodes| Warning::SmallPatches { contact_nodes, excess: 0.9 }.to_string();
    assert!(told(1).contains("the area of its 1 cell may be up to 90 % too large"), "{}", told(1));
    assert!(told(2).contains("the area of its 2 cells may be up to 90 % too large"), "{}", told(2));
}

#[test]
fn pressures_that_solids_do_not_bear_are_noticed() {
    let told = |pressure, e_star, hardness| {
        Warning::of_pressure(pressure, e_star, hardness).map(|warning| warning.to_string())
    };
    for (pressure, e_star, hardness, said) in [
        (2e9, 115e9, None, None),
        (2.5e9, 115e9, None, Some("2.5 GPa, 0.022 of E*")),
        (2.5e9, 115e9, None, Some("metals yield")),
        // Nothing but a modulus is known: it may be that of glass.
        (2.5e9, 115e9, None, Some("glass and ceramics")),
        // Polymers bear more of their modulus, and rubber does not yield.
        (0.14e9, 3e9, None, None),
        (0.16e9, 3e9, None, Some("polymers yield")),
        (3e6, 2.67e6, None, None),
        // What is known counts.
        (5e9, 73e9, Some(5.5e9), None),
        (5.5e9 * (1.0 + 1e-9), 73e9, Some(5.5e9), None),
        (11e9, 73e9, Some(5.5e9), Some("2.0 times the typical hardness of the material, 5.5 GPa")),
    ] {
        let found = told(pressure, e_star, hardness);
        let is_right = match (&found, said) {
            (Some(found), Some(said)) => found.contains(said),
            (None, None) => true,
            _ => false,
        };
        assert!(is_right, "{pressure} {e_star}: {found:?}");
    }
}

#[test]
fn cells_wider_than_a_coat_are_noticed() -> Result<(), Error> {
    let of = |layers: &[(f64, f64)], base, dx, dy| -> Result<_, Error> {
        let layer =
            |(youngs_modulus, thickness)| Layer { youngs_modulus, poissons_ratio: 0.3, thickness };
        let layers: Vec<_> = layers.iter().copied().map(layer).collect();
        let body = LayeredBody::new(&layers, base)?;
        Ok(Warning::of_layers(&body, &Grid::new(4, 4, dx, dy)?))
    };
    let wide = Warning::WideCells { cell: 3e-6, thickness: 2e-6 };
    let steel = Base::HalfSpace { youngs_modulus: 210e9, poissons_ratio: 0.3 };
    for (layers, base, dy, expected) in [
        (vec![(3e9, 2e-6)], Base::Rigid, 3e-6, Some(wide)),
        (vec![(3e9, 2e-6)], Base::Rigid, 2e-6, None),
        (vec![(450e9, 2e-6), (450e9, 1e-9)], steel, 2e-6, None),
        (vec![(450e9, 2e-6), (3e9, 1.0)], steel, 3e-6, Some(wide)),
        // Steps of a modulus that changes slowly count together, and a base like them is none.
        (vec![(450e9, 1e-6), (400e9, 1e-6), (200e9, 1e-6)], steel, 3e-6, Some(wide)),
        (vec![(300e9, 1e-6), (250e9, 1e-6)], steel, 3e-6, None),
    ] {
        assert_eq!(of(&layers, base, 1e-6, dy)?, expected, "{layers:?}");
    }
    assert!(
        wide.to_string().contains("cells of 3 µm are wider than the coat is thick, 2 µm"),
        "{wide}"
    );
    Ok(())
}

#[test]
fn fluids_that_open_the_gap_are_noticed() {
    let told = |drop, pressures: &[f64]| {
        let found = Warning::of_pressure_drop(drop, pressures.iter().copied());
        found.map(|warning| warning.to_string())
    };
    assert_eq!(told(1e5, &[0.0, 5e6]), None);
    let one = told(1e7, &[35e3]);
    assert!(one.as_ref().is_some_and(|text| {
        text.contains("10 MPa, is not small beside the mean pressure of the contact, 35 kPa:")
            && text.contains("states above 500 MPa")
    }));
    let several = told(1e7, &[0.0, 4e8, 35e3, 6e8]);
    assert!(several.is_some_and(|text| text.contains("35 kPa and more at 2 states:")));
}

#[test]
fn moduli_in_other_units_are_noticed() {
    for e_star in [2.3e6, 115e9, 1.2e12] {
        assert_eq!(Warning::of_modulus(e_star), None);
    }
    for (e_star, said) in [
        (230.8, "in GPa, it is 230.8 GPa"),
        (230_769.0, "in MPa, it is 230.8 GPa"),
        (1e-9, "is the modulus in Pa?"),
        (2.3e13, "above that of diamond"),
    ] {
        let found = Warning::of_modulus(e_star).map(|warning| warning.to_string());
        assert!(found.as_ref().is_some_and(|text| text.contains(said)), "{found:?}");
    }
}

/// Balls at places between the nodes: cells in contact against Hertz. The correction is right on average over such
/// places.
#[test]
fn contacts_of_few_nodes_are_noticed() -> Result<(), Error> {
    let grid = Grid::square(33, 33.0)?;
    let half_space = Boussinesq::new(grid, 1.0)?;
    let hertz = HertzSphere::new(100.0, 1.0)?;
    let (mut of_few, mut unnoticed) = (Vec::new(), Vec::new());
    for offset in [(0.1, 0.2), (0.4, 0.1), (0.3, 0.45), (0.25, 0.25)] {
        let ball = ball(&grid, 100.0, offset)?;
        let mut path = LoadingSolver::builder(&ball, &half_space).max_nodes(150).build()?;
        while let Some(state) = path.next().transpose()? {
            let (pressure, map) = (path.fields()?.pressure, path.contact_map());
            let found = Warning::of_contact(&pressure, &map, (&grid, Boundary::Free))?;
            let is_small = |warning: &Warning| matches!(warning, Warning::SmallPatches { .. });
            let is_noticed = found.iter().any(is_small);
            let area = hertz.contact_area(hertz.approach_at_load(state.contact.load));
            let excess = state.contact.contact_area / area - 1.0;
            let nodes = state.contact.contact_nodes;
            assert!(is_noticed || nodes > 12, "{nodes}");
            assert!(!is_noticed || nodes < 100, "{nodes}");
            if (9..13).contains(&nodes) {
                of_few.push(excess);
            }
            if !is_noticed {
                unnoticed.push(excess);
            }
        }
    }
    let mean = |excesses: &[f64]| excesses.iter().sum::<f64>() / excesses.len() as f64;
    assert!(mean(&of_few) > EXCESS, "{of_few:?}");
    assert!(mean(&unnoticed) < EXCESS, "{unnoticed:?}");
    Ok(())
}

/// 2.5 for 2.5 GPa, 250 for 250 MPa, and what no unit makes a hardness.
#[test]
fn a_hardness_without_its_unit_is_noticed() {
    let of =
        |hardness: f64| Warning::of_hardness(hardness, 230.8e9).map(|warning| warning.to_string());
    assert_eq!(of(2.5e9), None);
    assert_eq!(of(1e7), None);
    assert_eq!(of(-1.0), None);
    for (hardness, words) in [
        (
            2.5,
            "a hardness of 2.5 Pa is 1.1e-11 of E* = 230.8 GPa: no solid is so soft. If it was given in GPa, it is 2.5 GPa",
        ),
        (250.0, "If it was given in MPa, it is 250 MPa"),
        (2.5e-6, "Is it in Pa?"),
    ] {
        let told = of(hardness).unwrap_or_default();
        assert!(told.contains(words), "{told}");
    }
}

/// A ball whose contact has 25 nodes is not resolved; as many nodes apart from each other are not called one patch.
#[test]
fn a_single_patch_of_few_nodes_is_noticed() -> Result<(), Error> {
    let grid = Grid::square(32, 1e-3)?;
    let block = |side: usize| {
        DMatrix::from_fn(32, 32, |ix, iy| {
            (10..10 + side).contains(&ix) && (10..10 + side).contains(&iy)
        })
    };
    let warned = |map: &DMatrix<bool>| {
        let pressure = map.map(|is_in| if is_in { 1.0 } else { 0.0 });
        Warning::of_contact(&pressure, map, (&grid, Boundary::Periodic))
    };
    let found = warned(&block(6))?;
    assert!(matches!(found[..], [Warning::SmallPatches { contact_nodes: 36, .. }]), "{found:?}");
    assert_eq!(warned(&block(8))?, []);
    let mut two = block(8);
    two.view_mut((10, 10), (8, 8)).fill(false);
    two.view_mut((2, 2), (6, 4)).fill(true);
    two.view_mut((20, 20), (6, 4)).fill(true);
    assert!(two.iter().filter(|is_in| **is_in).count() < 50);
    assert_eq!(warned(&two)?, []);
    Ok(())
}

/// Slopes of 0.45 and of 0.6, and spheres whose contact at pull-off has 6 cells in its radius, and 4.
#[test]
fn laws_and_summits_that_the_grid_does_not_resolve_are_noticed() -> Result<(), Error> {
    use crate::adhesion::Adhesion;
    let (e_star, work) = (1e6, 0.05);
    let grid = Grid::new(32, 32, 3e-7, 2e-7)?;
    let half_space = Boussinesq::new(grid, e_star)?;
    let shortest = Adhesion::work(work).on(&half_space)?;
    // k C(0, 0) falls with the square of the range.
    let asked = Adhesion::work(work).range(shortest.range() * (0.45_f64 / 0.6).sqrt());
    let steep = asked.on(&half_space)?;
    // To some roundings.
    let same = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-12;
    // (9π w R² / 8E*)^⅓ = n dx
    let radius = |cells: f64| {
        let a = cells * grid.dx();
        (8.0 * e_star * a * a * a / (9.0 * std::f64::consts::PI * work)).sqrt()
    };
    for (cells, is_small) in [(6.0, false), (4.0, true)] {
        // A node is at its summit.
        let sphere = ball(&grid, radius(cells), (0.5, 0.5))?;
        for (law, is_steep) in [(&shortest, false), (&steep, true)] {
            let found = Warning::of_adhesion(&sphere, law, e_star);
            let about = |is: fn(&Warning) -> bool| found.iter().any(is);
            assert_eq!(about(|w| matches!(w, Warning::SteepLaw { .. })), is_steep, "{found:?}");
            assert_eq!(about(|w| matches!(w, Warning::SmallSummits { .. })), is_small, "{found:?}");
            for warning in found {
                if let Warning::SteepLaw { resolution, cell, cell_needed } = warning {
                    assert!(same(resolution, 0.6) && cell == grid.dx(), "{warning:?}");
                    // The same law on such cells is at the limit.
                    let [dx, dy] = [grid.dx(), grid.dy()].map(|side| side * cell_needed / cell);
                    let fine = Boussinesq::new(Grid::new(32, 32, dx, dy)?, e_star)?;
                    assert!(same(asked.on(&fine)?.resolution(), 0.5), "{warning:?}");
                }
                if let Warning::SmallSummits { cells: told, radius: of_summit } = warning {
                    assert!(same(told, cells) && same(of_summit, radius(cells)), "{warning:?}");
                }
                assert!(!matches!(warning, Warning::StrongAdhesion { .. }), "{warning:?}");
            }
        }
    }
    // 50 mJ/m² taken for J/m².
    let strong = Adhesion::work(50.0).on(&half_space)?;
    let found = Warning::of_adhesion(&ball(&grid, 1e-5, (0.5, 0.5))?, &strong, e_star);
    assert!(matches!(found[..], [Warning::StrongAdhesion { work: 50.0 }, ..]), "{found:?}");
    Ok(())
}
