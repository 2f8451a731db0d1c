//#use albedo
//#use color
//#use microfacet
//#use sampling
// Twin of src/kernel/layers.rs. `Lobes` are override constants; `Surface` is called `BsdfSurface`.

override LOBE_RETRO: bool = true;
override LOBE_SPECULAR: bool = true;
override LOBE_METAL: bool = true;
override LOBE_ANISOTROPY: bool = true;
override LOBE_CLEARCOAT: bool = true;
override LOBE_SHEEN: bool = true;
override LOBE_TRANSMISSION: bool = true;

const COAT_IOR: f32 = 1.5;
const MIN_REFRACTING_IOR: f32 = 1.03;
const MAX_REFRACTING_IOR: f32 = 3.0;

struct BsdfSurface {
    base_color: vec3f,
    metallic: f32,
    roughness: f32,
    specular: f32,
    specular_color: vec3f,
    ior: f32,
    anisotropy: f32,
    clearcoat: f32,
    clearcoat_roughness: f32,
    sheen_color: vec3f,
    sheen_roughness: f32,
    transmission: f32,
    thin: bool,
    entering: bool,
}

struct Layers {
    widths: vec2f,
    diffuse: vec3f,
    retro: f32,
    retro_roughness: f32,
    retro_scale: f32,
    reflect: vec3f,
    reflect_rise: vec3f,
    coat_width: f32,
    coat: f32,
    coat_rise: f32,
    sheen: vec3f,
    sheen_width: f32,
    sheen_lambda: f32,
    glass: vec3f,
    glass_color: vec3f,
    glass_reflect: vec3f,
    eta: f32,
    thin: bool,
    probabilities: vec4f,
}

fn retro_albedo(cosine: f32, roughness: f32) -> f32 {
    let r = roughness;
    let rise = cosine * (1.0f / 84.0) + 1.0f / 21.0;
    let slope = cosine * (55.0f / 84.0) + 20.0f / 21.0;
    let curve = (cosine * (-1.0f / 56.0) + 1.0f / 42.0) * cosine + 5.0f / 72.0;
    return (rise * r + 41.0f / 42.0) + ((curve * r + slope) * r - 41.0f / 84.0) * schlick_weight(cosine);
}

fn compensation(f0: vec3f, e: vec2f) -> vec3f {
    return f0 * ((1.0 - e.x) / e.x) + vec3f(1.0);
}

fn reflect_albedo(f0: vec3f, e: vec2f) -> vec3f {
    return min((f0 * (e.x - e.y) + vec3f(e.y)) * compensation(f0, e), vec3f(1.0));
}

fn glass_fresnel(glass_reflect: vec3f, fresnel: f32) -> vec3f {
    if fresnel >= 1.0 {
        return vec3f(1.0);
    }
    return glass_reflect * fresnel;
}

