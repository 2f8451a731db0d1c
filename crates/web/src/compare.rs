//! The same frames on the device and on the CPU, value by value. Not in the page's library but in a second one, which
//! the page loads when somebody asks for the comparison.

use crate::gpu::Gpu;
use crate::{Demo, Result};
use afterimage::Image;
use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::internal::{ContextDesc, Method, Settings};
use wasm_bindgen::prelude::*;
use wgpu::Texture;

#[wasm_bindgen]
impl Demo {
    /// Makes `frames` frames, without memory and with it, on the device and on the CPU: numbers of values compared and
    /// of values that differ in any bit, and milliseconds a frame with memory of the CPU. The gaze wanders; history
    /// starts empty.
    ///
    /// # Errors
    /// On a lost device.
    pub async fn compare(&mut self, frames: u32) -> Result<Vec<f64>> {
        let (gpu, stage) = (&self.gpu, &mut self.stage);
        stage.restart(gpu)?;
        let desc = stage.desc();
        let [width, height] = desc.size_px.map(|s| s as f32);
        let mut cpu = CpuAfterimage::new(&desc)?;
        let settings = Settings { method: Method::None, ..desc.settings };
        let mut cpu_plain = CpuAfterimage::new(&ContextDesc { settings, ..desc })?;
        let (mut compared, mut different, mut ms) = (0_u32, 0_u32, 0.0);
        for index in 0..frames {
            let t = index as f32 / frames.max(2) as f32;
            let gaze_px = [width * (0.3 + 0.5 * t), height * (0.4 + 0.3 * t)];
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let inputs = stage.record(gpu, &mut encoder, gaze_px, t)?;
            gpu.queue.submit([encoder.finish()]);
            let color = image(gpu, &inputs.color, |c| [c[0], c[1], c[2]]).await?;
            let (depth, motion) = match &inputs.geometry {
                Some([depth, motion]) => {
                    (vec![image(gpu, depth, |c| c[0]).await?], vec![image(gpu, motion, |c| [c[0], c[1]]).await?])
                }
                None => (vec![], vec![]),
            };
            let (colors, depths, motions): (Vec<_>, Vec<_>, Vec<_>) =
                (vec![&color], depth.iter().collect(), motion.iter().collect());
            let frame = Frame {
                depth: inputs.geometry.is_some().then_some(&depths[..]),
                motion: inputs.geometry.is_some().then_some(&motions[..]),
                ..Frame::new(&colors, &inputs.views, index.into())
            };
            let black = || [Image::filled(desc.size_px, [0.0_f32; 3])];
            let ([mut expected, mut expected_plain], start) = ([black(), black()], js_sys::Date::now());
            let mask = match stage.is_planned() {
                true => Some(cpu.plan(&frame)?[0].map(f32::from)),
                false => None,
            };
            cpu.process(&frame, &mut expected)?;
            ms += js_sys::Date::now() - start;
            let mask: Vec<_> = mask.iter().collect();
            let plain = Frame { mask: stage.is_planned().then_some(&mask[..]), ..frame };
            cpu_plain.process(&plain, &mut expected_plain)?;
            for (texture, [expected]) in [(&stage.output, expected), (&stage.plain_output, expected_plain)] {
                let shown = gpu.read(texture).await?;
                for (got, expected) in shown.chunks_exact(4).zip(expected.pixels()) {
                    different += (0..3).map(|i| u32::from(got[i].to_bits() != expected[i].to_bits())).sum::<u32>();
                    compared += 3;
                }
            }
        }
        Ok(vec![compared.into(), different.into(), ms / f64::from(frames.max(1))])
    }
}

/// A texture as an image: `pixel` makes a pixel of a texel's channels.
async fn image<T: Copy>(gpu: &Gpu, texture: &Texture, pixel: impl Fn(&[f32]) -> T) -> Result<Image<T>> {
    let size = [texture.width(), texture.height()];
    let floats = gpu.read(texture).await?;
    let channels = floats.len() / (size[0] as usize * size[1] as usize);
    Ok(Image::from_pixels(size, floats.chunks_exact(channels).map(pixel).collect())?)
}
