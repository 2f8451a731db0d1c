//! Frames of another renderer: names, counts, and all sign conventions.

use super::limits;
use crate::explained::explained_db;
use crate::shared_data::shared_data;
use afterimage::ViewGeometry;
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::source::exr_file::{ExrHeader, Vectors};
use afterimage_lab::source::motion_check::{Verdict, detect};
use afterimage_lab::source::{FrameSource, SceneOptions, SequenceSource, open};
use glam::{Mat4, Vec3};

fn tone(x: f32) -> f32 {
    (x.max(0.0) / (1.0 + x.max(0.0))).powf(1.0 / 2.2)
}

/// Previous position and depth of a pixel's surface point, from depth and cameras.
fn by_camera(frame: &SourceFrame, view: &ViewGeometry, x: usize, y: usize) -> ([f32; 2], f32) {
    let rows = frame.previous_from_current.unwrap();
    let matrix = Mat4::from_cols_array_2d(&rows).transpose();
    let z = frame.depth.as_ref().unwrap().at(x, y);
    let point: Vec3 = matrix.transform_point3(Vec3::from(view.ray([x as f32, y as f32])) * z);
    (view.project(point.into()).unwrap(), point.z)
}

/// Mean over steps of the PSNR of `previous` fetched at `p + sign * motion`. All signs use the same pixels: those
/// that were visible before and have a motion of at least `min_px`.
fn reprojected_db(
    source: &mut SequenceSource,
    indices: std::ops::Range<u64>,
    sign: [f32; 2],
    static_scene: bool,
    min_px: f32,
) -> f64 {
    let view = ViewGeometry::flat(source.info().size, source.info().hfov_deg.unwrap_or(70.0)).unwrap();
    let steps = (indices.end - indices.start) as f64;
    let mut sum = 0.0;
    for index in indices {
        let before = source.frame(index - 1).unwrap();
        let now = source.frame(index).unwrap();
        let (zb, zn) = (before.depth.as_ref().unwrap(), now.depth.as_ref().unwrap());
        let motion = now.motion.as_ref().unwrap();
        let was_seen = |[x, y]: [usize; 2], from: [f32; 2]| {
            let (expected, tolerance) =
                if static_scene { (by_camera(&now, &view, x, y).1, 0.03) } else { (zn.at(x, y), 0.1) };
            let seen = zb.at(from[0].round() as usize, from[1].round() as usize);
            let [mx, my] = motion.at(x, y);
            mx.hypot(my) >= min_px && (seen - expected).abs() < tolerance * expected
        };
        sum += explained_db(&before, &now, sign, |c| c.map(tone), was_seen).0;
    }
    sum / steps
}

#[test]
fn counts_sizes_and_channels() {
    for (name, size, frames) in [
        ("sequences/sponza_lateral", [480, 270], 24),
        ("sequences/sponza_object", [480, 270], 16),
        ("sequences/sponza_still", [1920, 1080], 1),
        ("sequences/blender_raw", [480, 270], 1),
    ] {
        let Some(folder) = shared_data(name) else { return };
        let mut source = open(folder.to_str().unwrap(), &limits(), &SceneOptions::default()).unwrap();
        let info = source.info().clone();
        assert_eq!((info.size, info.frames), (size, Some(frames)), "{name}");
        assert_eq!(info.still, frames == 1, "{name}");
        if name != "sequences/blender_raw" {
            assert_eq!((info.fps, info.hfov_deg), (Some(60.0), Some(70.0)), "{name}");
        }
        let frame = source.frame(0).unwrap();
        assert!(frame.cut && frame.nonfinite == 0);
        assert_eq!(frame.color.size(), size);
        let depth = frame.depth.unwrap();
        assert!(depth.pixels().iter().all(|&z| z > 0.05 && z < 200.0), "{name}");
        assert_eq!(frame.motion.is_some(), frames > 1, "{name}");
    }
}

/// Color and depth of the raw file against its repacked copy, and all four vector channels to half of 1/4096 px.
#[test]
fn the_repacked_frame_is_the_raw_one() {
    let (Some(raw), Some(packed)) = (shared_data("sequences/blender_raw"), shared_data("sequences/sponza_lateral"))
    else {
        return;
    };
    let raw = ExrHeader::open(&raw.join("sponza_lateral_0005.exr"), &limits()).unwrap();
    let packed = ExrHeader::open(&packed.join("frame_0005.exr"), &limits()).unwrap();
    assert!(raw.channel_names().iter().any(|n| n.contains("Noisy")));
    for vectors in [Vectors::ToPrevious, Vectors::ToNext] {
        let (a, b) = (raw.read(vectors).unwrap(), packed.read(vectors).unwrap());
        assert_eq!(a.color, b.color, "Combined was not the one taken");
        let (za, zb) = (a.depth.unwrap(), b.depth.unwrap());
        for (a, b) in za.pixels().iter().zip(zb.pixels()) {
            assert!((a - b).abs() <= 1e-5 * a, "{a} {b}");
        }
        let (ma, mb) = (a.motion.unwrap(), b.motion.unwrap());
        for (a, b) in ma.pixels().iter().zip(mb.pixels()) {
            for i in 0..2 {
                assert!((a[i] - b[i]).abs() <= 0.5001 / 4096.0, "{a:?} {b:?}");
            }
        }
    }
}

