//#use raster_frame
//#use raster_material
// The scene as the sun sees it: the shadow map. Depth is reversed, 1 next to the sun.

struct Lit {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
    @location(1) color: vec4<f32>,
}

@vertex
fn from_sun(corner: Corner) -> Lit {
    let at = vec4<f32>(corner.position, 1.0);
    let place = vec3<f32>(dot(lights.sun[0], at), dot(lights.sun[1], at), dot(lights.sun[2], at));
    return Lit(vec4<f32>(place, 1.0), corner.uv, corner.color);
}

@fragment
fn holes(in: Lit) {
    if !is_there(base_at(in.uv, in.color).w) {
        discard;
    }
}
