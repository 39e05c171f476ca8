//! Questions in between do not change a bit of the path.

use crate::problems::{grid, kernels, rough};
use crate::resumed::whole;
use asperity::loading::LoadingBuilder;
use asperity::updater::{ConjugateGradient, Dense, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{ContactGrowth, LoadingSolver};

/// The same path twice, once with every question at every third state.
fn undisturbed<U: LinearUpdater + Clone>(builder: &LoadingBuilder<'_, U>, context: &str) {
    for window in [1, 7, 40] {
        let builder = builder.clone().window_size(window);
        let expected = whole(builder.clone());
        let mut path = builder.build().unwrap();
        let mut states = Vec::new();
        while let Some(state) = path.next() {
            let state = state.unwrap();
            states.push(state);
            if state.step % 3 == 0 {
                path.fields().unwrap();
                path.certificate().unwrap();
                path.fields_at(&states[states.len() / 3]).unwrap();
                path.fields_at(&states[states.len() - 2]).unwrap();
                assert_eq!(path.contact_map().shape(), path.grid().shape());
            }
        }
        // Derived equality: every number, and none is NaN.
        assert!(states == expected, "{context}, window {window}");
    }
}

fn everywhere<U: LinearUpdater + Clone>(updater: U, context: &str) {
    let surface = rough(&grid(), 11);
    for (name, kernel) in kernels(grid()) {
        let builder = LoadingSolver::builder(&surface, &kernel).updater(updater.clone());
        let builder = builder.max_area_fraction(0.5);
        undisturbed(&builder, &format!("{context}, {name}"));
        if kernel.contact_growth() != ContactGrowth::Unknown {
            let load = whole(builder.clone()).last().unwrap().contact.load;
            // Half of the pressure that the nodes in contact bear on average: most of them yield.
            let hardness = load / grid().nominal_area();
            undisturbed(&builder.hardness(hardness), &format!("{context}, {name}, hardness"));
        }
    }
}

#[test]
fn by_questions_to_cholesky() {
    everywhere(RecursiveCholesky::new(), "Cholesky");
}

#[test]
fn by_questions_to_iterations() {
    everywhere(ConjugateGradient::new(), "conjugate gradients");
}

#[test]
fn by_questions_to_others() {
    everywhere(Handover::new(), "handover");
    let surface = rough(&grid(), 11);
    let kernel = &kernels(grid())[0].1;
    let builder = LoadingSolver::builder(&surface, kernel).updater(Dense::new());
    undisturbed(&builder.max_area_fraction(0.5), "dense");
}

/// Nor to a factor that hands over on the way.
#[test]
fn by_questions_across_the_seam() {
    let surface = rough(&grid(), 12);
    let kernel = &kernels(grid())[0].1;
    let fixed = LoadingSolver::new(&surface, kernel).unwrap().bytes();
    let mut seams = 0;
    for extra in (200_000..2_000_000).step_by(200_000) {
        let builder = || {
            LoadingSolver::builder(&surface, kernel)
                .updater(Handover::new())
                .memory_budget(fixed + extra)
        };
        let expected: Vec<_> = builder().build().unwrap().map_while(Result::ok).collect();
        let mut path = builder().build().unwrap();
        let mut states = Vec::new();
        while let Some(Ok(state)) = path.next() {
            states.push(state);
            path.certificate().unwrap();
            path.fields_at(&states[states.len() / 2]).unwrap();
        }
        assert!(states == expected, "{extra} bytes");
        let seam = path.handed_over_at();
        seams += usize::from(seam.is_some_and(|seam| seam > 0 && seam < states.len()));
    }
    assert!(seams > 0, "{seams}");
}
