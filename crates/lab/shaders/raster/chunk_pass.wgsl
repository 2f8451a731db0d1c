// Arguments of the draws of chunks of triangles: no instance where a chunk's rectangle has no chosen quad. One
// invocation a chunk.

struct Chunk {
    first_vertex: u32,
    vertices: u32,
    // First and last tile of its rectangle, x in the low 16 bits, y in the high 16 bits.
    low: u32,
    high: u32,
}

struct Draw {
    vertices: u32,
    instances: u32,
    first_vertex: u32,
    first_instance: u32,
}

@group(0) @binding(0) var<uniform> words_per_row: vec4u;
@group(0) @binding(1) var<storage, read> chunks: array<Chunk>;
// A bit a tile: tile_pass.
@group(0) @binding(2) var<storage, read> tiles: array<u32>;
@group(0) @binding(3) var<storage, read_write> draws: array<Draw>;

// Bits of the tiles from `low` to `high` in word `word` of a row.
fn bits_between(low: u32, high: u32, word: u32) -> u32 {
    let first = select(0u, low & 31u, (low >> 5u) == word);
    let last = select(31u, high & 31u, (high >> 5u) == word);
    return (0xffffffffu << first) & (0xffffffffu >> (31u - last));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&chunks) {
        return;
    }
    let chunk = chunks[id.x];
    let low = vec2u(chunk.low & 0xffffu, chunk.low >> 16u);
    let high = vec2u(chunk.high & 0xffffu, chunk.high >> 16u);
    var found = 0u;
    for (var y = low.y; y <= high.y && found == 0u; y++) {
        for (var word = low.x >> 5u; word <= high.x >> 5u; word++) {
            found |= tiles[y * words_per_row.x + word] & bits_between(low.x, high.x, word);
        }
    }
    draws[id.x] = Draw(chunk.vertices, select(0u, 1u, found != 0u), chunk.first_vertex, 0u);
}
