//#use light
//#use raster_frame
// What is around and between surfaces: the sky, the sun's shadow map, the tables of albedos.

@group(2) @binding(0) var shadow_map: texture_depth_2d;
@group(2) @binding(1) var shadow_sampler: sampler_comparison;
@group(2) @binding(2) var sky_map: texture_2d<f32>;
@group(2) @binding(3) var sky_sampler: sampler;
@group(2) @binding(4) var albedo_tables: texture_2d<u32>;

// Largest number of the color's format.
const MAX_COLOR: f32 = 65504.0;

// Cell of the tables of albedos.
fn load(i: u32) -> vec4<u32> {
    return textureLoad(albedo_tables, vec2<u32>(i % 256u, i / 256u), 0);
}

// Radiance from a direction of length 1, blurred by as much as a highlight of a roughness is wide.
fn sky_radiance(direction: vec3<f32>, roughness: f32) -> vec3<f32> {
    return textureSampleLevel(sky_map, sky_sampler, map_coordinates(direction), roughness * lights.last_level).xyz;
}

// Share of the sun that reaches a point: 3x3 comparisons, each between four texels.
fn sunlit(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    // Beside the surface, so that it does not shade itself where texels are coarse.
    let at = vec4<f32>(position + normal * (1.5 * lights.texel), 1.0);
    let place = vec3<f32>(dot(lights.sun[0], at), dot(lights.sun[1], at), dot(lights.sun[2], at));
    let uv = vec2<f32>(0.5 + 0.5 * place.x, 0.5 - 0.5 * place.y);
    let step = 1.0 / vec2<f32>(textureDimensions(shadow_map));
    var sum = 0.0;
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let tap = uv + vec2<f32>(f32(x), f32(y)) * step;
            sum += textureSampleCompareLevel(shadow_map, shadow_sampler, tap, place.z);
        }
    }
    // Beyond the map nothing casts a shadow.
    let inside = max(abs(place.x), abs(place.y)) < 1.0;
    return select(1.0, sum / 9.0, inside);
}
