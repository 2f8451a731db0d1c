//#use approx
// Twin of src/kernel/light.rs.

const MAP_AREA: f32 = 19.739208;

fn distance_falloff(away: f32, range: f32) -> f32 {
    let ratio = away / range;
    let squared = ratio * ratio;
    let window = clamp(1.0 - squared * squared, 0.0, 1.0);
    let near = max(away, 1e-3);
    return window / (near * near);
}

fn cone_falloff(cos_angle: f32, cos_inner: f32, cos_outer: f32) -> f32 {
    let t = clamp((cos_angle - cos_outer) / max(cos_inner - cos_outer, 1e-3), 0.0, 1.0);
    return t * t;
}

fn map_coordinates(direction: vec3f) -> vec2f {
    let across = sqrt(direction.x * direction.x + direction.z * direction.z);
    let longitude = atan2_upper(abs(direction.x), -direction.z) * 0.15915494;
    let u = select(0.5 + longitude, 0.5 - longitude, direction.x < 0.0);
    return vec2f(u, atan2_upper(across, direction.y) * 0.31830987);
}

struct MapDirection {
    direction: vec3f,
    sine: f32,
}

fn map_direction(u: f32, v: f32) -> MapDirection {
    let longitude = sin_cos_turns(u - 0.5);
    let latitude = sin_cos_turns(0.5 * v);
    let sine = max(latitude.x, 0.0);
    return MapDirection(vec3f(longitude.x * sine, latitude.y, -(longitude.y * sine)), sine);
}

fn map_pdf(probability: f32, texels: f32, sine: f32) -> f32 {
    return probability * texels / (MAP_AREA * max(sine, 1e-6));
}
