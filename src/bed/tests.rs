//! Beds whose numbers can be worked out by hand, and superpositions against their fields.

#![allow(clippy::unwrap_used, clippy::panic)]

use nalgebra::DMatrix;

use super::{Bed, Superposition};
use crate::contact::ContactState;
use crate::loading::{ContactEvent, History, LoadingState};
use crate::{
    BedError, Boussinesq, Error, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq,
    SelfAffine, test_chain,
};

/// Nodes 0 and 2 touch at the approaches 0 and 1, each a spring of 1/2 N/m: a quarter of a pascal on 2 m² for each
/// metre.
fn chain() -> Result<(LoadingSolver, History), Error> {
    let (surface, kernel) = (test_chain::surface(&[0.0, 9.0, 1.0, 9.0])?, test_chain::kernel(4)?);
    let mut path = LoadingSolver::builder(&surface, &kernel).max_approach(3.0).build()?;
    let history = path.by_ref().collect::<Result<_, _>>()?;
    Ok((path, history))
}

#[test]
fn springs_and_states_of_a_chain() -> Result<(), Error> {
    let (_, history) = chain()?;
    let bed = Bed::new(&history)?;
    let springs: Vec<_> = bed.springs().map(|s| (s.stiffness, s.gap, s.load)).collect();
    assert_eq!(springs, [(0.5, 0.0, 0.0), (0.5, 1.0, 0.5)]);
    assert_eq!((bed.loads(), bed.approaches()), (&[0.0, 0.5, 2.5][..], &[0.0, 1.0, 3.0][..]));
    assert_eq!((bed.energies(), bed.stiffnesses()), (&[0.0, 0.25, 3.25][..], &[0.5, 1.0, 1.0][..]));
    assert_eq!((bed.greatest_load(), bed.is_full()), (2.5, false));
    for (load, approach, energy, stiffness, nodes) in [
        (0.0, 0.0, 0.0, 0.5, 1),
        (0.25, 0.5, 0.0625, 0.5, 1),
        (0.5, 1.0, 0.25, 1.0, 2),
        (1.5, 2.0, 1.25, 1.0, 2),
        (2.5, 3.0, 3.25, 1.0, 2),
    ] {
        for state in [bed.at_load(load)?, bed.at_approach(approach)?] {
            let found = (state.load, state.approach, state.energy, state.stiffness);
            assert_eq!(found, (load, approach, energy, stiffness));
            assert_eq!((state.contact_nodes, state.contact_area), (nodes, 2.0 * nodes as f64));
        }
    }
    Ok(())
}

/// The second increment by half: node 0 carries 1/4 + 1/2 · 1/2 and node 2 half of 1/2, under displacements of 4 each.
#[test]
fn a_superposition_of_two_increments() -> Result<(), Error> {
    let (mut path, history) = chain()?;
    let bed = Bed::new(&history)?;
    let state = Superposition::new([(0.5, 1.0), (2.5, 0.5)])?;
    let found = state.scalars(&bed)?;
    assert_eq!((state.load(), found.load, found.approach), (1.5, 1.5, 2.0));
    // ½ · 2 m² · (0.5 · 2 + 0.25 · 1) J/m².
    assert!((found.energy - 1.25).abs() < 1e-15, "{}", found.energy);
    let near = |found: DMatrix<f64>, expected: [f64; 4]| {
        let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Rounding errors of a transform of numbers up to 9.
        assert!(off < 1e-13, "{found} {expected:?}");
    };
    near(state.pressure(&bed, &mut path)?, [0.5, 0.0, 0.25, 0.0]);
    near(state.displacement(&bed, &mut path)?, [2.0, 0.75, 1.0, 0.25]);
    // The gap of node 2 closes by 1 and then no more.
    near(state.gap_change(&bed, &mut path)?, [0.0, -1.25, -1.0, -1.75]);
    Ok(())
}

/// What is beyond the last load by rounding has the fields of the last, bit for bit; and nothing beyond has any.
#[test]
fn fields_beyond_the_last_load_by_rounding_are_the_last() -> Result<(), Error> {
    let (mut path, history) = chain()?;
    let bed = Bed::new(&history)?;
    let mut fields = |end: f64| -> Result<_, Error> {
        let state = Superposition::new([(0.5, 1.0), (end, 0.5)])?;
        Ok([
            state.pressure(&bed, &mut path)?,
            state.displacement(&bed, &mut path)?,
            state.gap_change(&bed, &mut path)?,
        ])
    };
    let expected = fields(2.5)?;
    for beyond in [2.5_f64.next_up(), 2.5 * (1.0 + 5e-13)] {
        assert_eq!(fields(beyond)?, expected);
        assert_eq!(bed.path_state(beyond)?, bed.path_state(2.5)?);
    }
    let refused = fields(2.5 * (1.0 + 2e-12));
    assert!(matches!(refused, Err(Error::Bed(BedError::PathEndsBefore { .. }))), "{refused:?}");
    Ok(())
}

