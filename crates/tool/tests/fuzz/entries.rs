//! Entry points for untrusted bytes, and the oracle: each must give an error in one line, or a valid result. Shared by
//! the fuzzing targets and `tests/fuzz_replay.rs`.

#[path = "../../../lab/tests/common/sound_scene.rs"]
mod sound_scene;

use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::internal::{
    Bias, ContextDesc, DepthTest, Foveation, FoveationKind, Gate, GateMetric, GateScale, Method, Reset, Sampler,
    Settings, Smr, ViewFrame, Wrs,
};
use afterimage::{DepthConvention, Exposure, Gaze, Image, ViewGeometry};
use afterimage_cli::sweep::Plan;
use afterimage_lab::error::InputError;
use afterimage_lab::scanpath::{FrameGaze, GazeLogOptions, GazeMap, parse_csv, parse_gaze_log, write_csv};
use afterimage_lab::scene::camera_file::CameraFile;
use afterimage_lab::scene::{Scene, SceneLimits};
use afterimage_lab::source::{ReadLimits, SceneOptions};
use afterimage_lab::view::View;
use afterimage_trace::cpu::CpuTracer;
use afterimage_trace::film::Film;
use afterimage_trace::settings::TraceSettings;
use afterimage_trace::work::Spans;
use afterimage_trace::world::World;
use std::fs;
use std::path::PathBuf;

