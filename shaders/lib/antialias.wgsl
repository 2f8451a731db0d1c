//#use stored_sample
//#use smr
//#use sparse_smr
//#use taa
// Twin of src/kernel/antialias.rs, which explains the constants.

const MOST_SAMPLES: f32 = 31.0;
const MOST_PAST: f32 = 30.0;
const MOST_PAST_MOVED: f32 = 3.0;
const MOVED_PER_PX: f32 = 4.0;
const CODES_PER_LOD: f32 = 7.0;
const ONE_SAMPLE: f32 = 30.0;
const CODES_PER_COARSE_LOD: f32 = 5.0;
const COARSE_LOD: f32 = 0.1;
const CLIP_SIGMAS: f32 = 2.0;
const CLIP: f32 = 0.5;
const CLIP_COST: f32 = 10.0;
const NEARER_RELATIVE: f32 = 0.02;
const ALONGSIDE_PX: f32 = 1.0;
const TOGETHER_PX: f32 = 0.25;
const DOUBTFUL: f32 = -2.0;

// A negative `lod`: empty.
struct Mean {
    lod: f32,
    samples: f32,
}

fn mean_of(stored: f32) -> Mean {
    let code = floor(stored * CODES_PER_LOD + 0.5);
    let coarse = code > ONE_SAMPLE;
    let empty = stored < 0.0;
    let lod = select(0.0, (code - ONE_SAMPLE) * (1.0f / CODES_PER_COARSE_LOD), coarse);
    return Mean(select(lod, -1.0, empty), select(ONE_SAMPLE + 1.0 - code, 1.0, coarse || empty));
}

fn stored_lod(m: Mean) -> f32 {
    let fine = ONE_SAMPLE + 1.0 - clamp(m.samples, 1.0, MOST_SAMPLES);
    let code = select(fine, ONE_SAMPLE + m.lod * CODES_PER_COARSE_LOD, m.lod > COARSE_LOD);
    return select(code * (1.0f / CODES_PER_LOD), -1.0, m.lod < 0.0);
}

fn stands_before(own: f32, neighbour: f32, own_motion: vec2f, motion: vec2f, full_rate: bool) -> bool {
    let difference = motion - own_motion;
    let alongside = max(abs(difference.x), abs(difference.y)) <= ALONGSIDE_PX;
    return neighbour > own * (1.0 + NEARER_RELATIVE) && neighbour > own && (full_rate || alongside);
}

fn move_together(own: vec2f, nearest: vec2f, farthest: vec2f) -> bool {
    let apart = max(max(abs(own - nearest), abs(own - farthest)), abs(nearest - farthest));
    return max(apart.x, apart.y) <= TOGETHER_PX;
}

fn is_of_surfaces(stored: f32, farthest: f32, nearest: f32) -> bool {
    let far = farthest * (1.0 - NEARER_RELATIVE);
    return stored >= far && stored * (1.0 - NEARER_RELATIVE) <= nearest;
}

fn is_thin(own: f32, a: f32, b: f32) -> bool {
    return min(a, b) >= 0.0 && max(a, b) < own * (1.0 - NEARER_RELATIVE);
}

fn is_silhouette(own: f32, a: f32, b: f32) -> bool {
    return min(a, b) < 0.0 || abs((a + b) - 2.0 * own) > own * NEARER_RELATIVE;
}

fn may_show(own: f32, neighbour: f32, place_px: vec2f, offset: vec2f) -> bool {
    let nearer = neighbour > own * (1.0 + NEARER_RELATIVE);
    let farther = neighbour >= 0.0 && neighbour < own * (1.0 - NEARER_RELATIVE);
    let toward = place_px * offset;
    return (nearer || farther) && (toward.x > 0.0 || offset.x == 0.0) && (toward.y > 0.0 || offset.y == 0.0);
}

struct Near {
    sum: vec3f,
    squares: vec3f,
    count: f32,
}

fn add_near(n: Near, c: vec3f) -> Near {
    let v = to_ycocg(c);
    return Near(n.sum + v, n.squares + v * v, n.count + 1.0);
}

struct Clip {
    change: vec3f,
    kept: f32,
}

fn clip(near: Near, history: vec3f) -> Clip {
    let inverse = 1.0 / near.count;
    let variance = (near.squares * near.count - near.sum * near.sum) * (inverse * inverse);
    let past = to_ycocg(history);
    let inside = clip_to_box(past, near.sum * inverse, roots(variance) * CLIP_SIGMAS + ROUNDING);
    let by = (inside - past) * CLIP;
    let moved = max(max(abs(by.x), abs(by.y)), abs(by.z));
    let outer = by.x - by.z;
    let change = vec3f(outer + by.y, by.x + by.z, outer - by.y);
    return Clip(change, 1.0 - min(moved * CLIP_COST / max(past.x, 1.0), 1.0));
}

fn clipped(c: vec3f, change: vec3f) -> vec3f {
    if all(change == vec3f(0.0)) {
        return c;
    }
    let v = max(roots(c) + change, vec3f(0.0));
    return v * v;
}

fn scattered_error(a: ObservedAround, scatter: f32) -> f32 {
    let inverse = 1.0 / a.weight;
    let mean = root_difference(a.sampled * inverse, a.history * inverse);
    let variance = max(scatter * inverse - mean * mean, 0.0);
    return max(a.error * inverse, sqrt(variance));
}

struct Averaged {
    result: Reconstructed,
    samples: f32,
}

fn average(r: Reconstruction, samples: f32, place_px: vec2f, kept: f32) -> Averaged {
    let acceptance = (r.fit * r.trust) * kept;
    let past_px = r.nearest.place_px;
    let away = max(abs(past_px.x), abs(past_px.y));
    let most = MOST_PAST + (MOST_PAST_MOVED - MOST_PAST) * min(away * MOVED_PER_PX, 1.0);
    let count = select(min(samples, most) * acceptance, 0.0, r.nearest.lod > 0.0);
    let share = count / (count + 1.0);
    let history = relit(r.history, r.gains, r.lowest, r.highest);
    let near = away <= FARTHEST_PX;
    var old = history;
    if near {
        old = relit(r.nearest.color, r.gains, r.lowest, r.highest);
    }
    let old_px = select(vec2f(0.0), past_px, near);
    let shown = r.candidate + (history - r.candidate) * share;
    let next = r.candidate + (old - r.candidate) * share;
    let next_px = place_px + (old_px - place_px) * share;
    return Averaged(Reconstructed(shown, StoredSample(next, 0.0, r.nearest.disparity, next_px), share), count + 1.0);
}

fn stored_mean(r: Reconstruction, result: Reconstructed, samples: f32) -> Averaged {
    let is_kept = result.stored.lod < COARSE_LOD && r.nearest.lod <= 0.0;
    let share = r.fit * r.trust;
    let left = samples * share + (1.0 - share);
    return Averaged(result, select(1.0, left, is_kept));
}
