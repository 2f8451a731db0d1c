//#use doctor
//#use origin
// Roots of the mean signal of 2x2 pixels. CPU twin: root_means in src/cpu/doctor_pass.rs. One invocation a texel.
//
// 4 reads of a color and 1 write of 4 bytes a texel.

// Width and height in pixels; first pixel of the view, x in the low half, y in the high half; bits of the factor on
// colors.
@group(0) @binding(0) var<uniform> view: vec4u;
@group(0) @binding(1) var color_in: texture_2d_array<f32>;
@group(0) @binding(23) var roots_out: texture_storage_2d_array<r32float, write>;

fn signal_at(at: vec2u) -> f32 {
    return signal(textureLoad(color_in, from_origin(min(at, view.xy - 1u), view.z), 0, 0).y * bitcast<f32>(view.w));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let first = 2u * id.xy;
    if any(first >= view.xy) {
        return;
    }
    let root = root_mean(
        signal_at(first),
        signal_at(first + vec2u(1u, 0u)),
        signal_at(first + vec2u(0u, 1u)),
        signal_at(first + vec2u(1u, 1u)),
    );
    textureStore(roots_out, id.xy, 0u, vec4f(root, 0.0, 0.0, 0.0));
}
