#![no_main]

#[path = "../entries.rs"]
mod entries;
#[path = "../../../../testing/src/panics.rs"]
mod panics;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    panics::silence_the_exr_decoder();
    entries::exr(bytes);
});
