//! What a frame looks like beside full rate, and beside its samples without memory.

use crate::room::{Hands, Room, encoded};
use afterimage_openxr::afterimage::gpu::{Afterimage, Frame};
use afterimage_openxr::afterimage::internal::{ContextDesc, Foveation, MethodKind, Reset, Settings, ViewFrame};
use afterimage_openxr::afterimage::{CreateError, DepthConvention, Gaze};
use afterimage_openxr::wgpu::{self, TextureFormat, TextureUsages};
use afterimage_openxr::{Eye, Shown, Targets};

pub struct Measure {
    device: wgpu::Device,
    queue: wgpu::Queue,
    foveation: Foveation,
    none: Option<Afterimage>,
}

pub struct Found {
    /// PSNR of both eyes against full rate.
    pub shown_db: f64,
    /// The same of the fovea and the even pattern, without memory.
    pub none_db: f64,
    pub shaded_percent: f64,
    /// Left and right eye: what is shown, without memory, full rate.
    pub sheet: image::RgbaImage,
}

/// Gray would do for PSNR; colors are for the eye.
type Pixels = Vec<[u8; 3]>;

impl Measure {
    /// `foveation`: that of the headset.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, foveation: Foveation) -> Self {
        Self { device: device.clone(), queue: queue.clone(), foveation, none: None }
    }

    pub fn frame(
        &mut self,
        shown: &Shown<'_>,
        room: &Room,
        eyes: &[Eye; 2],
        hands: [Hands; 2],
    ) -> Result<Found, Box<dyn std::error::Error>> {
        let size = eyes[0].geometry.size_px();
        let full = self.full_rate(room, eyes, hands);
        // A frame at half the size lacks the pixels that one without memory has.
        let color = if shown.is_half { &full } else { &shown.targets.color };
        let without_memory = self.without_memory(shown, eyes, color)?;
        let images = [self.read(shown.output), self.read(&without_memory), self.read(&full)];
        let mut sheet = image::RgbaImage::new(2 * size[0], 3 * size[1]);
        for (row, both) in (0..).zip(&images) {
            for (eye, pixels) in (0..).zip(both) {
                for (i, &[r, g, b]) in (0..).zip(pixels) {
                    let (x, y) = (i % size[0], i / size[0]);
                    sheet.put_pixel(eye * size[0] + x, row * size[1] + y, image::Rgba([r, g, b, 255]));
                }
            }
        }
        let pixels = if shown.is_half { 1 } else { 4 };
        Ok(Found {
            shown_db: self.psnr(&images[0], &images[2], shown, eyes),
            none_db: self.psnr(&images[1], &images[2], shown, eyes),
            shaded_percent: 100.0 * f64::from(pixels * self.quads(shown)) / f64::from(2 * size[0] * size[1]),
            sheet,
        })
    }

    /// The same frame without memory: interpolated between the fovea and the even pattern, which it has in common with
    /// the frame that was shown. `color`: with the pixels of both.
    fn without_memory(
        &mut self,
        shown: &Shown<'_>,
        eyes: &[Eye; 2],
        color: &wgpu::Texture,
    ) -> Result<wgpu::Texture, Box<dyn std::error::Error>> {
        let size = eyes[0].geometry.size_px();
        let mut none = match self.none.take().filter(|none| none.desc().size_px == size) {
            Some(none) => none,
            None => self.method_without_memory(size)?,
        };
        let output = self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("without memory"),
            usage: Afterimage::OUTPUT_USAGE | TextureUsages::COPY_SRC,
            size: shown.output.size(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: TextureFormat::Rgba16Float,
            view_formats: &[],
        });
        // A lost gaze is held by the headset alone.
        let views = [0, 1].map(|i| ViewFrame { gaze: Gaze::At { px: eyes[i].gaze_px }, ..shown.views[i] });
        let frame = Frame {
            depth: Some((&shown.targets.depth).into()),
            motion: Some((&shown.targets.motion).into()),
            reset: Reset::All,
            ..Frame::new(color, &views, shown.index)
        };
        let mut encoder = self.device.create_command_encoder(&Default::default());
        none.plan(&self.device, &mut encoder, &frame)?;
        none.record(&self.device, &mut encoder, &frame, &output)?;
        self.queue.submit([encoder.finish()]);
        self.none = Some(none);
        Ok(output)
    }

    fn method_without_memory(&self, size: [u32; 2]) -> Result<Afterimage, CreateError> {
        let settings = Settings { method: MethodKind::None.into(), foveation: self.foveation, ..Settings::default() };
        let desc = ContextDesc {
            view_count: 2,
            depth: DepthConvention::Reversed { near: 0.05, far: f32::INFINITY },
            settings,
            ..ContextDesc::new(size)
        };
        Afterimage::new(&self.device, &desc, TextureFormat::Rgba16Float)
    }

    fn full_rate(&self, room: &Room, eyes: &[Eye; 2], hands: [Hands; 2]) -> wgpu::Texture {
        let targets = Targets::new(&self.device, eyes[0].geometry.size_px());
        let mut encoder = self.device.create_command_encoder(&Default::default());
        for (eye, views) in eyes.iter().zip(&targets.views) {
            let eye = Eye {
                jittered_clip_from_world: eye.clip_from_world,
                jittered_clip_from_view: eye.clip_from_view,
                ..*eye
            };
            room.prepass(&self.queue, &mut encoder, views, &eye, hands);
            room.colors(&mut encoder, &eye, &views.color, &views.depth);
        }
        self.queue.submit([encoder.finish()]);
        targets.color
    }

    /// Number of quads that were shaded of both eyes.
    fn quads(&self, shown: &Shown<'_>) -> u32 {
        let of_eye = |list: &wgpu::Buffer| {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            let buffer = self.buffer(4);
            // Their number is at byte 28.
            encoder.copy_buffer_to_buffer(list, 28, &buffer, 0, 4);
            self.queue.submit([encoder.finish()]);
            let bytes = self.bytes(&buffer);
            u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
        };
        shown.lists.iter().map(|list| of_eye(list)).sum()
    }

    /// A buffer to read back.
    fn buffer(&self, size: u64) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        })
    }

    /// What was copied into such a buffer.
    fn bytes(&self, buffer: &wgpu::Buffer) -> Vec<u8> {
        buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device works");
        buffer.slice(..).get_mapped_range().expect("mapped").to_vec()
    }

    /// Both layers of an `Rgba16Float` texture, sRGB-encoded.
    fn read(&self, texture: &wgpu::Texture) -> [Pixels; 2] {
        let [width, height] = [texture.width(), texture.height()];
        let row = (8 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.buffer(u64::from(2 * row * height));
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: Some(height) };
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
        self.queue.submit([encoder.finish()]);
        let bytes = self.bytes(&buffer);
        [0, 1].map(|eye| {
            let rows = bytes.chunks_exact(row as usize).skip((eye * height) as usize).take(height as usize);
            let texels = rows.flat_map(|row| row[..8 * width as usize].chunks_exact(8));
            let channel = |texel: &[u8], i: usize| encoded(half(u16::from_le_bytes([texel[2 * i], texel[2 * i + 1]])));
            texels.map(|texel| [0, 1, 2].map(|i| channel(texel, i))).collect()
        })
    }

    /// Of what the lenses show.
    fn psnr(&self, a: &[Pixels; 2], b: &[Pixels; 2], shown: &Shown<'_>, eyes: &[Eye; 2]) -> f64 {
        let (mut squares, mut count) = (0.0, 0.0);
        for eye in 0..2 {
            let width = eyes[eye].geometry.size_px()[0];
            for (i, (a, b)) in (0..).zip(a[eye].iter().zip(&b[eye])) {
                let (x, y) = ((i % width) as f32, (i / width) as f32);
                let is_seen = shown.views[eye].visible_px.is_none_or(|[low, high]| {
                    [x, y, x + y, x - y].iter().zip(low.iter().zip(&high)).all(|(v, (low, high))| low <= v && v <= high)
                });
                if is_seen {
                    squares += (0..3).map(|k| (f64::from(a[k]) - f64::from(b[k])).powi(2)).sum::<f64>();
                    count += 3.0;
                }
            }
        }
        10.0 * (255.0 * 255.0 * count / squares).log10()
    }
}

/// A half of ordinary colors: finite, not negative.
fn half(word: u16) -> f32 {
    let (exponent, fraction) = (i32::from(word >> 10 & 31), f32::from(word & 1023) / 1024.0);
    if exponent == 0 { fraction * 2.0_f32.powi(-14) } else { (1.0 + fraction) * 2.0_f32.powi(exponent - 15) }
}
