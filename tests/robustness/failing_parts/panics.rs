//! A panic at the k-th call of an updater ends the path, if somebody catches it.

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::problems::{MAKERS, Small};
use super::refusals::is_over;
use super::updater::Fault;

#[test]
fn nothing_is_yielded_after_a_panic_at_any_call() {
    let mut methods = BTreeSet::new();
    let mut answered = 0;
    for small in Small::all() {
        for maker in MAKERS {
            let expected = small.states(maker);
            for fault in [Fault::PanicBefore, Fault::PanicAfter] {
                for at in 0.. {
                    let context = format!("{}, {}, {fault:?} at call {at}", small.name, maker.0);
                    let built = catch_unwind(|| small.path(maker, fault, at));
                    let Ok(built) = built else {
                        methods.insert("make_room");
                        continue;
                    };
                    let mut path = built.unwrap();
                    let mut states = Vec::new();
                    let has_panicked = loop {
                        match catch_unwind(AssertUnwindSafe(|| path.next())) {
                            Ok(Some(state)) => states.push(state.unwrap()),
                            Ok(None) => break false,
                            Err(_) => break true,
                        }
                    };
                    assert!(states == expected[..states.len()], "{context}");
                    let Some(method) = path.updater().unwrap().state.struck() else {
                        // Beyond the last call.
                        assert!(!has_panicked && states.len() == expected.len());
                        break;
                    };
                    assert!(has_panicked, "{context}");
                    methods.insert(method);
                    answered += is_over(&small, maker, &mut path, &states, &context);
                }
            }
        }
    }
    assert_eq!(
        methods.into_iter().collect::<Vec<_>>(),
        ["bytes", "join", "make_room", "release", "solve", "truncate", "watch"]
    );
    assert!(answered > 1000, "{answered}");
}
