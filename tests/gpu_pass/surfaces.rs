//! Surfaces that come, go and move, on the device: hard cases H44 to H60.

use super::common::Draws;
use super::rig::{Made, Rig, View, noise, with_w_sum};
use afterimage::convention::{DepthConvention, MotionConvention, MotionUnit};
use afterimage::frame::{ContextDesc, Reset};
use afterimage::image::Image;
use afterimage::kernel::debug_view::PixelTrace;
use afterimage::kernel::pack;
use afterimage::kernel::reproject::Verdict;
use afterimage::settings::{DepthTest, Settings};

const SIZE: [u32; 2] = [64, 48];
const PIXELS: u64 = 64 * 48;

fn still(name: &str) -> View {
    View::still(noise(SIZE, name), [20.0, 20.0])
}

fn with_depth(name: &str, depth: impl FnMut([u32; 2]) -> f32) -> View {
    View { depth: Some(Image::from_fn(SIZE, depth)), ..still(name) }
}

fn with_motion(name: &str, motion: impl FnMut([u32; 2]) -> [f32; 2]) -> View {
    View { motion: Some(Image::from_fn(SIZE, motion)), ..still(name) }
}

fn ungated() -> Option<Rig> {
    Rig::new(ContextDesc::new(SIZE), Settings { gate: None, ..Settings::paper() })
}

fn one(rig: &mut Rig, index: u64, view: View) -> (Made, Image<PixelTrace>) {
    let (made, mut trace) = rig.both(index, Reset::None, &[view]);
    (made, trace.remove(0))
}

/// A first frame whose samples no candidate will replace.
fn sticky(rig: &mut Rig, view: View) {
    let (made, _) = one(rig, 0, view);
    rig.restore(&with_w_sum(&made.words, 1e12));
}

fn bits(color: [f32; 3]) -> [u32; 3] {
    color.map(f32::to_bits)
}

#[test]
fn h44_a_steep_floor_under_jitter_is_not_flushed() {
    let Some(mut rig) = ungated() else { return };
    let floor = |jitter: f32| with_depth("floor", move |[_, y]| 1000.0 / (y as f32 + 1.0 + jitter));
    for index in 0..12 {
        assert_eq!(one(&mut rig, index, floor(0.5 * (index % 2) as f32)).0.stats.flushed(), 0, "frame {index}");
    }
    let test = Some(DepthTest { slope_px: 0.0, ..DepthTest::default() });
    let Some(mut strict) = Rig::new(ContextDesc::new(SIZE), Settings { depth_test: test, ..Settings::paper() }) else {
        return;
    };
    one(&mut strict, 0, floor(0.0));
    assert!(one(&mut strict, 1, floor(0.5)).0.stats.flushed() > 0, "the planted error: no allowance for slope");
}

#[test]
fn h45_driving_at_a_wall_does_not_flush_when_the_camera_is_known() {
    let camera = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 0.0, 1.0]];
    for (camera, flushes) in [(Some(camera), false), (None, true)] {
        let Some(mut rig) = ungated() else { return };
        for (index, z) in [(0, 6.0_f32), (1, 5.0)] {
            let k = z / (z + 1.0) - 1.0;
            let mut view = with_motion("wall", |[x, y]| [(x as f32 - 31.5) * k, (y as f32 - 23.5) * k]);
            view.depth = Some(Image::filled(SIZE, z));
            view.facts.previous_from_current = camera;
            let disoccluded = one(&mut rig, index, view).0.stats.verdicts[Verdict::Disoccluded as usize];
            assert_eq!(disoccluded > 0, index == 1 && flushes);
        }
    }
}

#[test]
fn h46_a_jittering_wire_flushes_itself_alone() {
    let Some(mut rig) = ungated() else { return };
    for index in 0..30 {
        let column = 30 + (index % 2) as u32;
        let (made, _) = one(&mut rig, index, with_depth("wire", |[x, _]| if x == column { 1.0 } else { 10.0 }));
        assert_eq!(made.stats.flushed(), if index == 0 { 0 } else { 2 * 48 }, "the two columns, and only they");
    }
}

#[test]
fn h47_a_nan_depth_flushes_its_pixel_alone() {
    let Some(mut rig) = ungated() else { return };
    // What was stored there has no depth either, so it is flushed once more.
    for (index, bad, flushed) in [(0, false, 0), (1, true, 1), (2, false, 1), (3, false, 0)] {
        let depth = |at: [u32; 2]| if bad && at == [20, 21] { f32::NAN } else { 4.0 };
        let (made, trace) = one(&mut rig, index, with_depth("nan depth", depth));
        assert_eq!((made.stats.flushed(), made.stats.bad_depth), (flushed, u64::from(bad)));
        assert_eq!(trace.at(20, 21).verdict == Verdict::Disoccluded, flushed == 1);
    }
}

