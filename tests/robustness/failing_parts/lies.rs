//! Wrong answers at the k-th call of an updater.

use super::problems::{MAKERS, Small};
use super::updater::{Fault, Part};

/// Every kind of wrong answer.
fn lies() -> Vec<Fault> {
    let mut lies = vec![Fault::Forget, Fault::Length(1), Fault::Length(-1)];
    let changes: [fn(f64) -> f64; 6] = [
        |_| f64::NAN,
        |_| f64::INFINITY,
        |_| f64::NEG_INFINITY,
        |value| -value,
        |_| 0.0,
        |value| 3.0 * value,
    ];
    for part in [Part::Pressure, Part::Rate, Part::Schur, Part::RowSums] {
        for change in changes {
            lies.extend([Fault::Each(part, change), Fault::Last(part, change)]);
        }
    }
    lies
}

#[test]
fn survey_of_lies() {
    for (number, fault) in lies().into_iter().enumerate() {
        for small in Small::all() {
            for maker in MAKERS {
                let expected = small.states(maker);
                let [mut harmless, mut refused, mut late, mut unnoticed] = [0; 4];
                let mut example = None;
                for at in 0.. {
                    let Ok(mut path) = small.path(maker, fault, at) else {
                        continue;
                    };
                    let (mut count, mut violation, mut failure) = (0, None, None);
                    while let Some(item) = path.next() {
                        match item {
                            Ok(state) => {
                                if path.updater().struck.get().is_none() {
                                    assert!(state == expected[count]);
                                }
                                count += 1;
                                violation = violation.or(small.violation(&state, maker));
                            }
                            Err(error) => failure = Some(error),
                        }
                        assert!(count < 1000);
                    }
                    if path.updater().struck.get().is_none() {
                        if at > path.updater().calls() {
                            break;
                        }
                        continue;
                    }
                    match (&violation, &failure) {
                        (None, None) => harmless += 1,
                        (None, Some(_)) => refused += 1,
                        (Some(_), Some(_)) => late += 1,
                        (Some(_), None) => unnoticed += 1,
                    }
                    if violation.is_some() {
                        example = violation.map(|v| (path.updater().struck.get(), v));
                    }
                }
                println!(
                    "{number:2} {fault:?} {} {}: harmless {harmless} refused {refused} late {late} unnoticed {unnoticed} {example:?}",
                    small.name, maker.0
                );
            }
        }
    }
}
