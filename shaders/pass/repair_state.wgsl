//#use repair
// Counts of the quads of a view by their key, and which keys are chosen; shared by the passes of a plan.

struct RepairState {
    // Counts of the quads with a key above 0.
    counts: array<atomic<u32>, KEYS>,
    // Smallest key that is chosen.
    threshold: u32,
    // Number of chosen quads that are in the list.
    listed: atomic<u32>,
}

@group(0) @binding(25) var<storage, read_write> state: RepairState;
