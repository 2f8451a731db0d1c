//! Occlusion and disocclusion on the device: hard cases H41, H42, H44 to H47, H49 and H50.

use super::rig::{Made, Rig, View, noise, with_w_sum};
use afterimage::kernel::debug_view::PixelTrace;
use afterimage::{ContextDesc, DepthConvention, DepthTest, Image, MethodKind, Reset, Settings, Verdict};
use afterimage_testing::Draws;
use afterimage_testing::holds;

pub const SIZE: [u32; 2] = [64, 48];
pub const PIXELS: u64 = 64 * 48;

pub fn still(name: &str) -> View {
    View::still(noise(SIZE, name), [20.0, 20.0])
}

pub fn with_depth(name: &str, depth: impl FnMut([u32; 2]) -> f32) -> View {
    View { depth: Some(Image::from_fn(SIZE, depth)), ..still(name) }
}

pub fn with_motion(name: &str, motion: impl FnMut([u32; 2]) -> [f32; 2]) -> View {
    View { motion: Some(Image::from_fn(SIZE, motion)), ..still(name) }
}

pub fn ungated() -> Option<Rig> {
    ungated_of(MethodKind::Wrs)
}

pub fn ungated_of(method: MethodKind) -> Option<Rig> {
    Rig::new(ContextDesc::new(SIZE), crate::settings::ungated_of(method))
}

/// Methods that find history by the same rules, each with its own storage.
pub const METHODS: [MethodKind; 2] = [MethodKind::Wrs, MethodKind::Smr];

pub fn one(rig: &mut Rig, index: u64, view: View) -> (Made, Image<PixelTrace>) {
    let (made, mut trace) = rig.both(index, Reset::None, &[view]);
    (made, trace.remove(0))
}

/// A first frame whose samples no candidate will replace.
pub fn sticky(rig: &mut Rig, view: View) {
    let (made, _) = one(rig, 0, view);
    rig.restore(&with_w_sum(&made.words, 1e12));
}

pub fn bits(color: [f32; 3]) -> [u32; 3] {
    color.map(f32::to_bits)
}

#[test]
fn h44_a_grazing_plane_under_jitter_is_not_rejected() {
    let focal_px = 32.0 / 35_f32.to_radians().tan();
    let mut seen = 0;
    for method in METHODS {
        for angle_deg in [60.0_f32, 89.0, 89.9] {
            let mut draws = Draws::new("jittered floor on the device");
            let per_row = angle_deg.to_radians().tan() / focal_px;
            let row = |y: f32| 0.2 * (1.0 + per_row * (y - 23.5));
            let mut frame = |index: u64| {
                let jitter = if index == 0 { 0.0 } else { draws.range(-0.5, 0.5) };
                with_depth("floor", |[_, y]| {
                    let d = row(y as f32 + jitter);
                    if d > 0.0 { 1.0 / d } else { f32::INFINITY }
                })
            };
            let Some(mut rig) = ungated_of(method) else { return };
            for index in 0..8 {
                let (_, trace) = one(&mut rig, index, frame(index));
                // Only where the neighbouring rows are on the plane for any sample position: the horizon is a
                // silhouette.
                for (i, t) in trace.pixels().iter().enumerate().filter(|(i, _)| row((i / 64) as f32 - 1.5) > 0.0) {
                    assert!(t.verdict != Verdict::Disoccluded, "{method:?}, {angle_deg} degrees, row {}", i / 64);
                    seen += 1;
                }
            }
        }
    }
    let test = Some(DepthTest { slope_px: 0.0, ..DepthTest::default() });
    let Some(mut strict) = Rig::new(ContextDesc::new(SIZE), Settings { depth_test: test, ..Settings::paper() }) else {
        return;
    };
    let floor = |jitter: f32| with_depth("floor", move |[_, y]| 1000.0 / (y as f32 + 1.0 + jitter));
    one(&mut strict, 0, floor(0.0));
    assert!(one(&mut strict, 1, floor(0.5)).0.stats.rejected() > 0, "the planted error: no allowance for slope");
    holds!("H44", Gpu, "wrs and smr, 60 to 89.9 degrees, 8 jittered frames: 0 of {seen} pixels rejected");
}

