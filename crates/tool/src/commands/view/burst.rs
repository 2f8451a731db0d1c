//! Bursts of consecutive frames: what both sides show, and the full-rate frame. The device packs their luminance, which
//! is read back a few frames later, without a stall.

use super::measuring_pass::MeasuringPass;
use afterimage::wgpu::{self, Buffer, Texture};
use afterimage::{Image, ViewGeometry};
use afterimage_lab::device::{Headless, mapped};
use bytemuck::{Pod, Zeroable};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Length of a burst.
const LENGTH: Duration = Duration::from_millis(500);
/// Memory at which a burst ends earlier, bytes.
const MAX_BYTES: u64 = 256 << 20;
/// The full-rate frame and two sides.
const MAX_PICTURES: usize = 3;
/// Pixels in a word of the packed luminance.
const WORD_PX: u32 = 4;
/// Words of a row that a workgroup packs, as in the shader.
const TILE_WORDS: u32 = 64;

/// `LuminanceConstants` in `shaders/view/view_luminance.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct LuminanceConstants {
    size: [u32; 2],
    /// Exposure factor, linear.
    gain: f32,
    padding: u32,
}

/// Consecutive frames.
pub struct Burst {
    pub geometry: ViewGeometry,
    /// Mean rate at which the frames were shown.
    pub fps: f32,
    pub frames: Vec<BurstFrame>,
}

/// A frame of a burst.
pub struct BurstFrame {
    pub gaze_px: [f32; 2],
    /// Packed luminance of the pictures.
    packed: Buffer,
}

impl BurstFrame {
    /// The full-rate frame, then what each side shows: gray, sRGB-encoded. `None` if the device is lost.
    pub fn pictures(&self, size: [u32; 2]) -> Option<Vec<Image<[f32; 3]>>> {
        let row_bytes = row_words(size) as usize * 4;
        let bytes = mapped(&self.packed)?;
        let picture = |bytes: &[u8]| {
            Image::from_fn(size, |[x, y]| [f32::from(bytes[y as usize * row_bytes + x as usize]) / 255.0; 3])
        };
        Some(bytes.chunks_exact(row_bytes * size[1] as usize).map(picture).collect())
    }
}

fn row_words(size: [u32; 2]) -> u32 {
    size[0].div_ceil(WORD_PX)
}

/// Bytes of packed pictures.
fn packed_bytes(size: [u32; 2], pictures: usize) -> u64 {
    4 * u64::from(row_words(size)) * u64::from(size[1]) * pictures as u64
}

/// Records bursts.
pub struct BurstRecorder {
    geometry: ViewGeometry,
    /// Packs the luminance of one frame's pictures.
    pass: MeasuringPass,
    frames: Vec<BurstFrame>,
    /// Times of the first and the last frame.
    span: Option<[Instant; 2]>,
    /// Number of frames that have been read back.
    arrived: Arc<AtomicUsize>,
}

impl BurstRecorder {
    pub fn new(gpu: &Headless, geometry: ViewGeometry) -> Self {
        let pass = MeasuringPass::new(gpu, "view_luminance", packed_bytes(geometry.size_px(), MAX_PICTURES));
        Self { geometry, pass, frames: vec![], span: None, arrived: Arc::default() }
    }

    /// Adds the frame that is shown now, unless the burst is complete.
    pub fn push(&mut self, gpu: &Headless, full: &Texture, sides: &[&Texture], gaze_px: [f32; 2], gain: f32) {
        if self.is_complete() {
            return;
        }
        let size = self.geometry.size_px();
        let packed = self.pass.readback(gpu, packed_bytes(size, 1 + sides.len()));
        let constants = LuminanceConstants { size, gain, padding: 0 };
        let workgroups = [row_words(size).div_ceil(TILE_WORDS), size[1], 1 + sides.len() as u32];
        self.pass.run(gpu, &constants, &[full, sides[0], sides[sides.len() - 1]], workgroups, &packed);
        let arrived = self.arrived.clone();
        packed.map_async(wgpu::MapMode::Read, .., move |r| _ = arrived.fetch_add(r.is_ok().into(), Ordering::Release));
        // A software device would take this work for that of the next pass that is timed.
        if gpu.is_software() {
            gpu.wait();
        }
        self.frames.push(BurstFrame { gaze_px, packed });
        let now = Instant::now();
        self.span = Some([self.span.map_or(now, |[first, _]| first), now]);
    }

    fn seconds(&self) -> f32 {
        self.span.map_or(0.0, |[first, last]| (last - first).as_secs_f32())
    }

    fn is_complete(&self) -> bool {
        let bytes: u64 = self.frames.iter().map(|frame| frame.packed.size()).sum();
        self.frames.len() > 1 && (self.seconds() >= LENGTH.as_secs_f32() || bytes >= MAX_BYTES)
    }

    /// Drops the burst: the next frame does not follow the last.
    pub fn clear(&mut self) {
        self.frames.clear();
        self.span = None;
        // Callbacks of earlier buffers count elsewhere.
        self.arrived = Arc::default();
    }

    /// The burst, once it is complete and read back.
    pub fn take(&mut self, gpu: &Headless) -> Option<Burst> {
        // `Viewer::frame` handles a lost device.
        let _ = gpu.device.poll(wgpu::PollType::Poll);
        if !self.is_complete() || self.arrived.load(Ordering::Acquire) < self.frames.len() {
            return None;
        }
        let fps = (self.frames.len() - 1) as f32 / self.seconds();
        let burst = Burst { geometry: self.geometry, fps, frames: std::mem::take(&mut self.frames) };
        self.clear();
        Some(burst)
    }
}
