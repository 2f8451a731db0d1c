//#use direction
//#use raster_frame
//#use lighting_maps
//#use sanitize
// The sky behind all surfaces.

// The sky's albedo instead of its color: 0.
override ALBEDO: bool = false;

@vertex
fn fullscreen(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return fullscreen_position(index);
}

@fragment
fn sky(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let px = full_rate_px(position);
    let direction = unit((frame.right.xyz * px.x + frame.down.xyz * px.y) + frame.corner.xyz);
    if ALBEDO {
        return vec4f(vec3f(0.0), 1.0);
    }
    return vec4f(clamp(sky_radiance(direction, 0.0), vec3f(0.0), vec3f(LARGEST_HALF)), 1.0);
}