#[test]
fn h45_driving_at_a_wall_keeps_history_when_camera_motion_is_known() {
    let camera = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 0.0, 1.0]];
    for method in METHODS {
        for (camera, rejected) in [(Some(camera), 0), (None, PIXELS)] {
            let Some(mut rig) = ungated_of(method) else { return };
            for (index, z) in [(0, 6.0_f32), (1, 5.0)] {
                let k = z / (z + 1.0) - 1.0;
                let mut view = with_motion("wall", |[x, y]| [(x as f32 - 31.5) * k, (y as f32 - 23.5) * k]);
                view.depth = Some(Image::filled(SIZE, z));
                view.facts.previous_from_current = camera;
                let disoccluded = one(&mut rig, index, view).0.stats.verdicts[Verdict::Disoccluded as usize];
                assert_eq!(disoccluded, if index == 1 { rejected } else { 0 }, "{method:?}");
            }
        }
    }
    holds!("H45", Gpu, "wrs and smr, from 6 to 5 m: 0 of 3072 pixels rejected; 3072 without camera motion");
}

#[test]
fn h46_a_jittering_wire_rejects_its_own_history_alone() {
    let [wall, wire] = [[0.25; 3], [0.9; 3]];
    let mut shares = vec![];
    for method in METHODS {
        let Some(mut rig) = ungated_of(method) else { return };
        let (mut blinks, mut before) = (0.0, None::<Vec<[u32; 3]>>);
        for index in 0..30 {
            let column = 30 + (index % 2) as u32;
            let mut view = with_depth("wire", |[x, _]| if x == column { 1.0 } else { 10.0 });
            view.color = Image::from_fn(SIZE, |[x, _]| if x == column { wire } else { wall });
            let (made, _) = one(&mut rig, index, view);
            assert_eq!(made.stats.rejected(), if index == 0 { 0 } else { 2 * 48 }, "the two columns, and only they");
            if let Some(before) = before.replace(made.shown.clone()).filter(|_| index > 1) {
                for (i, (a, b)) in made.shown.iter().zip(&before).enumerate() {
                    let change = f64::from(f32::from_bits(a[0]) - f32::from_bits(b[0]));
                    blinks += if [30, 31].contains(&(i % 64)) { 0.0 } else { change * change };
                }
            }
        }
        shares.push(blinks / (28.0 * 2.0 * 48.0 * 0.65_f64.powi(2)));
    }
    assert!(shares[0] == 0.0 && shares[1] < 1e-3, "{shares:?}");
    let smr = shares[1];
    holds!(
        "H46",
        Gpu,
        "wrs and smr: 96 px a frame rejected, always; blinking beside them {smr:.1e} of the wire's (wrs 0)"
    );
}

#[test]
fn h47_a_nan_depth_rejects_its_pixel_alone() {
    for method in METHODS {
        let (Some(mut clean), Some(mut hurt)) = (ungated_of(method), ungated_of(method)) else { return };
        // The stored sample has no depth either, so its history is rejected once more.
        for (index, bad, rejected) in [(0, false, 0), (1, true, 1), (2, false, 1), (3, false, 0)] {
            let view = |bad: bool| {
                let depth = |at: [u32; 2]| if bad && at == [20, 21] { f32::NAN } else { 4.0 };
                with_depth(&format!("nan depth {index}"), depth)
            };
            let (expected, _) = one(&mut clean, index, view(false));
            let (made, trace) = one(&mut hurt, index, view(bad));
            assert_eq!((made.stats.rejected(), made.stats.bad_depth), (rejected, u64::from(bad)));
            assert_eq!(trace.at(20, 21).verdict == Verdict::Disoccluded, rejected == 1);
            // A pixel without history affects its neighbours through smr's mip chain a frame later.
            let alike = |(i, (a, b))| i == 21 * 64 + 20 || method == MethodKind::Smr && index > 1 || a == b;
            assert!(made.shown.iter().zip(&expected.shown).enumerate().all(alike), "{method:?}, frame {index}");
        }
    }
    holds!("H47", Gpu, "wrs and smr: its pixel rejected in 2 frames, then kept; {} others: same bits", PIXELS - 1);
}

