//! An error at the k-th call of an updater is the last item of the path, and takes nothing away.

use asperity::loading::LoadingEnd;
use asperity::{ContactTarget, Error};

use super::problems::{MAKERS, Maker, Path, Small};
use super::updater::{Fault, is_refusal};

/// After its end a path yields nothing and does not go on; what it has yielded it still knows. Returns for how many
/// states it answered.
pub(super) fn is_over(
    small: &Small,
    maker: Maker,
    path: &mut Path,
    states: &[asperity::LoadingState],
    context: &str,
) -> usize {
    assert_eq!(path.end(), Some(LoadingEnd::Failed), "{context}");
    for _ in 0..3 {
        assert!(path.next().is_none(), "{context}");
    }
    assert_eq!(path.size_hint(), (0, Some(0)), "{context}");
    assert!(matches!(
        path.continue_to(ContactTarget::Load(1e9)),
        Err(Error::CannotContinue { steps }) if steps == states.len()
    ));
    assert_eq!(path.state(), states.last().copied(), "{context}");
    let nodes = states.last().map_or(0, |state| state.contact.contact_nodes);
    assert_eq!(path.contact_order().len(), nodes, "{context}");
    let mut answered = 0;
    for state in states {
        let map = path.contact_map_at(state).unwrap();
        let in_contact = map.iter().filter(|in_contact| **in_contact).count();
        assert_eq!(in_contact, state.contact.contact_nodes, "{context}");
        // Of an updater that has failed once anything but a wrong answer is welcome.
        if let Ok(pressure) = path.fields_at(state).map(|fields| fields.pressure) {
            answered += 1;
            let allowed = small.allowed(state, maker) * small.stiffness();
            for (found, expected) in pressure.iter().zip(&small.pressure(state)) {
                assert!((found - expected).abs() <= allowed, "{context}: {state:?}");
            }
        }
    }
    answered
}

#[test]
fn an_error_at_any_call_is_the_last_item() {
    let (mut refused, mut answered) = (0, 0);
    let mut methods = std::collections::BTreeSet::new();
    for small in Small::all() {
        for maker in MAKERS {
            let expected = small.states(maker);
            let calls = {
                let mut path = small.path(maker, Fault::Refuse, usize::MAX).unwrap();
                path.by_ref().for_each(drop);
                path.updater().unwrap().state.calls()
            };
            for at in 0..calls {
                let context = format!("{}, {}, call {at}", small.name, maker.0);
                let mut path = match small.path(maker, Fault::Refuse, at) {
                    Ok(path) => path,
                    Err(error) => {
                        assert!(is_refusal(&error), "{context}: {error}");
                        methods.insert("make_room");
                        continue;
                    }
                };
                let mut states = Vec::new();
                let mut failure = None;
                for item in path.by_ref() {
                    match item {
                        Ok(state) => states.push(state),
                        Err(error) => {
                            assert!(failure.is_none(), "{context}: two errors");
                            failure = Some(error);
                        }
                    }
                }
                assert!(states == expected[..states.len()], "{context}");
                let Some(method) = path.updater().unwrap().state.struck() else {
                    // A question that cannot fail.
                    assert!(failure.is_none() && states.len() == expected.len());
                    continue;
                };
                assert!(failure.is_some_and(|e| is_refusal(&e)), "{context}");
                methods.insert(method);
                refused += 1;
                answered += is_over(&small, maker, &mut path, &states, &context);
            }
        }
    }
    assert_eq!(
        methods.into_iter().collect::<Vec<_>>(),
        ["join", "make_room", "release", "solve", "truncate", "watch"]
    );
    assert!(refused > 300 && answered > refused, "{refused} {answered}");
}