#[test]
fn h41_h49_sky_and_orthographic_depth_flush_where_surfaces_change() {
    for (depth, sky, wall) in [
        (DepthConvention::Reversed { near: 0.1, far: f32::INFINITY }, 0.0, 0.05),
        (DepthConvention::Forward { near: 0.1, far: f32::INFINITY }, 1.0, 0.98),
        (DepthConvention::Linear, f32::INFINITY, 5.0),
        (DepthConvention::Orthographic { near: 0.0, far: 100.0 }, 1.0, 0.05),
    ] {
        let Some(mut rig) = Rig::new(ContextDesc { depth, ..ContextDesc::new(SIZE) }, Settings::paper()) else {
            return;
        };
        for (index, split, flushed) in [(0, 32, 0), (1, 32, 0), (2, 30, 2 * 48)] {
            let view = with_depth("sky", |[x, _]| if x < split { wall } else { sky });
            assert_eq!(one(&mut rig, index, view).0.stats.flushed(), flushed, "{depth:?}, frame {index}");
        }
    }
}

#[test]
fn h50_z_fighting_shows_only_what_was_presented() {
    let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), Settings::paper()) else { return };
    let (a, b) = ([0.25, 0.5, 0.75], [0.75, 0.25, 0.5]);
    let mut draws = Draws::new("z-fighting on the device");
    for index in 0..40 {
        let picks: Vec<bool> = (0..PIXELS).map(|_| draws.uniform() < 0.5).collect();
        let pick = |[x, y]: [u32; 2]| picks[(y * 64 + x) as usize];
        let mut view = with_depth("", |at| if pick(at) { 3.0 } else { 3.0001 });
        view.color = Image::from_fn(SIZE, |at| if pick(at) { a } else { b });
        let (made, trace) = one(&mut rig, index, view);
        assert!(made.shown.iter().all(|&c| c == bits(a) || c == bits(b)));
        assert_eq!(made.stats.flushed(), 0);
        assert!(trace.pixels().iter().all(|t| u64::from(t.age) <= index));
    }
}

#[test]
fn h51_a_thousand_still_frames_never_move_a_sample() {
    let Some(mut rig) = ungated() else { return };
    let view = with_motion("still", |_| [0.0; 2]);
    let picture: Vec<[u32; 3]> = view.color.pixels().iter().map(|&c| bits(c)).collect();
    for index in 0..1000 {
        let made = rig.on_gpu(index, Reset::None, std::slice::from_ref(&view));
        assert!(made.shown == picture && made.stats.flushed() == 0, "frame {index}");
    }
}

#[test]
fn h52_an_integer_shift_moves_history_exactly_and_marks_the_border_new() {
    for (shift, right) in [([3.0, -2.0], true), ([-3.0, 2.0], false)] {
        let Some(mut rig) = ungated() else { return };
        let before = still("before");
        sticky(&mut rig, before.clone());
        let after = with_motion("after", |_| shift);
        let color = after.color.clone();
        let (made, trace) = one(&mut rig, 1, after);
        let as_expected = (0..48_usize).flat_map(|y| (0..64_usize).map(move |x| (x, y))).all(|(x, y)| {
            let shown = made.shown[y * 64 + x];
            if x + 3 < 64 && y >= 2 {
                shown == bits(before.color.at(x + 3, y - 2)) && trace.at(x, y).verdict == Verdict::Valid
            } else {
                shown == bits(color.at(x, y)) && trace.at(x, y).verdict == Verdict::OffScreen
            }
        });
        assert_eq!(as_expected, right, "the planted error: the other sign");
    }
}

#[test]
fn h53_half_pixel_motion_never_blurs() {
    let Some(mut rig) = ungated() else { return };
    let mut known = std::collections::HashSet::new();
    for index in 0..200 {
        let view = with_motion(&format!("h53 {index}"), |_| [-0.5, 0.5]);
        known.extend(view.color.pixels().iter().map(|&c| bits(c)));
        assert!(one(&mut rig, index, view).0.shown.iter().all(|c| known.contains(c)), "an invented colour");
    }
}

