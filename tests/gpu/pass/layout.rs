//! Uniform structs of Rust and WGSL agree: names, order, offsets, sizes.

use afterimage::gpu::MAX_VIEWS;
use afterimage::internal::FoveationUniforms;
use afterimage::internal::{
    CameraUniforms, FrameUniforms, LatticeUniforms, SparseUniforms, ViewLattices, ViewUniforms,
};
use afterimage::shader::SHADERS;
use afterimage::wgpu::naga;
use std::mem::offset_of;

/// Name and offset of each member of a WGSL struct, and its size.
fn wgsl(module: &naga::Module, name: &str) -> (Vec<(String, usize)>, usize) {
    let (_, ty) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some(name)).unwrap();
    let naga::TypeInner::Struct { members, span } = &ty.inner else { panic!("{name} is no struct") };
    // Three words of padding in WGSL are one array in Rust.
    let members = members.iter().filter(|m| !m.name.as_ref().unwrap().starts_with("unused"));
    let list = members.map(|m| (m.name.clone().unwrap(), m.offset as usize)).collect();
    (list, *span as usize)
}

macro_rules! rust {
    ($ty:ty: $($field:ident),*) => {
        (vec![$((stringify!($field).to_owned(), offset_of!($ty, $field))),*], size_of::<$ty>())
    };
}

fn view_uniforms() -> (Vec<(String, usize)>, usize) {
    rust!(ViewUniforms: ray_scale, ray_offset, gaze_ray, depth_row, key, disparity_a, disparity_b, disparity_flags,
        motion_offset, jitter_px, origins, lowest_px, highest_px)
}

#[test]
fn constants_have_one_layout() {
    let composed = SHADERS.compose("wrs_pass");
    let module = naga::front::wgsl::parse_str(&composed.source).unwrap();
    let frame = rust!(FrameUniforms: size, past_frame, frame_low, fovea_radius_deg, inv_density_at_fovea, exponential_survival,
        gate_offset, inv_gate_divisor, depth_relative, depth_slope_px, exposure, motion_scale, mid_radius_deg,
        blend_deg, coarse_mid, coarse_far, smr_accumulate, smr_accumulate_tolerance, smr_tolerance, first_view, lattice,
        mip_levels, color_exposure, inverse_exposure, largest_shown, first_quad, quad_offsets, views, cameras);
    let cameras = rust!(CameraUniforms: x, y, z, per_tangent, zoom, shift_px, ahead, sky, no_vector);
    assert_eq!(wgsl(&module, "CameraUniforms"), cameras);
    assert_eq!(wgsl(&module, "FrameUniforms"), frame);
    assert_eq!(wgsl(&module, "ViewUniforms"), view_uniforms());
    assert!(composed.source.contains(&format!("array<ViewUniforms, {MAX_VIEWS}>")));
}

#[test]
fn constants_of_sparse_frames_have_one_layout() {
    let composed = SHADERS.compose("lattices");
    let module = naga::front::wgsl::parse_str(&composed.source).unwrap();
    let lattice = rust!(LatticeUniforms: low_px, high_px, first_px, points, texel, level, texel_level, results);
    assert_eq!(wgsl(&module, "LatticeUniforms"), lattice);
    assert_eq!(wgsl(&module, "SparseUniforms"), rust!(SparseUniforms: missing, views));
    let count = ViewLattices::default().len();
    assert!(composed.source.contains(&format!("array<array<LatticeUniforms, {count}>, {MAX_VIEWS}>")));
    assert!(composed.source.contains(&format!("const LATTICES: u32 = {count}u;")));
}

#[test]
fn constants_of_the_foveation_have_one_layout() {
    let composed = SHADERS.compose("foveated_views");
    let module = naga::front::wgsl::parse_str(&composed.source).unwrap();
    let frame = rust!(FoveationUniforms: size, coarsest, fovea_radius_deg, mid_radius_deg, blend_deg, mid, far,
        views);
    assert_eq!(wgsl(&module, "FoveationUniforms"), frame);
    assert_eq!(wgsl(&module, "ViewUniforms"), view_uniforms());
    assert!(composed.source.contains(&format!("array<ViewUniforms, {MAX_VIEWS}>")));
}
