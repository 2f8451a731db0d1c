//! Every function of every module; one test a module, named after its hard cases.

use super::probe::check_module;
use super::{
    antialias, decisions, doctor, foveation, lattice, lens, matching, mathematics, noise, repair, sparse, state,
    surfaces, upsampling,
};
use afterimage_testing::holds;

#[test]
fn acuity_is_bit_equal_h61_h62_h64_h65() {
    check_module(mathematics::PROBES, "acuity");
}

#[test]
fn approx_is_bit_equal_h38_h61() {
    check_module(mathematics::PROBES, "approx");
}

#[test]
fn rng_is_bit_equal_h23_h26_and_for_a_million_words_h28() {
    let Some(rows) = check_module(state::PROBES, "rng") else { return };
    holds!("H28", Gpu, "{rows} rows of the generator bit-equal, 1e6 of them of (x, y, frame)");
}

#[test]
fn color_is_bit_equal_h30_h31_h32_h33_h36_h37_h38() {
    check_module(mathematics::PROBES, "color");
}

#[test]
fn debug_view_is_bit_equal() {
    check_module(decisions::PROBES, "debug_view");
}

#[test]
fn depth_is_bit_equal_h41_h42_h44_h45_h46_h47() {
    check_module(mathematics::PROBES, "depth");
}

#[test]
fn doctor_is_bit_equal() {
    check_module(doctor::PROBES, "doctor");
}

#[test]
fn foveate_is_bit_equal_h69_h71() {
    check_module(foveation::PROBES, "foveate");
}

#[test]
fn antialias_is_bit_equal() {
    check_module(antialias::PROBES, "antialias");
}

#[test]
fn lens_is_bit_equal() {
    check_module(lens::PROBES, "lens");
}

#[test]
fn repair_is_bit_equal() {
    check_module(repair::PROBES, "repair");
}

#[test]
fn kept_is_bit_equal() {
    check_module(sparse::PROBES, "kept");
}

#[test]
fn sparse_is_bit_equal() {
    check_module(sparse::PROBES, "sparse");
}

#[test]
fn lattice_is_bit_equal() {
    check_module(lattice::PROBES, "lattice");
}

#[test]
fn noise_is_bit_equal() {
    check_module(noise::PROBES, "noise");
}

#[test]
fn pack_is_bit_equal_h05_h15_h19() {
    check_module(state::PROBES, "pack");
}

#[test]
fn reproject_is_bit_equal_h51_h52_h54_h57() {
    check_module(state::PROBES, "reproject");
}

#[test]
fn reservoir_is_bit_equal_h01_h02_h04_h15_h17_h18_h21() {
    check_module(state::PROBES, "reservoir");
}

#[test]
fn sanitize_is_bit_equal_h17_h18_h37() {
    check_module(state::PROBES, "sanitize");
}

#[test]
fn wrs_decides_bit_equal_h01_h02_h20_h39() {
    check_module(decisions::PROBES, "wrs");
}

#[test]
fn matched_is_bit_equal() {
    check_module(matching::PROBES, "matched");
}

#[test]
fn surface_is_bit_equal() {
    check_module(surfaces::PROBES, "surface");
}

#[test]
fn resample_is_bit_equal() {
    check_module(surfaces::PROBES, "resample");
}

#[test]
fn resize_is_bit_equal() {
    check_module(surfaces::PROBES, "resize");
}

#[test]
fn taa_is_bit_equal() {
    check_module(upsampling::PROBES, "taa");
}

#[test]
fn taau_is_bit_equal() {
    check_module(upsampling::PROBES, "taau");
}