/// A kind of input, and its reader.
pub type Target = (&'static str, fn(&[u8]));

/// All kinds, named like their folders in `fixtures/fuzz`.
#[allow(dead_code, reason = "a fuzzing target uses one of them")]
pub const TARGETS: [Target; 7] = [
    ("scanpath", scanpath),
    ("exr", exr),
    ("png", png),
    ("gltf", gltf),
    ("camera", camera),
    ("plan", plan),
    ("settings", settings),
];

/// Small limits, so that inputs of a large claimed size take little time.
const IMAGES: ReadLimits = ReadLimits { max_pixels: 1 << 16 };
const SCENES: SceneLimits =
    SceneLimits { max_triangles: 2000, max_texels: 1 << 16, max_file_bytes: 1 << 20, max_json_bytes: 1 << 20 };

/// A scanpath (CSV), or an eye tracker's export.
pub fn scanpath(bytes: &[u8]) {
    let options = GazeLogOptions { screen_px: Some([64, 36]), ..GazeLogOptions::default() };
    if let Some(log) = sound(parse_gaze_log("fuzz.csv", bytes, &options)) {
        assert!(log.scanpath.samples().is_sorted_by(|a, b| a.t_s < b.t_s));
        assert!(log.warnings.iter().all(|warning| !warning.contains('\n')));
    }
    let Some(path) = sound(parse_csv("fuzz.csv", bytes)) else { return };
    let samples = path.samples();
    assert!(samples.iter().all(|s| s.t_s.is_finite()) && samples.is_sorted_by(|a, b| a.t_s < b.t_s));
    let mut text = Vec::new();
    write_csv(&path, &mut text).unwrap();
    let again = parse_csv("again.csv", &text).expect("what was written is read");
    assert_eq!(again.samples().len(), samples.len());
    let view = ViewGeometry::flat([64, 36], 70.0).unwrap();
    for map in [GazeMap::Fit, GazeMap::Angle] {
        let Some(gaze) = sound(FrameGaze::new(&path, &view, map, 0.0, 60.0)) else { continue };
        for index in [0, 1, gaze.frames() - 1, gaze.frames(), u64::MAX] {
            assert!(gaze.px(index).is_none_or(|px| px.iter().all(|v| v.is_finite())));
            assert!(gaze.age_s(index).is_none_or(|age| age >= 0.0));
        }
    }
}

/// An EXR file as a still.
pub fn exr(bytes: &[u8]) {
    image("exr", bytes);
}

/// A PNG file as a still.
pub fn png(bytes: &[u8]) {
    image("png", bytes);
}

fn image(extension: &str, bytes: &[u8]) {
    let file = file(extension, bytes);
    let opened = afterimage_lab::source::open(file.path(), &IMAGES, &SceneOptions::default());
    let Some(mut source) = sound(opened) else { return };
    let [width, height] = source.info().size;
    assert!(u64::from(width) * u64::from(height) <= IMAGES.max_pixels);
    let Some(frame) = sound(source.frame(0)) else { return };
    assert_eq!(frame.color.size(), [width, height]);
    assert!(frame.color.pixels().iter().flatten().all(|v| v.is_finite()));
}

/// A scene in a single file.
pub fn gltf(bytes: &[u8]) {
    let file = file(if bytes.starts_with(b"glTF") { "glb" } else { "gltf" }, bytes);
    let Some(scene) = sound(Scene::open(file.path(), &SCENES)) else { return };
    sound_scene::assert_sound(&scene);
    let mut world = World::new(&scene);
    world.pose(&scene, 0.5, 0.0);
    let size = [4, 3];
    let view = View::of_camera(&scene.framing_camera(4.0 / 3.0), size, None).unwrap();
    let mut film = Film::new(size);
    let work = Spans::uniform(size[0], 0..size[1], 0..1);
    CpuTracer::new(TraceSettings::default()).trace(&world, &view, 0, &work, &mut film);
    assert!(film.moments.pixels().iter().all(|m| m.mean.is_finite()), "a ray saw what is no number");
}

/// A camera path, or the cameras of a sequence.
pub fn camera(bytes: &[u8]) {
    let Some(camera) = sound(CameraFile::parse("fuzz.json", bytes)) else { return };
    for (index, time_s) in [(0, 0.0), (1, 0.1), (1000, 1e9), (u64::MAX, -1.0), (0, f64::NAN)] {
        let pose = camera.world_from_camera(index, time_s);
        assert!(pose.is_finite() && (pose.determinant().abs() - 1.0).abs() < 0.1, "{pose}");
    }
}

/// A plan of a sweep.
pub fn plan(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let mut plan = Plan::default();
    if sound(plan.add("fuzz.toml", text)).is_none() || sound(plan.check()).is_none() {
        return;
    }
    let combinations: usize = plan.grid.axes.iter().map(|a| a.values.len()).product();
    if combinations.saturating_mul(1 + plan.grid.switches.len()) < 256 {
        let points = plan.grid.points(&["in".into()], plan.seeds.min(2), |_, _| true, |_, _| true);
        assert!(points.iter().all(|p| !p.command(&plan.common).contains('\0')));
    }
}

/// Arbitrary settings, frames and history through every method: an error, or output without NaN or infinity.
pub fn settings(bytes: &[u8]) {
    let mut bits = Bits(bytes);
    let Ok(mut post) = CpuAfterimage::new(&ContextDesc { settings: bits.settings(), ..ContextDesc::new(SIZE) }) else {
        return;
    };
    let geometry = ViewGeometry::flat(SIZE, 60.0).unwrap();
    for index in 0..3 {
        let color = bits.image(|b| [b.float(), b.float(), b.float()]);
        let (depth, trust, lod) = (bits.image(Bits::float), bits.image(Bits::float), bits.image(Bits::float));
        let (motion, noise) = (bits.image(|b| [b.float(), b.float()]), bits.image(|b| [b.float(), b.float()]));
        let given = bits.word();
        let has = |bit: u32| given >> bit & 1 == 1;
        let gaze = if has(0) { Gaze::At { px: [bits.float(), bits.float()] } } else { Gaze::Lost };
        let row = |bits: &mut Bits| [0; 4].map(|_| bits.float());
        let previous_from_current = has(8).then(|| [0; 4].map(|_| row(&mut bits)));
        let jitter_px = if has(9) { [bits.float(), bits.float()] } else { [0.0; 2] };
        let depth_convention = has(10).then(|| DepthConvention::Reversed { near: bits.float(), far: bits.float() });
        let views =
            [ViewFrame { previous_from_current, jitter_px, depth: depth_convention, ..ViewFrame::new(geometry, gaze) }];
        let (color, depth, motion) = ([&color], [&depth], [&motion]);
        let (trust, lod, noise) = ([&trust], [&lod], [&noise]);
        let frame = Frame {
            depth: has(1).then_some(&depth),
            motion: has(2).then_some(&motion),
            trust: has(3).then_some(&trust),
            reactive: has(11).then_some(&trust),
            lod: has(4).then_some(&lod),
            noise: post.desc().settings.noisy.then_some(&noise),
            reset: if has(5) { Reset::All } else { Reset::None },
            exposure: match [has(6), has(12)] {
                [true, _] => Exposure::Changed { ratio: bits.float() },
                [_, true] => Exposure::Scene { exposure: bits.float() },
                _ => Exposure::Same,
            },
            ..Frame::new(&color, &views, index)
        };
        let mut shown = [Image::filled(SIZE, [f32::NAN; 3])];
        if let Err(refused) = post.process(&frame, &mut shown) {
            assert!(!refused.to_string().contains('\n'));
            continue;
        }
        assert!(shown[0].pixels().iter().flatten().all(|v| v.is_finite()), "{:?}", post.desc().settings);
        if has(7) && matches!(post.desc().settings.method, Method::Wrs(_)) {
            let words: Vec<_> = (0..SIZE[0] * SIZE[1]).map(|_| [bits.word(), bits.word(), bits.word()]).collect();
            post.restore_history(&words);
        }
    }
}

const SIZE: [u32; 2] = [5, 3];

/// Reads bytes as words; zeros after the end.
struct Bits<'a>(&'a [u8]);

