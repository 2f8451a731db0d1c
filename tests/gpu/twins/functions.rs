//! Every function of every module; one test a module, named after its hard cases.

use super::probe::check_module;
use afterimage_testing::holds;

#[test]
fn rng_is_bit_equal_h23_h26_and_for_a_million_words_h28() {
    let Some(rows) = check_module("rng") else { return };
    holds!("H28", Gpu, "{rows} rows of the generator bit-equal, 1e6 of them of (x, y, frame)");
}

macro_rules! bit_equal {
    ($($test:ident: $module:literal;)*) => {$(
        #[test]
        fn $test() {
            check_module($module);
        }
    )*};
}

bit_equal! {
    acuity_is_bit_equal_h61_h62_h64_h65: "acuity";
    demodulation_is_bit_equal: "demodulation";
    approx_is_bit_equal_h38_h61: "approx";
    candidate_is_bit_equal: "candidate";
    color_is_bit_equal_h30_h31_h32_h33_h36_h37_h38: "color";
    debug_view_is_bit_equal: "debug_view";
    depth_is_bit_equal_h41_h42_h44_h45_h46_h47: "depth";
    doctor_is_bit_equal: "doctor";
    foveate_is_bit_equal_h69_h71: "foveate";
    antialias_is_bit_equal: "antialias";
    lab_is_bit_equal: "lab";
    lens_is_bit_equal: "lens";
    lod_is_bit_equal: "lod";
    mip_noise_is_bit_equal: "mip_noise";
    quads_is_bit_equal: "quads";
    stored_reservoir_is_bit_equal: "stored_reservoir";
    stored_sample_is_bit_equal: "stored_sample";
    reconstruction_is_bit_equal: "reconstruction";
    lattice_is_bit_equal: "lattice";
    noise_is_bit_equal: "noise";
    pack_is_bit_equal_h05_h15_h19: "pack";
    reproject_is_bit_equal_h51_h52_h54_h57: "reproject";
    reservoir_is_bit_equal_h01_h02_h04_h15_h17_h18_h21: "reservoir";
    sanitize_is_bit_equal_h17_h18_h37: "sanitize";
    wrs_decides_bit_equal_h01_h02_h20_h39: "wrs";
    smr_is_bit_equal: "smr";
    surface_is_bit_equal: "surface";
    resample_is_bit_equal: "resample";
    resize_is_bit_equal: "resize";
    taa_is_bit_equal: "taa";
    taau_is_bit_equal: "taau";
}
