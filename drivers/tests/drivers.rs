//! Every driver on random bytes.
//!
//! `ASPERITY_DRIVER_SEED` chooses other bytes, `ASPERITY_DRIVER_CASES` how many cases there are of each driver. A case that
//! fails is printed with its bytes: `ASPERITY_DRIVER_BYTES=… cargo test --release -p asperity-drivers --test drivers NAME`
//! repeats it.

use std::env;
use std::panic::{AssertUnwindSafe, catch_unwind};

use asperity_drivers::{Tally, Verdict, Violation};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

const SEED: u64 = 2020;

/// A number from the environment.
fn number(name: &str, default: u64) -> Result<u64, Violation> {
    match env::var(name) {
        Ok(text) => text
            .parse()
            .map_err(|_| Violation::new(format!("{name} is '{text}', which is no number"))),
        Err(_) => Ok(default),
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn from_hex(text: &str) -> Option<Vec<u8>> {
    let digits = |k: usize| u8::from_str_radix(text.get(k..k + 2)?, 16).ok();
    (0..text.len()).step_by(2).map(digits).collect()
}

/// One case; a panic of the library is a violation as well.
fn case(driver: fn(&[u8]) -> Verdict, bytes: &[u8]) -> Verdict {
    catch_unwind(AssertUnwindSafe(|| driver(bytes)))
        .unwrap_or_else(|_| Err(Violation::new("the library panicked")))
}

/// Runs a driver on as many random inputs as it is told to, up to so many bytes each.
fn drive(
    name: &str,
    driver: fn(&[u8]) -> Verdict,
    cases: u64,
    most_bytes: usize,
) -> Result<Tally, Violation> {
    if let Ok(text) = env::var("ASPERITY_DRIVER_BYTES") {
        let bytes = from_hex(&text)
            .ok_or_else(|| Violation::new("ASPERITY_DRIVER_BYTES holds no hexadecimal bytes"))?;
        return case(driver, &bytes);
    }
    let seed = number("ASPERITY_DRIVER_SEED", SEED)?;
    let cases = number("ASPERITY_DRIVER_CASES", cases)?;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut tally = Tally::default();
    for k in 0..cases {
        let length = random.next_u64() as usize % (most_bytes + 1);
        let mut bytes = vec![0; length];
        random.fill_bytes(&mut bytes);
        tally += case(driver, &bytes).map_err(|violation| {
            let bytes = hex(&bytes);
            Violation::new(format!(
                "{violation}\n{name}, seed {seed}, case {k}: ASPERITY_DRIVER_BYTES={bytes}"
            ))
        })?;
    }
    println!("{name}: {cases} cases of seed {seed}, {tally:?}");
    Ok(tally)
}

#[test]
fn paths_are_right() -> Result<(), Violation> {
    drive("paths_are_right", asperity_drivers::paths, 100, 400)?;
    Ok(())
}
