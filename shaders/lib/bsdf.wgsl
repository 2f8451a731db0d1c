//#use albedo
//#use color
//#use direction
//#use microfacet
//#use sampling
// Twin of src/kernel/bsdf.rs. `Lobes` are overrides; `Surface` is `BsdfSurface`, `Scatter` and `Sampled` are one struct.

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
    base_color: vec3<f32>,
    metallic: f32,
    roughness: f32,
    specular: f32,
    specular_color: vec3<f32>,
    ior: f32,
    anisotropy: f32,
    clearcoat: f32,
    clearcoat_roughness: f32,
    sheen_color: vec3<f32>,
    sheen_roughness: f32,
    transmission: f32,
    thin: bool,
    entering: bool,
}

struct Scatter {
    wi: vec3<f32>,
    value: vec3<f32>,
    pdf: f32,
}

struct Layers {
    widths: vec2<f32>,
    diffuse: vec3<f32>,
    retro: f32,
    retro_roughness: f32,
    retro_scale: f32,
    reflect: vec3<f32>,
    reflect_rise: vec3<f32>,
    coat_width: f32,
    coat: f32,
    coat_rise: f32,
    sheen: vec3<f32>,
    sheen_width: f32,
    sheen_lambda: f32,
    glass: vec3<f32>,
    glass_color: vec3<f32>,
    glass_reflect: vec3<f32>,
    eta: f32,
    thin: bool,
    chances: vec4<f32>,
}

// bsdf::retro_albedo
fn retro_albedo(cosine: f32, roughness: f32) -> f32 {
    let p = schlick_weight(cosine);
    let r = roughness;
    let b = r - 0.5;
    let rc = r * cosine;
    let rise_i = b / 42.0 + rc / 168.0;
    let rise_o = b / 2.0 + rc / 3.0;
    let squares = ((11.0f / 1008.0f) * r) * r * (1.0 - cosine * cosine);
    let both = ((rc * rc) / 504.0 + squares) + (b / 42.0 + rc / 84.0) * b;
    return (rise_i + (rise_o + both) * p) * 2.0 + 1.0;
}

// bsdf::retro_value
fn retro_value(wo: vec3<f32>, wi: vec3<f32>, roughness: f32) -> f32 {
    let rise = (1.0 + dot(wo, wi)) * roughness - 0.5;
    let i = rise * schlick_weight(wi.z) + 1.0;
    let o = rise * schlick_weight(wo.z) + 1.0;
    return i * o;
}

// bsdf::compensation
fn compensation(f0: vec3<f32>, e: vec2<f32>) -> vec3<f32> {
    return f0 * ((1.0 - e.x) / e.x) + vec3<f32>(1.0);
}

// bsdf::reflect_albedo
fn reflect_albedo(f0: vec3<f32>, e: vec2<f32>) -> vec3<f32> {
    return min((f0 * (e.x - e.y) + vec3<f32>(e.y)) * compensation(f0, e), vec3<f32>(1.0));
}

