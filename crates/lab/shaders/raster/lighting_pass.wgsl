//#use g_buffer
//#use raster_lighting
//#use shading
// Lights the pixels of the G-buffer: all, those of chosen quads, or one of each quad; or gives their albedo.
//
// A pixel reads the depth, the base color and the words, 24 bytes; 2 texels of its material, with sheen 4; and what the
// lights need: 9 texels of the shadow map, 4 of the tables of directional albedos a lobe, and one place of the sky. It
// writes 8 bytes.

@group(1) @binding(0) var depth_map: texture_2d<f32>;
@group(1) @binding(1) var base_map: texture_2d<f32>;
@group(1) @binding(2) var words_map: texture_2d<u32>;
// A row a material, twin of g_buffer::material_texels.
@group(1) @binding(3) var material_map: texture_2d<f32>;
@group(1) @binding(4) var color_out: texture_storage_2d<rgba16float, write>;
// The list of gpu::Afterimage::quad_list.
@group(3) @binding(0) var<storage, read> list: array<u32>;

// Ray through a pixel, 1 long along the view axis.
fn ray_of(px: vec2f) -> vec3f {
    return (frame.right.xyz * px.x + frame.down.xyz * px.y) + frame.corner.xyz;
}

// Normal of the triangle at a pixel, on the eye's side: the depth over that at the pixel is the product of a plane's
// normal and the ray, here written in the camera's rows, which are dual to the rays' steps.
fn triangle_normal(px: vec2f, slopes: vec2f) -> vec3f {
    let eye = frame.current;
    return -unit((eye.x.xyz * slopes.x + eye.y.xyz * slopes.y) + eye.along.xyz * (1.0 - dot(slopes, px)));
}

// BSDF parameters of a kept surface.
fn surface_of(kept: KeptSurface) -> BsdfSurface {
    let specular = textureLoad(material_map, vec2u(0u, kept.material), 0);
    let coat = textureLoad(material_map, vec2u(1u, kept.material), 0);
    var s: BsdfSurface;
    s.base_color = kept.base;
    s.metallic = kept.metalness;
    s.roughness = kept.roughness;
    s.specular = specular.w;
    s.specular_color = specular.xyz * tint(kept.base, coat.y);
    s.ior = coat.x;
    s.clearcoat = coat.z;
    s.clearcoat_roughness = coat.w;
    if LOBE_SHEEN {
        let sheen = textureLoad(material_map, vec2u(2u, kept.material), 0);
        s.sheen_color = sheen.xyz * tint(kept.base, textureLoad(material_map, vec2u(3u, kept.material), 0).x);
        s.sheen_roughness = sheen.w;
    }
    s.thin = true;
    s.entering = true;
    return s;
}

// The point that a pixel shows, at depth `depth`.
fn point_at(px: vec2u, depth: f32) -> LitPoint {
    let kept = kept_surface(textureLoad(base_map, px, 0), textureLoad(words_map, px, 0));
    let ray = ray_of(vec2f(px));
    let eye = frame.current;
    let position = (ray * (frame.near / depth) + eye.low.xyz) + eye.high.xyz;
    let toward = unit(-ray);
    let geometric = triangle_normal(vec2f(px), kept.slopes);
    let normal = visible_normal(kept.normal, geometric, toward);
    return LitPoint(position, toward, geometric, normal, vec3f(0.0), kept.emitted, surface_of(kept));
}

fn lit(px: vec2u) -> vec4f {
    let depth = textureLoad(depth_map, px, 0).x;
    var color: vec3f;
    if depth > 0.0 {
        color = radiance_at(point_at(px, depth));
    } else {
        color = sky_radiance(unit(ray_of(vec2f(px))), 0.0);
    }
    return vec4f(clamp(color, vec3f(0.0), vec3f(LARGEST_HALF)), 1.0);
}

// All pixels of the window, one invocation each.
@compute @workgroup_size(64, 1)
fn light_all(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(color_out)) {
        return;
    }
    let px = vec2u(frame.first_px) + u32(frame.step) * id.xy;
    textureStore(color_out, id.xy, lit(min(px, textureDimensions(depth_map) - vec2u(1u))));
}

// The pixels of chosen quads, four invocations a quad, by the dispatch of the list.
@compute @workgroup_size(4, 64)
fn light_quads(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let at = group.x * 64u + local.y;
    if at >= list[7u] {
        return;
    }
    let quad = list[8u + at];
    let px = 2u * vec2u(quad & 0xffffu, quad >> 16u) + vec2u(local.x & 1u, local.x >> 1u);
    if all(px < textureDimensions(color_out)) {
        textureStore(color_out, px, lit(px));
    }
}

// Albedo of all pixels, 0 in the sky.
@compute @workgroup_size(64, 1)
fn albedo_all(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(color_out)) {
        return;
    }
    let depth = textureLoad(depth_map, id.xy, 0).x;
    var albedo = vec3f(0.0);
    if depth > 0.0 {
        albedo = albedo_at(point_at(id.xy, depth));
    }
    textureStore(color_out, id.xy, vec4f(albedo, 1.0));
}
