//#use debug_view
//#use inputs
// Output of a pixel; shared by all methods. output_and_view takes its place where a debug view is written beside it.

// Whether the output has the candidate's alpha instead of 1.
override KEEP_ALPHA: u32 = 1u;

@group(0) @binding(10) var color_out: texture_storage_2d_array<rgba16float, write>;

// Writes the output color, or the debug view of the decision. `alpha`: the candidate's, as the renderer wrote it.
fn write_output(px: vec2u, view: u32, shown: vec3f, alpha: f32, traced: PixelTrace) {
    let at = texel_of(px, view, COLOR_OUT);
    if VIEW != 0u {
        textureStore(color_out, at, layer_of(view), vec4f(view_color(VIEW, traced), 1.0));
    } else {
        let kept = select(1.0, alpha, KEEP_ALPHA != 0u && is_finite(alpha));
        textureStore(color_out, at, layer_of(view), vec4f(delivered(shown), kept));
    }
}