#[test]
fn h54_garbage_motion_shows_the_candidate() {
    let Some(mut rig) = ungated() else { return };
    sticky(&mut rig, still("a"));
    for (index, bad) in (1..).zip([f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e9, -1e9, f32::MAX]) {
        let view = with_motion("b", |at| match at {
            [7, 5] => [bad, 0.0],
            [7, 6] => [0.0, bad],
            _ => [0.0; 2],
        });
        let color = [5, 6].map(|y| bits(view.color.at(7, y)));
        let (made, _) = one(&mut rig, index, view);
        assert_eq!((made.stats.verdicts[Verdict::BadMotion as usize], made.stats.flushed()), (2, 2), "{bad}");
        assert_eq!([5, 6].map(|y| made.shown[y * 64 + 7]), color);
    }
}

#[test]
fn h55_half_float_motion_is_off_by_its_quantum_and_no_more() {
    // Half a view and half a pixel, nearly, in texture coordinates, where halves step by 2^-11: a 32nd of these pixels.
    let motion = MotionConvention { unit: MotionUnit::Uv, ..MotionConvention::default() };
    let desc = ContextDesc { motion, ..ContextDesc::new(SIZE) };
    let Some(mut rig) = Rig::new(desc, Settings { gate: None, ..Settings::paper() }) else { return };
    rig.halve_motion();
    sticky(&mut rig, still("before"));
    let wanted_px = 32.0 + 0.49;
    let stored = pack::half_value(pack::half_bits(wanted_px / 64.0));
    let (made, trace) = one(&mut rig, 1, with_motion("after", |_| [stored, 0.0]));
    let read_px = trace.at(0, 0).motion[0];
    println!("{wanted_px} px is read as {read_px} px");
    assert!(read_px != wanted_px && (read_px - wanted_px).abs() <= 0.5 * 64.0 * 2.0_f32.powi(-11));
    // 0.49 would round to the same texel; as read it is the next one's: one column more has left the view.
    let columns = if read_px >= 32.5 { 33 } else { 32 };
    assert_eq!(made.stats.verdicts[Verdict::OffScreen as usize], columns * 48);
}

#[test]
fn h57_the_last_texel_is_inside_and_a_hundredth_beyond_its_edge_is_not() {
    // The view ends half a pixel beyond the last centre, column 63.
    for (to, inside) in [(63.0, true), (63.49, true), (63.51, false), (-0.49, true), (-0.51, false), (0.0, true)] {
        let Some(mut rig) = ungated() else { return };
        sticky(&mut rig, still("border"));
        let (_, trace) = one(&mut rig, 1, with_motion("border", |[x, _]| [to - x as f32, 0.0]));
        let verdict = if inside { Verdict::Valid } else { Verdict::OffScreen };
        assert!(trace.pixels().iter().all(|t| t.verdict == verdict), "to column {to}");
    }
}

#[test]
fn h58_nothing_bleeds_over_a_depth_edge() {
    let Some(mut rig) = ungated() else { return };
    for index in 0..24_u64 {
        let left = 4.0 + 1.5 * index as f32;
        let inside = |[x, y]: [u32; 2]| (left..left + 10.0).contains(&(x as f32)) && (10..30).contains(&y);
        let mut view = with_depth("", |at| if inside(at) { 1.0 } else { 8.0 });
        view.color = Image::from_fn(SIZE, |at| if inside(at) { [1.0; 3] } else { [0.125; 3] });
        view.motion = Some(Image::from_fn(SIZE, |at| if inside(at) { [-1.5, 0.0] } else { [0.0; 2] }));
        let color: Vec<[u32; 3]> = view.color.pixels().iter().map(|&c| bits(c)).collect();
        assert!(one(&mut rig, index, view).0.shown == color, "frame {index}");
    }
}

#[test]
fn h59_h60_zoom_and_turn_leave_no_hole() {
    let Some(mut rig) = ungated() else { return };
    one(&mut rig, 0, still("zoom"));
    let (made, trace) = one(&mut rig, 1, with_motion("zoom 2", |[x, y]| [x as f32 - 32.0, y as f32 - 24.0]));
    assert!(made.stats.flushed() > 0 && made.stats.valid() > 0);
    assert!(trace.pixels().iter().filter(|t| !t.take).all(|t| t.age == 1), "duplicates keep their age");
    let turn = with_motion("turn", |_| [5000.0, 0.0]);
    let color: Vec<[u32; 3]> = turn.color.pixels().iter().map(|&c| bits(c)).collect();
    let (made, _) = one(&mut rig, 2, turn);
    assert!(made.shown == color && made.stats.flushed() == PIXELS);
}