/// Scalars of superpositions of many pieces are those of their fields, on a free and on a periodic half-space.
#[test]
fn scalars_are_those_of_the_fields() -> Result<(), Error> {
    let grid = Grid::square(16, 6.25e-4)?;
    let kernels: [&dyn InfluenceKernel; 2] =
        [&Boussinesq::new(grid, 1e9)?, &PeriodicBoussinesq::new(grid, 1e9)?];
    for kernel in kernels {
        // To full contact and beyond it.
        let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(3), kernel).build()?;
        let history = path.run()?;
        let bed = Bed::new(&history)?;
        let top = bed.last_load();
        assert_eq!(bed.greatest_load(), f64::INFINITY);
        let parts = [(0.01, 0.9), (0.2, -0.7), (0.21, 1.0), (0.6, 0.0), (1.0, 0.4), (1.1, -0.3)];
        let state = Superposition::new(parts.map(|(end, weight)| (end * top, weight)))?;
        let found = state.scalars(&bed)?;
        let (pressure, displacement) =
            (state.pressure(&bed, &mut path)?, state.displacement(&bed, &mut path)?);
        let area = grid.cell_area();
        let energy = 0.5 * area * pressure.dot(&displacement);
        let gap = state.gap_change(&bed, &mut path)?.mean() + bed.mean_gaps()[0];
        let scale = bed.at_load(state.end())?;
        // Rounding of 256 nodes, and of fast transforms.
        for (name, found, expected, scale) in [
            ("load", found.load, area * pressure.sum(), scale.load),
            ("load", state.load(), area * pressure.sum(), scale.load),
            ("energy", found.energy, energy, scale.energy),
            ("mean gap", found.mean_gap, gap, bed.mean_gaps()[0]),
        ] {
            assert!((found - expected).abs() < 1e-12 * scale, "{name}: {found} {expected}");
        }
        // The node that touched first moves as the approach says.
        let node = history.states()[0].node;
        let off = displacement[node] - found.approach;
        assert!(off.abs() < 1e-12 * scale.approach, "{off}");
    }
    Ok(())
}

/// The energy of knots is that of the path, and all of it is read as the history reads it.
#[test]
fn a_bed_reads_what_its_history_reads() -> Result<(), Error> {
    let kernel = Boussinesq::new(Grid::square(24, 9.375e-4)?, 1e9)?;
    let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(2), &kernel)
        .max_area_fraction(0.4)
        .build()?;
    let history = path.run()?;
    let bed = Bed::new(&history)?;
    for k in 0..=50 {
        let load = bed.last_load() * f64::from(k) / 50.0;
        let (found, expected) = (bed.at_load(load)?, bed.path_state(load)?.contact);
        assert_eq!(found.contact_nodes, expected.contact_nodes);
        for (found, expected) in [
            (found.approach, expected.approach),
            (found.mean_gap, expected.mean_gap),
            (found.energy, expected.energy),
            (bed.at_approach(found.approach)?.load, load),
        ] {
            // Sums of 230 terms.
            assert!((found - expected).abs() <= 1e-13 * expected, "{found} {expected}");
        }
    }
    Ok(())
}

fn state(step: usize, approach: f64, load: f64, mean_gap: f64) -> LoadingState {
    let grid = Grid::new(4, 5, 1.0, 1.0).unwrap();
    let mut contact = ContactState::new(&grid, step, approach, load, mean_gap);
    contact.contact_stiffness = Some(step as f64);
    LoadingState::new(step, ContactEvent::Touch, (step - 1, 0), contact)
}

