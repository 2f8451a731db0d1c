//! Antialiasing of jittered planned frames: both executors are equal, and differ by planted errors.

use super::sparse::{SIZE, arrange, desc, gliding_view, settings};
use super::*;

const PASSES: [&str; 4] = ["quad_key_pass", "quad_observe_pass", "quad_rectify_pass", "quad_pass"];

fn antialiased() -> Settings {
    let method = Method::Smr(Smr { antialias: true, ..Smr::default() });
    Settings { method, ..settings(MethodKind::Smr) }
}

/// Two views that glide, with jitter. The surfaces meet in a silhouette that is not straight; in the second view some
/// of it is where motion changes, too, and the nearer surface comes from where the other one was. The first view stands
/// still for three frames. In one frame the second is jittered by more than a pixel. In the last frames every pixel is
/// shaded.
fn views(index: u64) -> [View; 2] {
    [0, 1].map(|v| {
        let mut view = gliding_view(index, v);
        view.facts.jitter_px = Foveation::jitter_px(index + u64::from(v));
        if v == 1 && index == 4 {
            // No jitter of an antialiased picture.
            view.facts.jitter_px = view.facts.jitter_px.map(|px| 5.0 * px);
        }
        if v == 1 {
            view.motion = view.motion.map(|motion| motion.map(|[x, y]| [x, -y]));
        }
        if v == 0 && (5..8).contains(&index) {
            view.motion = view.motion.map(|motion| motion.map(|_| [0.0; 2]));
        }
        view.depth = view.depth.map(|depth| {
            let (near, far) = (depth.at(0, 0), depth.at(0, SIZE[1] as usize - 1));
            Image::from_fn(SIZE, |[x, y]| if 3 * y < SIZE[1] + x && (v == 0 || 2 * y < SIZE[1]) { near } else { far })
        });
        view.mask = (index > 8).then(|| Image::filled(SIZE, 1.0));
        view
    })
}

#[test]
fn a_wrong_mean_is_caught() {
    let settings = antialiased();
    let planted = [
        ("own_motion, motion, level == 0u)", "own_motion, motion, true)"),
        ("surface.mixes = true;", ""),
        ("surface.is_silhouette = silhouette;", ""),
        ("columns = 3u;", "columns = 2u;"),
        ("stored.lod = mean_lod(lod);", ""),
        (
            "return average(inputs, regular, place_px, at_edge, kept,",
            "return average(inputs, regular, -place_px, at_edge, kept,",
        ),
        ("let regular = with_regular_run(past, level);", "let regular = past;"),
        ("kept, difference, change, is_centred);", "kept, difference, change, false);"),
        ("next.color = candidate.color + centred_change(near);", ""),
        ("(vec2f(offset) - 1.0) + place_px", "(vec2f(offset) - 1.0) - place_px"),
        ("level == 0u && surrounds_centre(frame.views[view].jitter_px)", "level == 0u"),
        ("inputs.candidate = candidate.beside;", ""),
        ("return average_beside(inputs, past, place_px);", ""),
        ("level > 0u && has_moved(own_motion, motion)", "level > 0u"),
        ("pack_color_by(next.color, unit_draw(random))", "pack_color_by(next.color, 0.5)"),
    ];
    rig::all_caught_in(PASSES, desc(), settings, 12, &planted, |index, rig| {
        arrange(index, rig);
        (Reset::None, views(index).to_vec())
    });
}
