//#use frame
// Bounce and number of live paths.

@group(2) @binding(0) var<storage, read> plan: array<u32, 9>;

// Path of invocation `i` among the live paths.
fn active_path(i: u32) -> u32 {
    return lists[(plan[BOUNCE] & 1u) * frame.capacity + i];
}
