//! Paths on disk.

use asperity::Error;
use asperity::record::LoadingRecord;

use super::dense::near;
use super::rows::{Pressed, through_a_file};

/// What is written is read: states, settings, body, and the fields of its states.
pub(super) fn record(pressed: &mut Pressed<'_>) -> Result<(), Error> {
    let name = pressed.row.name;
    let written = LoadingRecord::new(&pressed.path, pressed.history.clone())?;
    let read = through_a_file(&written);
    assert_eq!(read.history(), &pressed.history, "{name}");
    let kernel = &pressed.row.kernel;
    assert_eq!(read.history().layering(), kernel.origin().layering(kernel.boundary()), "{name}");
    assert_eq!(read.settings(), written.settings(), "{name}");
    assert_eq!(read.hardness_map()?, pressed.path.hardness_map(), "{name}");
    assert_eq!(read.hardness_map()?, pressed.row.hardness, "{name}");
    assert_eq!((read.end(), read.grid()), (pressed.path.end(), pressed.path.grid()), "{name}");
    let mut replay = read.replay()?;
    let [mut found, mut expected] = [read.states().to_vec(), pressed.history.states().to_vec()];
    replay.add_unloading_stiffness(&mut found)?;
    pressed.path.add_unloading_stiffness(&mut expected)?;
    assert_eq!(found, expected, "{name}");
    for state in pressed.some() {
        let (found, expected) =
            (replay.fields_at(&state)?.pressure, pressed.path.fields_at(&state)?.pressure);
        let greatest = expected.max();
        for (found, expected) in found.iter().zip(&expected) {
            // A solution by iterations to some 10⁻¹², beside one with a factor.
            near(*found, *expected, 1e-9 * greatest, name);
        }
        assert_eq!(replay.contact_map_at(&state)?, pressed.path.contact_map_at(&state)?, "{name}");
        assert_eq!(
            replay.fields_at(&state)?.yielded_map,
            pressed.path.fields_at(&state)?.yielded_map,
            "{name}"
        );
    }
    Ok(())
}

/// A path that is interrupted and goes on from its record is the one that is not, bit for bit.
pub(super) fn resume(pressed: &mut Pressed<'_>) -> Result<(), Error> {
    let row = pressed.row;
    let states = pressed.history.states().len();
    for states in [3, states / 2, 4 * states / 5] {
        let (path, before) = row.follow(states);
        let (_, found) = row.resume(&LoadingRecord::new(&path, before)?);
        assert_eq!(found.events(), pressed.history.events(), "{}", row.name);
    }
    Ok(())
}
