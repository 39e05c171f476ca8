#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let verdict = asperity_drivers::large_loads(data);
    assert!(verdict.is_ok(), "{verdict:?}");
});
