//! Fall back to the CPU on a machine without a GPU. Both give the same image.
//!
//! `cargo run -p afterimage-lab --example 05_cpu_fallback`; writes `out/05_cpu_fallback.png`

use afterimage::cpu::{self, CpuAfterimage};
use afterimage::gpu::{self, Afterimage};
use afterimage::internal::{ContextDesc, Foveation, Pyramid, Settings, ViewFrame};
use afterimage::wgpu::{Texture, TextureFormat, TextureUsages};
use afterimage::{FrameError, Gaze, Image, ViewGeometry};
use afterimage_lab::device::Headless;
use afterimage_lab::metric::encode;
use afterimage_lab::picture::{to_rgb8, write_png};
use afterimage_lab::source::{AnalyticSource, FrameSource};
use std::sync::Arc;

const SIZE: [u32; 2] = [320, 180];

/// The post-process on the GPU or the CPU.
enum Post {
    Gpu { gpu: Arc<Headless>, post: Box<Afterimage>, color: Texture, output: Texture },
    Cpu(Box<CpuAfterimage>),
}

impl Post {
    fn new(gpu: Option<Arc<Headless>>, settings: Settings) -> Result<Self, Box<dyn std::error::Error>> {
        let desc = ContextDesc { settings, ..ContextDesc::new(SIZE) };
        let Some(gpu) = gpu else {
            return Ok(Self::Cpu(Box::new(CpuAfterimage::new(&desc)?)));
        };
        let texture = |usage| gpu.texture(SIZE, 1, TextureFormat::Rgba32Float, usage);
        Ok(Self::Gpu {
            post: Box::new(Afterimage::new(&gpu.device, &desc, TextureFormat::Rgba32Float)?),
            color: texture(TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST),
            output: texture(TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC),
            gpu,
        })
    }

    fn show(&mut self, index: u64, color: &Image<[f32; 3]>, view: ViewFrame) -> Result<Image<[f32; 3]>, FrameError> {
        match self {
            Self::Cpu(post) => {
                let mut shown = [Image::filled(SIZE, [0.0; 3])];
                post.process(&cpu::Frame::new(&[color], &[view], index), &mut shown)?;
                let [shown] = shown;
                Ok(shown)
            }
            Self::Gpu { gpu, post, color: input, output } => {
                gpu.write_rgb(input, 0, color);
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                post.record(&gpu.device, &mut encoder, &gpu::Frame::new(&*input, &[view], index), &*output)?;
                gpu.queue.submit([encoder.finish()]);
                Ok(gpu.read_rgb(output, 0))
            }
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Skip software adapters: the CPU executor needs no driver.
    let gpu = Headless::find(false);
    println!("chosen: {}", gpu.as_ref().map_or("the CPU", |g| &g.info.name));
    let settings = Settings::default();
    let mut chosen = Post::new(gpu, settings)?;
    // For comparison, also run on the other one if there is any adapter.
    let mut other = match &chosen {
        Post::Cpu(_) => Headless::find(true).map(|any| Post::new(Some(any), settings)).transpose()?,
        Post::Gpu { .. } => Some(Post::new(None, settings)?),
    };

    let color = AnalyticSource::new("still", SIZE, 70.0, 60.0)?.frame(0)?.color;
    let geometry = ViewGeometry::flat(SIZE, 70.0)?;
    let foveation = Foveation { rate_mid: 4, rate_far: 8, ..Foveation::default() };
    let pyramid = Pyramid::new(color, foveation.max_level());
    let mut shown = Image::filled(SIZE, [0.0; 3]);
    for index in 0..30 {
        let px = if index < 20 { [80.0, 90.0] } else { [240.0, 90.0] };
        let lods = foveation.lod_map(&geometry, px);
        let foveated = foveation.render(&pyramid, &lods);
        let facts = ViewFrame::new(geometry, Gaze::At { px });
        shown = chosen.show(index, &foveated, facts)?;
        if let Some(other) = &mut other {
            let theirs = other.show(index, &foveated, facts)?;
            let differ = shown.pixels().iter().zip(theirs.pixels()).filter(|(a, b)| a != b).count();
            if index == 29 {
                println!("pixels that differ from the other executor after {} frames: {differ}", index + 1);
            }
        }
    }
    std::fs::create_dir_all("out")?;
    write_png("out/05_cpu_fallback.png".as_ref(), &to_rgb8(&encode(&shown, 0.0)))?;
    println!("sharp where the eye is (right) and was (left): out/05_cpu_fallback.png");
    Ok(())
}
