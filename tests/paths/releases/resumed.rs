//! Paths on which nodes leave, gone on from and kept on disk.

use super::table::{Table, case};
use asperity::loading::{ContactEvent, History};
use asperity::updater::RecursiveCholesky;
use asperity::{Error, LoadingSolver, LoadingState};

/// The first cases on whose path a node leaves, and their paths.
fn cases(count: usize) -> impl Iterator<Item = (Table, Vec<f64>, Vec<LoadingState>)> {
    let all = (0..).map(|seed| {
        let (kernel, gaps) = case(seed);
        let states: Vec<LoadingState> = kernel.path(&gaps).map(Result::unwrap).collect();
        (kernel, gaps, states)
    });
    let leaves =
        |states: &[LoadingState]| states.iter().any(|state| state.event == ContactEvent::Release);
    all.filter(move |(_, _, states)| leaves(states)).take(count)
}

/// Resumed at any of its states, before, at and behind a release, a path goes on with the events of one that was never
/// interrupted, and knows the fields of the states before. Matrices have a condition of 1e3 at most, and a closing rate
/// of 1e-3 would lose three digits more: 1e-9 of sixteen digits.
#[test]
fn paths_with_releases_go_on_from_any_state() {
    for (kernel, gaps, all) in cases(6) {
        let surface = kernel.heights(&gaps);
        let mut whole = kernel.path(&gaps);
        whole.by_ref().for_each(drop);
        for at in 0..all.len() {
            let history: History = all[..at].iter().copied().collect();
            let mut resumed = LoadingSolver::builder(&surface, &kernel)
                .updater(RecursiveCholesky::new())
                .resume(&history)
                .unwrap();
            assert_eq!(resumed.state(), history.states().last().copied());
            let rest: Vec<LoadingState> = resumed.by_ref().map(Result::unwrap).collect();
            assert_eq!(rest.len(), all.len() - at);
            for (found, expected) in rest.iter().zip(&all[at..]) {
                assert_eq!(
                    (found.step, found.event, found.node, found.contact.contact_nodes),
                    (expected.step, expected.event, expected.node, expected.contact.contact_nodes)
                );
                for (a, b) in [
                    (found.contact.approach, expected.contact.approach),
                    (found.contact.load, expected.contact.load),
                    (found.contact.mean_gap, expected.contact.mean_gap),
                ] {
                    assert!((a - b).abs() <= 1e-9 * (1.0 + b.abs()), "{found:?} {expected:?}");
                }
            }
            assert_eq!(resumed.contact_order(), whole.contact_order());
            for state in all.iter().step_by(5) {
                let (found, expected) = (
                    resumed.fields_at(state).map(|fields| fields.pressure),
                    whole.fields_at(state).map(|fields| fields.pressure),
                );
                let (found, expected) = (found.unwrap(), expected.unwrap());
                let error = (&found - &expected).amax();
                assert!(error <= 1e-9 * (1.0 + expected.amax()), "{error:e}, {state:?}");
            }
        }
    }
}

/// A contact that nodes have left since is factored once more for its fields, beside the factor of the present one:
/// where the budget has room for one of them only, the path goes to its end, and the question is refused.
#[test]
fn earlier_contacts_are_factored_within_the_budget() {
    let (kernel, gaps, all) = cases(1).next().unwrap();
    let surface = kernel.heights(&gaps);
    let release = all.iter().position(|state| state.event == ContactEvent::Release);
    let before = all[release.unwrap() - 1];
    let (mut ended, mut refused, mut answered) = (0, 0, 0);
    for budget in (0..3_000_000).step_by(20_000) {
        let path = LoadingSolver::builder(&surface, &kernel)
            .updater(RecursiveCholesky::new())
            .memory_budget(budget)
            .build();
        let Ok(mut path) = path else { continue };
        match path.by_ref().find_map(Result::err) {
            Some(Error::MemoryBudget { .. }) => continue,
            Some(error) => panic!("{error}"),
            None => ended += 1,
        }
        match path.fields_at(&before).map(|fields| fields.pressure) {
            Ok(_) => answered += 1,
            Err(Error::MemoryBudget { needed, budget: given, nodes_that_fit }) => {
                assert!(needed > given && given == budget, "{needed} {given}");
                assert_eq!(nodes_that_fit, path.contact_order().len());
                assert_eq!(answered, 0, "more room is less");
                refused += 1;
            }
            Err(error) => panic!("{error}"),
        }
    }
    assert!(refused > 0 && answered > 0 && ended == refused + answered);
}

/// A record of such a path keeps all of it but patches, which know no node that leaves. Its kernel cannot be made
/// again, and its fields are computed on the kernel itself.
#[cfg(feature = "io")]
#[test]
fn records_with_releases_are_read_back() {
    use asperity::record::LoadingRecord;

    for (number, (kernel, gaps, all)) in cases(3).enumerate() {
        let mut path = kernel.path(&gaps);
        let history = path.run().unwrap();
        let record = LoadingRecord::new(&path, history).unwrap();
        let name = format!("asperity-releases-{}-{number}.npz", std::process::id());
        let file = std::env::temp_dir().join(name);
        record.write_npz(&file, &[]).unwrap();
        let (bytes, read) = (std::fs::read(&file).unwrap(), LoadingRecord::read_npz(&file));
        std::fs::remove_file(&file).unwrap();
        let read = read.unwrap();
        assert_eq!(read.states(), all);
        assert_eq!(read.contact().unwrap().order(), path.contact_order());
        let has = |member: &str| {
            let name = member.as_bytes();
            bytes.windows(name.len()).any(|window| window == name)
        };
        assert!(has("heights.npy") && has("activation.npy") && !has("patches.npy"));

        assert!(matches!(read.make_kernel(), Err(Error::ForeignKernel)));
        assert!(matches!(read.resume(), Err(Error::ForeignKernel)));
        let mut replay = read.replay_on(&kernel).unwrap();
        for state in all.iter().step_by(4) {
            let expected = path.fields_at(state).unwrap().pressure;
            let found = replay.fields_at(state).unwrap().pressure;
            // Residuals of 1e-10 of the approach, times the condition number.
            let allowed = 1e-7 * (state.contact.approach + expected.amax());
            assert!((&found - &expected).amax() <= allowed, "{state:?}");
        }
    }
}