fn layers(surface: BsdfSurface, wo: vec3f, tables: u32) -> Layers {
    let z = clamp(wo.z, 0.0, 1.0);
    let base = clamp(surface.base_color, vec3f(0.0), vec3f(1.0));
    let roughness = clamp(surface.roughness, 0.0, 1.0);
    let strength = clamp(surface.specular, 0.0, 1.0);
    let specular = select(0.0, strength, LOBE_SPECULAR);
    let metallic = select(0.0, clamp(surface.metallic, 0.0, 1.0), LOBE_METAL);
    let transmission = select(0.0, clamp(surface.transmission, 0.0, 1.0), LOBE_TRANSMISSION);
    let anisotropy = select(0.0, surface.anisotropy, LOBE_ANISOTROPY);
    let widths = ggx_widths(roughness, anisotropy);
    let dielectric = 1.0 - metallic;
    let opaque = dielectric * (1.0 - transmission);

    var coat = 0.0;
    var coat_rise = 0.0;
    var coat_albedo = 0.0;
    var coat_width = 1.0;
    if LOBE_CLEARCOAT {
        let amount = clamp(surface.clearcoat, 0.0, 1.0);
        let coat_roughness = clamp(surface.clearcoat_roughness, 0.0, 1.0);
        coat_width = ggx_widths(coat_roughness, 0.0).x;
        let e = ggx_albedo(tables, z, coat_width);
        let f0 = reflectance_at_normal(COAT_IOR);
        let scale = amount * (f0 * ((1.0 - e.x) / e.x) + 1.0);
        coat = scale * f0;
        coat_rise = scale * (1.0 - f0);
        coat_albedo = min((f0 * (e.x - e.y) + e.y) * scale, 1.0);
    }
    let below_coat = 1.0 - coat_albedo;
    var sheen = vec3f(0.0);
    var sheen_probability = 0.0;
    var sheen_width = 1.0;
    var sheen_lambda = 0.0;
    var below = below_coat;
    if LOBE_SHEEN {
        let color = clamp(surface.sheen_color, vec3f(0.0), vec3f(1.0));
        let sheen_roughness = clamp(surface.sheen_roughness, MIN_SHEEN_ROUGHNESS, 1.0);
        let e = sheen_albedo(tables, z, sheen_roughness);
        let scale = 1.0 / max(e, 1.0);
        let albedo = e * scale;
        sheen = color * (scale * below_coat);
        sheen_probability = luma(color) * (albedo * below_coat);
        sheen_width = sheen_roughness * sheen_roughness;
        sheen_lambda = charlie_lambda(z, sheen_width);
        below = below_coat * (1.0 - max(max(color.x, color.y), color.z) * albedo);
    }

    var e = vec2f(1.0, 0.0);
    let mean_width = ggx_mean_width(widths);
    if LOBE_SPECULAR || LOBE_METAL || LOBE_TRANSMISSION {
        e = ggx_albedo(tables, z, mean_width);
        if LOBE_ANISOTROPY && anisotropy > 0.0 {
            e += anisotropic_albedo(tables, wo, widths);
        }
    }
    var reflected = vec3f(0.0);
    var reflect_rise = vec3f(0.0);
    var reflect_probability = 0.0;
    var entered = vec3f(1.0);
    if LOBE_SPECULAR {
        let normal = reflectance_at_normal(max(surface.ior, 1.0));
        let f0 = min(max(surface.specular_color, vec3f(0.0)) * normal, vec3f(1.0));
        let albedo = reflect_albedo(f0, e) * specular;
        let scale = compensation(f0, e) * ((opaque * below) * specular);
        reflected = scale * f0;
        reflect_rise = scale * (vec3f(1.0) - f0);
        reflect_probability = luma(albedo) * (opaque * below);
        entered = vec3f(1.0) - albedo;
    }
    if LOBE_METAL {
        let scale = compensation(base, e) * (metallic * below);
        reflected += scale * base;
        reflect_rise += scale * (vec3f(1.0) - base);
        reflect_probability += luma(reflect_albedo(base, e)) * (metallic * below);
    }
    let diffuse_albedo = (base * entered) * (opaque * below);
    let retro = select(0.0, strength, LOBE_RETRO);
    var retro_scale = 1.0;
    if LOBE_RETRO {
        retro_scale = 1.0 / retro_albedo(z, roughness);
    }

    var glass = vec3f(0.0);
    var glass_reflect = vec3f(0.0);
    var eta = 1.0;
    var glass_probability = 0.0;
    let ior = clamp(surface.ior, 1.0, MAX_REFRACTING_IOR);
    let thin = surface.thin || ior < MIN_REFRACTING_IOR;
    if LOBE_TRANSMISSION {
        eta = select(1.0 / ior, ior, surface.entering || thin);
        glass_reflect = clamp(surface.specular_color * strength, vec3f(0.0), vec3f(1.0));
        var returned = vec2f(e.x, e.x);
        if !thin {
            returned = glass_albedo(tables, z, mean_width, ior, surface.entering);
        }
        let amount = (dielectric * transmission) * below;
        glass = vec3f(amount) / (glass_reflect * (returned.x - returned.y) + vec3f(returned.y));
        let f = glass_fresnel(glass_reflect, fresnel_dielectric(z, eta));
        let least = select(0.0, 0.1, eta < 1.0);
        glass_probability = max(luma((vec3f(1.0) - f) * base + f), least) * amount;
    }

    let diffuse_probability = luma(diffuse_albedo) + sheen_probability;
    let total = ((diffuse_probability + reflect_probability) + coat_albedo) + glass_probability;
    var probabilities = vec4f(0.0);
    if total > 1e-30 {
        probabilities = vec4f(diffuse_probability / total, reflect_probability / total, coat_albedo / total, glass_probability / total);
    }
    return Layers(
        widths,
        diffuse_albedo * FRAC_1_PI,
        retro,
        roughness,
        retro_scale,
        reflected,
        reflect_rise,
        coat_width,
        coat,
        coat_rise,
        sheen,
        sheen_width,
        sheen_lambda,
        glass,
        base,
        glass_reflect,
        eta,
        thin,
        probabilities,
    );
}
