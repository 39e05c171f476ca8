//! Tables for finite elements: their error, their order, and their syntax.

use asperity::joint::{Conduction, FeProgram, FeUnits, InterfaceRow, InterfaceTable};
use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::loading::History;
use asperity::{
    Boussinesq, ContactEvent, ContactState, Error, Grid, InfluenceKernel, JointError, LoadingState,
    PeriodicBoussinesq,
};

use super::{history, rough};

const E_STAR: f64 = 115e9;

fn paths() -> Vec<History> {
    let grid = Grid::square(48, 1.25e-3).unwrap();
    let free = Boussinesq::new(grid, E_STAR).unwrap();
    let periodic = PeriodicBoussinesq::new(grid, E_STAR).unwrap();
    let kernels: [&dyn InfluenceKernel; 2] = [&free, &periodic];
    // The second one to full contact.
    kernels.iter().zip([0.4, 1.0]).map(|(kernel, area)| history(&rough(), *kernel, area)).collect()
}

fn table(history: &History, tolerance: f64) -> InterfaceTable {
    InterfaceTable::builder(history)
        .conduction(Conduction::thermal(E_STAR, 0.04).unwrap())
        .friction(0.25, 1.2)
        .tolerance(tolerance)
        .build()
        .unwrap()
}

/// Linear interpolation as a finite element program does it.
fn interpolated(
    rows: &[InterfaceRow],
    x: impl Fn(&InterfaceRow) -> f64,
    y: impl Fn(&InterfaceRow) -> f64,
    at: f64,
) -> f64 {
    let after = rows.partition_point(|row| x(row) < at).clamp(1, rows.len() - 1);
    let (a, b) = (&rows[after - 1], &rows[after]);
    y(a) + (y(b) - y(a)) * (at - x(a)) / (x(b) - x(a))
}

/// At every state of the path each quantity is within the tolerance, which is what thins the table; between states
/// pressure is linear in the overclosure, as in the table. The worst error is near the tolerance: the table is no
/// longer than it needs to be by much.
#[test]
fn interpolation_errs_by_no_more_than_the_tolerance() {
    for history in paths() {
        let states = history.states();
        let area = states[0].contact.contact_area / states[0].contact.contact_area_fraction;
        let unloaded = states[0].contact.mean_gap;
        let finite = states.iter().filter(|s| s.contact.interfacial_stiffness.unwrap().is_finite());
        let mut lengths = Vec::new();
        for tolerance in [0.1, 0.01, 0.001] {
            let table = table(&history, tolerance);
            let rows = table.rows();
            lengths.push(rows.len());
            let greatest = rows.last().unwrap().pressure;
            let mut worst = 0.0_f64;
            for state in finite.clone() {
                let pressure = state.contact.mean_pressure();
                let overclosure = unloaded - state.contact.mean_gap;
                let found = interpolated(rows, |r| r.overclosure, |r| r.pressure, overclosure);
                let error = (found - pressure).abs() / pressure.max(1e-3 * greatest);
                worst = worst.max(error);
                assert!(error <= tolerance * (1.0 + 1e-6), "{error}");
                let stiffness = state.contact.interfacial_stiffness.unwrap() / area;
                let conductance = |r: &InterfaceRow| r.conductance.unwrap();
                let found = interpolated(rows, |r| r.pressure, conductance, pressure);
                let error = found / (2.0 * stiffness / (0.04 * E_STAR)) - 1.0;
                assert!(error.abs() <= tolerance * (1.0 + 1e-6), "{error}");
                worst = worst.max(error.abs());
                let tangential = |r: &InterfaceRow| r.tangential_stiffness.unwrap();
                let found = interpolated(rows, |r| r.pressure, tangential, pressure);
                assert!((found / (stiffness / 1.2) - 1.0).abs() <= tolerance * (1.0 + 1e-6));
                // As a program does it that has the overclosure: by way of the pressure.
                let by_pressure =
                    interpolated(rows, |r| r.overclosure, |r| r.pressure, overclosure);
                let found = interpolated(rows, |r| r.pressure, conductance, by_pressure);
                let error = found / (2.0 * stiffness / (0.04 * E_STAR)) - 1.0;
                assert!(error.abs() <= tolerance * (1.0 + 1e-6), "{error} over overclosure");
            }
            assert!(worst > 0.5 * tolerance, "{worst} {tolerance}");
        }
        assert!(lengths[0] < lengths[1] && lengths[1] < lengths[2]);
        assert!(lengths[1] * 5 < states.len(), "{lengths:?} of {}", states.len());
    }
}

