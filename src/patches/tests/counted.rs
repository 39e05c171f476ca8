//! Histograms, and distributions of fields.

use nalgebra::{DMatrix, dmatrix};
use proptest::prelude::*;

use super::super::*;
use crate::{Error, SurfaceError};

/// The integral of a density.
fn integral(histogram: &Histogram) -> f64 {
    let widths = histogram.edges().windows(2).map(|edges| edges[1] - edges[0]);
    histogram.density().iter().zip(widths).map(|(density, width)| density * width).sum()
}

fn bins() -> impl Strategy<Value = Bins> {
    prop_oneof![(1_usize..40).prop_map(Bins::Linear), (1_usize..20).prop_map(Bins::PerDecade),]
}

proptest! {
    /// Counted one by one, with the definition of a bin.
    #[test]
    fn every_value_lies_in_its_bin(
        values in prop::collection::vec(prop_oneof![-1e3..1e3, 1e-20..1e-3, Just(0.0)], 0..60),
        bins in bins(),
    ) {
        let histogram = Histogram::new(values.iter().copied(), bins)?;
        let edges = histogram.edges();
        let last = edges.len().saturating_sub(2);
        for (bin, &count) in histogram.counts().iter().enumerate() {
            let is_in = |value: &&f64| {
                let below = **value < edges[bin + 1] || (bin == last && **value == edges[bin + 1]);
                **value >= edges[bin] && below
            };
            prop_assert_eq!(values.iter().filter(is_in).count(), count);
        }
        let inside: usize = histogram.counts().iter().sum();
        prop_assert_eq!(inside + histogram.outside(), values.len());
        if inside > 0 {
            let share = inside as f64 / values.len() as f64;
            // Some 60 bins of three rounding errors.
            prop_assert!((integral(&histogram) - share).abs() < 1e-13);
        }
        match bins {
            Bins::Linear(count) if inside > 0 => {
                prop_assert_eq!((histogram.counts().len(), histogram.outside()), (count, 0));
            }
            Bins::Linear(_) => prop_assert!(edges.is_empty()),
            Bins::PerDecade(_) => {
                let positive = values.iter().filter(|value| **value > 0.0).count();
                prop_assert_eq!(inside, positive);
                // No bin too many at either end.
                prop_assert!(histogram.counts().first() != Some(&0));
                prop_assert!(histogram.counts().last() != Some(&0));
            }
        }
    }
}

#[test]
fn decades_begin_at_powers_of_ten() -> Result<(), Error> {
    let histogram = Histogram::new([1.0, 10.0, 99.0, 1000.0], Bins::PerDecade(2))?;
    let edges = histogram.edges();
    assert_eq!(edges.len(), 8);
    for (k, edge) in edges.iter().enumerate() {
        // A power is rounded a few times.
        assert!((edge / 10.0_f64.powf(0.5 * k as f64) - 1.0).abs() < 1e-15);
    }
    assert_eq!(histogram.counts(), [1, 0, 1, 1, 0, 0, 1]);
    Ok(())
}

#[test]
fn values_without_a_range_have_no_bins() -> Result<(), Error> {
    for bins in [Bins::Linear(10), Bins::PerDecade(10)] {
        for values in [&[][..], &[0.0, 0.0]] {
            let histogram = Histogram::new(values.iter().copied(), bins)?;
            assert!(histogram.edges().is_empty() && histogram.density().is_empty());
            assert_eq!(histogram.outside(), values.len());
        }
    }
    let one = Histogram::with_edges([1.0, 2.0], vec![1.0])?;
    assert_eq!((one.counts(), one.outside()), (&[][..], 2));
    Ok(())
}

#[test]
fn impossible_histograms_are_refused() {
    let refused =
        |result: Result<Histogram, Error>| matches!(result, Err(Error::OutOfRange { .. }));
    for bins in
        [Bins::Linear(0), Bins::Linear(usize::MAX), Bins::PerDecade(0), Bins::PerDecade(usize::MAX)]
    {
        assert!(refused(Histogram::new([1.0], bins)), "{bins:?}");
    }
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(refused(Histogram::new([1.0, value], Bins::Linear(3))));
    }
    for edges in [vec![1.0, 1.0], vec![2.0, 1.0], vec![0.0, f64::NAN], vec![0.0, f64::INFINITY]] {
        assert!(refused(Histogram::with_edges([1.0], edges)));
    }
    // Of the least double there is no part, and beyond the greatest no edge.
    assert!(refused(Histogram::new([f64::from_bits(1)], Bins::Linear(10))));
    assert!(refused(Histogram::new([f64::MAX], Bins::PerDecade(10))));
    assert!(
        Histogram::new([-f64::MAX, f64::MAX], Bins::Linear(10)).is_ok_and(|histogram| {
            histogram.density().iter().all(|density| density.is_finite())
        })
    );
}

#[test]
fn pressures_count_in_contact_and_gaps_out_of_it() -> Result<(), Error> {
    let contact = dmatrix![true, false; true, false; true, false; false, false];
    let pressure = dmatrix![3.0, 0.0; 0.0, 0.0; 1.0, 0.0; 0.0, 0.0];
    let gap = dmatrix![1e-20, 4.0; 0.0, 1.0; 0.0, 1.0; 2.0, 3.0];
    let found = pressure_distribution(&pressure, &contact, Bins::Linear(3))?;
    assert_eq!(found.contact_area_fraction, 3.0 / 8.0);
    assert_eq!(found.histogram.edges(), [0.0, 1.0, 2.0, 3.0]);
    assert_eq!(found.histogram.counts(), [1, 1, 1]);
    let found = gap_distribution(&gap, &contact, Bins::Linear(4))?;
    assert_eq!(found.contact_area_fraction, 3.0 / 8.0);
    assert_eq!(found.histogram.counts(), [0, 2, 1, 2]);
    // Powers of two: exact.
    assert_eq!(integral(&found.histogram), 1.0);
    // Full contact has no gap.
    let full = contact.map(|_| true);
    let found = gap_distribution(&gap, &full, Bins::Linear(4))?;
    assert_eq!((found.contact_area_fraction, found.histogram.edges()), (1.0, &[][..]));

    let bins = Bins::Linear(3);
    assert!(matches!(
        pressure_distribution(&pressure.transpose(), &contact, bins),
        Err(Error::GridMismatch { expected: (2, 4), found: (4, 2) })
    ));
    let nothing = DMatrix::zeros(0, 3);
    assert!(matches!(
        gap_distribution(&nothing, &contact, bins),
        Err(Error::Surface(SurfaceError::EmptyGrid { nx: 0, ny: 3 }))
    ));
    let mut bad = pressure;
    bad[(2, 1)] = f64::NAN;
    assert!(matches!(
        pressure_distribution(&bad, &contact, bins),
        Err(Error::FieldNotFinite { field: "pressure", ix: 2, iy: 1, .. })
    ));
    Ok(())
}
