//#use g_buffer
//#use raster_frame
//#use raster_material
//#use raster_point
// Surfaces into the G-buffer: depth, motion and what lighting needs, without any light.

struct GeometryVarying {
    // As in the color pass, whose blended surfaces are tested against this depth.
    @builtin(position) position: vec4f,
    // Position relative to the eye.
    @location(0) relative: vec3f,
    // Homogeneous pixel in the previous frame.
    @location(1) before: vec3f,
    @location(2) normal: vec3f,
    @location(3) tangent: vec4f,
    @location(4) uvs: vec4f,
    @location(5) color: vec4f,
}

struct Kept {
    @location(0) motion: vec2f,
    @location(1) base: vec4f,
    @location(2) words: vec4u,
}

@vertex
fn keep_vertex(vertex: Vertex) -> GeometryVarying {
    let relative = from_eye(frame.current, vertex.position);
    let before = homogeneous_px(frame.previous, from_eye(frame.previous, vertex.before));
    let position = clip(homogeneous_px(frame.current, relative));
    return GeometryVarying(position, relative, before, vertex.normal, vertex.tangent, vertex.uvs, vertex.color);
}

// The normal that lighting makes visible from the eye. Not of unit length.
fn kept_normal(in: GeometryVarying, front: bool) -> vec3f {
    let across = cross(dpdx(in.relative), dpdy(in.relative));
    let side = select(-1.0, 1.0, front);
    let face = across * select(side, -side, dot(across, in.relative) > 0.0);
    var normal = select(face, in.normal, dot(in.normal, face) > 0.0);
    if NORMAL_MAP {
        normal = with_normal_map(unit(normal), in.tangent, in.uvs);
    }
    return normal * side;
}

fn kept(in: GeometryVarying, base: vec3f, front: bool) -> Kept {
    let widths = roughness_and_metalness(in.uvs);
    let depth = in.position.z;
    let slopes = vec2f(dpdx(depth), dpdy(depth)) / depth;
    let emitted = emitted_at(in.uvs, front);
    let words = words_of(kept_normal(in, front), slopes, emitted, widths.x, u32(material.index));
    return Kept(moved(homogeneous_px(frame.current, in.relative), in.before), base_word(base, widths.y), words);
}

@fragment
fn keep(in: GeometryVarying, @builtin(front_facing) front: bool) -> Kept {
    let base = base_at(in.uvs, in.color);
    let kept = kept(in, base.xyz, front);
    // Last: discarded invocations may give neighbours no derivatives.
    if !passes_alpha_test(base.w) {
        discard;
    }
    return kept;
}

@fragment
fn keep_opaque(in: GeometryVarying, @builtin(front_facing) front: bool) -> Kept {
    return kept(in, base_at(in.uvs, in.color).xyz, front);
}