#[test]
fn tables_begin_without_pressure_and_rise() {
    for history in paths() {
        for tolerance in [0.3, 0.01, 1e-9] {
            let table = table(&history, tolerance);
            assert_eq!(table.tolerance(), tolerance);
            let rows = table.rows();
            assert_eq!((rows[0].pressure, rows[0].overclosure), (0.0, 0.0));
            for pair in rows.windows(2) {
                assert!(pair[0].pressure < pair[1].pressure);
                assert!(pair[0].overclosure < pair[1].overclosure);
                assert!(pair[0].conductance <= pair[1].conductance);
                assert!(pair[0].tangential_stiffness <= pair[1].tangential_stiffness);
            }
            for row in rows {
                assert_eq!(row.slip_limit, Some(0.25 * row.pressure));
                assert!(row.conductance.unwrap().is_finite());
            }
        }
    }
}

/// Every number of the CSV reads back; the same numbers are in the other formats, where each program expects them.
#[test]
fn programs_find_the_numbers_where_they_look() {
    let history = &paths()[1];
    let table = table(history, 0.02);
    let csv = table.text(FeProgram::Csv);
    let mut lines = csv.lines();
    assert_eq!(
        lines.next(),
        Some("pressure,overclosure,thermal_conductance,tangential_stiffness,slip_limit")
    );
    let cells: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(cells.len(), table.rows().len());
    for (cells, row) in cells.iter().zip(table.rows()) {
        let read: Vec<f64> = cells.iter().map(|cell| cell.parse().unwrap()).collect();
        let expected = [
            row.pressure,
            row.overclosure,
            row.conductance.unwrap(),
            row.tangential_stiffness.unwrap(),
            row.slip_limit.unwrap(),
        ];
        for (read, expected) in read.iter().zip(expected) {
            assert!((read - expected).abs() <= 1e-12 * expected);
        }
        // What CalculiX reads of a field.
        assert!(cells.iter().all(|cell| cell.len() <= 20));
    }
    let column = |k: usize| -> Vec<&str> { cells.iter().map(|cells| cells[k]).collect() };
    let (pressure, overclosure, conductance) = (column(0), column(1), column(2));
    let last = cells.last().unwrap();
    for (program, heat, friction) in [
        (FeProgram::Abaqus, "*GAP CONDUCTANCE, PRESSURE", "*FRICTION, ELASTIC SLIP="),
        (FeProgram::CalculiX, "*GAP CONDUCTANCE", "*FRICTION"),
    ] {
        let text = table.text(program);
        let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with("**")).collect();
        assert_eq!(lines[0], "*SURFACE INTERACTION, NAME=ROUGH_INTERFACE");
        assert_eq!(lines[1], "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR");
        let n = pressure.len();
        assert_eq!(lines[2 + n], heat);
        for k in 0..n {
            assert_eq!(lines[2 + k], format!("{}, {}", pressure[k], overclosure[k]));
            assert_eq!(lines[3 + n + k], format!("{}, {}", conductance[k], pressure[k]));
        }
        assert!(lines[3 + 2 * n].starts_with(friction));
        let coefficient: f64 = lines[4 + 2 * n].split(',').next().unwrap().parse().unwrap();
        assert_eq!(coefficient, 0.25);
        if program == FeProgram::CalculiX {
            assert_eq!(lines[4 + 2 * n].split(", ").nth(1), Some(last[3]));
        }
        assert_eq!(lines.len(), 5 + 2 * n);
        // Abaqus reads no longer lines.
        assert!(text.lines().all(|line| line.len() <= 256));
    }
    let moose = table.text(FeProgram::Moose);
    for (name, x, y) in [
        ("pressure_of_overclosure", &overclosure, &pressure),
        ("conductance_of_pressure", &pressure, &conductance),
        ("tangential_stiffness_of_pressure", &pressure, &column(3)),
        ("slip_limit_of_pressure", &pressure, &column(4)),
    ] {
        let block = format!(
            "  [{name}]\n    type = PiecewiseLinear\n    x = '{}'\n    y = '{}'\n  []\n",
            x.join(" "),
            y.join(" ")
        );
        assert!(moose.contains(&block), "{name}");
    }
    assert!(moose.starts_with("# ") && moose.ends_with("[]\n"));
    // Only what was asked for.
    let plain = InterfaceTable::builder(history).build().unwrap();
    for program in [FeProgram::Abaqus, FeProgram::CalculiX, FeProgram::Moose, FeProgram::Csv] {
        let text = plain.text(program).to_lowercase();
        assert!(
            !text.contains("conductance") && !text.contains("friction") && !text.contains("slip")
        );
    }
    let current = Conduction::electrical(E_STAR, 3.4e-8).unwrap();
    let current = InterfaceTable::builder(history).conduction(current).build().unwrap();
    assert!(current.text(FeProgram::Abaqus).contains("*GAP ELECTRICAL CONDUCTANCE, PRESSURE\n"));
    assert!(current.text(FeProgram::CalculiX).contains("\n*GAP CONDUCTANCE\n"));
    assert!(
        current.text(FeProgram::Csv).starts_with("pressure,overclosure,electrical_conductance\n")
    );
}

