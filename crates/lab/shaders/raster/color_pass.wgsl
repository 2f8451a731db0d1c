//#use raster_frame
//#use raster_lighting
//#use raster_material
//#use raster_point
//#use shading
// Color of surfaces, premultiplied by opacity, lit where they are drawn.

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
    let widths = roughness_and_metalness(uvs);
    var s: BsdfSurface;
    s.base_color = base;
    s.metallic = widths.y;
    s.roughness = widths.x;
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
    let toward = unit(-in.relative);
    let normals = normals_at(toward, across, in.normal, in.tangent, in.uvs, front);
    let emitted = emitted_at(in.uvs, front);
    let point = LitPoint(in.world, toward, normals.geometric, normals.shading, in.tangent.xyz, emitted, surface);
    var color: vec3f;
    if ALBEDO {
        color = albedo_at(point);
    } else {
        color = radiance_at(point);
    }

    // Transmission shows what is straight behind, dimmed by the base color's luminance.
    var through = 0.0;
    if LOBE_TRANSMISSION {
        let passed = clamp(surface.transmission * (1.0 - surface.metallic), 0.0, 1.0);
        let cosine = dot(toward, normals.shading);
        through = passed * (1.0 - fresnel_dielectric(cosine, max(surface.ior, 1.0))) * luma(clamp(base.xyz, vec3f(0.0), vec3f(1.0)));
    }
    color = clamp(color, vec3f(0.0), vec3f(LARGEST_HALF));
    if (material.flags & FLAG_BLEND) != 0u {
        color *= opacity;
    }
    // Last: discarded invocations may give neighbours no derivatives.
    if ALPHA_TEST && !passes_alpha_test(base.w) {
        discard;
    }
    return vec4f(color, opacity * (1.0 - through));
}
