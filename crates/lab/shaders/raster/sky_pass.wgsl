//#use direction
//#use raster_frame
//#use lighting_maps
//#use sanitize
// The sky behind all surfaces.

@vertex
fn fullscreen(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return fullscreen_position(index);
}

@fragment
fn sky(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let px = full_rate_px(position);
    let direction = unit((frame.right.xyz * px.x + frame.down.xyz * px.y) + frame.corner.xyz);
    return vec4f(clamp(sky_radiance(direction, 0.0), vec3f(0.0), vec3f(MAX_COLOR)), 1.0);
}
