//#use approx
//#use sampling
// Twin of src/kernel/phong.rs. One struct holds the fields of `Sampled` and `Scatter`.

struct PhongSurface {
    diffuse: vec3f,
    specular: vec3f,
    exponent: f32,
}

struct PhongScatter {
    wi: vec3f,
    value: vec3f,
    pdf: f32,
}

fn phong_power(x: f32, y: f32) -> f32 {
    if y <= 0.0 {
        return 1.0;
    }
    if x <= 0.0 {
        return 0.0;
    }
    return exp_approx(max(ln_approx(max(x, 1e-30)) * y, -60.0));
}

fn phong_specular_probability(surface: PhongSurface) -> f32 {
    let diffuse = (surface.diffuse.x + surface.diffuse.y) + surface.diffuse.z;
    let specular = (surface.specular.x + surface.specular.y) + surface.specular.z;
    let sum = diffuse + specular;
    if sum > 0.0 {
        return specular / sum;
    }
    return 0.0;
}

fn phong_diffuse(surface: PhongSurface, wi: vec3f) -> vec3f {
    return surface.diffuse * (max(wi.z, 0.0) * FRAC_1_PI);
}

fn phong_specular(surface: PhongSurface, wo: vec3f, wi: vec3f) -> vec3f {
    let cosine = clamp(wi.z * wo.z - (wi.x * wo.x + wi.y * wo.y), 0.0, 1.0);
    let top = (surface.exponent + 2.0) * (0.5 * FRAC_1_PI);
    return surface.specular * ((top * phong_power(cosine, surface.exponent)) * max(wi.z, 0.0));
}

fn phong_eval(surface: PhongSurface, wo: vec3f, wi: vec3f) -> PhongScatter {
    if wo.z <= 0.0 || wi.z <= 0.0 {
        return PhongScatter(wi, vec3f(0.0), 0.0);
    }
    let value = phong_diffuse(surface, wi) + phong_specular(surface, wo, wi);
    return PhongScatter(wi, value, uniform_hemisphere_pdf(wi.z));
}

fn phong_sample(surface: PhongSurface, wo: vec3f, u: vec3f) -> PhongScatter {
    let wi = uniform_hemisphere(vec2f(u.y, u.z));
    if wo.z <= 0.0 || wi.z <= 0.0 {
        return PhongScatter(wi, vec3f(0.0), 0.0);
    }
    let probability = phong_specular_probability(surface);
    let pdf = uniform_hemisphere_pdf(wi.z);
    if u.x < probability {
        return PhongScatter(wi, phong_specular(surface, wo, wi) / probability, pdf);
    }
    return PhongScatter(wi, phong_diffuse(surface, wi) / (1.0 - probability), pdf);
}