// bsdf::layers
fn layers(surface: BsdfSurface, wo: vec3<f32>, tables: u32) -> Layers {
    let z = clamp(wo.z, 0.0, 1.0);
    let base = clamp(surface.base_color, vec3<f32>(0.0), vec3<f32>(1.0));
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
    var sheen = vec3<f32>(0.0);
    var sheen_chance = 0.0;
    var sheen_width = 1.0;
    var sheen_lambda = 0.0;
    var below = below_coat;
    if LOBE_SHEEN {
        let color = clamp(surface.sheen_color, vec3<f32>(0.0), vec3<f32>(1.0));
        let sheen_roughness = clamp(surface.sheen_roughness, MIN_SHEEN_ROUGHNESS, 1.0);
        let e = sheen_albedo(tables, z, sheen_roughness);
        let scale = 1.0 / max(e, 1.0);
        let albedo = e * scale;
        sheen = color * (scale * below_coat);
        sheen_chance = luma(color) * (albedo * below_coat);
        sheen_width = sheen_roughness * sheen_roughness;
        sheen_lambda = charlie_lambda(z, sheen_width);
        below = below_coat * (1.0 - max(max(color.x, color.y), color.z) * albedo);
    }

    var e = vec2<f32>(1.0, 0.0);
    let mean_width = ggx_mean_width(widths);
    if LOBE_SPECULAR || LOBE_METAL || LOBE_TRANSMISSION {
        e = ggx_albedo(tables, z, mean_width);
        if LOBE_ANISOTROPY && anisotropy > 0.0 {
            e += stretched_albedo(tables, wo, widths);
        }
    }
    var reflect = vec3<f32>(0.0);
    var reflect_rise = vec3<f32>(0.0);
    var reflect_chance = 0.0;
    var entered = vec3<f32>(1.0);
    if LOBE_SPECULAR {
        let normal = reflectance_at_normal(max(surface.ior, 1.0));
        let f0 = min(max(surface.specular_color, vec3<f32>(0.0)) * normal, vec3<f32>(1.0));
        let albedo = reflect_albedo(f0, e) * specular;
        let scale = compensation(f0, e) * ((opaque * below) * specular);
        reflect = scale * f0;
        reflect_rise = scale * (vec3<f32>(1.0) - f0);
        reflect_chance = luma(albedo) * (opaque * below);
        entered = vec3<f32>(1.0) - albedo;
    }
    if LOBE_METAL {
        let scale = compensation(base, e) * (metallic * below);
        reflect += scale * base;
        reflect_rise += scale * (vec3<f32>(1.0) - base);
        reflect_chance += luma(reflect_albedo(base, e)) * (metallic * below);
    }
    let diffuse_albedo = (base * entered) * (opaque * below);
    let retro = select(0.0, strength, LOBE_RETRO);
    var retro_scale = 1.0;
    if LOBE_RETRO {
        retro_scale = 1.0 / retro_albedo(z, roughness);
    }

    var glass = vec3<f32>(0.0);
    var glass_reflect = vec3<f32>(0.0);
    var eta = 1.0;
    var glass_chance = 0.0;
    let ior = clamp(surface.ior, 1.0, MAX_REFRACTING_IOR);
    let thin = surface.thin || ior < MIN_REFRACTING_IOR;
    if LOBE_TRANSMISSION {
        eta = select(1.0 / ior, ior, surface.entering || thin);
        glass_reflect = clamp(surface.specular_color * strength, vec3<f32>(0.0), vec3<f32>(1.0));
        var returned = vec2<f32>(e.x, e.x);
        if !thin {
            returned = glass_albedo(tables, z, mean_width, ior, surface.entering);
        }
        let amount = (dielectric * transmission) * below;
        glass = vec3<f32>(amount) / (glass_reflect * (returned.x - returned.y) + vec3<f32>(returned.y));
        let f = glass_fresnel(glass_reflect, fresnel_dielectric(z, eta));
        let least = select(0.0, 0.1, eta < 1.0);
        glass_chance = max(luma((vec3<f32>(1.0) - f) * base + f), least) * amount;
    }

    let diffuse_chance = luma(diffuse_albedo) + sheen_chance;
    let total = ((diffuse_chance + reflect_chance) + coat_albedo) + glass_chance;
    var chances = vec4<f32>(0.0);
    if total > 1e-30 {
        chances = vec4<f32>(diffuse_chance / total, reflect_chance / total, coat_albedo / total, glass_chance / total);
    }
    return Layers(
        widths,
        diffuse_albedo * FRAC_1_PI,
        retro,
        roughness,
        retro_scale,
        reflect,
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
        chances,
    );
}

// bsdf::mirror_chance
fn mirror_chance(glass_reflect: vec3<f32>, fresnel: f32) -> f32 {
    if fresnel >= 1.0 {
        return 1.0;
    }
    return fresnel * max(max(glass_reflect.x, glass_reflect.y), glass_reflect.z);
}

// bsdf::glass_fresnel
fn glass_fresnel(glass_reflect: vec3<f32>, fresnel: f32) -> vec3<f32> {
    if fresnel >= 1.0 {
        return vec3<f32>(1.0);
    }
    return glass_reflect * fresnel;
}

// bsdf::eval_reflection
fn eval_reflection(layers: Layers, wo: vec3<f32>, wi: vec3<f32>) -> Scatter {
    let lambert = cosine_hemisphere_pdf(wi.z);
    var pdf = layers.chances.x * lambert;
    var diffuse = layers.diffuse;
    if LOBE_RETRO {
        let burley = retro_value(wo, wi, layers.retro_roughness) * layers.retro_scale;
        diffuse *= (1.0 - layers.retro) + burley * layers.retro;
    }
    let h = unit(wo + wi);
    let vh = clamp(dot(wo, h), 0.0, 1.0);
    let rise = schlick_weight(vh);
    if LOBE_SHEEN {
        let lambda = charlie_lambda(wi.z, layers.sheen_width);
        let visibility = charlie_visibility(wo.z, layers.sheen_lambda, wi.z, lambda);
        diffuse += layers.sheen * (charlie_d(h.z, layers.sheen_width) * visibility);
    }
    var value = diffuse * wi.z;
    if LOBE_SPECULAR || LOBE_METAL || LOBE_TRANSMISSION {
        let d = 0.5 * ggx_d(h, layers.widths);
        let length_o = ggx_length(wo, layers.widths);
        let length_i = ggx_length(wi, layers.widths);
        let density = d / (wo.z + length_o);
        let shape = (d * wi.z) / (wi.z * length_o + wo.z * length_i);
        value += (layers.reflect_rise * rise + layers.reflect) * shape;
        pdf += layers.chances.y * density;
        if LOBE_TRANSMISSION {
            let fresnel = fresnel_dielectric(vh, layers.eta);
            value += (layers.glass * glass_fresnel(layers.glass_reflect, fresnel)) * shape;
            pdf += (layers.chances.w * mirror_chance(layers.glass_reflect, fresnel)) * density;
        }
    }
    if LOBE_CLEARCOAT {
        let a = vec2<f32>(layers.coat_width);
        let d = 0.5 * ggx_d(h, a);
        let length_o = ggx_length(wo, a);
        let length_i = ggx_length(wi, a);
        let shape = (d * wi.z) / (wi.z * length_o + wo.z * length_i);
        value += vec3<f32>((layers.coat_rise * rise + layers.coat) * shape);
        pdf += layers.chances.z * (d / (wo.z + length_o));
    }
    return Scatter(wi, value, pdf);
}

