//#use approx
//#use direction
// Twin of src/kernel/microfacet.rs.

const MIN_WIDTH: f32 = 1e-3;
const MIN_SHEEN_ROUGHNESS: f32 = 0.1;
const MIN_SHEEN_COSINE: f32 = 1e-3;

fn ggx_widths(roughness: f32, anisotropy: f32) -> vec2f {
    let width = clamp(roughness * roughness, MIN_WIDTH, 1.0);
    let aspect = sqrt(1.0 - 0.9 * clamp(anisotropy, 0.0, 1.0));
    return vec2f(min(width / aspect, 1.0), max(width * aspect, MIN_WIDTH));
}

fn ggx_mean_width(a: vec2f) -> f32 {
    return sqrt(0.5 * (a.x * a.x + a.y * a.y));
}

fn ggx_length(v: vec3f, a: vec2f) -> f32 {
    let x = v.x * a.x;
    let y = v.y * a.y;
    return sqrt(x * x + y * y + v.z * v.z);
}

fn ggx_d(h: vec3f, a: vec2f) -> f32 {
    let x = h.x / a.x;
    let y = h.y / a.y;
    let e = x * x + y * y + h.z * h.z;
    return 1.0 / (((PI * a.x) * a.y) * (e * e));
}

fn vndf_sample(v: vec3f, a: vec2f, u: vec2f) -> vec3f {
    let s = unit(vec3f(v.x * a.x, v.y * a.y, v.z));
    let sc = sin_cos_turns(u.x);
    let q = u.y * (1.0 + s.z);
    let r = sqrt(max(q * (2.0 - q), 0.0));
    let h = vec3f(r * sc.y + s.x, r * sc.x + s.y, (1.0 - u.y) * (1.0 + s.z));
    return unit(vec3f(h.x * a.x, h.y * a.y, h.z));
}

fn schlick_weight(cosine: f32) -> f32 {
    let x = clamp(1.0 - cosine, 0.0, 1.0);
    let x2 = x * x;
    return (x2 * x2) * x;
}

fn reflectance_at_normal(ior: f32) -> f32 {
    let r = (ior - 1.0) / (ior + 1.0);
    return r * r;
}

fn fresnel_dielectric(cosine: f32, eta: f32) -> f32 {
    let c = clamp(cosine, 0.0, 1.0);
    let k = refraction_discriminant(c, eta);
    if k <= 0.0 {
        return 1.0;
    }
    let t = sqrt(k);
    let s = (c - eta * t) / (c + eta * t);
    let p = (eta * c - t) / (eta * c + t);
    return 0.5 * (s * s + p * p);
}

fn refraction_discriminant(cosine: f32, eta: f32) -> f32 {
    return 1.0 - (1.0 - cosine) * (1.0 + cosine) / (eta * eta);
}

fn mirrored(v: vec3f, h: vec3f) -> vec3f {
    let d = 2.0 * dot(v, h);
    return vec3f(d * h.x - v.x, d * h.y - v.y, d * h.z - v.z);
}

fn refracted(v: vec3f, h: vec3f, eta: f32) -> vec3f {
    let c = dot(v, h);
    let t = sqrt(max(refraction_discriminant(c, eta), 0.0));
    let d = c / eta - t;
    return vec3f(d * h.x - v.x / eta, d * h.y - v.y / eta, d * h.z - v.z / eta);
}

fn charlie_d(cosine: f32, a: f32) -> f32 {
    let sin2 = max((1.0 - cosine) * (1.0 + cosine), 1e-30);
    return ((a * (1.0f / PI) + 0.5f / PI) / a) * exp_approx(max(ln_approx(sin2) * (0.5 / a), -60.0));
}

fn charlie_curve(x: f32, a: f32) -> f32 {
    let w = (1.0 - a) * (1.0 - a);
    let top = 21.5473 + 3.7772 * w;
    let slope = 3.82987 - 0.50552 * w;
    let power = 0.19823 - 0.03022 * w;
    let linear = -1.9776 + 0.70367 * w;
    let offset = -4.32054 - 0.53913 * w;
    let raised = exp_approx(ln_approx(max(x, 1e-30)) * power);
    return (top / (slope * raised + 1.0) + offset) + linear * x;
}

fn charlie_lambda(cosine: f32, a: f32) -> f32 {
    let c = clamp(cosine, MIN_SHEEN_COSINE, 1.0);
    if c < 0.5 {
        return exp_approx(charlie_curve(c, a));
    }
    return exp_approx(2.0 * charlie_curve(0.5, a) - charlie_curve(1.0 - c, a));
}

fn charlie_visibility(cos_o: f32, lambda_o: f32, cos_i: f32, lambda_i: f32) -> f32 {
    let o = max(cos_o, MIN_SHEEN_COSINE);
    let i = max(cos_i, MIN_SHEEN_COSINE);
    let x = ((1.0 + lambda_o) + lambda_i) * ((4.0 * o) * i);
    if x > 1.0 {
        return 1.0 / x;
    }
    return 1.0;
}
