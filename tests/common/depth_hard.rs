//! Hard cases of depth, H41 and H44 to H50: laws that hold on either executor. A law returns what it measured, or
//! `None` without an executor.

use crate::images::{Images, View, held_words, noise, pixel, pixels, planned, traced};
use crate::settings::ungated_of;
use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::internal::{ContextDesc, DepthTest, Foveation, FoveationKind, MethodKind, Reset, Settings};
use afterimage::kernel::debug_view::PixelTrace;
use afterimage::kernel::stored_reservoir;
use afterimage::kernel::surface::{Surface, unpack_surface};
use afterimage::{DepthConvention, Exposure, FrameStats, Image, Verdict};
use afterimage_testing::Draws;

/// The laws as tests of an executor. `$run_law` runs one, and returns what it measured.
macro_rules! depth_laws {
    ($side:ident, $run_law:ident) => {
        crate::laws::laws! { $side, $run_law,
            h41_h49_sky_and_orthographic_depth_go_through_the_pass: "H41", "H49", sky_and_orthographic_depth;
            h44_a_grazing_plane_under_jitter_is_not_rejected: "H44", grazing_plane;
            h45_driving_at_a_wall_keeps_history_when_camera_motion_is_known: "H45", driving_at_a_wall;
            h46_a_jittering_wire_rejects_its_own_history_alone: "H46", jittering_wire;
            h47_a_nan_depth_rejects_its_pixel_alone: "H47", nan_depth;
            h50_z_fighting_shows_only_what_was_presented: "H50", z_fighting;
        }
    };
}
pub(crate) use depth_laws;

pub const SIZE: [u32; 2] = [64, 48];
/// Methods that find history by the same rules, each with its own storage.
pub const METHODS: [MethodKind; 2] = [MethodKind::Wrs, MethodKind::Smr];
pub type Color = Image<[f32; 3]>;

/// Result of a frame of one view.
#[derive(Clone, Debug, PartialEq)]
pub struct Made {
    pub shown: Color,
    /// Packed history.
    pub words: Vec<[u32; 3]>,
    pub trace: Image<PixelTrace>,
    pub stats: FrameStats,
}

impl Made {
    /// What the history stores, of methods that store surfaces.
    pub fn surfaces(&self) -> Vec<Surface> {
        self.words.iter().map(|w| unpack_surface([w[0], w[1]])).collect()
    }

    /// Its colors as an image.
    pub fn stored(&self) -> Color {
        let colors = self.surfaces().iter().map(|s| s.color.to_array()).collect();
        Image::from_pixels(self.shown.size(), colors).unwrap()
    }
}

/// An executor.
pub trait Steps {
    /// A frame of one view.
    fn make(&mut self, index: u64, view: &View, exposure: Exposure, reset: Reset) -> Made;

    fn exposed(&mut self, index: u64, view: &View, exposure: Exposure) -> Made {
        self.make(index, view, exposure, Reset::None)
    }

    /// A frame at the exposure of the frame before.
    fn step(&mut self, index: u64, view: &View) -> Made {
        self.exposed(index, view, Exposure::Same)
    }

    fn set_settings(&mut self, settings: Settings);

    /// Another size; history that it makes anew is garbage.
    fn resize(&mut self, size: [u32; 2]);

    fn forget(&mut self);

    /// Gives reservoirs so much weight that no candidate replaces their samples.
    fn stick(&mut self);
}

/// Makes an executor, if there is one.
pub type Make<'a> = &'a dyn Fn(ContextDesc) -> Option<Box<dyn Steps>>;

impl Steps for CpuAfterimage {
    fn make(&mut self, index: u64, view: &View, exposure: Exposure, reset: Reset) -> Made {
        let images = Images::of([view]);
        let frame = Frame { exposure, reset, ..images.frame(index) };
        planned(self, &frame);
        let (mut shown, mut trace, stats) = traced(self, &frame);
        Made { shown: shown.remove(0), words: held_words(self), trace: trace.remove(0), stats }
    }

    fn set_settings(&mut self, settings: Settings) {
        CpuAfterimage::set_settings(self, settings).unwrap();
    }

    fn resize(&mut self, size: [u32; 2]) {
        CpuAfterimage::resize(self, size).unwrap();
    }

