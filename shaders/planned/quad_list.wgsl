// List of the shaded quads of a view.

// `gpu::Afterimage::quad_list` documents the fields.
struct QuadList {
    draw: vec4u,
    dispatch: vec4u,
    quads: array<u32>,
}

@group(0) @binding(26) var<storage, read_write> list: QuadList;
