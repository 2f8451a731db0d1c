//! What a frame looks like beside full rate, and beside its samples without memory.

use crate::room::{Hands, Room, encoded};
use afterimage_openxr::afterimage::gpu::{Afterimage, Frame};
use afterimage_openxr::afterimage::{
    ContextDesc, DepthConvention, Filter, Foveation, Lattice, Lattices, MethodKind, Settings,
};
use afterimage_openxr::wgpu::{self, TextureFormat, TextureUsages};
use afterimage_openxr::{Draw, Eye, Shown, Targets};

pub struct Measure {
    device: wgpu::Device,
    queue: wgpu::Queue,
}

pub struct Found {
    /// PSNR of both eyes against full rate.
    pub shown_db: f64,
    /// The same of the samples without memory.
    pub none_db: f64,
    pub drawn_percent: f64,
    /// Left and right eye: what is shown, without memory, full rate.
    pub sheet: image::RgbaImage,
}

/// Gray would do for PSNR; colors are for the eye.
type Pixels = Vec<[u8; 3]>;

impl Measure {
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        Self { device: device.clone(), queue: queue.clone() }
    }

    pub fn frame(
        &self,
        shown: &Shown<'_>,
        room: &Room,
        eyes: &[Eye; 2],
        hands: [Hands; 2],
    ) -> Result<Found, Box<dyn std::error::Error>> {
        let size = eyes[0].geometry.size_px();
        let images = [
            self.read(shown.output),
            self.read(&self.without_memory(shown, size)?),
            self.full_rate(room, eyes, hands)?,
        ];
        let samples =
            eyes.iter().flat_map(Eye::draws).map(|draw| u64::from(draw.viewport[2] * draw.viewport[3])).sum::<u64>();
        let mut sheet = image::RgbaImage::new(2 * size[0], 3 * size[1]);
        for (row, both) in (0..).zip(&images) {
            for (eye, pixels) in (0..).zip(both) {
                for (i, &[r, g, b]) in (0..).zip(pixels) {
                    let (x, y) = (i % size[0], i / size[0]);
                    sheet.put_pixel(eye * size[0] + x, row * size[1] + y, image::Rgba([r, g, b, 255]));
                }
            }
        }
        Ok(Found {
            shown_db: self.psnr(&images[0], &images[2], shown, eyes),
            none_db: self.psnr(&images[1], &images[2], shown, eyes),
            drawn_percent: 100.0 * samples as f64 / f64::from(2 * size[0] * size[1]),
            sheet,
        })
    }

    /// The same sparse frame, interpolated.
    fn without_memory(&self, shown: &Shown<'_>, size: [u32; 2]) -> Result<wgpu::Texture, Box<dyn std::error::Error>> {
        let foveation = Foveation { filter: Filter::Sparse, ..Foveation::default() };
        let desc = ContextDesc {
            view_count: 2,
            depth: DepthConvention::Reversed { near: 0.05, far: f32::INFINITY },
            settings: Settings { method: MethodKind::None.into(), foveation, ..Settings::default() },
            ..ContextDesc::new(size)
        };
        let mut none = Afterimage::new(&self.device, &desc, TextureFormat::Rgba16Float)?;
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
        let frame = Frame {
            depth: Some((&shown.targets.depth).into()),
            motion: Some((&shown.targets.motion).into()),
            ..Frame::new(&shown.targets.color, &shown.views, shown.index)
        };
        let mut encoder = self.device.create_command_encoder(&Default::default());
        none.record(&self.device, &mut encoder, &frame, &output)?;
        self.queue.submit([encoder.finish()]);
        Ok(output)
    }

    fn full_rate(
        &self,
        room: &Room,
        eyes: &[Eye; 2],
        hands: [Hands; 2],
    ) -> Result<[Pixels; 2], Box<dyn std::error::Error>> {
        let size = eyes[0].geometry.size_px();
        let targets = Targets::new(&self.device, size);
        let lattices = Lattices::new(&[Lattice::covering(1, [0, 0], size, [0, 0])])?.in_atlas().0;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        for eye in eyes {
            let draws: Vec<Draw> = Eye { lattices, jitter_px: [0.0; 2], ..*eye }.draws().collect();
            room.draw(&self.queue, &mut encoder, &targets, eye, &draws, hands);
        }
        self.queue.submit([encoder.finish()]);
        Ok(self.read(&targets.color))
    }

    /// Both layers of an `Rgba16Float` texture, sRGB-encoded.
    fn read(&self, texture: &wgpu::Texture) -> [Pixels; 2] {
        let [width, height] = [texture.width(), texture.height()];
        let row = (8 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(2 * row * height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: Some(height) };
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
        self.queue.submit([encoder.finish()]);
        buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device works");
        let bytes = buffer.slice(..).get_mapped_range().expect("mapped").to_vec();
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
