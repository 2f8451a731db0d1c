//#use debug_view
//#use inputs
// Output of a pixel, and a debug view of its decision. Takes the place of output, which has the same functions.

override KEEP_ALPHA: u32 = 1u;
// A VIEW_* code.
override DEBUG_VIEW: u32 = 1u;

@group(0) @binding(10) var color_out: texture_storage_2d_array<rgba16float, write>;
@group(0) @binding(11) var debug_out: texture_storage_2d_array<rgba16float, write>;

fn write_output(px: vec2u, view: u32, shown: vec3f, alpha: f32, traced: PixelTrace) {
    let kept = select(1.0, alpha, KEEP_ALPHA != 0u && is_finite(alpha));
    textureStore(color_out, texel_of(px, view, COLOR_OUT), layer_of(view), vec4f(delivered(shown), kept));
    let drawn = vec4f(view_color(DEBUG_VIEW, traced), 1.0);
    textureStore(debug_out, texel_of(px, view, DEBUG_OUT), layer_of(view), drawn);
}
