//! A question of fields that fails is that question's failure: the path goes on as if it had not been asked.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::problems::{MAKERS, Small};
use super::updater::{Fault, is_refusal};

#[test]
fn questions_that_fail_do_not_disturb_the_path() {
    let mut failed = 0;
    for small in Small::all() {
        for maker in MAKERS {
            let expected = small.states(maker);
            for fault in [Fault::Refuse, Fault::PanicBefore, Fault::PanicAfter] {
                for ahead in 0..3 {
                    let context = format!("{}, {}, {fault:?}", small.name, maker.0);
                    let mut path = small.path(maker, fault, usize::MAX).unwrap();
                    let mut states = Vec::new();
                    while let Some(state) = path.next() {
                        states.push(state.unwrap());
                        let earlier = states[states.len() / 2];
                        path.updater().unwrap().state.arm(ahead);
                        let asked = catch_unwind(AssertUnwindSafe(|| {
                            path.fields()?;
                            path.fields_at(&earlier)?;
                            path.certificate()
                        }));
                        failed += match asked {
                            Ok(Ok(_)) => 0,
                            Ok(Err(error)) => {
                                assert!(is_refusal(&error), "{context}: {error}");
                                1
                            }
                            Err(_) => 1,
                        };
                        path.updater().unwrap().state.arm(usize::MAX / 2);
                    }
                    assert!(states == expected, "{context}");
                }
            }
        }
    }
    assert!(failed > 500, "{failed}");
}
