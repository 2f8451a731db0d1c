// List of the quads of a view that a plan chose.

// `gpu::Afterimage::repair_quads` documents the fields.
struct RepairList {
    draw: vec4<u32>,
    dispatch: vec4<u32>,
    quads: array<u32>,
}

@group(0) @binding(26) var<storage, read_write> list: RepairList;
