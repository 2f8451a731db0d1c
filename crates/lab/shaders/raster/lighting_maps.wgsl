//#use light
//#use raster_frame
// Group 2: sun's shadow map, sky, and tables of directional albedos.

@group(2) @binding(0) var shadow_map: texture_depth_2d;
@group(2) @binding(1) var shadow_sampler: sampler_comparison;
@group(2) @binding(2) var sky_map: texture_2d<f32>;
@group(2) @binding(3) var sky_sampler: sampler;
@group(2) @binding(4) var albedo_tables: texture_2d<u32>;

// Largest f16 value, the color format's.
const LARGEST_HALF: f32 = 65504.0;

// Cell of the albedo tables.
fn load(i: u32) -> vec4u {
    return textureLoad(albedo_tables, vec2u(i % 256u, i / 256u), 0);
}

// Sky radiance in a unit direction, blurred to the width of a highlight of `roughness`.
fn sky_radiance(direction: vec3f, roughness: f32) -> vec3f {
    return textureSampleLevel(sky_map, sky_sampler, map_coordinates(direction), roughness * lights.last_level).xyz;
}

// Share of the sun that reaches a point: 3x3 bilinear shadow map comparisons.
fn sunlit(position: vec3f, normal: vec3f) -> f32 {
    // Offset along the normal by 1.5 texels, against self-shadowing.
    let at = vec4f(position + normal * (1.5 * lights.texel), 1.0);
    let place = vec3f(dot(lights.sun[0], at), dot(lights.sun[1], at), dot(lights.sun[2], at));
    let uv = vec2f(0.5 + 0.5 * place.x, 0.5 - 0.5 * place.y);
    let texel = 1.0 / vec2f(textureDimensions(shadow_map));
    var sum = 0.0;
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let tap = uv + vec2f(f32(x), f32(y)) * texel;
            sum += textureSampleCompareLevel(shadow_map, shadow_sampler, tap, place.z);
        }
    }
    // Outside the map nothing casts a shadow.
    let inside = max(abs(place.x), abs(place.y)) < 1.0;
    return select(1.0, sum * (1.0f / 9.0), inside);
}
