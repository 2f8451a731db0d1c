//! Antialiasing of jittered sparse frames: both executors are equal, and differ by planted errors.

use super::rig::View;
use super::sparse::{SIZE, all_caught_in_samples, arrange, desc, full_rate, gliding_view, settings};
use afterimage::{Foveation, Method, MethodKind, Settings, Smr};

fn antialiased() -> Settings {
    let method = Method::Smr(Smr { antialias: true, ..Smr::default() });
    Settings { method, ..settings(MethodKind::Smr) }
}

/// Two views that glide, with jitter. The surfaces meet in a silhouette that is not straight; in the second view some
/// of it is where motion changes, too, and the nearer surface comes from where the other one was. The first view
/// stands still for three frames. In the last frames all is at full rate.
fn views(index: u64, settings: &Settings) -> [View; 2] {
    [0, 1].map(|v| {
        let mut view = gliding_view(index, v, settings);
        view.facts.jitter_px = Foveation::jitter_px(index + u64::from(v));
        if v == 1 {
            view.motion = view.motion.map(|motion| motion.map(|[x, y]| [x, -y]));
        }
        if v == 0 && (5..8).contains(&index) {
            view.motion = view.motion.map(|motion| motion.map(|_| [0.0; 2]));
        }
        view.depth = view.depth.map(|depth| {
            let (near, far) = (depth.at(0, 0), depth.at(0, SIZE[1] as usize - 1));
            afterimage::Image::from_fn(SIZE, |[x, y]| {
                if 3 * y < SIZE[1] + x && (v == 0 || 2 * y < SIZE[1]) { near } else { far }
            })
        });
        if index > 8 {
            view.facts.lattices = Some(full_rate());
        }
        view
    })
}

#[test]
fn a_wrong_mean_is_caught() {
    let settings = antialiased();
    let planted = [
        // Surfaces: without the nearer one, that of another texel, or its motion alone.
        ("nearest_at = select(nearest_at, texel, near > nearest_disparity);", ""),
        ("own_motion, motion, level == 0u)", "own_motion, motion, true)"),
        // Mixtures of surfaces: never, always, of fewer surfaces, stored as another.
        ("surface.mixes = true;", ""),
        ("farthest_at = select(farthest_at, texel, is_farther);", ""),
        ("surface.nearest = nearest_disparity;", ""),
        ("previous.verdict = VERDICT_VALID;\n    }", "}"),
        // Doubtful samples: none, those on the other side, those of surfaces that move as one, too; compared with
        // history, interpolated, averaged.
        ("doubtful = doubtful || may_show(own, near, place_px, vec2<f32>(offset) - 1.0);", ""),
        ("own >= 0.0 && !surface.mixes;", "own >= 0.0;"),
        ("usable && !surface.is_doubtful;", "usable;"),
        ("own.usable && (ANTIALIAS == 0u || same);", "own.usable;"),
        // History: fewer or other texels, another reach, another number of samples.
        ("columns = 3u;", "columns = 2u;"),
        ("inverse_reach = INVERSE_MEAN_REACH;", ""),
        ("stored.lod = mean.lod;", ""),
        // Comparison: at the pixel's centre, by the model alone.
        ("source.previous.at -= frame.views[view].jitter_px;", ""),
        // Means: another place, no clip, samples of other pixels, other numbers of samples.
        (
            "return average(inputs, samples, -frame.views[view].jitter_px, left);",
            "return average(inputs, samples, frame.views[view].jitter_px, left);",
        ),
        ("inputs.nearest.color = clipped(inputs.nearest.color, by.change);", ""),
        ("vec2<u32>(tap % 3u, tap / 3u);\n        let sampled", "vec2<u32>(tap / 3u, tap / 3u);\n        let sampled"),
        ("samples = averaged.samples;", ""),
        // Storage: without chance, or with that of another view.
        ("pack_color_by(next.color, draw)", "pack_color_by(next.color, 0.5)"),
    ];
    all_caught_in_samples(desc(), settings, 12, &planted, |index, rig| {
        arrange(index, rig);
        views(index, &settings).to_vec()
    });
}
