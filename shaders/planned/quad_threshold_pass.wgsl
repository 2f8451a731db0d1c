//#use quad_list
//#use quad_state
// Smallest key within the budget, and arguments of draws and dispatches. CPU twin: `threshold` in src/kernel/quads.rs,
// which goes through all keys; here 64 invocations sum them first. One workgroup.

const INVOCATIONS: u32 = 64u;
// Number of keys that an invocation sums. The last invocation's keys have no quads.
const RUN: u32 = 1u << HASH_BITS;

// The budget, in quads or in paths, and whether there are further paths.
@group(0) @binding(0) var<uniform> budget_quads: vec4u;

// Number of paths of each invocation's keys, and of quads.
var<workgroup> of_run: array<u32, INVOCATIONS>;
var<workgroup> quads_of_run: array<u32, INVOCATIONS>;

// Number of quads with a key: each has one path.
fn quads_at(key: u32) -> u32 {
    return atomicLoad(&state.counts[key]);
}

// Number of further paths with a key.
fn further_at(key: u32) -> u32 {
    return select(0u, atomicLoad(&state.further[key]), budget_quads.y != 0u);
}

// Arguments of a dispatch of at least `invocations` invocations.
fn groups(invocations: u32) -> array<u32, 3> {
    let count = (invocations + INVOCATIONS - 1u) / INVOCATIONS;
    return array<u32, 3>(min(count, GROUPS_PER_ROW), (count + GROUPS_PER_ROW - 1u) / GROUPS_PER_ROW, 1u);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(local_invocation_index) run: u32) {
    var sum = 0u;
    var quads_sum = 0u;
    for (var key = run * RUN; key < min((run + 1u) * RUN, KEYS); key++) {
        let quads = quads_at(key);
        sum += quads + further_at(key);
        quads_sum += quads;
    }
    of_run[run] = sum;
    quads_of_run[run] = quads_sum;
    workgroupBarrier();
    if run > 0u {
        return;
    }
    let budget = budget_quads.x;
    var chosen = 0u;
    var by_need = 0u;
    var first = INVOCATIONS;
    while first > 0u && of_run[first - 1u] <= budget - chosen {
        first--;
        chosen += of_run[first];
        by_need += quads_of_run[first];
    }
    // The budget ends within the keys of the run before `first`, unless `first` is 0. No quad is counted at key 0.
    var key = first * RUN;
    while key > 1u && quads_at(key - 1u) + further_at(key - 1u) <= budget - chosen {
        key--;
        chosen += quads_at(key) + further_at(key);
        by_need += quads_at(key);
    }
    state.threshold = max(key, 1u);
    let quads = by_need + atomicLoad(&state.even);
    atomicStore(&state.listed, 0u);
    state.pixel_groups = groups(4u * quads);
    state.quad_groups = groups(quads);
    // Two triangles a quad, and an invocation a quad.
    list.draw = vec4u(6u, quads, 0u, 0u);
    list.dispatch = vec4u((quads + INVOCATIONS - 1u) / INVOCATIONS, 1u, 1u, quads);
}