    fn forget(&mut self) {
        CpuAfterimage::forget(self);
    }

    fn stick(&mut self) {
        // The candidate's share is below the smallest draw, 2^-24.
        let heavy = |&w: &[u32; 3]| {
            stored_reservoir::pack(stored_reservoir::Stored { w_sum: 1e12, ..stored_reservoir::unpack(w) })
        };
        let words: Vec<_> = self.history().words().iter().map(heavy).collect();
        self.restore_history(&words);
    }
}

pub fn desc(settings: Settings) -> ContextDesc {
    ContextDesc { settings, ..ContextDesc::new(SIZE) }
}

/// A method without a gate, so that only the test in question rejects history.
pub fn of(method: MethodKind) -> ContextDesc {
    desc(ungated_of(method))
}

/// Methods of full-size frames without a gate, and planned frames: everywhere alike, and antialiased around a gaze.
pub fn ungated_and_planned() -> [ContextDesc; 4] {
    let everywhere = Settings { foveation: Foveation::uniform(0.25), ..Settings::default() };
    let [wrs, smr] = METHODS.map(of);
    [wrs, smr, desc(everywhere), desc(Settings::screen())]
}

pub fn is_planned(desc: &ContextDesc) -> bool {
    desc.settings.foveation.kind == FoveationKind::Quads
}

pub fn still(color: Color) -> View {
    View::still(color, [20.0, 20.0])
}

/// Planes seen at up to 89.9 degrees from their normal, from the horizon on; the depth sample moves by half a pixel.
pub fn grazing_plane(make: Make<'_>) -> Option<String> {
    let focal_px = 32.0 / 35_f32.to_radians().tan();
    let mut seen = 0;
    // Along y, and along x.
    for (desc, axis) in ungated_and_planned().into_iter().zip([1, 0, 1, 0]) {
        for angle_deg in [60.0_f32, 85.0, 89.0, 89.9] {
            let mut draws = Draws::new("jittered floor");
            let per_row = angle_deg.to_radians().tan() / focal_px;
            let row = |v: f32| 0.2 * (1.0 + per_row * (v - [31.5, 23.5][axis]));
            let mut frame = |index: u64| {
                let jitter = if index == 0 { 0.0 } else { draws.range(-0.5, 0.5) };
                let depth = Image::from_fn(SIZE, |at| {
                    let d = row(at[axis] as f32 + jitter);
                    if d > 0.0 { 1.0 / d } else { f32::INFINITY }
                });
                View { depth: Some(depth), ..still(noise(SIZE, "floor")) }
            };
            let mut post = make(desc)?;
            // Only where the neighbouring rows are on the plane for any sample position: the horizon is a silhouette.
            let place = |i: usize| [i % 64, i / 64][axis];
            for index in 0..20 {
                let trace = post.step(index, &frame(index)).trace;
                for (i, t) in trace.pixels().iter().enumerate().filter(|(i, _)| row(place(*i) as f32 - 1.5) > 0.0) {
                    assert!(t.verdict != Verdict::Disoccluded, "{desc:?}, {angle_deg} degrees, row {}", place(i));
                    seen += 1;
                }
            }
            if is_planned(&desc) {
                // The planted error: another plane. The slope is that of the depth buffer.
                let nearer =
                    frame(20).with(|view| view.depth = view.depth.as_ref().map(|depth| depth.map(|z| 0.7 * z)));
                assert!(post.step(20, &nearer).stats.rejected() > 0);
                continue;
            }
            // The planted error: no allowance for slope.
            let test = DepthTest { slope_px: 0.0, ..DepthTest::default() };
            post.set_settings(Settings { depth_test: Some(test), ..desc.settings });
            assert!(post.step(20, &frame(20)).stats.rejected() > 0 || angle_deg < 89.0);
        }
    }
    Some(format!("wrs, smr and planned, 60 to 89.9 degrees, 20 jittered frames: 0 of {seen} pixels rejected"))
}

