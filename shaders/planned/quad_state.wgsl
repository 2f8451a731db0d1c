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

// Word of a quad for the pass that chooses. Bits 0 to 13: key of its first path, or of the even pattern's pixels the
// hash of the key of further paths; 14 and 15: region; 16: whether the even pattern has it; 17 to 20: its pixels; 21 to
// 26: code of the key of further paths; 27 to 31: samples of history.
fn key_word(key: u32, region_now: u32, even: bool, pixels: u32) -> u32 {
    return key | (region_now << 14u) | (u32(even) << 16u) | (pixels << 17u);
}

// The bits of further paths.
fn further_word(further: u32, samples: u32) -> u32 {
    return (further & ((1u << HASH_BITS) - 1u)) | ((further >> HASH_BITS) << 21u) | (samples << 27u);
}
