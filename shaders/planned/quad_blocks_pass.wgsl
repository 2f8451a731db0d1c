//#use antialias
//#use past_frame
//#use quad_samples
// Gain of the light in each block of 16x16 quads. CPU twin: `block_gains` in src/cpu/planned/block_gains.rs. One
// workgroup a block, one invocation for four of its quads in a row; z is the view.
//
// A read a quad, and 8 to 12 a shaded one: comparisons of its pixels and their colors, where quads are shaded in part
// also the mask; 4 bytes written a block. Where light changes the reads are made twice.

override RELIGHT_ON: u32 = 1u;
override ANTIALIAS: u32 = 0u;

@group(0) @binding(21) var observed: texture_2d_array<u32>;
@group(0) @binding(23) var block_gains_out: texture_storage_2d_array<r32uint, write>;

struct BlockSum {
    around: ObservedAround,
    scatter: f32,
    votes: vec2f,
}

const RUNS: u32 = 64u;

var<workgroup> runs: array<BlockSum, RUNS>;
var<workgroup> block_gains: vec3f;

// Sums over no comparison.
fn no_sum() -> BlockSum {
    return BlockSum(none_around(), 0.0, vec2f(0.0));
}

// Sums over the comparisons at four quads in a row, if `needed`: without votes, or the votes on `gains` alone.
fn sum_of_run(first: vec2u, view: u32, needed: bool, is_vote: bool, gains: vec3f) -> BlockSum {
    var sum = no_sum();
    // Variable counts on purpose: Mesa would unroll constant ones and reorder their sums of products.
    let quads = select(0u, 4u, needed);
    for (var i = 0u; i < quads; i++) {
        let quad = first + vec2u(i, 0u);
        let is_shaded_quad = all(2u * quad < frame.size) && (textureLoad(quad_mask, quad, view, 0).x & 15u) != 0u;
        for (var place = 0u; place < select(0u, 4u, is_shaded_quad); place++) {
            let px = px_of_quad(quad, place);
            let words = textureLoad(observed, min(px, frame.size - 1u), view, 0).xy;
            if all(px < frame.size) && is_observed(words) {
                let o = unpack_observation(words, color(sample_at(px, view).xyz).color);
                if is_vote {
                    sum.votes += block_vote(o, gains);
                } else {
                    let weight = block_weight(o);
                    sum.around = add_observation(sum.around, o, weight, weight);
                    if ANTIALIAS != 0u {
                        sum.scatter = add_scatter(sum.scatter, o, weight);
                    }
                }
            }
        }
    }
    return sum;
}

// Sum over the runs.
fn sum_of_block() -> BlockSum {
    var sum = no_sum();
    let count = select(0u, RUNS, has_history());
    for (var i = 0u; i < count; i++) {
        let run = runs[i];
        sum = BlockSum(add_around(sum.around, run.around), sum.scatter + run.scatter, sum.votes + run.votes);
    }
    return sum;
}

// Gain that the sums of a block show.
fn gain_of(sum: BlockSum) -> vec3f {
    if sum.around.weight < 1e-6 {
        return vec3f(1.0);
    }
    var error = mean_error(sum.around);
    if ANTIALIAS != 0u {
        error = scattered_error(sum.around, sum.scatter);
    }
    return block_gain(sum.around, error);
}

// Gain of a block, in invocation 0.
fn gain_of_block(first: vec2u, view: u32, invocation: u32) -> vec3f {
    runs[invocation] = sum_of_run(first, view, has_history(), false, vec3f(1.0));
    workgroupBarrier();
    if invocation == 0u {
        block_gains = gain_of(sum_of_block());
    }
    workgroupBarrier();
    let gains = block_gains;
    runs[invocation] = sum_of_run(first, view, any(gains != vec3f(1.0)), true, gains);
    workgroupBarrier();
    if invocation == 0u && any(gains != vec3f(1.0)) && has_majority(sum_of_block().votes) {
        return gains;
    }
    return vec3f(1.0);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) invocation: u32) {
    let view = frame.first_view + group.z;
    var gains = vec3f(1.0);
    if RELIGHT_ON != 0u {
        let first = BLOCK_QUADS * group.xy + vec2u(4u * (invocation & 3u), invocation >> 2u);
        gains = gain_of_block(first, view, invocation);
    }
    if invocation == 0u {
        textureStore(block_gains_out, group.xy, view, vec4u(pack_color(gains), 0u, 0u, 0u));
    }
}
