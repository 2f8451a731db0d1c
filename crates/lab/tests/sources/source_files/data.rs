//! Frames of another renderer: names, counts, and all sign conventions.

use super::limits;
use crate::explained::explained_db;
use crate::shared_data::shared_data;
use afterimage::ViewGeometry;
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::source::{FrameSource, SequenceSource};
use glam::{Mat4, Vec3};
use std::ops::Range;

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
/// that were visible before and, in a scene that is not still, have a motion of at least a quarter of a pixel.
fn reprojected_db(source: &mut SequenceSource, indices: Range<u64>, sign: [f32; 2], is_still: bool) -> f64 {
    let view = ViewGeometry::flat(source.info().size, source.info().hfov_deg.unwrap_or(70.0)).unwrap();
    let steps = (indices.end - indices.start) as f64;
    let mut sum = 0.0;
    for index in indices {
        let before = source.frame(index - 1).unwrap();
        let now = source.frame(index).unwrap();
        let (zb, zn) = (before.depth.as_ref().unwrap(), now.depth.as_ref().unwrap());
        let motion = now.motion.as_ref().unwrap();
        let was_seen = |[x, y]: [usize; 2], from: [f32; 2]| {
            let (expected, tolerance, min_px) =
                if is_still { (by_camera(&now, &view, x, y).1, 0.03, 0.0) } else { (zn.at(x, y), 0.1, 0.25) };
            let seen = zb.at(from[0].round() as usize, from[1].round() as usize);
            let [mx, my] = motion.at(x, y);
            mx.hypot(my) >= min_px && (seen - expected).abs() < tolerance * expected
        };
        sum += explained_db(&before, &now, sign, |c| c.map(tone), was_seen).0;
    }
    sum / steps
}

/// The table in the data's README, forwards and backwards; flipped signs must be clearly worse.
#[test]
fn vectors_reproject_as_published() {
    for (name, is_still, right, both_flipped) in
        [("sequences/sponza_lateral", true, 36.3, 24.8), ("sequences/sponza_object", false, 34.8, 18.4)]
    {
        let Some(folder) = shared_data(name) else { return };
        let mut source = SequenceSource::open(&folder, &limits()).unwrap();
        let n = source.info().frames.unwrap();
        for (direction, steps) in [("forwards", 1..n), ("backwards", n..2 * n - 1)] {
            let signs = [[1.0, 1.0], [0.0, 0.0], [1.0, -1.0], [-1.0, -1.0]];
            let all = signs.map(|sign| reprojected_db(&mut source, steps.clone(), sign, is_still));
            println!("{name} {direction}: {all:.2?} dB with right, no, y-flipped and flipped motion");
            let [good, still, y, both] = all;
            assert!((good - right).abs() < 0.5, "{name} {direction}: {good}");
            assert!(good > still + 5.0 && good > both + 8.0, "{name} {direction}");
            if direction == "forwards" {
                assert!((both - both_flipped).abs() < 0.5, "{name}: {both}");
            }
            if !is_still {
                assert!(good > y + 5.0, "{name} {direction}: the y sign does not matter?");
            }
        }
    }
}
