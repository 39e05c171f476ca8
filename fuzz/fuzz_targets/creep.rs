#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let verdict = asperity_drivers::creep(data);
    assert!(verdict.is_ok(), "{verdict:?}");
});
