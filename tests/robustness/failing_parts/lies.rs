//! Wrong answers at the k-th call of an updater.
//!
//! An exact updater is held to the contact conditions at every solution: a wrong one is refused before any state rests
//! on it. What it says of watched nodes is believed until the next solution, and what an inexact updater says of its
//! own displacements is believed altogether; `updater::check` is what finds those.

use asperity::Problem;
use asperity::updater;

use super::problems::{MAKERS, Maker, Small};
use super::updater::{Fault, Part, failing};

const NUMBERS: [fn(f64) -> f64; 3] = [|value| -value, |_| 0.0, |value| 3.0 * value];
const NO_NUMBERS: [fn(f64) -> f64; 3] = [|_| f64::NAN, |_| f64::INFINITY, |_| f64::NEG_INFINITY];
const SOLUTION: [Part; 2] = [Part::Pressure, Part::Rate];
const WATCHED: [Part; 2] = [Part::Schur, Part::RowSums];

/// Changes of all numbers of an answer, and of the last one.
fn changes(parts: [Part; 2], values: [fn(f64) -> f64; 3]) -> Vec<Fault> {
    let each = parts.into_iter().flat_map(|part| values.map(|value| (part, value)));
    each.flat_map(|(part, value)| [Fault::Each(part, value), Fault::Last(part, value)]).collect()
}

/// Follows a path for each call that the fault may strike. Returns how many were struck, and how many ended with an
/// error.
fn follow(small: &Small, maker: Maker, fault: Fault) -> (usize, usize) {
    let expected = small.states(maker);
    let (mut struck, mut refused) = (0, 0);
    for at in 0.. {
        let context = format!("{}, {}, {fault:?} at call {at}", small.name, maker.0);
        let mut path = match small.path(maker, fault, at) {
            Ok(path) => path,
            Err(error) => panic!("{context}: {error}"),
        };
        let (mut count, mut failure) = (0, None);
        while let Some(item) = path.next() {
            match item {
                Ok(state) if path.updater().unwrap().state.struck().is_none() => {
                    assert!(state == expected[count], "{context}: {state:?}");
                    count += 1;
                }
                Ok(state) => {
                    count += 1;
                    // Not more than any path has.
                    assert!(count <= 2 * expected.len() + 20, "{context} has no end");
                    assert_eq!(small.violation(&state, maker), None, "{context}");
                }
                Err(error) => {
                    assert!(failure.is_none(), "{context}: two errors");
                    failure = Some(error);
                }
            }
        }
        match path.updater().unwrap().state.struck() {
            Some(_) => struck += 1,
            None if at >= path.updater().unwrap().state.calls() => return (struck, refused),
            None => assert!(count == expected.len() && failure.is_none(), "{context}"),
        }
        refused += usize::from(failure.is_some());
    }
    unreachable!("there is a call beyond the last one")
}

/// Answers of another size, that are no numbers, or to calls that were not passed on: whoever gives them, no wrong
/// state follows.
#[test]
fn what_no_answer_can_be_is_refused() {
    let mut lies = vec![Fault::Forget, Fault::Length(1), Fault::Length(-1)];
    lies.extend(changes(SOLUTION, NO_NUMBERS));
    lies.extend(changes(WATCHED, NO_NUMBERS));
    for small in Small::all() {
        // Before it hands over, the third is the first.
        for maker in [MAKERS[0], MAKERS[1]] {
            for &fault in &lies {
                let (struck, refused) = follow(&small, maker, fault);
                // Infinite pressures whose displacements are right do no harm, and what is forgotten is looked for
                // again.
                assert!(struck > 0 || matches!(fault, Fault::Forget));
                let is_length = matches!(fault, Fault::Length(1));
                assert!(!is_length || refused == struck, "{refused} of {struck}");
            }
        }
    }
}

/// Wrong numbers in a solution of an exact updater.
#[test]
fn wrong_solutions_are_refused() {
    let (mut struck, mut refused) = (0, 0);
    for small in Small::all() {
        for fault in changes(SOLUTION, NUMBERS) {
            let counts = follow(&small, MAKERS[0], fault);
            struck += counts.0;
            refused += counts.1;
        }
    }
    // Before first touch there is nothing to spoil, and the pressure of the last node, which has just touched, is zero.
    assert!(2 * refused > struck, "{refused} of {struck}");
}

/// Whatever is wrong, whoever says it and whenever, the checker finds it.
#[test]
fn the_checker_finds_every_wrong_number() {
    let mut found = 0;
    let mut lies = vec![Fault::Length(1), Fault::Length(-1)];
    for values in [NUMBERS, NO_NUMBERS] {
        lies.extend(changes(SOLUTION, values));
        lies.extend(changes(WATCHED, values));
    }
    for small in Small::all() {
        let problem: Problem = small.problem();
        for maker in [MAKERS[0], MAKERS[1]] {
            for &fault in &lies {
                for at in 0.. {
                    let mut failing = failing((maker.1)(), fault, at);
                    let checked = updater::check(&mut failing, &problem);
                    if failing.state.struck().is_none() {
                        assert!(checked.is_ok());
                        if at >= failing.state.calls() {
                            break;
                        }
                        continue;
                    }
                    let context = format!("{}, {}, {fault:?}, {at}", small.name, maker.0);
                    assert!(checked.is_err(), "{context}: {checked:?}");
                    found += 1;
                }
            }
        }
    }
    assert!(found > 1000, "{found}");
}
