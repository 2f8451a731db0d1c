//#use light
//#use sampling
//#use surface_point
//#use frame
// Light sampling and environment lookup. Twin of src/cpu/lights.rs.

const LIGHT_TRIANGLE: u32 = 0u;
const LIGHT_PUNCTUAL: u32 = 1u;
const LIGHT_ENVIRONMENT: u32 = 2u;
const LIGHT_INDEX: u32 = 0x3fffffffu;
// Distance that stands for lights at infinity.
const FAR: f32 = 3e38;

// lights::LightSample; a `pdf` of 0 means no light.
struct LightSample {
    direction: vec3f,
    distance: f32,
    radiance: vec3f,
    pdf: f32,
    can_be_hit: bool,
}

fn no_light() -> LightSample {
    return LightSample(vec3f(0.0, 1.0, 0.0), 0.0, vec3f(0.0), 0.0, false);
}

fn sample_light(p: SurfacePoint, draws: vec4f, more: vec4f) -> LightSample {
    let count = frame.lights;
    if count == 0u {
        return no_light();
    }
    var pick = load(PICKS + min(u32(draws.x * f32(count)), count - 1u));
    if draws.y >= bitcast<f32>(pick.x) {
        pick = load(PICKS + pick.y);
    }
    let probability = bitcast<f32>(pick.z);
    let kind = pick.w >> 30u;
    let index = pick.w & LIGHT_INDEX;
    if EFFECT_EMISSIVE_TRIANGLES {
        if kind == LIGHT_TRIANGLE {
            return from_triangle(p.position, index, probability, draws.zw);
        }
    }
    if EFFECT_PUNCTUAL_LIGHTS {
        if kind == LIGHT_PUNCTUAL {
            return from_punctual(p.position, index, probability);
        }
    }
    if EFFECT_ENVIRONMENT {
        if kind == LIGHT_ENVIRONMENT {
            return from_environment(p, probability, draws.zw, more);
        }
    }
    return no_light();
}

fn from_triangle(position: vec3f, index: u32, probability: f32, place: vec2f) -> LightSample {
    let c = triangle_at(index);
    let weights = barycentrics(place);
    let normal = cross(c.corners[1] - c.corners[0], c.corners[2] - c.corners[0]);
    let face = unit(normal);
    let on_light = point_at(c.corners[0], c.corners[1], c.corners[2], weights.y, weights.z);
    let cosine = dot(face, position - on_light);
    let double_sided = (material_row(c.material, 8u).x & FLAG_DOUBLE_SIDED) != 0u;
    if cosine <= 0.0 && !double_sided {
        return no_light();
    }
    let side = select(-face, face, cosine > 0.0);
    let to = offset_ray(on_light, side, magnitude(c.corners[0], c.corners[1], c.corners[2])) - position;
    let squared = dot(to, to);
    let direction = unit(to);
    let area = 0.5 * sqrt(dot(normal, normal));
    let pdf = probability * area_pdf(area, squared, dot(face, direction));
    return LightSample(direction, sqrt(squared), emission_at(index, c.material, weights.y, weights.z), pdf, true);
}

fn from_punctual(position: vec3f, index: u32, probability: f32) -> LightSample {
    let r0 = load(PUNCTUAL + index * PUNCTUAL_ROWS);
    let r1 = load(PUNCTUAL + index * PUNCTUAL_ROWS + 1u);
    let r2 = bitcast<vec4f>(load(PUNCTUAL + index * PUNCTUAL_ROWS + 2u));
    let axis = bitcast<vec3f>(r1.xyz);
    var radiance = r2.xyz;
    var direction = -axis;
    var away = FAR;
    if r0.w != 0u {
        let to = bitcast<vec3f>(r0.xyz) - position;
        away = sqrt(dot(to, to));
        direction = unit(to);
        radiance *= distance_falloff(away, bitcast<f32>(r1.w));
    }
    if r0.w == 2u {
        let cos_outer = bitcast<f32>(load(PUNCTUAL + index * PUNCTUAL_ROWS + 3u).x);
        radiance *= cone_falloff(-dot(direction, axis), r2.w, cos_outer);
    }
    return LightSample(direction, away, radiance, probability, false);
}

fn has_map() -> bool {
    return EFFECT_ENVIRONMENT_MAP && frame.map_size.x > 0u;
}

fn map_radiance(i: i32, j: i32) -> vec3f {
    let size = frame.map_size;
    let index = wrap_texel(j, size.y, WRAP_CLAMP) * size.x + wrap_texel(i, size.x, WRAP_REPEAT);
    return bitcast<vec3f>(load(MAP + index * MAP_ROWS).xyz);
}

fn from_environment(p: SurfacePoint, probability: f32, place: vec2f, more: vec4f) -> LightSample {
    var direction: vec3f;
    var pdf: f32;
    if has_map() {
        let size = frame.map_size;
        let count = size.x * size.y;
        var index = min(u32(more.x * f32(count)), count - 1u);
        let row = load(MAP + index * MAP_ROWS + 1u);
        if more.y >= bitcast<f32>(row.x) {
            index = row.y;
        }
        let u = (f32(index % size.x) + place.x) / f32(size.x);
        let v = (f32(index / size.x) + place.y) / f32(size.y);
        let to = map_direction(u, v);
        direction = to.direction;
        pdf = map_pdf(bitcast<f32>(load(MAP + index * MAP_ROWS).w), f32(count), to.sine);
    } else {
        let local = cosine_hemisphere(place);
        direction = to_world(local, p.x, p.y, p.z);
        pdf = cosine_hemisphere_pdf(local.z);
    }
    return LightSample(direction, FAR, sky(direction), probability * pdf, true);
}

fn sky(direction: vec3f) -> vec3f {
    if !has_map() {
        return frame.sky;
    }
    let place = map_coordinates(direction);
    let x = place.x * f32(frame.map_size.x) - 0.5;
    let y = place.y * f32(frame.map_size.y) - 0.5;
    let i = floor(x);
    let j = floor(y);
    let r = x - i;
    let s = y - j;
    let top = map_radiance(i32(i), i32(j)) * (1.0 - r) + map_radiance(i32(i) + 1, i32(j)) * r;
    let bottom = map_radiance(i32(i), i32(j) + 1) * (1.0 - r) + map_radiance(i32(i) + 1, i32(j) + 1) * r;
    return top * (1.0 - s) + bottom * s;
}

fn sky_pdf(direction: vec3f, cosine: f32) -> f32 {
    if !has_map() {
        return frame.sky_probability * cosine_hemisphere_pdf(cosine);
    }
    let size = frame.map_size;
    let place = map_coordinates(direction);
    let i = min(u32(place.x * f32(size.x)), size.x - 1u);
    let j = min(u32(place.y * f32(size.y)), size.y - 1u);
    let sine = sqrt(direction.x * direction.x + direction.z * direction.z);
    let probability = bitcast<f32>(load(MAP + (j * size.x + i) * MAP_ROWS).w);
    return frame.sky_probability * map_pdf(probability, f32(size.x * size.y), sine);
}

fn triangle_pdf(triangle: u32, away: f32, cosine: f32) -> f32 {
    let c = triangle_at(triangle);
    if c.light == 0u {
        return 0.0;
    }
    let normal = cross(c.corners[1] - c.corners[0], c.corners[2] - c.corners[0]);
    let area = 0.5 * sqrt(dot(normal, normal));
    return bitcast<f32>(load(PICKS + c.light - 1u).z) * area_pdf(area, away * away, cosine);
}