/// The table in the data's README, forwards and backwards; flipped signs must be clearly worse.
#[test]
fn vectors_reproject_as_published() {
    let cases =
        [("sequences/sponza_lateral", true, 0.0, 36.3, 24.8), ("sequences/sponza_object", false, 0.25, 34.8, 18.4)];
    for (name, static_scene, min_px, right, both_flipped) in cases {
        let Some(folder) = shared_data(name) else { return };
        let mut source = SequenceSource::open(&folder, &limits()).unwrap();
        let n = source.info().frames.unwrap();
        for (direction, steps) in [("forwards", 1..n), ("backwards", n..2 * n - 1)] {
            let mut db = |sign| reprojected_db(&mut source, steps.clone(), sign, static_scene, min_px);
            let (good, still, y, both) = (db([1.0, 1.0]), db([0.0, 0.0]), db([1.0, -1.0]), db([-1.0, -1.0]));
            eprintln!(
                "{name} {direction}: {good:.2} dB; no motion {still:.2}, y flipped {y:.2}, both flipped {both:.2}"
            );
            assert!((good - right).abs() < 0.5, "{name} {direction}: {good}");
            assert!(good > still + 5.0 && good > both + 8.0, "{name} {direction}");
            if direction == "forwards" {
                assert!((both - both_flipped).abs() < 0.5, "{name}: {both}");
            }
            if name == "sequences/sponza_object" {
                assert!(good > y + 5.0, "{name} {direction}: the y sign does not matter?");
            }
        }
    }
}

/// In a static scene, depth and cameras agree with the motion vectors, in both directions of playback.
#[test]
fn cameras_agree_with_vectors() {
    let Some(folder) = shared_data("sequences/sponza_lateral") else { return };
    let mut source = SequenceSource::open(&folder, &limits()).unwrap();
    let view = ViewGeometry::flat(source.info().size, source.info().hfov_deg.unwrap()).unwrap();
    for index in [1, 5, 12, 13, 23, 24, 30, 40, 46, 47] {
        let frame = source.frame(index).unwrap();
        let motion = frame.motion.as_ref().unwrap();
        let mut off: Vec<f32> = Vec::new();
        let mut moved: f32 = 0.0;
        for y in (0..motion.height()).step_by(3) {
            for x in (0..motion.width()).step_by(3) {
                let m = motion.at(x, y);
                let (was, _) = by_camera(&frame, &view, x, y);
                off.push((was[0] - x as f32 - m[0]).hypot(was[1] - y as f32 - m[1]));
                moved = moved.max(m[0].hypot(m[1]));
            }
        }
        let middle = off.len() / 2;
        let median = *off.select_nth_unstable_by(middle, f32::total_cmp).1;
        eprintln!("position {index}: median {median:.5} px off, motion up to {moved:.1} px");
        assert!(median < 0.01, "position {index}: {median}");
    }
    assert!(source.frame(0).unwrap().previous_from_current.is_none());
}

/// The frames at positions i and 2n-2-i are equal; only frame 0 is a cut.
#[test]
fn playback_turns_round() {
    let Some(folder) = shared_data("sequences/sponza_object") else { return };
    let mut source = SequenceSource::open(&folder, &limits()).unwrap();
    let n = source.info().frames.unwrap();
    for i in [0, 3, n - 2] {
        let (there, back) = (source.frame(i).unwrap(), source.frame(2 * n - 2 - i).unwrap());
        assert_eq!(there.color, back.color);
        assert_ne!(there.motion, back.motion);
        assert_eq!((there.cut, back.cut), (i == 0, false));
        let again = source.frame(2 * n - 2 + i).unwrap();
        assert_eq!(there.color, again.color);
        assert!(!again.cut);
    }
}

#[test]
fn the_detector_confirms_what_the_reader_delivers() {
    for (name, verdict) in
        [("sequences/sponza_lateral", Verdict::YAxisOpen), ("sequences/sponza_object", Verdict::Decided)]
    {
        let Some(folder) = shared_data(name) else { return };
        let mut source = SequenceSource::open(&folder, &limits()).unwrap();
        for index in [3, 20, 40] {
            let before = source.frame(index - 1).unwrap();
            let now = source.frame(index).unwrap();
            let motion = now.motion.unwrap();
            let check = detect(&before.color, &now.color, &motion).unwrap();
            eprintln!(
                "{name} position {index}: {:?}, {:.1} dB, margin {:.1} dB over {} pixels",
                check.verdict, check.psnr_db[0].1, check.margin_db, check.pixels
            );
            assert_eq!(check.verdict, verdict, "{name} {index}");
            assert_eq!(check.best, Default::default(), "{name} {index}");
        }
    }
}
