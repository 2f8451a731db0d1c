//! Writes a frame as EXR, atomically.

use crate::whole_file::write_whole;
use afterimage::Image;
use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Layer, LayerAttributes, LineOrder, SmallVec,
    WritableImage, f16,
};
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;

/// Largest finite half float.
const HALF_MAX: f32 = 65504.0;

/// Sample format of color.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorFormat {
    /// 16 bit, values clamped to +-65504.
    #[default]
    Half,
    /// 32 bit.
    Float,
}

/// Images of a frame to write. All must have the size of the color.
#[derive(Clone, Copy, Debug)]
pub struct FrameToWrite<'a> {
    /// Linear color, written to `R`, `G`, `B`.
    pub color: &'a Image<[f32; 3]>,
    /// Sample format of `color`.
    pub format: ColorFormat,
    /// Depth along the view axis, written to `Z` as float.
    pub depth: Option<&'a Image<f32>>,
    /// Motion vectors in pixels, y down, previous minus current, written to `motion.X/Y` as float.
    pub motion: Option<&'a Image<[f32; 2]>>,
    /// Motion vectors in pixels, y down, next minus current, written to `motion.Z/W` as float.
    pub motion_to_next: Option<&'a Image<[f32; 2]>>,
    /// Albedo, written to `albedo.R/G/B` as half float.
    pub albedo: Option<&'a Image<[f32; 3]>>,
}

impl<'a> FrameToWrite<'a> {
    /// A frame of color alone, stored as half float.
    pub fn color(color: &'a Image<[f32; 3]>) -> Self {
        Self { color, format: ColorFormat::Half, depth: None, motion: None, motion_to_next: None, albedo: None }
    }
}

/// Writes a scan-line EXR with ZIP compression, atomically. The same frame gives the same bytes.
///
/// # Errors
/// If the images differ in size or are empty, or the file cannot be written.
pub fn write(path: &Path, frame: &FrameToWrite) -> io::Result<()> {
    let size = frame.color.size();
    let [motion, to_next] = [frame.motion, frame.motion_to_next].map(|motion| motion.map(Image::size));
    let others = [frame.depth.map(Image::size), motion, to_next, frame.albedo.map(Image::size)];
    if size.contains(&0) || others.into_iter().flatten().any(|s| s != size) {
        return Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "color, depth, motion and albedo must have one size of at least 1x1 pixels",
        ));
    }
    write_whole(path, |out| write_layer(out, size, channels(frame)))
}

/// Writes float channels as a scan-line EXR with ZIP compression, atomically.
///
/// # Errors
/// If they are empty or differ in size, or the file cannot be written.
pub fn write_channels(path: &Path, channels: &[(&str, &Image<f32>)]) -> io::Result<()> {
    let size = channels.first().map_or([0, 0], |(_, image)| image.size());
    if size.contains(&0) || channels.iter().any(|(_, image)| image.size() != size) {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "channels must have one size of at least 1x1 pixels"));
    }
    let channel =
        |(name, image): &(&str, &Image<f32>)| AnyChannel::new(*name, FlatSamples::F32(image.pixels().to_vec()));
    write_whole(path, |out| write_layer(out, size, channels.iter().map(channel).collect()))
}

fn write_layer(out: &mut BufWriter<File>, size: [u32; 2], channels: Vec<AnyChannel<FlatSamples>>) -> io::Result<()> {
    let [w, h] = size.map(|s| s as usize);
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: exr::image::Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let channels = AnyChannels::sort(SmallVec::from_vec(channels));
    let layer = Layer::new((w, h), LayerAttributes::default(), encoding, channels);
    exr::image::Image::from_layer(layer).write().to_buffered(out).map_err(|e| match e {
        exr::error::Error::Io(e) => e,
        other => io::Error::other(other.to_string()),
    })
}

fn channels(frame: &FrameToWrite) -> Vec<AnyChannel<FlatSamples>> {
    let mut channels = rgb(["R", "G", "B"], frame.color, frame.format);
    if let Some(albedo) = frame.albedo {
        channels.extend(rgb(["albedo.R", "albedo.G", "albedo.B"], albedo, ColorFormat::Half));
    }
    if let Some(depth) = frame.depth {
        let samples = FlatSamples::F32(depth.pixels().to_vec());
        channels.push(AnyChannel::new("Z", samples));
    }
    let pairs = [(frame.motion, ["motion.X", "motion.Y"]), (frame.motion_to_next, ["motion.Z", "motion.W"])];
    for (image, names) in pairs {
        for (i, name) in names.into_iter().enumerate() {
            if let Some(image) = image {
                let values = image.pixels().iter().map(|m| m[i]);
                channels.push(AnyChannel::new(name, FlatSamples::F32(values.collect())));
            }
        }
    }
    channels
}

fn rgb(names: [&str; 3], image: &Image<[f32; 3]>, format: ColorFormat) -> Vec<AnyChannel<FlatSamples>> {
    let channel = |(i, name): (usize, &str)| {
        let values = image.pixels().iter().map(|p| p[i]);
        let samples = match format {
            ColorFormat::Half => {
                FlatSamples::F16(values.map(|v| f16::from_f32(v.clamp(-HALF_MAX, HALF_MAX))).collect())
            }
            ColorFormat::Float => FlatSamples::F32(values.collect()),
        };
        AnyChannel::new(name, samples)
    };
    names.into_iter().enumerate().map(channel).collect()
}