pub fn driving_at_a_wall(make: Make<'_>) -> Option<String> {
    let step_m = 1.0;
    let camera = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, step_m], [0.0, 0.0, 0.0, 1.0]];
    let frame = |z: f32, camera| {
        // The wall's points flow outwards: previous = current * z / (z + step), about the middle.
        let motion = Image::from_fn(SIZE, |[x, y]| {
            let k = z / (z + step_m) - 1.0;
            [(x as f32 - 31.5) * k, (y as f32 - 23.5) * k]
        });
        let mut view = still(noise(SIZE, "wall"));
        view.facts.previous_from_current = camera;
        View { depth: Some(Image::filled(SIZE, z)), motion: Some(motion), ..view }
    };
    for desc in ungated_and_planned().into_iter().chain([MethodKind::Taa, MethodKind::Taau].map(of)) {
        for (camera, disoccluded) in [(Some(camera), 0), (None, 64 * 48)] {
            let mut post = make(desc)?;
            post.step(0, &frame(6.0, camera));
            let stats = post.step(1, &frame(5.0, camera)).stats;
            assert_eq!(stats.verdicts[Verdict::Disoccluded as usize], disoccluded, "{desc:?}");
        }
    }
    Some("wrs, smr, taa and planned, from 6 to 5 m: 0 of 3072 pixels rejected; 3072 without camera motion".into())
}

/// A wire one pixel wide at 1 m in front of a wall at 10 m, moved between two columns by the jitter.
pub fn jittering_wire(make: Make<'_>) -> Option<String> {
    let [wall, wire] = [[0.25; 3], [0.9; 3]];
    let mut shares = vec![];
    for method in METHODS {
        let mut post = make(of(method))?;
        let (mut rejected, mut blinks, mut before) = (vec![], 0.0_f64, None::<Color>);
        for index in 0..24 {
            let column = 30 + (index % 2) as u32;
            let input = View {
                depth: Some(Image::from_fn(SIZE, |[x, _]| if x == column { 1.0 } else { 10.0 })),
                ..still(Image::from_fn(SIZE, |[x, _]| if x == column { wire } else { wall }))
            };
            let Made { shown: out, stats, .. } = post.step(index, &input);
            let at_wire =
                |image: &Color| -> Vec<_> { (0..48).flat_map(|y| [30, 31].map(|x| image.at(x, y))).collect() };
            assert_eq!(at_wire(&out), at_wire(&input.color), "{method:?}: the wire shows what came");
            if let Some(before) = before.replace(out.clone()).filter(|_| index > 1) {
                for (i, (a, b)) in out.pixels().iter().zip(before.pixels()).enumerate() {
                    blinks += if [30, 31].contains(&(i % 64)) { 0.0 } else { f64::from((a[0] - b[0]).powi(2)) };
                }
            }
            rejected.push(stats.rejected());
        }
        assert!(rejected[1..].iter().all(|&n| n == 2 * 48), "the two columns, and only they: {rejected:?}");
        // Compared with the change in the wire's own two columns: 0.65 each, in every frame.
        let share = blinks / (22.0 * 2.0 * 48.0 * 0.65_f64.powi(2));
        shares.push(share);
    }
    // The wire appears in smr's mip chain and disappears from it.
    assert!(shares[0] == 0.0 && shares[1] < 1e-3, "{shares:?}");
    let smr = shares[1];
    Some(format!("wrs and smr: 96 px a frame rejected, always; blinking beside them {smr:.1e} of the wire's (wrs 0)"))
}

pub fn nan_depth(make: Make<'_>) -> Option<String> {
    let hurt_at = 20 * 64 + 20;
    for method in METHODS {
        let (mut clean, mut hurt) = (make(of(method))?, make(of(method))?);
        let mut rejected = vec![];
        for index in 0..4 {
            let input = View { depth: Some(Image::filled(SIZE, 4.0)), ..still(noise(SIZE, &format!("d {index}"))) };
            let mut broken = input.clone();
            if index == 1 {
                broken.depth.as_mut().unwrap().pixels_mut()[hurt_at] = f32::NAN;
            }
            let (a, b) = (clean.step(index, &input), hurt.step(index, &broken));
            rejected.push(b.stats.rejected());
            assert_eq!(b.stats.bad_depth, u64::from(index == 1));
            // A pixel without history affects its neighbours through smr's mip chain a frame later.
            let unchanged = |i: usize| i == hurt_at || method == MethodKind::Smr && index > 1;
            for i in (0..64 * 48).filter(|&i| !unchanged(i)) {
                assert_eq!(a.shown.pixels()[i], b.shown.pixels()[i], "{method:?}, frame {index}: a neighbour changed");
                assert_eq!(a.trace.pixels()[i], b.trace.pixels()[i]);
            }
            assert_eq!(b.trace.pixels()[hurt_at].verdict == Verdict::Disoccluded, [1, 2].contains(&index));
        }
        // The stored sample has no depth: its history is rejected once more, then it is valid again.
        assert_eq!(rejected, [0, 1, 1, 0]);
    }
    Some(format!("wrs and smr: its pixel rejected in 2 frames, then kept; {} others: same bits", 64 * 48 - 1))
}

