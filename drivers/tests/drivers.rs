//! Every driver on random bytes.
//!
//! `ASPERITY_DRIVER_SEED` chooses other bytes, and `ASPERITY_DRIVER_CASES` how many cases there are of each driver, or
//! `ASPERITY_DRIVER_SECONDS` for how long. A case that fails is printed with its bytes:
//! `ASPERITY_DRIVER_BYTES=… cargo test --release -p asperity-drivers --test drivers NAME` repeats it.

use std::env;
use std::time::{Duration, Instant};

use asperity_drivers::{DRIVERS, Driver, Tally, Violation, case, from_hex};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

const SEED: u64 = 2020;

/// A number from the environment, if it is there.
fn number(name: &str) -> Result<Option<u64>, Violation> {
    match env::var(name) {
        Ok(text) => match text.parse() {
            Ok(number) => Ok(Some(number)),
            Err(_) => Err(Violation::new(format!("{name} is '{text}', which is no number"))),
        },
        Err(_) => Ok(None),
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Runs a driver on as many random inputs as it is told to, up to so many bytes each. At least this share of the cases
/// has to come to a comparison, but for four standard deviations of chance: a driver that refuses its own inputs tests
/// nothing.
fn drive(
    name: &str,
    driver: Driver,
    cases: u64,
    most_bytes: usize,
    least_share: f64,
) -> Result<(), Violation> {
    if let Ok(text) = env::var("ASPERITY_DRIVER_BYTES") {
        return case(driver, &from_hex(&text)?).map(|_| ());
    }
    let seed = number("ASPERITY_DRIVER_SEED")?.unwrap_or(SEED);
    let seconds = number("ASPERITY_DRIVER_SECONDS")?;
    let cases = number("ASPERITY_DRIVER_CASES")?.unwrap_or(cases);
    let start = Instant::now();
    let goes_on = |k: u64| match seconds {
        Some(seconds) => start.elapsed() < Duration::from_secs(seconds),
        None => k < cases,
    };
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut tally = Tally::default();
    let (mut k, mut compared) = (0, 0);
    while goes_on(k) {
        let length = random.next_u64() as usize % (most_bytes + 1);
        let mut bytes = vec![0; length];
        random.fill_bytes(&mut bytes);
        let of_case = case(driver, &bytes).map_err(|violation| {
            let bytes = hex(&bytes);
            Violation::new(format!(
                "{violation}\n{name}, seed {seed}, case {k}: ASPERITY_DRIVER_BYTES={bytes}"
            ))
        })?;
        // One case may compare many states, or neither compare nor refuse anything.
        compared += u64::from(of_case.checked > 0);
        tally += of_case;
        k += 1;
    }
    println!("{name}: {k} cases of seed {seed}, {compared} of them compared, {tally:?}");
    let expected = least_share * k as f64;
    if (compared as f64) < expected - 4.0 * (expected * (1.0 - least_share)).sqrt() {
        return Err(Violation::new(format!(
            "hardly anything was compared: {compared} of {k} cases, {tally:?}"
        )));
    }
    Ok(())
}

// Least shares are 0.8 of what seed 2020 came to: nearly all cases; of parsers 0.12, as few hostile files can be read,
// of records 0.6, and of slip 0.81.

#[test]
fn paths_are_right() -> Result<(), Violation> {
    drive("paths_are_right", asperity_drivers::paths, 150, 400, 0.8)
}

#[test]
fn yielding_is_right() -> Result<(), Violation> {
    drive("yielding_is_right", asperity_drivers::yielding, 100, 400, 0.75)
}

#[test]
fn adhesion_is_right() -> Result<(), Violation> {
    drive("adhesion_is_right", asperity_drivers::adhesion, 150, 400, 0.8)
}

#[test]
fn large_contacts_are_right() -> Result<(), Violation> {
    drive("large_contacts_are_right", asperity_drivers::large_contacts, 40, 400, 0.75)
}

#[test]
fn fixed_loads_are_right() -> Result<(), Violation> {
    drive("fixed_loads_are_right", asperity_drivers::fixed_loads, 100, 400, 0.75)
}

#[test]
fn large_loads_are_right() -> Result<(), Violation> {
    drive("large_loads_are_right", asperity_drivers::large_loads, 30, 400, 0.8)
}

#[test]
fn parsers_are_right() -> Result<(), Violation> {
    drive("parsers_are_right", asperity_drivers::parsers, 4000, 400, 0.09)
}

#[test]
fn records_are_right() -> Result<(), Violation> {
    drive("records_are_right", asperity_drivers::records, 100, 400, 0.45)
}

#[test]
fn creep_is_right() -> Result<(), Violation> {
    drive("creep_is_right", asperity_drivers::creep, 200, 400, 0.75)
}

#[test]
fn slip_is_right() -> Result<(), Violation> {
    drive("slip_is_right", asperity_drivers::slip, 400, 400, 0.65)
}

/// Cases that an earlier version failed. As the drivers change what they make of their bytes, so do these.
#[test]
fn earlier_failures_are_mended() -> Result<(), Violation> {
    let cases = include_str!("cases.txt").lines().filter(|line| !line.starts_with('#'));
    for line in cases {
        let (name, text) = line.split_once(' ').unwrap_or_default();
        let Some((_, driver)) = DRIVERS.iter().find(|(other, _)| *other == name) else {
            return Err(Violation::new(format!("there is no driver '{name}'")));
        };
        case(*driver, &from_hex(text)?)
            .map_err(|violation| Violation::new(format!("{violation}\n{name} {text}")))?;
    }
    Ok(())
}
