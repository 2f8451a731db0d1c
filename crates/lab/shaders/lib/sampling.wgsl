//#use approx
// Twin of src/kernel/sampling.rs.

const FRAC_1_PI: f32 = 0.318309886183790671538;

fn disk(u: vec2f) -> vec2f {
    let r = sqrt(u.x);
    let sc = sin_cos_turns(u.y);
    return vec2f(r * sc.y, r * sc.x);
}

fn cosine_hemisphere(u: vec2f) -> vec3f {
    let d = disk(u);
    return vec3f(d.x, d.y, sqrt(max(1.0 - u.x, 0.0)));
}

fn cosine_hemisphere_pdf(z: f32) -> f32 {
    return max(z, 0.0) * FRAC_1_PI;
}

fn uniform_hemisphere(u: vec2f) -> vec3f {
    let r = sqrt(max(u.x * (2.0 - u.x), 0.0));
    let sc = sin_cos_turns(u.y);
    return vec3f(r * sc.y, r * sc.x, 1.0 - u.x);
}

fn uniform_hemisphere_pdf(z: f32) -> f32 {
    return select(0.0, 0.5f * FRAC_1_PI, z >= 0.0);
}

fn barycentrics(u: vec2f) -> vec3f {
    let s = sqrt(u.x);
    let y = u.y * s;
    return vec3f(1.0 - s, s - y, y);
}

fn area_pdf(area: f32, distance_squared: f32, cosine: f32) -> f32 {
    let projected = area * abs(cosine);
    if projected > 1e-30 {
        return distance_squared / projected;
    }
    return 0.0;
}

fn power_heuristic(own: f32, other: f32) -> f32 {
    if own > other {
        let r = other / own;
        return 1.0 / (r * r + 1.0);
    }
    if other > 0.0 {
        let r = own / other;
        return (r * r) / (r * r + 1.0);
    }
    return 0.0;
}
