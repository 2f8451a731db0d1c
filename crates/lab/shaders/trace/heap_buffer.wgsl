// The heap as a storage buffer.

@group(0) @binding(0) var<storage, read> heap: array<vec4<u32>>;

// Element `i` of the heap.
fn load(i: u32) -> vec4<u32> {
    return heap[i];
}
