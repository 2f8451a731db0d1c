//! Every function of every module; one test a module, named after its hard cases.

use crate::holds;
use crate::probe::check_module;
use crate::{
    decisions, facets, foveation, lighting, matching, mathematics, noise, scattering, scattering_lobes, state,
    surfaces, triangles,
};

#[test]
fn acuity_is_bit_equal_h61_h62_h64_h65() {
    check_module(mathematics::PROBES, "acuity");
}

#[test]
fn approx_is_bit_equal_h38_h61() {
    check_module(mathematics::PROBES, "approx");
    check_module(scattering::PROBES, "approx");
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
fn foveate_is_bit_equal_h69_h71() {
    check_module(foveation::PROBES, "foveate");
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
fn rng_is_bit_equal_h23_h26_and_for_a_million_words_h28() {
    let Some(rows) = check_module(state::PROBES, "rng") else { return };
    check_module(lighting::PROBES, "rng");
    holds!("H28", Gpu, "{rows} rows of the generator bit-equal, 1e6 of them of (x, y, frame)");
}

#[test]
fn scrub_is_bit_equal_h17_h18_h37() {
    check_module(state::PROBES, "scrub");
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
fn taa_is_bit_equal() {
    check_module(surfaces::PROBES, "taa");
}

#[test]
fn triangle_is_bit_equal_h80() {
    check_module(triangles::PROBES, "triangle");
}

#[test]
fn octahedral_is_bit_equal() {
    check_module(triangles::PROBES, "octahedral");
}

#[test]
fn direction_is_bit_equal() {
    check_module(scattering::PROBES, "direction");
}

#[test]
fn sampling_is_bit_equal_h83() {
    check_module(scattering::PROBES, "sampling");
}

#[test]
fn microfacet_is_bit_equal_h83() {
    check_module(facets::PROBES, "microfacet");
}

#[test]
fn phong_is_bit_equal() {
    check_module(scattering::PROBES, "phong");
}

#[test]
fn albedo_is_bit_equal() {
    check_module(scattering_lobes::PROBES, "albedo");
}

#[test]
fn bsdf_is_bit_equal_h83() {
    check_module(scattering_lobes::PROBES, "bsdf");
}

#[test]
fn layers_is_bit_equal_h83() {
    check_module(scattering_lobes::PROBES, "layers");
}

#[test]
fn light_is_bit_equal() {
    check_module(lighting::PROBES, "light");
}

#[test]
fn shading_is_bit_equal() {
    check_module(lighting::PROBES, "shading");
}

#[test]
fn texel_is_bit_equal() {
    check_module(lighting::PROBES, "texel");
}
