//! Output files of a frame.

use super::eyes::below;
use super::setup::Setup;
use super::{AovName, TonemapName, TraceArgs};
use crate::args::FormatName;
use crate::failure::Failure;
use crate::output::Output;
use afterimage::Image;
use afterimage::kernel::color::srgb_encode;
use afterimage_lab::picture::to_rgb8;
use afterimage_lab::source::exr_file;
use afterimage_lab::source::exr_file::FrameToWrite;
use afterimage_lab::view::View;
use afterimage_trace::surfaces::{self, Surfaces};

/// Depth of the background in files.
const BACKGROUND_M: f32 = 1e10;

/// A traced frame.
pub struct Picture {
    pub color: Image<[f32; 3]>,
    pub variance: Option<Image<[f32; 3]>>,
    pub lod: Image<f32>,
}

/// Folders of the images of an eye.
pub fn folders(args: &TraceArgs, eye: &str) -> Vec<String> {
    let mut folders = vec![below(eye, "color")];
    let names = [
        (AovName::Depth, "depth"),
        (AovName::Motion, "motion"),
        (AovName::Albedo, "albedo"),
        (AovName::Variance, "variance"),
        (AovName::Lod, "lod"),
    ];
    for (aov, name) in names {
        if args.aov.contains(&aov) {
            folders.push(below(eye, name));
        }
    }
    folders
}

/// Which frame, and how it is exposed.
pub struct Place<'a> {
    pub eye: &'a str,
    pub index: usize,
    pub exposure_ev: f32,
}

impl TraceArgs {
    /// Linear value that is white in the files: all but 1 with Reinhard's curve.
    pub fn white(&self) -> f64 {
        let default = if self.format == Some(FormatName::Exr) { TonemapName::None } else { TonemapName::Reinhard };
        match self.tonemap.unwrap_or(default) {
            TonemapName::Reinhard => 100.0,
            TonemapName::None => 1.0,
        }
    }
}

/// Writes the files of a frame of an eye, with its views in this frame and the previous one.
pub fn write(
    args: &TraceArgs,
    out: &Output,
    setup: &Setup,
    &Place { eye, index, exposure_ev }: &Place,
    picture: &Picture,
    [view, previous]: [&View; 2],
) -> Result<(), Failure> {
    let color = &picture.color;
    let wants = |aov| args.aov.contains(&aov);
    let mut depth = None;
    let mut motion = None;
    if wants(AovName::Depth) || wants(AovName::Motion) {
        let seen = Surfaces::trace(&setup.world, view, previous, setup.tracer.effects(&setup.world));
        depth = wants(AovName::Depth).then(|| seen.depth.map(|d| if d.is_finite() { d } else { BACKGROUND_M }));
        motion = wants(AovName::Motion).then_some(seen.motion);
    }
    let albedo = wants(AovName::Albedo).then(|| surfaces::albedo(&setup.world, view, &setup.settings));
    let scale = exposure_ev.exp2();
    let mapped = |name: Option<TonemapName>, default: TonemapName| {
        let reinhard = name.unwrap_or(default) == TonemapName::Reinhard;
        color.map(|c| c.map(|v| if reinhard { v * scale / (1.0 + v * scale) } else { v * scale }))
    };
    let wants_format = |format| args.format.is_none_or(|f| f == format);
    if wants_format(FormatName::Exr) {
        let color = mapped(args.tonemap, TonemapName::None);
        let (depth, motion, albedo) = (depth.as_ref(), motion.as_ref(), albedo.as_ref());
        let frame = FrameToWrite { depth, motion, albedo, ..FrameToWrite::color(&color) };
        let path = out.path(&below(eye, "color"), index, "exr");
        exr_file::write(&path, &frame).map_err(|e| Failure::writing(&path, e))?;
    }
    if wants_format(FormatName::Png) {
        let encoded = mapped(args.tonemap, TonemapName::Reinhard).map(|c| c.map(|v| srgb_encode(v.clamp(0.0, 1.0))));
        out.picture(&below(eye, "color"), index, &to_rgb8(&encoded))?;
    }
    let channels = |folder: &str, channels: &[(&str, &Image<f32>)]| {
        let path = out.path(&below(eye, folder), index, "exr");
        exr_file::write_channels(&path, channels).map_err(|e| Failure::writing(&path, e))
    };
    if let Some(depth) = &depth {
        channels("depth", &[("Z", depth)])?;
    }
    if let Some(motion) = &motion {
        channels("motion", &[("motion.X", &motion.map(|m| m[0])), ("motion.Y", &motion.map(|m| m[1]))])?;
    }
    let rgb = |folder: &str, image: &Image<[f32; 3]>| {
        let [r, g, b] = [0, 1, 2].map(|i| image.map(|v| v[i]));
        channels(folder, &[("R", &r), ("G", &g), ("B", &b)])
    };
    if let Some(albedo) = &albedo {
        rgb("albedo", albedo)?;
    }
    if wants(AovName::Lod) {
        channels("lod", &[("lod", &picture.lod)])?;
    }
    if wants(AovName::Variance)
        && let Some(variance) = &picture.variance
    {
        rgb("variance", variance)?;
    }
    Ok(())
}
