// Which tiles of 16x16 pixels have chosen quads. One invocation a quad, by the dispatch of the list.

// Binary logarithm of the quads along a tile; twin of chosen_quads::TILE_QUADS_LOG2.
const TILE_QUADS_LOG2: u32 = 3u;

@group(0) @binding(0) var<uniform> words_per_row: vec4u;
// The list of gpu::Afterimage::quad_list.
@group(0) @binding(1) var<storage, read> list: array<u32>;
// A bit a tile.
@group(0) @binding(2) var<storage, read_write> tiles: array<atomic<u32>>;

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= list[7u] {
        return;
    }
    let quad = list[8u + id.x];
    let tile = vec2u(quad & 0xffffu, quad >> 16u) >> vec2u(TILE_QUADS_LOG2);
    atomicOr(&tiles[tile.y * words_per_row.x + (tile.x >> 5u)], 1u << (tile.x & 31u));
}
