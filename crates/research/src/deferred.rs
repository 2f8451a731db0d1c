//! Times of whole frames: forward and deferred, full rate with taa, and planned with smr and albedo.
//!
//! Medians of CPU time of the process on software Vulkan, otherwise of the device's time, over frames that all ways
//! take in turn: of the geometry (depth and motion, or the G-buffer), the albedo, the light, and the method with its
//! plan.
//!
//! `cargo research deferred SCENE`
//!
//! Makes the table of deferred frames in `docs/equal-time.md`.

use crate::error::AnyError;
use afterimage::gpu::{Afterimage, Frame, Target};
use afterimage::internal::{ContextDesc, Foveation, Method, Settings, Smr, ViewFrame};
use afterimage::wgpu::{CommandEncoder, Texture, TextureFormat, TextureUsages};
use afterimage::{DepthConvention, FrameError, Gaze};
use afterimage_cli::args::parse_size;
use afterimage_lab::clock::Quartiles;
use afterimage_lab::device::{Backend, Headless, SpanClock};
use afterimage_lab::frame::OnDevice;
use afterimage_lab::raster::Shading;
use afterimage_lab::scene::builtin::courtyard_of;
use afterimage_lab::scene::{Pose, PunctualKind, PunctualLight, Scene};
use afterimage_lab::source::{
    FrameRequest, RasterSource, ReadLimits, SceneCamera, SceneChoice, SceneOptions, ViewedScene, Wanted,
};
use clap::Args;
use glam::{Vec3, vec3};
use std::sync::Arc;

/// Frames before the first that is timed: pipelines compile, histories fill.
const WARM_UP: u64 = 6;
/// Horizontal field of view, degrees.
const HFOV_DEG: f32 = 40.0;

/// One way to draw frames.
struct Way {
    name: &'static str,
    source: RasterSource,
    post: Afterimage,
    output: Texture,
    is_planned: bool,
    /// Milliseconds of geometry, albedo, light and method, frame by frame.
    took_ms: [Vec<f64>; 4],
    /// Share of the pixels that were shaded in the last frame.
    share: f64,
}

struct Rig {
    gpu: Arc<Headless>,
    clock: SpanClock,
    shadow_maps: u32,
}

impl Rig {
    /// Records and submits work; its result, and its time in milliseconds.
    fn timed<T>(&self, record: impl FnOnce(&mut CommandEncoder) -> T) -> (T, f64) {
        let (result, took) = self.clock.time(|| {
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            let recorded = record(&mut encoder);
            self.gpu.queue.submit([encoder.finish()]);
            recorded
        });
        (result, took.device_ms.or(took.cpu_ms).unwrap_or(took.wall_ms))
    }
}

impl Way {
    fn new(name: &'static str, source: RasterSource, gpu: &Headless, is_planned: bool) -> Result<Self, AnyError> {
        let size = source.views(0).0[0].geometry().size_px();
        let foveation = Foveation { fovea_deg: 4.0, budget: 0.0, ..Settings::screen().foveation };
        let smr = Method::Smr(Smr { antialias: true, ..Smr::default() });
        let (method, foveation) = if is_planned { (smr, foveation) } else { (Method::Taa, Foveation::default()) };
        let settings = Settings { method, foveation, ..Settings::default() };
        let depth = DepthConvention::Reversed { near: source.near(), far: f32::INFINITY };
        let desc = ContextDesc { settings, depth, has_albedo: is_planned, keep_alpha: false, ..ContextDesc::new(size) };
        let format = TextureFormat::Rgba16Float;
        let post = Afterimage::new(&gpu.device, &desc, format)?;
        let output = gpu.texture(size, 1, format, TextureUsages::STORAGE_BINDING);
        Ok(Self { name, source, post, output, is_planned, took_ms: Default::default(), share: 1.0 })
    }

