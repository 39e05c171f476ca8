//! Patches of every state of a path against those that tamaas finds.

use asperity::patches::{Connectivity, PatchHistory};
use asperity::{Boundary, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq};
use asperity_testing::table;

use crate::common::surface;

/// Number of patches, perimeter and largest patch as tamaas counts them, at each of 768 states to full contact.
#[test]
fn every_state_has_the_patches_that_tamaas_counts() {
    let file = format!("{}/tests/data/periodic_32x24_love_patches.csv", env!("CARGO_MANIFEST_DIR"));
    let heights = surface("periodic_32x24");
    let kernel = PeriodicBoussinesq::new(Grid::new(32, 24, 2e-5, 3e-5).unwrap(), 1.0).unwrap();
    let mut path = LoadingSolver::builder(&heights, &kernel).build().unwrap();
    let contact = path.run().unwrap().contact_sequence(kernel.grid()).unwrap();
    let mut history = PatchHistory::new(&contact, Boundary::Periodic, Connectivity::Four);
    let mut states = 0;
    for row in table::read(file) {
        let [step, patches, perimeter, largest] = [0, 1, 2, 3].map(|column| row[column] as usize);
        let state = history.next().unwrap();
        let found = (state.patches, state.perimeter.sides(), state.largest);
        assert_eq!((state.step, found), (step, (patches, perimeter, largest)));
        states += 1;
    }
    assert!(history.next().is_none());
    assert_eq!(states, 768);
}
