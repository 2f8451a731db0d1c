//#use bsdf
//#use direction
//#use light
//#use raster_frame
//#use raster_material
//#use lighting_maps
//#use shading
// Color of surfaces by the tracer's scattering functions; lit by punctual lights, panels, the sun and the sky. Indirect
// light is an estimate (`bounced`). Color is premultiplied by opacity.

override SURFACE_TEXTURE: bool = true;
override NORMAL_MAP: bool = true;
override EMISSIVE_TEXTURE: bool = true;
override HAS_SUN: bool = true;
// Alpha test instead of alpha to coverage, where pixels have one sample.
override ALPHA_TEST: bool = false;
// Albedo of surfaces instead of their color.
override ALBEDO: bool = false;

struct ColorVarying {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    // Position relative to the eye.
    @location(1) relative: vec3f,
    @location(2) normal: vec3f,
    @location(3) tangent: vec4f,
    @location(4) uvs: vec4f,
    @location(5) color: vec4f,
}

@vertex
fn shade_vertex(vertex: Vertex) -> ColorVarying {
    let relative = from_eye(frame.current, vertex.position);
    let position = clip(homogeneous_px(frame.current, relative));
    return ColorVarying(position, vertex.position, relative, vertex.normal, vertex.tangent, vertex.uvs, vertex.color);
}

// BSDF parameters with textures and tints applied, as in trace/surface_point.wgsl.
fn surface_of(base: vec3f, uvs: vec4f, front: bool) -> BsdfSurface {
    var s: BsdfSurface;
    s.base_color = base;
    s.metallic = material.metallic;
    s.roughness = material.roughness;
    s.specular = material.specular;
    s.specular_color = material.specular_color;
    s.ior = material.ior;
    s.anisotropy = material.anisotropy;
    s.clearcoat = material.clearcoat;
    s.clearcoat_roughness = material.clearcoat_roughness;
    s.sheen_color = material.sheen_color;
    s.sheen_roughness = material.sheen_roughness;
    s.transmission = material.transmission;
    s.thin = (material.flags & FLAG_VOLUME) == 0u;
    s.entering = front;
    if SURFACE_TEXTURE {
        let surface = textureSampleBias(metallic_roughness_map, metallic_roughness_sampler, uv_of(1u, uvs), frame.texture_bias);
        s.roughness *= surface.y;
        s.metallic *= surface.z;
        s.specular *= textureSampleBias(specular_map, base_color_sampler, uv_of(4u, uvs), frame.texture_bias).w;
        s.specular_color *= textureSampleBias(specular_color_map, base_color_sampler, uv_of(5u, uvs), frame.texture_bias).xyz;
    }
    if SURFACE_TEXTURE && LOBE_CLEARCOAT {
        s.clearcoat *= textureSampleBias(clearcoat_map, base_color_sampler, uv_of(6u, uvs), frame.texture_bias).x;
        s.clearcoat_roughness *= textureSampleBias(clearcoat_roughness_map, base_color_sampler, uv_of(7u, uvs), frame.texture_bias).y;
    }
    if SURFACE_TEXTURE && LOBE_SHEEN {
        s.sheen_color *= textureSampleBias(sheen_color_map, base_color_sampler, uv_of(8u, uvs), frame.texture_bias).xyz;
        s.sheen_roughness *= textureSampleBias(sheen_roughness_map, base_color_sampler, uv_of(9u, uvs), frame.texture_bias).w;
    }
    if SURFACE_TEXTURE && LOBE_TRANSMISSION {
        s.transmission *= textureSampleBias(transmission_map, base_color_sampler, uv_of(10u, uvs), frame.texture_bias).x;
    }
    s.specular_color *= tint(base, material.specular_tint);
    s.sheen_color *= tint(base, material.sheen_tint);
    return s;
}

// Ambient irradiance from six faces, weighted by the squared components of the normal, whose sum is 1.
fn ambient_at(normal: vec3f) -> vec3f {
    let share = normal * normal;
    let x = select(lights.ambient[1], lights.ambient[0], normal.x >= 0.0).xyz;
    let y = select(lights.ambient[3], lights.ambient[2], normal.y >= 0.0).xyz;
    let z = select(lights.ambient[5], lights.ambient[4], normal.z >= 0.0).xyz;
    return (x * share.x + y * share.y) + z * share.z;
}

// Share of uniform light from all sides that a surface returns towards the eye, by its diffuse lobe and its
// reflections; not what shines through it, nor what it emits.
fn albedo_of(l: Layers, cosine: f32) -> vec3f {
    var albedo = l.diffuse * PI;
    if LOBE_SPECULAR || LOBE_METAL {
        let e = ggx_albedo(0u, cosine, ggx_mean_width(l.widths));
        albedo += l.reflect * e.x + l.reflect_rise * e.y;
    }
    if LOBE_CLEARCOAT {
        let e = ggx_albedo(0u, cosine, l.coat_width);
        albedo += vec3f(l.coat * e.x + l.coat_rise * e.y);
    }
    return albedo;
}

struct Incoming {
    direction: vec3f,
    // On a surface facing the light.
    irradiance: vec3f,
}