/// The same law in mm, N, MPa, t, s and A: energies in mJ, so that pressure times overclosure, conductance times a
/// temperature or half a voltage squared, and slip limit squared over stiffness are what they were, per mm².
#[test]
fn tables_may_be_in_millimetres() {
    let history = &paths()[1];
    let heat = table(history, 0.02);
    let current = Conduction::electrical(E_STAR, 3.4e-8).unwrap();
    let current = InterfaceTable::builder(history).conduction(current).build().unwrap();
    let read = |table: &InterfaceTable, units: FeUnits| -> Vec<Vec<f64>> {
        let text = table.text_in(FeProgram::Csv, units);
        let lines = text.lines().skip(1);
        lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
    };
    for (table, conductance) in [(&heat, 1e-3), (&current, 1e-9)] {
        let both = read(table, FeUnits::Si).into_iter().zip(read(table, FeUnits::Millimetres));
        for (si, mm) in both {
            // MPa, mm, mW/(mm² K) or A/(mV mm²), MPa/mm, MPa.
            for ((si, mm), unit) in si.iter().zip(&mm).zip([1e-6, 1e3, conductance, 1e-9, 1e-6]) {
                assert!((mm - unit * si).abs() <= 1e-12 * mm, "{si:e} {mm:e}");
            }
        }
    }
    let names = |table: &InterfaceTable, units: FeUnits| {
        table.text_in(FeProgram::Csv, units).lines().next().unwrap().to_string()
    };
    assert!(names(&heat, FeUnits::Si).starts_with("pressure,overclosure,thermal_conductance,"));
    let told = "pressure [MPa],overclosure [mm],thermal_conductance [mW/(mm2 K)],";
    assert!(names(&heat, FeUnits::Millimetres).starts_with(told));
    let told = "pressure [MPa],overclosure [mm],electrical_conductance [A/(mV mm2)]";
    assert!(names(&current, FeUnits::Millimetres).starts_with(told));
    for program in [FeProgram::Abaqus, FeProgram::CalculiX, FeProgram::Moose] {
        let text = heat.text_in(program, FeUnits::Millimetres);
        assert!(text.lines().next().unwrap().contains("in mm, N, MPa, t, s, A"), "{text}");
        assert_eq!(heat.text_in(program, FeUnits::Si), heat.text(program));
        assert!(heat.text(program).lines().next().unwrap().ends_with("in SI units"));
    }
}

#[test]
fn tables_of_nothing_are_refused() {
    let full = &paths()[0];
    for bad in [0.0, -0.1, f64::NAN, f64::INFINITY, 1.0] {
        assert!(InterfaceTable::builder(full).tolerance(bad).build().is_err());
    }
    for bad in [0.0, -0.1, f64::NAN] {
        assert!(InterfaceTable::builder(full).friction(bad, 1.2).build().is_err());
        assert!(InterfaceTable::builder(full).friction(0.2, bad).build().is_err());
    }
    let first: History = full.states()[..1].iter().copied().collect();
    for history in [History::default(), first] {
        let refused = InterfaceTable::builder(&history).build();
        assert!(matches!(refused, Err(Error::OutOfRange { .. })));
    }
    // Without stiffnesses there is no state to put in.
    let none = full.states().iter().map(|state| {
        let mut contact = state.contact;
        contact.interfacial_stiffness = None;
        LoadingState::new(state.step, ContactEvent::Touch, state.node, contact)
    });
    assert!(InterfaceTable::builder(&none.collect()).build().is_err());
}