    /// Draws and processes a frame; milliseconds of its parts.
    fn draw(&mut self, rig: &Rig, index: u64) -> Result<[f64; 4], AnyError> {
        let jitter_px = Foveation::jitter_px(index + 1);
        let views = self.source.views(index).0;
        let size = views[0].geometry().size_px();
        let gaze = Gaze::At { px: size.map(|side| 0.5 * (side as f32 - 1.0)) };
        let previous_from_current = Some(views[0].previous_from_current(&views[1]));
        let view = ViewFrame { jitter_px, previous_from_current, ..ViewFrame::new(*views[0].geometry(), gaze) };
        let ((), shadows_ms) = rig.timed(|encoder| {
            (0..rig.shadow_maps).for_each(|_| self.source.record_shadows(encoder, index));
        });
        let took = if self.is_planned {
            self.planned(rig, index, jitter_px, &view)?
        } else {
            let (drawn, light_ms) = rig.timed(|encoder| self.source.record_points(encoder, index, jitter_px));
            let (depth, motion) = (Some((&drawn.depth).into()), Some((&drawn.motion).into()));
            let frame = Frame { depth, motion, ..Frame::new(&drawn.color, std::slice::from_ref(&view), index) };
            [0.0, 0.0, light_ms, self.process(rig, &frame)?]
        };
        Ok([took[0] + shadows_ms, took[1], took[2], took[3]])
    }

    fn planned(&mut self, rig: &Rig, index: u64, jitter_px: [f32; 2], view: &ViewFrame) -> Result<[f64; 4], AnyError> {
        let wanted = Wanted::Surfaces;
        let request =
            FrameRequest { wanted, jitter_px: Some(jitter_px), reference: false, ..FrameRequest::full_rate(index) };
        let (content, geometry_ms) = rig.timed(|encoder| self.source.record(encoder, &request));
        let Some(OnDevice::Surfaces(drawn)) = OnDevice::of(&content.content) else {
            return Err("surfaces are on the device".into());
        };
        let (albedo, albedo_ms) = rig.timed(|encoder| self.source.record_albedo(encoder, index, jitter_px));
        let frame = Frame {
            depth: Some((&drawn.depth).into()),
            motion: Some((&drawn.motion).into()),
            albedo: Some((&albedo).into()),
            ..Frame::new(&drawn.color, std::slice::from_ref(view), index)
        };
        let (planned, plan_ms) = rig.timed(|encoder| self.post.plan(&rig.gpu.device, encoder, &frame));
        planned?;
        let list = self.post.quad_list(0).ok_or("the frame is planned")?;
        let (color, light_ms) = rig.timed(|encoder| self.source.record_quads(encoder, index, jitter_px, list));
        let masks = rig.gpu.read::<u32>(self.post.quad_mask().ok_or("the frame is planned")?, 0);
        let chosen: u32 = masks.pixels().iter().map(|mask| (mask & 15).count_ones()).sum();
        self.share = f64::from(chosen) / (4 * masks.pixels().len()) as f64;
        let smr_ms = self.process(rig, &Frame { color: (&color).into(), ..frame })?;
        Ok([geometry_ms, albedo_ms, light_ms, plan_ms + smr_ms])
    }

    fn process(&mut self, rig: &Rig, frame: &Frame<'_>) -> Result<f64, AnyError> {
        let record = |encoder: &mut CommandEncoder| -> Result<(), FrameError> {
            self.post.record(&rig.gpu.device, encoder, frame, Target::new(&self.output)).map(|_| ())
        };
        let (processed, took_ms) = rig.timed(record);
        processed?;
        rig.gpu.check()?;
        Ok(took_ms)
    }

    /// Medians of the parts, and of the whole frame.
    fn medians_ms(&self) -> [f64; 5] {
        let median = |times: &[f64]| Quartiles::of(times).map_or(f64::NAN, |q| q.median);
        let whole: Vec<f64> =
            (0..self.took_ms[0].len()).map(|i| self.took_ms.iter().map(|part| part[i]).sum()).collect();
        let [geometry, albedo, light, method] = self.took_ms.each_ref().map(|part| median(part));
        [geometry, albedo, light, method, median(&whole)]
    }
}