#[test]
fn what_is_no_bed_is_refused() -> Result<(), Error> {
    let good = [state(1, 0.0, 0.0, 5.0), state(2, 1.0, 1.0, 4.5), state(3, 2.0, 3.0, 4.0)];
    let refused = |states: &[LoadingState]| {
        let history: History = states.iter().copied().collect();
        match Bed::new(&history) {
            Ok(_) => None,
            Err(Error::Bed(error)) => Some(error),
            Err(other) => unreachable!("{other}"),
        }
    };
    assert!(refused(&good).is_none());
    assert!(matches!(refused(&[]), Some(BedError::Empty)));
    assert!(matches!(
        refused(&good[1..]),
        Some(BedError::NotFromFirstTouch { load: 1.0, approach: 1.0 })
    ));
    for (event, word) in [(ContactEvent::Release, "leaves"), (ContactEvent::Yield, "yields")] {
        let mut states = good;
        states[2].event = event;
        let error = refused(&states);
        assert!(
            matches!(&error, Some(BedError::NotElasticGrowth { event: 3, ix: 2, iy: 0, happens, .. }) if happens.contains(word)),
            "{error:?}"
        );
    }
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let set: [fn(&mut ContactState, f64); 3] = [
            |contact, x| contact.load = x,
            |contact, x| contact.approach = x,
            |contact, x| contact.mean_gap = x,
        ];
        for (set, name) in set.into_iter().zip(["load", "approach", "mean gap"]) {
            let mut states = good;
            set(&mut states[1].contact, bad);
            let error = refused(&states);
            assert!(
                matches!(error, Some(BedError::NotMonotone { step: 2, quantity, .. }) if quantity == name),
                "{error:?}"
            );
        }
    }
    for (place, approach, load, gap) in
        [(1, 1.0, -0.5, 4.5), (2, 0.5, 3.0, 4.0), (2, 2.0, 0.5, 4.0), (2, 2.0, 3.0, 4.75)]
    {
        let mut states = good;
        states[place] = state(place + 1, approach, load, gap);
        assert!(matches!(refused(&states), Some(BedError::NotMonotone { .. })));
    }
    for stiffness in [None, Some(0.0), Some(-1.0), Some(f64::NAN)] {
        let mut states = good;
        states[2].contact.contact_stiffness = stiffness;
        assert!(matches!(refused(&states), Some(BedError::NoStiffness { step: 3, .. })));
    }
    Ok(())
}

#[test]
fn what_lies_outside_is_refused() -> Result<(), Error> {
    let (_, history) = chain()?;
    let bed = Bed::new(&history)?;
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(bed.at_load(bad), Err(Error::OutOfRange { quantity: "load", .. })));
        let refused = bed.at_approach(bad);
        assert!(matches!(refused, Err(Error::OutOfRange { quantity: "approach", .. })));
    }
    let told = bed.at_load(2.75).err().map(|error| error.to_string());
    assert_eq!(told.as_deref(), Some("the path ends at the load 2.5 N, before 2.75 N"));
    let told = bed.at_approach(4.0).err().map(|error| error.to_string());
    assert_eq!(told.as_deref(), Some("the path ends at the approach 3 m, before 4 m"));
    let beyond = Superposition::new([(2.75, 1.0)])?;
    assert!(matches!(beyond.scalars(&bed), Err(Error::Bed(BedError::PathEndsBefore { .. }))));
    for bad in [[(1.0, 1.0), (0.5, 1.0)], [(f64::NAN, 1.0), (1.0, 1.0)], [(-1.0, 1.0), (1.0, 1.0)]]
    {
        assert!(matches!(Superposition::new(bad), Err(Error::OutOfRange { .. })));
    }
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(matches!(Superposition::new([(1.0, bad)]), Err(Error::OutOfRange { .. })));
    }
    // Nothing is a state too: that of first touch.
    let none = Superposition::new([(0.0, 1.0)])?;
    assert_eq!((none.pieces().len(), none.load(), none.scalars(&bed)?.approach), (0, 0.0, 0.0));
    Ok(())
}

/// Behind full contact a free half-space goes on as a punch; under a periodic one the mean planes stop, and no approach
/// can be asked for.
#[test]
fn full_contact_goes_on() -> Result<(), Error> {
    let grid = Grid::square(6, 1.0)?;
    let surface = crate::HeightMap::new(DMatrix::from_fn(6, 6, |ix, iy| {
        -0.01 * ((ix as f64 - 2.3).powi(2) + (iy as f64 - 3.1).powi(2))
    }))?;
    let read = |kernel: &dyn InfluenceKernel| -> Result<History, Error> {
        LoadingSolver::builder(&surface, kernel).build()?.collect()
    };
    let history = read(&Boussinesq::new(grid, 1.0)?)?;
    let bed = Bed::new(&history)?;
    let (last, beyond) = (bed.at_load(bed.last_load())?, bed.at_load(2.0 * bed.last_load())?);
    let advance = bed.last_load() / last.stiffness;
    assert!((beyond.approach - last.approach - advance).abs() < 1e-14 * beyond.approach);
    assert_eq!((beyond.mean_gap, beyond.contact_nodes), (0.0, 36));
    assert!((bed.at_approach(beyond.approach)?.load / beyond.load - 1.0).abs() < 1e-14);

    let history = read(&PeriodicBoussinesq::new(grid, 1.0)?)?;
    let bed = Bed::new(&history)?;
    let (last, beyond) = (bed.at_load(bed.last_load())?, bed.at_load(2.0 * bed.last_load())?);
    assert_eq!((beyond.approach, beyond.energy), (last.approach, last.energy));
    assert_eq!(beyond.stiffness, f64::INFINITY);
    assert_eq!(bed.at_approach(last.approach)?.load, last.load);
    let refused = bed.at_approach(1.01 * last.approach);
    assert!(matches!(refused, Err(Error::Bed(BedError::PathEndsBefore { .. }))), "{refused:?}");
    Ok(())
}
