//#use direction
//#use raster_frame
//#use lighting_maps
//#use sanitize
// The sky behind all surfaces.

@vertex
fn fullscreen(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(index);
}

@fragment
fn sky(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let px = full_rate_px(position);
    let direction = unit((frame.right.xyz * px.x + frame.down.xyz * px.y) + frame.corner.xyz);
    return vec4<f32>(clamp(sky_radiance(direction, 0.0), vec3<f32>(0.0), vec3<f32>(MAX_COLOR)), 1.0);
}