impl Bits<'_> {
    fn word(&mut self) -> u32 {
        let (now, rest) = self.0.split_at(self.0.len().min(4));
        self.0 = rest;
        let mut word = [0; 4];
        word[..now.len()].copy_from_slice(now);
        u32::from_le_bytes(word)
    }

    fn float(&mut self) -> f32 {
        f32::from_bits(self.word())
    }

    /// A number in the range, or arbitrary bits.
    fn around(&mut self, low: f32, high: f32) -> f32 {
        let word = self.word();
        if word & 7 == 0 { self.float() } else { low + (high - low) * ((word >> 8) as f32 / 16_777_215.0) }
    }

    fn image<T: Copy>(&mut self, mut pixel: impl FnMut(&mut Self) -> T) -> Image<T> {
        let pixels = (0..SIZE[0] * SIZE[1]).map(|_| pixel(self)).collect();
        Image::from_pixels(SIZE, pixels).unwrap()
    }

    fn settings(&mut self) -> Settings {
        let pick = self.word();
        let foveation = Foveation {
            kind: [FoveationKind::Mip, FoveationKind::Gauss, FoveationKind::Block, FoveationKind::Off]
                [(pick >> 2 & 3) as usize],
            fovea_deg: self.around(0.0, 20.0),
            mid_deg: self.around(20.0, 60.0),
            blend_deg: self.around(0.0, 10.0),
            rate_mid: 1 << (pick >> 4 & 3),
            rate_far: 1 << (pick >> 6 & 7),
            budget: 0.025,
            single_pixels: false,
        };
        let smr = Smr {
            accumulate: self.around(0.0, 0.98),
            tolerance: self.around(0.1, 10.0),
            relight: pick >> 9 & 1 == 1,
            antialias: pick >> 31 & 1 == 1,
        };
        let wrs = self.wrs(pick);
        Settings {
            method: [Method::None, Method::Taa, Method::Smr(smr), Method::Wrs(wrs)][(pick & 3) as usize],
            foveation,
            depth_test: (pick >> 15 & 1 == 1)
                .then(|| DepthTest { relative: self.around(1e-4, 0.999), slope_px: self.around(0.0, 64.0) }),
            noisy: pick >> 16 & 1 == 1,
            seed: u64::from(pick),
        }
    }

    fn wrs(&mut self, pick: u32) -> Wrs {
        Wrs {
            sampler: match (pick >> 10 & 1, pick >> 17 & 1) {
                (1, _) => Sampler::AEs,
                (_, 1) => Sampler::AChaoMean,
                _ => Sampler::AChao,
            },
            weight_exponent: pick >> 18 & 15,
            rate_exponent: pick >> 23 & 7,
            bias: match pick >> 11 & 3 {
                0 => Bias::None,
                1 => Bias::Exponential { lambda: self.around(0.0, 80.0) },
                _ => Bias::Bernoulli,
            },
            gate: (pick >> 13 & 1 == 1).then(|| Gate {
                metric: if pick >> 14 & 1 == 1 { GateMetric::Lightness } else { GateMetric::DeltaE94 },
                scale: if pick >> 22 & 1 == 1 { GateScale::Candidate } else { GateScale::Sample },
                divisor: self.around(1e-3, 200.0),
                offset: self.around(0.0, 50.0),
            }),
        }
    }
}

/// The result of a reader. Checks that an error is one line with a remedy.
fn sound<T>(read: Result<T, InputError>) -> Option<T> {
    match read {
        Ok(read) => Some(read),
        Err(refused) => {
            let text = refused.to_string();
            assert!(!text.contains('\n') && !refused.message().remedy.is_empty(), "{text:?}");
            None
        }
    }
}

/// A file in a folder of its own, which is removed when this is dropped.
struct Written {
    folder: PathBuf,
    path: PathBuf,
}

impl Drop for Written {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.folder);
    }
}

impl Written {
    fn path(&self) -> &str {
        self.path.to_str().expect("a path in UTF-8")
    }
}

/// Writes the bytes to a file, in memory where the system supports it. Tests of a program run on threads, each with a
/// folder of its own.
fn file(extension: &str, bytes: &[u8]) -> Written {
    let memory = PathBuf::from("/dev/shm");
    let place = if memory.is_dir() { memory } else { std::env::temp_dir() };
    let folder = place.join(format!("afterimage-fuzz-{}-{:?}", std::process::id(), std::thread::current().id()));
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("fuzz.{extension}"));
    fs::write(&path, bytes).unwrap();
    Written { folder, path }
}
