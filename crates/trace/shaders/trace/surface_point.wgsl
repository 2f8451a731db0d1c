//#use bsdf
//#use phong
//#use shading
//#use triangle
//#use effects
//#use geometry
//#use texture
// Surface properties at a hit. Twin of src/cpu/surface.rs.

struct SurfacePoint {
    position: vec3f,
    magnitude: f32,
    geometric: vec3f,
    x: vec3f,
    y: vec3f,
    z: vec3f,
    front: bool,
    emitted: vec3f,
    absorption: vec3f,
    surface: BsdfSurface,
    phong: PhongSurface,
}

// Geometry::attributes_at
fn place_at(triangle: u32, u: f32, v: f32) -> Attributes {
    var place = attributes_at(triangle, u, v);
    if EFFECT_TEXTURE_COORDINATES {
        place.second_uv = second_uv_at(triangle, u, v);
    }
    return place;
}

fn uvs_of(place: Attributes) -> vec4f {
    return vec4f(place.uv, place.second_uv);
}

// surface::base
fn base_of(material: u32, place: Attributes) -> vec4f {
    var base = bitcast<vec4f>(material_row(material, 0u));
    if EFFECT_BASE_COLOR {
        base *= place.color;
        let id = material_row(material, 8u).z;
        if id != NO_TEXTURE {
            base *= texture_value(id, uvs_of(place), true);
        }
    }
    return base;
}

fn passes_alpha_test(triangle: u32, u: f32, v: f32, draw: f32) -> bool {
    let material = triangle_at(triangle).material;
    let place = place_at(triangle, u, v);
    let opacity = base_of(material, place).w;
    let flags = material_row(material, 8u).x;
    if (flags & FLAG_MASK) != 0u {
        return opacity >= bitcast<f32>(material_row(material, 1u).w);
    }
    return (flags & FLAG_BLEND) == 0u || draw < opacity;
}

fn emission(material: u32, uvs: vec4f) -> vec3f {
    var radiance = bitcast<vec3f>(material_row(material, 1u).xyz);
    if EFFECT_EMISSIVE_TEXTURE {
        let id = material_row(material, 9u).y;
        if id != NO_TEXTURE {
            radiance *= texture_value(id, uvs, true).xyz;
        }
    }
    return radiance;
}

fn emission_at(triangle: u32, material: u32, u: f32, v: f32) -> vec3f {
    if EFFECT_EMISSIVE_TEXTURE {
        return emission(material, uvs_of(place_at(triangle, u, v)));
    }
    return emission(material, vec4f(0.0));
}

fn optional_texture(id: u32, uvs: vec4f, is_color: bool) -> vec4f {
    if id == NO_TEXTURE {
        return vec4f(1.0);
    }
    return texture_value(id, uvs, is_color);
}

