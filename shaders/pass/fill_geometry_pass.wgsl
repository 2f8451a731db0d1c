//#use sparse_history
//#use lattices
// Depth and motion between samples. CPU twin: src/cpu/fill_geometry.rs, which explains the choice of the surface. One
// invocation a pixel; z is the view.
//
// Up to 20 reads and 2 writes a pixel: depth and motion of the samples twice, a stored sample for each; 12 bytes
// written.

// Whether history can confirm a sample's surface.
override HAS_SPARSE_HISTORY: u32 = 0u;

@group(0) @binding(23) var depth_out: texture_storage_2d_array<r32float, write>;
@group(0) @binding(24) var motion_out: texture_storage_2d_array<rg32float, write>;

struct GeometrySample {
    disparity: f32,
    motion: vec2f,
    share: f32,
}

fn geometry_at(tap: u32, near: Around, lattice: LatticeUniforms, view: u32) -> GeometrySample {
    let right = tap & 1u;
    let below = tap >> 1u;
    let point = vec2u(near.x.points[right], near.y.points[below]);
    let texel = texel_of_point(point, lattice);
    let share = point_weight(near.x.fraction, right) * point_weight(near.y.fraction, below);
    return GeometrySample(disparity_at(texel, view), motion_of(px_of_point(point, lattice), texel, view), share);
}

// Whether history confirms that a pixel shows a sample's surface: history must have the expected disparity at the
// previous position.
fn is_confirmed(px: vec2u, view: u32, s: GeometrySample) -> bool {
    if HAS_SPARSE_HISTORY == 0u || DEPTH_TEST == 0u {
        return false;
    }
    let at = reprojected(px, view, s.motion);
    let stored = stored_at(vec2i(at.at), view);
    let expected = expected_disparity(view, ray_at(px, view), s.disparity);
    return at.verdict == VERDICT_VALID
        && stored.lod >= 0.0
        && same_surface(expected, stored.disparity, TAP_RELATIVE, 0.0);
}

fn pixel(px: vec2u, view: u32) {
    let lattice = lattice_at(px, view);
    let near = around(px, lattice);
    var own = GeometrySample(INVALID_DISPARITY, vec2f(0.0), 0.0);
    var best = -1.0;
    let taps = select(0u, 4u, near.any);
    for (var tap = 0u; tap < taps; tap++) {
        let s = geometry_at(tap, near, lattice, view);
        let rank = s.share + select(0.0, 1.0, s.share > 0.0 && is_confirmed(px, view, s));
        if rank > best {
            best = rank;
            own = s;
        }
    }
    var mean = GeometryMean(0.0, vec2f(0.0), 0.0);
    for (var tap = 0u; tap < taps; tap++) {
        let s = geometry_at(tap, near, lattice, view);
        mean = add_geometry(mean, own.disparity, s.disparity, s.motion, s.share);
    }
    let filled = filled_geometry(mean, own.disparity, own.motion);
    textureStore(depth_out, px, view, vec4f(filled.x, 0.0, 0.0, 0.0));
    textureStore(motion_out, px, view, vec4f(filled.yz, 0.0, 0.0));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    if id.x < frame.size.x && id.y < frame.size.y {
        pixel(id.xy, frame.first_view + group.z);
    }
}
