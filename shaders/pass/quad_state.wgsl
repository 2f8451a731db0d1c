//#use quads
// Plan of a view: counts of its quads by their key, which keys are chosen, and the numbers of quads; shared by the
// passes of a plan. src/gpu/quads.rs says where the arguments of dispatches lie.

struct QuadState {
    // Counts of the quads with a key above 0, and of the further paths of noisy frames.
    counts: array<atomic<u32>, KEYS>,
    further: array<atomic<u32>, KEYS>,
    // Smallest key that is chosen.
    threshold: u32,
    // Number of quads of the fovea and of the even pattern.
    even: atomic<u32>,
    // Number of shaded quads that are in the list.
    listed: atomic<u32>,
    // Workgroups with an invocation for each pixel of the shaded quads, and for each of these quads.
    pixel_groups: array<u32, 3>,
    quad_groups: array<u32, 3>,
}

@group(0) @binding(25) var<storage, read_write> state: QuadState;
