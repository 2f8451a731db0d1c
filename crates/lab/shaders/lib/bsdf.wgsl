//#use direction
//#use layers
//#use microfacet
//#use sampling
// Twin of src/kernel/bsdf.rs. One struct `Scatter` stands for both `Scatter` and `Sampled`.

struct Scatter {
    wi: vec3f,
    value: vec3f,
    pdf: f32,
}

fn retro_value(wo: vec3f, wi: vec3f, roughness: f32) -> f32 {
    let rise = (1.0 + dot(wo, wi)) * roughness - 0.5;
    let i = rise * schlick_weight(wi.z) + 1.0;
    let o = rise * schlick_weight(wo.z) + 1.0;
    return i * o;
}

fn mirror_probability(glass_reflect: vec3f, fresnel: f32) -> f32 {
    if fresnel >= 1.0 {
        return 1.0;
    }
    return fresnel * max(max(glass_reflect.x, glass_reflect.y), glass_reflect.z);
}

fn eval_reflection(layers: Layers, wo: vec3f, wi: vec3f) -> Scatter {
    let lambert = cosine_hemisphere_pdf(wi.z);
    var pdf = layers.probabilities.x * lambert;
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
        pdf += layers.probabilities.y * density;
        if LOBE_TRANSMISSION {
            let fresnel = fresnel_dielectric(vh, layers.eta);
            value += (layers.glass * glass_fresnel(layers.glass_reflect, fresnel)) * shape;
            pdf += (layers.probabilities.w * mirror_probability(layers.glass_reflect, fresnel)) * density;
        }
    }
    if LOBE_CLEARCOAT {
        let a = vec2f(layers.coat_width);
        let d = 0.5 * ggx_d(h, a);
        let length_o = ggx_length(wo, a);
        let length_i = ggx_length(wi, a);
        let shape = (d * wi.z) / (wi.z * length_o + wo.z * length_i);
        value += vec3f((layers.coat_rise * rise + layers.coat) * shape);
        pdf += layers.probabilities.z * (d / (wo.z + length_o));
    }
    return Scatter(wi, value, pdf);
}

fn eval_transmission(layers: Layers, wo: vec3f, wi: vec3f) -> Scatter {
    let none = Scatter(wi, vec3f(0.0), 0.0);
    let below = vec3f(wi.x, wi.y, -wi.z);
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
    let through = vec3f(1.0) - glass_fresnel(layers.glass_reflect, fresnel);
    let value = (layers.glass * layers.glass_color) * through * shape;
    return Scatter(wi, value, (layers.probabilities.w * (1.0 - mirror_probability(layers.glass_reflect, fresnel))) * density);
}

fn eval(layers: Layers, wo: vec3f, wi: vec3f) -> Scatter {
    if wo.z > 0.0 && wi.z > 0.0 {
        return eval_reflection(layers, wo, wi);
    }
    if LOBE_TRANSMISSION && wo.z > 0.0 && wi.z < 0.0 && layers.probabilities.w > 0.0 {
        return eval_transmission(layers, wo, wi);
    }
    return Scatter(wi, vec3f(0.0), 0.0);
}

fn sample(layers: Layers, wo: vec3f, u: vec4f) -> Scatter {
    let none = Scatter(vec3f(0.0, 0.0, 1.0), vec3f(0.0), 0.0);
    if wo.z <= 0.0 {
        return none;
    }
    let up_to_reflect = layers.probabilities.x + layers.probabilities.y;
    let up_to_coat = up_to_reflect + layers.probabilities.z;
    let total = up_to_coat + layers.probabilities.w;
    let at = u.x * total;
    let direction = vec2f(u.y, u.z);
    var wi = vec3f(0.0, 0.0, 1.0);
    var side = 1.0;
    if at < layers.probabilities.x {
        wi = cosine_hemisphere(direction);
    } else if (LOBE_SPECULAR || LOBE_METAL) && at < up_to_reflect {
        wi = mirrored(wo, vndf_sample(wo, layers.widths, direction));
    } else if LOBE_CLEARCOAT && at < up_to_coat {
        wi = mirrored(wo, vndf_sample(wo, vec2f(layers.coat_width), direction));
    } else if LOBE_TRANSMISSION && at < total {
        let h = vndf_sample(wo, layers.widths, direction);
        let vh = clamp(dot(wo, h), 0.0, 1.0);
        wi = mirrored(wo, h);
        if u.w >= mirror_probability(layers.glass_reflect, fresnel_dielectric(vh, layers.eta)) {
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