fn incoming(light: RasterLight, position: vec3f) -> Incoming {
    if light.kind == 0u {
        return Incoming(-light.direction, light.intensity);
    }
    let to = light.position - position;
    let square = dot(to, to);
    let direction = unit(to);
    let cosine = -dot(direction, light.direction);
    if light.kind >= 3u {
        // Irradiance of a disk of the panel's area on its axis, times the cosine off the axis.
        let seen = select(max(cosine, 0.0), abs(cosine), light.kind == 4u);
        return Incoming(direction, light.intensity * (seen * light.area / (square + light.area * FRAC_1_PI)));
    }
    var irradiance = light.intensity * distance_falloff(sqrt(square), light.range);
    if light.kind == 2u {
        irradiance *= cone_falloff(cosine, light.cos_inner, light.cos_outer);
    }
    return Incoming(direction, irradiance);
}

@fragment
fn shade(in: ColorVarying, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let base = base_at(in.uvs, in.color);
    let across = cross(dpdx(in.relative), dpdy(in.relative));
    // An alpha-tested edge is widened to one pixel, for alpha to coverage.
    let edge = max(fwidth(base.w) * frame.per_step, 1e-4);
    var opacity = 1.0;
    if (material.flags & FLAG_MASK) != 0u {
        opacity = clamp((base.w - material.cutoff) / edge + 0.5, 0.0, 1.0);
        // What has the cutoff's alpha is opaque.
        if abs(base.w - material.cutoff) <= ALPHA_ROUNDING {
            opacity = 1.0;
        }
    } else if (material.flags & FLAG_BLEND) != 0u {
        opacity = clamp(base.w, 0.0, 1.0);
    }
    let surface = surface_of(base.xyz, in.uvs, front);
    var mapped = vec3f(0.5, 0.5, 1.0);
    if NORMAL_MAP {
        mapped = textureSampleBias(normal_map, normal_sampler, uv_of(2u, in.uvs), frame.texture_bias).xyz;
    }
    var emitted = material.emissive;
    if EMISSIVE_TEXTURE {
        emitted *= textureSampleBias(emissive_map, emissive_sampler, uv_of(3u, in.uvs), frame.texture_bias).xyz;
    }
    if !front && (material.flags & FLAG_DOUBLE_SIDED) == 0u {
        emitted = vec3f(0.0);
    }

    let toward = unit(-in.relative);
    var geometric = unit(across);
    geometric = select(geometric, -geometric, dot(geometric, toward) < 0.0);
    let side = select(-1.0, 1.0, front);
    let face = geometric * side;
    var normal = unit(in.normal);
    normal = select(face, normal, dot(normal, face) > 0.0);
    if NORMAL_MAP && material.normal_texture != NO_TEXTURE {
        normal = mapped_normal(normal, in.tangent.xyz, in.tangent.w, mapped, material.normal_scale);
    }
    normal = visible_normal(normal * side, geometric, toward);
    var x = basis(normal)[0];
    if LOBE_ANISOTROPY && material.anisotropy > 0.0 {
        let along = in.tangent.xyz - normal * dot(normal, in.tangent.xyz);
        if dot(along, along) > 1e-12 {
            x = unit(along);
        }
    }
    let y = cross(normal, x);

    let wo = to_local(toward, x, y, normal);
    let l = layers(surface, wo, 0u);
    var color = emitted;
    for (var i = 0u; i < lights.count; i++) {
        let light = lights.lights[i];
        let arriving = incoming(light, in.world);
        var share = select(0.0, 1.0, dot(arriving.direction, geometric) > 0.0 || LOBE_TRANSMISSION);
        if HAS_SUN && light.has_shadow > 0.0 && share > 0.0 {
            share *= sunlit(in.world, geometric);
        }
        let value = eval(l, wo, to_local(arriving.direction, x, y, normal)).value;
        color += value * arriving.irradiance * share;
    }

    // Ambient light: diffuse lobes use irradiance; highlights use sky radiance in the mirror direction.
    let reflected = unit(normal * (2.0 * wo.z) - toward);
    color += l.diffuse * (ambient_at(normal) + lights.bounced * PI);
    if LOBE_SPECULAR || LOBE_METAL || LOBE_TRANSMISSION {
        let e = ggx_albedo(0u, wo.z, ggx_mean_width(l.widths));
        let around = sky_radiance(reflected, surface.roughness) + lights.bounced;
        color += (l.reflect * e.x + l.reflect_rise * e.y) * around;
        if LOBE_TRANSMISSION {
            color += l.glass * l.glass_reflect * fresnel_dielectric(wo.z, l.eta) * around;
        }
    }
    if LOBE_CLEARCOAT {
        let e = ggx_albedo(0u, wo.z, l.coat_width);
        color += (l.coat * e.x + l.coat_rise * e.y) * (sky_radiance(reflected, surface.clearcoat_roughness) + lights.bounced);
    }

    // Transmission shows what is straight behind, dimmed by the base color's luminance.
    var through = 0.0;
    if LOBE_TRANSMISSION {
        let passed = clamp(surface.transmission * (1.0 - surface.metallic), 0.0, 1.0);
        through = passed * (1.0 - fresnel_dielectric(wo.z, max(surface.ior, 1.0))) * luma(clamp(base.xyz, vec3f(0.0), vec3f(1.0)));
    }
    if ALBEDO {
        color = albedo_of(l, wo.z);
    }
    color = clamp(color, vec3f(0.0), vec3f(MAX_COLOR));
    if (material.flags & FLAG_BLEND) != 0u {
        color *= opacity;
    }
    // Last: discarded invocations may give neighbours no derivatives.
    if ALPHA_TEST && !passes_alpha_test(base.w) {
        discard;
    }
    return vec4f(color, opacity * (1.0 - through));
}
