//#use raster_frame
//#use raster_material
// The sun's shadow map. Depth is reversed, 1 nearest to the sun.

struct ShadowVarying {
    @builtin(position) position: vec4f,
    @location(0) uvs: vec4f,
    @location(1) color: vec4f,
}

@vertex
fn shadow_vertex(vertex: Vertex) -> ShadowVarying {
    let at = vec4f(vertex.position, 1.0);
    let place = vec3f(dot(lights.sun[0], at), dot(lights.sun[1], at), dot(lights.sun[2], at));
    return ShadowVarying(vec4f(place, 1.0), vertex.uvs, vertex.color);
}

@fragment
fn alpha_test(in: ShadowVarying) {
    if !passes_alpha_test(base_at(in.uvs, in.color).w) {
        discard;
    }
}