/// The courtyard of so many triangles, with a sun.
fn sunny_courtyard(triangles: u32) -> Result<Scene, AnyError> {
    let scene = courtyard_of(triangles);
    let sun = PunctualLight {
        kind: PunctualKind::Directional,
        position: Vec3::ZERO,
        direction: vec3(-0.35, -0.87, -0.35).normalize(),
        intensity: [3.6, 3.3, 2.9],
        range: f32::INFINITY,
    };
    let lights = vec![sun];
    let pose = Pose { lights, ..Pose::default() };
    let (materials, environment) = (scene.materials.clone(), scene.environment.clone());
    Ok(Scene::from_parts(&scene.name, materials, scene.still().clone(), pose, environment)?)
}

/// Times of whole frames: forward and deferred, full rate with taa, and planned with smr and albedo
#[derive(Args, Clone, Debug)]
pub struct DeferredArgs {
    /// Scene, as for `afterimage run`
    pub scene: String,
    /// Camera of the scene, as for `afterimage run`
    #[arg(long, value_name = "NAME|FILE.json", default_value = "walk")]
    pub camera: String,
    /// Size of a frame, pixels
    #[arg(long, value_parser = parse_size, value_name = "WxH", default_value = "640x360")]
    pub size: [u32; 2],
    /// Frames that are timed
    #[arg(long, value_name = "N", default_value_t = 24, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub frames: u64,
    /// builtin:courtyard of so many triangles, with a sun besides its lanterns, in place of the scene
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub triangles: u32,
    /// How often more the sun's map is drawn in each frame, as by a renderer whose scene moves; part of the geometry
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub shadow_maps: u32,
}

pub fn bench(args: &DeferredArgs) -> Result<(), AnyError> {
    let (size, triangles) = (args.size, args.triangles);
    let gpu = Headless::find_roomy(true).ok_or("no device")?;
    let scene = if triangles > 0 {
        let scene = sunny_courtyard(triangles)?;
        let camera = SceneCamera::choose(&scene, Some(&args.camera), size, Some(HFOV_DEG))?;
        ViewedScene::new(scene, camera, None)?
    } else {
        let options = SceneOptions { size: Some(size), hfov_deg: Some(HFOV_DEG), fps: Some(60.0) };
        let limits = ReadLimits::from_megapixels(64);
        ViewedScene::open(&SceneChoice {
            camera: Some(&args.camera),
            options,
            limits,
            ..SceneChoice::new(&args.scene)
        })?
    };
    let rig =
        Rig { clock: SpanClock::new(&Backend::Gpu(gpu.clone())), gpu: gpu.clone(), shadow_maps: args.shadow_maps };
    let way = |name, shading, is_planned| Way::new(name, scene.shaded_on(gpu.clone(), shading)?, &gpu, is_planned);
    let mut ways = vec![
        way("full rate, forward, taa", Shading::Forward, false)?,
        way("full rate, deferred, taa", Shading::Deferred, false)?,
        way("planned, forward, smr, albedo", Shading::Forward, true)?,
        way("planned, deferred, smr, albedo", Shading::Deferred, true)?,
    ];
    for index in 0..WARM_UP + args.frames {
        for way in &mut ways {
            let took_ms = way.draw(&rig, index)?;
            if index >= WARM_UP {
                way.took_ms.iter_mut().zip(took_ms).for_each(|(part, ms)| part.push(ms));
            }
        }
    }
    say!("{} triangles", scene.scene.still().len());
    say!("| frames | shaded, % | geometry | albedo | light | method | whole, ms | over forward | over deferred |");
    say!("|---|---|---|---|---|---|---|---|---|");
    let wholes: Vec<f64> = ways.iter().map(|way| way.medians_ms()[4]).collect();
    for way in &ways {
        let [geometry, albedo, light, method, whole] = way.medians_ms();
        say!(
            "| {} | {:.1} | {geometry:.1} | {albedo:.1} | {light:.1} | {method:.1} | {whole:.1} | {:.2} | {:.2} |",
            way.name,
            100.0 * way.share,
            whole / wholes[0],
            whole / wholes[1]
        );
    }
    Ok(())
}