// bsdf::eval_transmission
fn eval_transmission(layers: Layers, wo: vec3<f32>, wi: vec3<f32>) -> Scatter {
    let none = Scatter(wi, vec3<f32>(0.0), 0.0);
    let below = vec3<f32>(wi.x, wi.y, -wi.z);
    let length_o = ggx_length(wo, layers.widths);
    let length_i = ggx_length(wi, layers.widths);
    var h = unit(wo + below);
    var jacobian = 0.25;
    if !layers.thin {
        h = unit(wo + wi * layers.eta);
        if h.z < 0.0 {
            h = -h;
        }
        let vh = dot(wo, h);
        let lh = dot(wi, h);
        if vh <= 0.0 || lh >= 0.0 {
            return none;
        }
        let root = (vh + lh * layers.eta) / layers.eta;
        jacobian = (vh * -lh) / (root * root);
    }
    let vh = dot(wo, h);
    let fresnel = fresnel_dielectric(vh, layers.eta);
    if fresnel >= 1.0 {
        return none;
    }
    let d = (2.0 * ggx_d(h, layers.widths)) * jacobian;
    let shape = (d * below.z) / (below.z * length_o + wo.z * length_i);
    let density = d / (wo.z + length_o);
    let through = vec3<f32>(1.0) - glass_fresnel(layers.glass_reflect, fresnel);
    let value = (layers.glass * layers.glass_color) * through * shape;
    return Scatter(wi, value, (layers.chances.w * (1.0 - mirror_chance(layers.glass_reflect, fresnel))) * density);
}

// bsdf::eval
fn eval(layers: Layers, wo: vec3<f32>, wi: vec3<f32>) -> Scatter {
    if wo.z > 0.0 && wi.z > 0.0 {
        return eval_reflection(layers, wo, wi);
    }
    if LOBE_TRANSMISSION && wo.z > 0.0 && wi.z < 0.0 && layers.chances.w > 0.0 {
        return eval_transmission(layers, wo, wi);
    }
    return Scatter(wi, vec3<f32>(0.0), 0.0);
}

// bsdf::sample
fn sample(layers: Layers, wo: vec3<f32>, u: vec4<f32>) -> Scatter {
    let none = Scatter(vec3<f32>(0.0, 0.0, 1.0), vec3<f32>(0.0), 0.0);
    if wo.z <= 0.0 {
        return none;
    }
    let up_to_reflect = layers.chances.x + layers.chances.y;
    let up_to_coat = up_to_reflect + layers.chances.z;
    let total = up_to_coat + layers.chances.w;
    let at = u.x * total;
    let direction = vec2<f32>(u.y, u.z);
    var wi = vec3<f32>(0.0, 0.0, 1.0);
    var side = 1.0;
    if at < layers.chances.x {
        wi = cosine_hemisphere(direction);
    } else if (LOBE_SPECULAR || LOBE_METAL) && at < up_to_reflect {
        wi = mirrored(wo, vndf_sample(wo, layers.widths, direction));
    } else if LOBE_CLEARCOAT && at < up_to_coat {
        wi = mirrored(wo, vndf_sample(wo, vec2<f32>(layers.coat_width), direction));
    } else if LOBE_TRANSMISSION && at < total {
        let h = vndf_sample(wo, layers.widths, direction);
        let vh = clamp(dot(wo, h), 0.0, 1.0);
        wi = mirrored(wo, h);
        if u.w >= mirror_chance(layers.glass_reflect, fresnel_dielectric(vh, layers.eta)) {
            side = -1.0;
            if layers.thin {
                wi.z = -wi.z;
            } else if refraction_discriminant(vh, layers.eta) > 0.0 {
                wi = refracted(wo, h, layers.eta);
            }
        }
    } else {
        return none;
    }
    wi = unit(wi);
    if wi.z * side <= 0.0 {
        return none;
    }
    return eval(layers, wo, wi);
}
