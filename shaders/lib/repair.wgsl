//#use rng
// Twin of src/kernel/repair.rs, which explains the order.

const WANTED_LOD: f32 = 1.0;
const RINGS: u32 = 31u;
const RINGS_PER_DEG: f32 = 0.5;
const HASH_BITS: u32 = 8u;
const KEYS: u32 = (2u * RINGS + 1u) << HASH_BITS;

// repair::priority
fn priority(lod: f32, e_deg: f32) -> u32 {
    let has_history = lod >= 0.0;
    let ring = u32(min(e_deg * RINGS_PER_DEG, f32(RINGS - 1u)));
    return select(select(2u * RINGS, RINGS, has_history) - ring, 0u, has_history && lod < WANTED_LOD);
}

// repair::asked_px
fn asked_px(i: u32, x: u32, y: u32, frame_low: u32) -> vec2<u32> {
    return vec2<u32>(2u * x + ((i ^ frame_low ^ x ^ y) & 1u), 2u * y + i);
}

// repair::quad_key
fn quad_key(largest: u32, x: u32, y: u32, frame_low: u32, key: u32) -> u32 {
    let hash = bits(x, y, frame_low, ~key) >> (32u - HASH_BITS);
    return select((largest << HASH_BITS) | hash, 0u, largest == 0u);
}