/// States in a row with these overclosures and pressures, by hand.
fn by_hand(points: &[(f64, f64)]) -> History {
    let grid = Grid::square(10, 1.0).unwrap();
    let states = points.iter().enumerate().map(|(k, (overclosure, pressure))| {
        let load = pressure * grid.nominal_area();
        let mut contact = ContactState::new(&grid, k + 1, k as f64, load, 1.0 - overclosure);
        contact.interfacial_stiffness = Some(-1.0);
        LoadingState::new(k + 1, ContactEvent::Touch, (k, 0), contact)
    });
    states.collect()
}

/// By hand: of 100 nodes 1 and 2 are in contact, and the mean gap is 1 m and 0.6 m. Over 0.99 and 0.98 of the area it
/// is so much more.
#[test]
fn a_gap_conducts_beside_the_interface() {
    let states = by_hand(&[(0.0, 0.0), (0.4, 3.0)]);
    let with_stiffness = states.states().iter().map(|state| {
        let mut contact = state.contact;
        contact.interfacial_stiffness = Some(7.0);
        LoadingState::new(state.step, state.event, state.node, contact)
    });
    let solid = Conduction::thermal(2.0, 0.5).unwrap();
    let history: History = with_stiffness.collect();
    let conductances = |conduction: Conduction| -> Vec<f64> {
        let table = InterfaceTable::builder(&history).conduction(conduction).build().unwrap();
        table.rows().iter().map(|row| row.conductance.unwrap()).collect()
    };
    let expected = [0.1 * 0.99 / (1.0 / 0.99 + 2.0), 0.1 * 0.98 / (0.6 / 0.98 + 2.0)];
    let found = conductances(solid.with_gap(0.1, 2.0).unwrap());
    assert_eq!(found.len(), 2);
    for ((found, solid), gap) in found.into_iter().zip(conductances(solid)).zip(expected) {
        // Of 1 m², to some roundings of the sum.
        assert!(
            (solid - 14.0).abs() < 1e-13 && (found - solid - gap).abs() < 1e-13,
            "{found} {gap}"
        );
    }
}

/// Where the mean gap opens under a greater load the stiffness is negative. A state whose pressure the table has all
/// the same is left out; else the table would be wrong there, and the error says where.
#[test]
fn gaps_that_open_are_coped_with_or_named() {
    let build = |history: &History| InterfaceTable::builder(history).tolerance(0.1).build();
    // At 0.49 the line from (0.4, 3) to (0.5, 4) has 3.9 for 4.2, which is 7 % off, and for 4.5, which is 13 %.
    let near = by_hand(&[(0.0, 0.0), (0.4, 3.0), (0.5, 4.0), (0.49, 4.2), (0.6, 5.0)]);
    let table = build(&near).unwrap();
    let pressures: Vec<f64> = table.rows().iter().map(|row| row.pressure).collect();
    assert!(!pressures.contains(&4.2) && pressures.last() == Some(&5.0), "{pressures:?}");
    let far = by_hand(&[(0.0, 0.0), (0.4, 3.0), (0.5, 4.0), (0.49, 4.5), (0.6, 5.0)]);
    match build(&far) {
        Err(Error::Joint(JointError::NoFunction {
            step: 4,
            quantity,
            value,
            interpolated,
            ..
        })) => {
            assert_eq!((quantity, value), ("pressure", 4.5));
            // Of rows, some of which the tolerance has left out.
            assert!((interpolated - 3.9).abs() < 0.1, "{interpolated}");
        }
        other => panic!("{other:?}"),
    }
    // A stiff coat on a soft base, pressed by asperities far from each other, becomes a dish.
    let grid = Grid::square(32, 1.25e-3).unwrap();
    let glass = Layer { youngs_modulus: 70e9, poissons_ratio: 0.22, thickness: 2e-4 };
    let base = Base::HalfSpace { youngs_modulus: 3e6, poissons_ratio: 0.49 };
    let coat = Layered::free(grid, LayeredBody::new(&[glass], base).unwrap()).unwrap();
    let path = history(&rough(), &coat, 0.1);
    let is_negative = |state: &&LoadingState| state.contact.interfacial_stiffness < Some(0.0);
    assert!(path.states().iter().filter(is_negative).count() > 10);
    let refused = InterfaceTable::builder(&path).build();
    assert!(matches!(refused, Err(Error::Joint(JointError::NoFunction { .. }))));
}
