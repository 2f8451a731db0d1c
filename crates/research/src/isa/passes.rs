//! The passes of the methods, as the drop-in compiles them.

use super::failure::Result;
use afterimage::gpu::{Afterimage, Frame};
use afterimage::internal::{ContextDesc, Foveation, Method, MethodKind, Sampler, Settings, Smr, ViewFrame, Wrs};
use afterimage::kernel::quads::RUN_QUADS;
use afterimage::shader::{Composer, Module, SHADERS};
use afterimage::wgpu::{Device, DeviceDescriptor, Extent3d, TextureDescriptor, TextureDimension, TextureFormat};
use afterimage::{Gaze, ViewGeometry};

/// Size of the frames of the roofline.
pub const SIZE_PX: [u32; 2] = [3840, 2160];
/// Their horizontal field of view.
const FOV_DEG: f32 = 70.0;
/// Of frames that have albedo: "quads smr antialias" with it.
const ALBEDO: &str = "quads smr antialias albedo";
/// Bytes a pixel of albedo: of an input of 8 bits a channel, and of history, read and written.
const ALBEDO_BYTES: u32 = 4 + 4 + 4;
/// Passes that choose the quads to shade.
const PLAN: [&str; 5] =
    ["quad_key_pass", "quad_threshold_pass", "quad_mask_pass", "quad_around_pass", "quad_octants_pass"];

/// The copy that benches hold the passes against.
static COPY: &[Module] = &[Module {
    name: "copy_pass",
    path: "crates/tool/shaders/bench/copy_pass.wgsl",
    text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../tool/shaders/bench/copy_pass.wgsl")),
}];
static WITH_COPY: Composer = Composer::new(&[afterimage::shader::MODULES, COPY]);

/// What is run for a frame.
pub struct MethodPasses {
    pub name: &'static str,
    /// Bytes a pixel, read and written.
    pub bytes: u32,
    pub passes: Vec<Pass>,
}

/// A pipeline.
pub struct Pass {
    /// Method and shader module.
    pub name: String,
    pub text: String,
    pub overrides: Vec<(&'static str, u32)>,
    /// Pixels, texels or samples that it covers, for each pixel of the frame.
    pub share: f64,
    /// Of these, what an invocation takes.
    pub pixels: f64,
    /// Whether it chooses the quads to shade, before they are shaded.
    pub plans: bool,
    /// Its loops in the order of the code, by the names that `perf::rounds` knows.
    pub loops: &'static [&'static str],
}

/// All methods, on full frames, and on planned ones, as by default.
pub fn methods() -> Result<Vec<MethodPasses>> {
    let full = |method: MethodKind| Settings { method: method.into(), ..Settings::default() };
    let quads = |method: MethodKind| Settings { foveation: Foveation::quads(), ..full(method) };
    let noisy = |settings: Settings| Settings { noisy: true, ..settings };
    let antialias =
        |settings: Settings| Settings { method: Method::Smr(Smr { antialias: true, ..Smr::default() }), ..settings };
    [
        ("copy", full(MethodKind::Wrs)),
        ("none", full(MethodKind::None)),
        ("taa", full(MethodKind::Taa)),
        ("wrs", full(MethodKind::Wrs)),
        ("wrs weighted", Settings::weighted()),
        ("smr", full(MethodKind::Smr)),
        ("smr noisy", noisy(full(MethodKind::Smr))),
        ("quads smr", quads(MethodKind::Smr)),
        ("quads smr antialias", antialias(quads(MethodKind::Smr))),
        (ALBEDO, antialias(quads(MethodKind::Smr))),
        ("quads smr noisy", noisy(quads(MethodKind::Smr))),
        ("quads taau", quads(MethodKind::Taau)),
        ("quads wrs", quads(MethodKind::Wrs)),
    ]
    .into_iter()
    .map(|(name, settings)| method(name, &settings))
    .collect()
}

/// The pipelines for frames with depth and motion.
fn method(name: &'static str, settings: &Settings) -> Result<MethodPasses> {
    // A device without hardware takes all shaders, and does nothing with them.
    let (device, _queue) = Device::noop(&DeviceDescriptor::default());
    let has_albedo = name == ALBEDO;
    let desc = ContextDesc { settings: *settings, keep_alpha: false, has_albedo, ..ContextDesc::new([64, 64]) };
    let post = Afterimage::new(&device, &desc, TextureFormat::Rgba16Float)?;
    let image = |format| device.create_texture(&texture(desc.size_px, format));
    let [color, depth] = [TextureFormat::Rgba16Float, TextureFormat::R32Float].map(image);
    let [motion, albedo] = [TextureFormat::Rg32Float, TextureFormat::Rgba8Unorm].map(image);
    let views = [ViewFrame::new(ViewGeometry::flat(desc.size_px, FOV_DEG)?, Gaze::Lost)];
    let (depth, motion) = (Some((&depth).into()), Some((&motion).into()));
    let albedo = has_albedo.then_some((&albedo).into());
    post.prewarm(&device, &Frame { depth, motion, albedo, ..Frame::new(&color, &views, 0) }, &color);
    let pass = |(module, overrides): (&'static str, Vec<_>)| -> Result<Pass> {
        if name == "copy" {
            let text = WITH_COPY.compose("copy_pass").source;
            return Ok(Pass {
                name: name.to_owned(),
                text,
                overrides,
                share: 1.0,
                pixels: 1.0,
                plans: false,
                loops: &[],
            });
        }
        let of_candidates = if overrides.contains(&("CANDIDATES", 1)) { ", candidates" } else { "" };
        Ok(Pass {
            name: format!("{name}: {module}{of_candidates}"),
            text: SHADERS.compose(module).source,
            overrides,
            share: share(module, settings)?,
            pixels: pixels(module),
            plans: PLAN.contains(&module),
            loops: loops(module, settings),
        })
    };
    // Frames of which quads are shaded in part are few.
    let usual = |(_, overrides): &(&str, Vec<(&str, u32)>)| !overrides.contains(&("PARTIAL", 1));
    let mut passes: Vec<Pass> = post.pipelines().into_iter().filter(usual).map(pass).collect::<Result<_>>()?;
    // The table of compiled pipelines has no order of its own.
    passes.sort_by(|a, b| a.name.cmp(&b.name));
    let albedo_bytes = if has_albedo { ALBEDO_BYTES } else { 0 };
    Ok(MethodPasses { name, bytes: settings.traffic_bytes_per_pixel([true, true, false]) + albedo_bytes, passes })
}

