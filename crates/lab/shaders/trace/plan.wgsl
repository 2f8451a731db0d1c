//#use frame
// How many paths are alive at which bounce: what `count_pass` wrote.

@group(2) @binding(0) var<storage, read> plan: array<u32, 9>;

// Path of thread `i` among those alive.
fn active_path(i: u32) -> u32 {
    return lists[(plan[BOUNCE] & 1u) * frame.capacity + i];
}
