//#use octahedral
//#use texel
//#use hit
// Triangle records. Twin of rays/triangle_records.rs and geometry.rs. Triangles are indexed as in hits.

override ATTRIBUTES: u32 = 0u;
override MOVING_ATTRIBUTES: u32 = 0u;
override SECOND_UVS: u32 = 0u;
override MOVING_SECOND_UVS: u32 = 0u;

// Corner positions in world space; material; one plus the row in the light table, or 0.
struct Triangle {
    corners: array<vec3f, 3>,
    material: u32,
    light: u32,
}

// Attributes at a point of a triangle. Normal and tangent are interpolated, not normalized; the bitangent's sign is the
// first corner's.
struct Attributes {
    normal: vec3f,
    tangent: vec3f,
    bitangent_sign: f32,
    uv: vec2f,
    color: vec4f,
    // Zero unless place_at reads it.
    second_uv: vec2f,
}

fn is_moving(triangle: u32) -> bool {
    return MOVES && triangle >= FIRST_MOVING;
}

// First element of a triangle's record of `size` elements.
fn record_at(triangle: u32, still: u32, moving: u32, size: u32) -> u32 {
    return select(still + triangle * size, moving + (triangle - FIRST_MOVING) * size, is_moving(triangle));
}

fn triangle_at(triangle: u32) -> Triangle {
    let at = record_at(triangle, TRIANGLES, MOVING_TRIANGLES, 3u);
    let r0 = load(at);
    let r1 = load(at + 1u);
    let r2 = load(at + 2u);
    let corners = array<vec3f, 3>(bitcast<vec3f>(r0.xyz), bitcast<vec3f>(r1.xyz), bitcast<vec3f>(r2.xyz));
    return Triangle(corners, r0.w & 0xffffffu, r2.w);
}

// AttributeRecord::at
fn attributes_at(triangle: u32, u: f32, v: f32) -> Attributes {
    let at = record_at(triangle, ATTRIBUTES, MOVING_ATTRIBUTES, 4u);
    let normals = load(at);
    let tangents = load(at + 1u);
    let uv0 = load(at + 2u);
    let uv1 = load(at + 3u);
    let w = (1.0 - u) - v;
    let normal = (decode_direction(normals.x) * w + decode_direction(normals.y) * u) + decode_direction(normals.z) * v;
    let tangent = (decode_direction(tangents.x & ~1u) * w + decode_direction(tangents.y & ~1u) * u)
        + decode_direction(tangents.z & ~1u) * v;
    let a = bitcast<vec2f>(uv0.xy);
    let b = bitcast<vec2f>(vec2u(uv0.z, uv1.x));
    let c = bitcast<vec2f>(uv1.yz);
    let color0 = texel_value(normals.w);
    let color = (color0 + (texel_value(tangents.w) - color0) * u) + (texel_value(uv0.w) - color0) * v;
    return Attributes(normal, tangent, select(1.0, -1.0, (tangents.x & 1u) != 0u), (a * w + b * u) + c * v, color, vec2f(0.0));
}

// SecondUvRecord::at
fn second_uv_at(triangle: u32, u: f32, v: f32) -> vec2f {
    // No section but that of the nodes begins at 0: there is none.
    if select(SECOND_UVS, MOVING_SECOND_UVS, is_moving(triangle)) == 0u {
        return vec2f(0.0);
    }
    let at = record_at(triangle, SECOND_UVS, MOVING_SECOND_UVS, 2u);
    let ab = bitcast<vec4f>(load(at));
    let c = bitcast<vec2f>(load(at + 1u).xy);
    let w = (1.0 - u) - v;
    return (ab.xy * w + ab.zw * u) + c * v;
}
