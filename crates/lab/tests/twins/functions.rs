//! Every function of every module; one test per module, named after its hard cases.

use super::probe::check_module;
use super::{facets, lighting, scattering, scattering_lobes, triangles};

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
