//! PSNR of each side in the periphery. Squared errors are summed on the device and read back a few frames later,
//! without a stall.

use super::device;
use super::measuring_pass::MeasuringPass;
use super::state::Side;
use afterimage::ViewGeometry;
use afterimage::wgpu::{self, Buffer, Texture};
use afterimage_lab::device::{Headless, mapped};
use afterimage_lab::metric::psnr_db;
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Eccentricity where the periphery begins, degrees, as in the reports.
const PERIPHERY_DEG: f32 = 7.5;
/// Pixels per workgroup, as in the shader.
const TILE: [u32; 2] = [64, 16];

/// `QualityConstants` in `shaders/view/view_quality.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct QualityConstants {
    /// Tangent of the ray's angle: change per pixel, and value at pixel (0, 0).
    ray_scale: [f32; 2],
    ray_offset: [f32; 2],
    /// Ray through the gaze.
    gaze_ray: [f32; 4],
    size: [u32; 2],
    /// Exposure factor, linear.
    gain: f32,
    /// Eccentricity beyond which errors count, degrees.
    from_deg: f32,
}

/// Viewing conditions: view geometry, gaze in pixels, exposure factor.
pub struct Viewing<'a> {
    pub geometry: &'a ViewGeometry,
    pub gaze_px: [f32; 2],
    pub gain: f32,
}

/// Measures the PSNR of both sides.
pub struct Quality {
    /// Sums the squared errors of tiles.
    pass: MeasuringPass,
    sides: [Readback; 2],
}

struct Readback {
    buffer: Buffer,
    /// Pending measurement: becomes `true` when the buffer is mapped.
    done: Option<Arc<AtomicBool>>,
}

impl Quality {
    /// Creates the pass for outputs of `size`.
    pub fn new(gpu: &Headless, size: [u32; 2]) -> Self {
        let bytes = 8 * [0, 1].map(|i| u64::from(size[i].div_ceil(TILE[i]))).iter().product::<u64>();
        let pass = MeasuringPass::new(gpu, "view_quality", bytes);
        let sides = [0, 1].map(|_| Readback { buffer: pass.readback(gpu, bytes), done: None });
        Self { pass, sides }
    }

    /// Starts to measure a side's output, unless a measurement of that side is pending.
    pub fn measure(&mut self, gpu: &Headless, side: Side, full: &Texture, shown: &Texture, viewing: &Viewing<'_>) {
        let readback = &mut self.sides[side as usize];
        if readback.done.is_some() {
            return;
        }
        let (ray_scale, ray_offset) = viewing.geometry.scale_offset();
        let size = viewing.geometry.size_px();
        let constants = QualityConstants {
            ray_scale,
            ray_offset,
            gaze_ray: Vec3::from(viewing.geometry.ray(viewing.gaze_px)).extend(0.0).to_array(),
            size,
            gain: viewing.gain,
            from_deg: PERIPHERY_DEG,
        };
        let workgroups = [size[0].div_ceil(TILE[0]), size[1].div_ceil(TILE[1]), 1];
        self.pass.run(gpu, &constants, &[full, shown], workgroups, &readback.buffer);
        readback.done = Some(device::map(&readback.buffer));
    }

    /// The PSNR of a side's periphery in dB, if a measurement has finished: `Some(None)` if the error is zero.
    pub fn take(&mut self, gpu: &Headless, side: Side) -> Option<Option<f64>> {
        let readback = &mut self.sides[side as usize];
        // `Viewer::frame` handles a lost device.
        let _ = gpu.device.poll(wgpu::PollType::Poll);
        readback.done.take_if(|done| done.load(Ordering::Acquire))?;
        let sums = mapped(&readback.buffer).map(|bytes| {
            let tiles = bytes.chunks_exact(8).map(bytemuck::pod_read_unaligned::<[f32; 2]>);
            tiles.fold([0.0, 0.0], |sum: [f64; 2], tile| [0, 1].map(|i| sum[i] + f64::from(tile[i])))
        });
        readback.buffer.unmap();
        let [squared, count] = sums?;
        (count > 0.0).then(|| psnr_db(squared / count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use afterimage::Image;
    use afterimage::kernel::color::srgb_encode;
    use afterimage::wgpu::{TextureFormat, TextureUsages};

    const SIZE: [u32; 2] = [150, 70];
    const GAIN: f32 = 1.5;

    fn pattern(seed: u32) -> Image<[f32; 3]> {
        let value = |x: u32, y: u32, c: u32| ((x * 31 + y * 57 + c * 91 + seed * 7) % 101) as f32 / 80.0 - 0.1;
        Image::from_fn(SIZE, |[x, y]| [0, 1, 2].map(|c| value(x, y, c)))
    }

    /// PSNR of the periphery in dB, computed on the CPU.
    fn expected_db(full: &Image<[f32; 3]>, shown: &Image<[f32; 3]>, viewing: &Viewing<'_>) -> f64 {
        let encode = |v: f32| f64::from(srgb_encode((v * GAIN).clamp(0.0, 1.0)));
        let (mut squared, mut count) = (0.0, 0.0);
        for (i, (f, s)) in full.pixels().iter().zip(shown.pixels()).enumerate() {
            let px = [i % SIZE[0] as usize, i / SIZE[0] as usize].map(|v| v as f32);
            if viewing.geometry.eccentricity_deg(px, viewing.gaze_px) > PERIPHERY_DEG {
                squared += (0..3).map(|c| (encode(s[c]) - encode(f[c])).powi(2)).sum::<f64>() / 3.0;
                count += 1.0;
            }
        }
        psnr_db(squared / count).unwrap()
    }

    #[test]
    fn the_device_adds_up_what_the_formula_says() {
        let Some(adapter) = afterimage_testing::gpu::adapter() else { return };
        let gpu = Headless::on(adapter, wgpu::Limits::default()).unwrap();
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let images = [pattern(0), pattern(1)];
        let textures = images.each_ref().map(|image| {
            let texture = gpu.texture(SIZE, 1, TextureFormat::Rgba32Float, usage);
            gpu.write_rgb(&texture, 0, image);
            texture
        });
        let geometry = ViewGeometry::flat(SIZE, 70.0).unwrap();
        let viewing = Viewing { geometry: &geometry, gaze_px: [40.0, 30.0], gain: GAIN };
        let mut quality = Quality::new(&gpu, SIZE);
        let mut measured = |shown: &Texture| {
            quality.measure(&gpu, Side::Right, &textures[0], shown, &viewing);
            gpu.wait();
            quality.take(&gpu, Side::Right)
        };
        let found = measured(&textures[1]).flatten().unwrap();
        let expected = expected_db(&images[0], &images[1], &viewing);
        println!("{found} dB, expected {expected}");
        assert!((found - expected).abs() < 1e-3, "{found} dB, expected {expected}");
        assert_eq!(measured(&textures[0]), Some(None), "no error has no PSNR");
    }
}
