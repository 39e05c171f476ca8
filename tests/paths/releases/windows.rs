//! Windows of kernels that break what windows rest on.

use super::table::Table;
use crate::common::with_window;
use crate::problems::{grid, layer, rough};
use asperity::loading::ContactEvent;
use asperity::{Boundary, ContactGrowth, LoadingSolver, LoadingState};
use asperity_testing::dense::restrict;
use nalgebra::DVector;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;

/// Where contact happens to grow, the same path with windows that are checked at their ends; gaps of
/// these kernels are far from convex, so that events are taken back.
#[test]
fn windows_of_kernels_whose_gaps_are_not_convex() {
    let (mut paths, mut taken_back) = (0, 0);
    for seed in 0..400 {
        let mut random = ChaCha12Rng::seed_from_u64(3000 + seed);
        let mut kernel = Table::random((6, 4), Boundary::Free, &mut random);
        kernel.coefficients.apply(|value| *value *= if *value == 1.0 { 1.0 } else { 0.35 });
        let gaps: Vec<f64> = (0..24).map(|_| random.random_range(0.0..0.5)).collect();
        let expected: Vec<LoadingState> = kernel.path(&gaps).map(Result::unwrap).collect();
        let matrix = kernel.matrix();
        let mut order = Vec::new();
        let monotone = expected.iter().all(|state| {
            order.push(kernel.grid.node(state.node.0, state.node.1).unwrap());
            let own = restrict(&matrix, &order).cholesky();
            let y2 = own.map(|own| own.solve(&DVector::from_element(order.len(), 1.0)));
            let rates = y2.map(|y2| {
                (0..24).all(|i| {
                    order.iter().zip(&y2).map(|(&j, y)| matrix[(i, j)] * y).sum::<f64>()
                        < 1.0 + 1e-12
                })
            });
            state.event == ContactEvent::Touch && rates == Some(true)
        });
        if !monotone {
            continue;
        }
        kernel.growth = ContactGrowth::Monotone;
        for window in [None, Some(1), Some(3), Some(8)] {
            let heights = kernel.heights(&gaps);
            let builder = LoadingSolver::builder(&heights, &kernel);
            let mut path = with_window(builder, window).build().unwrap();
            for expected in &expected {
                let state = path.next().unwrap().unwrap();
                assert_eq!((state.step, state.node), (expected.step, expected.node));
                for (found, expected) in [
                    (state.contact.approach, expected.contact.approach),
                    (state.contact.load, expected.contact.load),
                    (state.contact.mean_gap, expected.contact.mean_gap),
                    (state.contact.energy, expected.contact.energy),
                    (
                        state.contact.contact_stiffness.unwrap(),
                        expected.contact.contact_stiffness.unwrap(),
                    ),
                ] {
                    assert!((found - expected).abs() < 1e-12 * (1.0 + expected), "{state:?}");
                }
            }
            assert!(path.next().is_none());
            taken_back += path.timings().taken_back;
        }
        paths += 1;
    }
    println!("{paths} paths, {taken_back} events taken back");
    assert!(paths >= 10 && taken_back >= 30, "{paths} {taken_back}");
}

/// On a layer gaps are nearly convex: the ends of windows hardly ever contradict their events.
#[test]
fn little_is_taken_back_on_a_layer() {
    let kernel = layer(grid(), ContactGrowth::Monotone);
    let mut path = LoadingSolver::new(&rough(&grid(), 3), &kernel).unwrap();
    let events = path.by_ref().map(Result::unwrap).count();
    assert_eq!(events, grid().nodes());
    let taken_back = path.timings().taken_back;
    assert!(20 * taken_back <= events, "{taken_back} of {events}");
}