fn texture([width, height]: [u32; 2], format: TextureFormat) -> TextureDescriptor<'static> {
    TextureDescriptor {
        label: None,
        size: Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format,
        usage: Afterimage::INPUT_USAGE,
        view_formats: &[],
    }
}

/// Pixels, texels or samples that an invocation takes.
fn pixels(module: &str) -> f64 {
    match module {
        "smr_pass" | "quad_around_pass" | "quad_octants_pass" | "quad_rectify_pass" => 4.0,
        // Four quads.
        "quad_key_pass" | "quad_blocks_pass" => 16.0,
        // A run of quads.
        "quad_mask_pass" => 4.0 * f64::from(RUN_QUADS),
        _ => 1.0,
    }
}

fn share(module: &str, settings: &Settings) -> Result<f64> {
    Ok(match module {
        // Texels of level 1.
        "candidate_pass" => 1.0 / 4.0,
        // Level 2 has a sixteenth of the pixels, the others a third of that.
        "mip_chain_pass" => 1.0 / 12.0,
        "quad_octants_pass" => shaded_shares(&settings.foveation).iter().sum(),
        // Quads of the fovea are not compared with history.
        "quad_observe_pass" | "quad_observe_albedo_pass" | "quad_rectify_pass" => shaded_shares(&settings.foveation)[1],
        // One workgroup.
        "quad_threshold_pass" => 64.0 / SIZE_PX.map(f64::from).iter().product::<f64>(),
        _ => 1.0,
    })
}

/// Shaded pixels for each pixel of such a view: in the fovea, and outside it.
fn shaded_shares(foveation: &Foveation) -> [f64; 2] {
    let [width, height] = SIZE_PX.map(f64::from);
    let per_tangent = 0.5 * width / (0.5 * f64::from(FOV_DEG)).to_radians().tan();
    let inside = |diameter_deg: f32| {
        let radius_px = per_tangent * (0.5 * f64::from(diameter_deg)).to_radians().tan();
        std::f64::consts::PI * radius_px * radius_px / (width * height)
    };
    let [fovea, middle] = [foveation.fovea_deg, foveation.mid_deg].map(inside);
    let even = |rate: u32| 4.0 / f64::from(rate * rate);
    // In the periphery a frame has every second block.
    let pattern = (middle - fovea) * even(foveation.rate_mid) + 0.5 * (1.0 - middle) * even(foveation.rate_far);
    [fovea, pattern + f64::from(foveation.budget)]
}

fn is_antialiased(settings: &Settings) -> bool {
    matches!(settings.method, Method::Smr(Smr { antialias: true, .. }))
}

fn loops(module: &str, settings: &Settings) -> &'static [&'static str] {
    match module {
        "wrs_pass" if matches!(settings.method, Method::Wrs(Wrs { sampler: Sampler::AChaoMean, .. })) => {
            &["slope", "guard", "resample"]
        }
        "wrs_pass" => &["slope"],
        "taau_pass" => &["slope", "guard", "resample", "around"],
        "quad_key_pass" if settings.noisy => &["four", "four", "four", "paths"],
        "quad_key_pass" if !matches!(settings.method, Method::Smr(_)) => &["four"],
        "quad_key_pass" => &["four", "four"],
        "quad_threshold_pass" => &["keys", "runs", "keys"],
        "quad_mask_pass" if settings.noisy => &["run", "paths", "list"],
        "quad_mask_pass" => &["run", "no paths", "list"],
        "quad_around_pass" | "quad_octants_pass" => &["rows"],
        "quad_observe_pass" | "quad_observe_albedo_pass" if is_antialiased(settings) => {
            &["no pixels", "pixel", "slope", "around"]
        }
        "quad_observe_pass" => &["no pixels", "pixel", "slope", "four"],
        "quad_blocks_pass" if settings.noisy => &[],
        "quad_blocks_pass" => &["four", "four", "runs", "four relit", "four relit", "runs relit"],
        "quad_rectify_pass" if settings.noisy => &["four", "four", "quads"],
        "quad_rectify_pass" => &["four", "four", "quads", "gains", "quads relit"],
        "quad_pass" if is_antialiased(settings) => &["four", "near", "slope", "around"],
        // The loop over the albedos beside a pixel is unrolled.
        "quad_albedo_pass" => &["four", "near", "slope", "around"],
        "quad_pass" if settings.noisy => &["four", "twelve", "slope", "four"],
        "quad_pass" => &["four", "slope", "four"],
        "wrs_quad_pass" => &["four"],
        "taa_pass" => &["slope", "guard", "resample", "around"],
        "smr_pass" if settings.noisy => &["block", "slope", "guard", "resample"],
        "smr_pass" => &["block", "slope", "guard", "resample", "relight"],
        _ => &[],
    }
}