/// Sky in three conventions of depth, and orthographic depth.
pub fn sky_and_orthographic_depth(make: Make<'_>) -> Option<String> {
    let paper = |method: MethodKind| desc(Settings { method: method.into(), ..Settings::paper() });
    let [.., everywhere, around_a_gaze] = ungated_and_planned();
    for desc in METHODS.map(paper).into_iter().chain([everywhere, around_a_gaze]) {
        for (depth, sky, wall) in [
            (DepthConvention::Reversed { near: 0.1, far: f32::INFINITY }, 0.0, 0.05),
            (DepthConvention::Forward { near: 0.1, far: f32::INFINITY }, 1.0, 0.98),
            (DepthConvention::Linear, f32::INFINITY, 5.0),
            (DepthConvention::Orthographic { near: 0.0, far: 100.0 }, 1.0, 0.05),
        ] {
            let mut post = make(ContextDesc { depth, ..desc })?;
            let frame = |split| {
                let depth = Image::from_fn(SIZE, |[x, _]| if x < split { wall } else { sky });
                View { depth: Some(depth), ..still(noise(SIZE, "sky")) }
            };
            // The wall's edge moves to the left and back: sky replaces wall, then wall replaces sky.
            for (index, split, rejected) in [(0, 32, 0), (1, 32, 0), (2, 30, 2 * 48), (3, 32, 2 * 48), (4, 32, 0)] {
                let Made { stats, trace, .. } = post.step(index, &frame(split));
                // Planned frames find sky's history beside the first column that the wall leaves.
                let found = if is_planned(&desc) && rejected > 0 { 48 } else { 0 };
                let count = stats.rejected();
                assert!((rejected - found..=rejected).contains(&count), "{desc:?}, {depth:?}: {count}");
                let elsewhere = pixels(SIZE).filter(|[x, _]| !(30..32).contains(x));
                assert!(elsewhere.map(|px| pixel(&trace, px).verdict).all(|v| v != Verdict::Disoccluded));
            }
        }
    }
    Some("wrs, smr and planned, 3 skies and orthographic depth: the edge's 96 pixels rejected each way, no other of 3072".into())
}

/// Two surfaces that z-fight pixel by pixel.
pub fn z_fighting(make: Make<'_>) -> Option<String> {
    let (a, b) = ([0.25, 0.5, 0.75], [0.75, 0.25, 0.5]);
    // Reference: the same colors with constant depth. Both must be equal.
    let (mut post, mut plain) = (make(desc(Settings::paper()))?, make(desc(Settings::paper()))?);
    let mut draws = Draws::new("z-fighting");
    let mut oldest = 0;
    for index in 0..40 {
        let picks: Vec<bool> = (0..64 * 48).map(|_| draws.uniform() < 0.5).collect();
        let color = Image::from_pixels(SIZE, picks.iter().map(|&p| if p { a } else { b }).collect()).unwrap();
        let depth = picks.iter().map(|&p| if p { 3.0 } else { 3.0001 }).collect();
        let input = View { depth: Some(Image::from_pixels(SIZE, depth).unwrap()), ..still(color) };
        let Made { shown: out, stats, trace, .. } = post.step(index, &input);
        let expected = plain.step(index, &View { depth: None, ..input });
        assert_eq!((&out, &trace, stats.rejected()), (&expected.shown, &expected.trace, 0), "frame {index}");
        assert!(out.pixels().iter().all(|&c| c == a || c == b));
        oldest = trace.pixels().iter().map(|t| t.age).max().unwrap().max(oldest);
    }
    Some(format!("wrs, 40 frames: ages (to {oldest}) and colors as without depth, bit for bit; no third color"))
}
