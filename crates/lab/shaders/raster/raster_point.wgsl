//#use direction
//#use raster_frame
//#use raster_material
//#use shading
// What vertices and textures say of a point of a surface.

override SURFACE_TEXTURE: bool = true;
override NORMAL_MAP: bool = true;
override EMISSIVE_TEXTURE: bool = true;

// Roughness and metalness.
fn roughness_and_metalness(uvs: vec4f) -> vec2f {
    var found = vec2f(material.roughness, material.metallic);
    if SURFACE_TEXTURE {
        found *= textureSampleBias(metallic_roughness_map, metallic_roughness_sampler, uv_of(1u, uvs), frame.texture_bias).yz;
    }
    return found;
}

// Radiance that the surface emits; one-sided ones emit from the front.
fn emitted_at(uvs: vec4f, front: bool) -> vec3f {
    var emitted = material.emissive;
    if EMISSIVE_TEXTURE {
        emitted *= textureSampleBias(emissive_map, emissive_sampler, uv_of(3u, uvs), frame.texture_bias).xyz;
    }
    if !front && (material.flags & FLAG_DOUBLE_SIDED) == 0u {
        emitted = vec3f(0.0);
    }
    return emitted;
}

// The unit normal `normal` as the normal map changes it, if the material has one.
fn with_normal_map(normal: vec3f, tangent: vec4f, uvs: vec4f) -> vec3f {
    let mapped = textureSampleBias(normal_map, normal_sampler, uv_of(2u, uvs), frame.texture_bias).xyz;
    if material.normal_texture == NO_TEXTURE {
        return normal;
    }
    return mapped_normal(normal, tangent.xyz, tangent.w, mapped, material.normal_scale);
}

struct Normals {
    // Of the triangle, on the eye's side.
    geometric: vec3f,
    // Of the vertices and the normal map, visible from the eye.
    shading: vec3f,
}

// Normals of a point in the direction `toward` the eye. `across`: the cross product of the position's derivatives;
// `interpolated` and `tangent`: those of the vertices.
fn normals_at(toward: vec3f, across: vec3f, interpolated: vec3f, tangent: vec4f, uvs: vec4f, front: bool) -> Normals {
    var geometric = unit(across);
    geometric = select(geometric, -geometric, dot(geometric, toward) < 0.0);
    let side = select(-1.0, 1.0, front);
    let face = geometric * side;
    var normal = unit(interpolated);
    normal = select(face, normal, dot(normal, face) > 0.0);
    if NORMAL_MAP {
        normal = with_normal_map(normal, tangent, uvs);
    }
    return Normals(geometric, visible_normal(normal * side, geometric, toward));
}