// surface::resolve
fn resolve_surface(material: u32, place: Attributes, front: bool) -> BsdfSurface {
    let base_color = base_of(material, place).xyz;
    let basic = bitcast<vec4f>(material_row(material, 2u));
    let words = material_row(material, 8u);
    var s: BsdfSurface;
    s.base_color = base_color;
    s.metallic = basic.x;
    s.roughness = basic.y;
    s.specular = basic.z;
    s.ior = basic.w;
    s.specular_color = vec3f(1.0);
    s.sheen_color = vec3f(0.0);
    s.sheen_roughness = 0.0;
    s.anisotropy = 0.0;
    s.clearcoat = 0.0;
    s.clearcoat_roughness = 0.0;
    s.transmission = 0.0;
    s.thin = (words.x & FLAG_VOLUME) == 0u;
    s.entering = front;
    var specular_tint = 0.0;
    if EFFECT_DIELECTRIC || EFFECT_TRANSMISSION {
        let row = bitcast<vec4f>(material_row(material, 3u));
        s.specular_color = row.xyz;
        specular_tint = row.w;
    }
    if EFFECT_SHEEN {
        let row = bitcast<vec4f>(material_row(material, 4u));
        s.sheen_color = row.xyz;
        s.sheen_roughness = row.w;
    }
    if EFFECT_ANISOTROPY || EFFECT_CLEARCOAT || EFFECT_TRANSMISSION {
        let row = bitcast<vec4f>(material_row(material, 5u));
        s.anisotropy = row.x;
        s.clearcoat = row.y;
        s.clearcoat_roughness = row.z;
        s.transmission = row.w;
    }
    if EFFECT_SURFACE_TEXTURE {
        let metallic_roughness = optional_texture(words.w, uvs_of(place), false);
        s.roughness *= metallic_roughness.y;
        s.metallic *= metallic_roughness.z;
        let ids = material_row(material, 9u);
        s.specular *= optional_texture(ids.z, uvs_of(place), false).w;
        s.specular_color *= optional_texture(ids.w, uvs_of(place), true).xyz;
        let more = material_row(material, 10u);
        if EFFECT_CLEARCOAT {
            s.clearcoat *= optional_texture(more.x, uvs_of(place), false).x;
            s.clearcoat_roughness *= optional_texture(more.y, uvs_of(place), false).y;
        }
        if EFFECT_SHEEN {
            s.sheen_color *= optional_texture(more.z, uvs_of(place), true).xyz;
            s.sheen_roughness *= optional_texture(more.w, uvs_of(place), false).w;
        }
        if EFFECT_TRANSMISSION {
            s.transmission *= optional_texture(material_row(material, 11u).x, uvs_of(place), false).x;
        }
    }
    if EFFECT_DIELECTRIC {
        if specular_tint > 0.0 {
            s.specular_color *= tint(base_color, specular_tint);
        }
    }
    if EFFECT_SHEEN {
        let sheen_tint = bitcast<f32>(words.y);
        if sheen_tint > 0.0 {
            s.sheen_color *= tint(base_color, sheen_tint);
        }
    }
    return s;
}

fn surface_point(hit: Hit, direction: vec3f) -> SurfacePoint {
    let c = triangle_at(hit.triangle);
    let v0 = c.corners[0];
    let v1 = c.corners[1];
    let v2 = c.corners[2];
    let place = place_at(hit.triangle, hit.u, hit.v);
    let toward = -direction;

    let face = unit(cross(v1 - v0, v2 - v0));
    let front = dot(face, toward) >= 0.0;
    let side = select(-1.0, 1.0, front);

    var normal = unit(place.normal);
    if dot(normal, face) <= 0.0 {
        normal = face;
    }
    let flags = material_row(c.material, 8u).x;
    if EFFECT_NORMAL_MAP {
        let id = material_row(c.material, 9u).x;
        if id != NO_TEXTURE {
            let texel = texture_value(id, uvs_of(place), false).xyz;
            let scale = bitcast<f32>(material_row(c.material, 6u).w);
            normal = mapped_normal(normal, place.tangent, place.bitangent_sign, texel, scale);
        }
    }
    var p: SurfacePoint;
    p.geometric = face * side;
    p.z = visible_normal(normal * side, p.geometric, toward);
    p.surface = resolve_surface(c.material, place, front);
    var along = vec3f(0.0);
    if EFFECT_ANISOTROPY {
        if p.surface.anisotropy > 0.0 {
            along = place.tangent - p.z * dot(p.z, place.tangent);
        }
    }
    if dot(along, along) > 1e-12 {
        p.x = unit(along);
        p.y = cross(p.z, p.x);
    } else {
        let xy = basis(p.z);
        p.x = xy[0];
        p.y = xy[1];
    }
    p.front = front;
    p.emitted = vec3f(0.0);
    if EFFECT_EMISSIVE_TRIANGLES {
        if front || (flags & FLAG_DOUBLE_SIDED) != 0u {
            p.emitted = emission(c.material, uvs_of(place));
        }
    }
    p.absorption = vec3f(0.0);
    if EFFECT_TRANSMISSION {
        if (flags & FLAG_VOLUME) != 0u {
            p.absorption = bitcast<vec3f>(material_row(c.material, 6u).xyz);
        }
    }
    if PHONG {
        let lobe = bitcast<vec4f>(material_row(c.material, 7u));
        let diffuse = bitcast<f32>(material_row(c.material, 11u).y);
        let held = clamp(p.surface.base_color * diffuse, vec3f(0.0), vec3f(1.0));
        p.phong = PhongSurface(held, lobe.xyz, lobe.w);
    }
    p.position = point_at(v0, v1, v2, hit.u, hit.v);
    p.magnitude = magnitude(v0, v1, v2);
    return p;
}