#[test]
fn h41_h49_sky_and_orthographic_depth_are_rejected_where_surfaces_change() {
    for method in METHODS {
        for (depth, sky, wall) in [
            (DepthConvention::Reversed { near: 0.1, far: f32::INFINITY }, 0.0, 0.05),
            (DepthConvention::Forward { near: 0.1, far: f32::INFINITY }, 1.0, 0.98),
            (DepthConvention::Linear, f32::INFINITY, 5.0),
            (DepthConvention::Orthographic { near: 0.0, far: 100.0 }, 1.0, 0.05),
        ] {
            let settings = Settings { method: method.into(), ..Settings::paper() };
            let Some(mut rig) = Rig::new(ContextDesc { depth, ..ContextDesc::new(SIZE) }, settings) else { return };
            for (index, split, rejected) in [(0, 32, 0), (1, 32, 0), (2, 30, 2 * 48), (3, 32, 2 * 48), (4, 32, 0)] {
                let view = with_depth("sky", |[x, _]| if x < split { wall } else { sky });
                assert_eq!(one(&mut rig, index, view).0.stats.rejected(), rejected, "{depth:?}, frame {index}");
            }
        }
    }
    holds!(
        "H41",
        Gpu,
        "wrs and smr, 3 skies: sky on sky keeps 1536 of 1536, sky on wall and wall on sky reject 96 of 96"
    );
    holds!("H49", Gpu, "wrs and smr: the edge's 96 pixels rejected each way, no other of 3072");
}

#[test]
fn h42_depth_beyond_its_ends_is_clamped() {
    let depth = DepthConvention::Reversed { near: 0.1, far: 1000.0 };
    for method in METHODS {
        let settings = crate::settings::ungated_of(method);
        let Some(mut rig) = Rig::new(ContextDesc { depth, ..ContextDesc::new(SIZE) }, settings) else { return };
        let ends = |by: f32| move |[x, _]: [u32; 2]| if x < 32 { 1.0 + by } else { -by };
        for (index, by) in (0..).zip([0.0, f32::EPSILON, 1e-3, 1e30, f32::INFINITY, 0.0]) {
            let (made, _) = one(&mut rig, index, with_depth("ends", ends(by)));
            assert_eq!((made.stats.rejected(), made.stats.bad_depth), (0, 0), "{method:?}, by {by}");
        }
    }
    holds!("H42", Gpu, "wrs and smr: 1 ulp to infinity beyond either end is the same surface as the end, 3072 pixels");
}

#[test]
fn h50_z_fighting_shows_only_what_was_presented() {
    let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), Settings::paper()) else { return };
    let (a, b) = ([0.25, 0.5, 0.75], [0.75, 0.25, 0.5]);
    let mut draws = Draws::new("z-fighting on the device");
    let mut oldest = 0;
    for index in 0..40 {
        let picks: Vec<bool> = (0..PIXELS).map(|_| draws.uniform() < 0.5).collect();
        let pick = |[x, y]: [u32; 2]| picks[(y * 64 + x) as usize];
        let mut view = with_depth("", |at| if pick(at) { 3.0 } else { 3.0001 });
        view.color = Image::from_fn(SIZE, |at| if pick(at) { a } else { b });
        let (made, trace) = one(&mut rig, index, view);
        assert!(made.shown.iter().all(|&c| c == bits(a) || c == bits(b)));
        assert_eq!(made.stats.rejected(), 0);
        oldest = trace.pixels().iter().map(|t| t.age).max().unwrap().max(oldest);
    }
    assert!(oldest < 40);
    holds!("H50", Gpu, "wrs, 40 frames: none rejected, ages to {oldest}, no third color");
}
