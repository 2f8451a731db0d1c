//! An engine's loop, and where each call goes in it: a window that is resized and minimised, a cut, a pause, a lost
//! gaze, a change of exposure, and an output in a format that compute shaders can write.
//!
//! `cargo run --example 02_engine` (any adapter; software Vulkan: mesa-vulkan-drivers)

mod headless;

use afterimage::gpu::{Afterimage, Frame, Target};
use afterimage::wgpu::{self, Buffer, BufferUsages, Texture, TextureFormat, TextureUsages};
use afterimage::{ContextDesc, Exposure, FrameStats, Gaze, Reset, ViewFrame, ViewGeometry};
use headless::Headless;

/// Event of the application before a frame.
#[derive(Clone, Copy)]
enum Event {
    Nothing,
    Resized([u32; 2]),
    Cut,
    ResumedAfter(f32),
    GazeLost,
    Brighter(f32),
}

struct Engine {
    post: Afterimage,
    color: Texture,
    output: Texture,
    counters: Buffer,
    /// `None` while the window is minimised.
    size: Option<[u32; 2]>,
}

/// Output format. Compute shaders can rarely write a swapchain's format: write this one, and draw it to the screen.
const OUTPUT: TextureFormat = TextureFormat::Rgba16Float;

fn targets(gpu: &Headless, size: [u32; 2]) -> (Texture, Texture) {
    let color = TextureUsages::TEXTURE_BINDING | TextureUsages::RENDER_ATTACHMENT;
    let output = TextureUsages::STORAGE_BINDING | TextureUsages::TEXTURE_BINDING;
    (gpu.texture(size, 1, TextureFormat::Rgba16Float, color), gpu.texture(size, 1, OUTPUT, output))
}

impl Engine {
    fn new(gpu: &Headless, size: [u32; 2]) -> Result<Self, Box<dyn std::error::Error>> {
        let (color, output) = targets(gpu, size);
        let post = Afterimage::new(&gpu.device, &ContextDesc::new(size), OUTPUT)?;
        let counted = BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
        Ok(Self { post, color, output, counters: gpu.buffer(FrameStats::COUNTERS_BYTES, counted), size: Some(size) })
    }

    fn resize(&mut self, gpu: &Headless, size: [u32; 2]) -> Result<(), Box<dyn std::error::Error>> {
        // A minimised window is 0x0: skip its frames, and keep the context and its history.
        if size.contains(&0) {
            self.size = None;
        } else if self.post.desc().size_px == size {
            self.size = Some(size);
        } else {
            self.post.resize(&gpu.device, size)?;
            (self.color, self.output) = targets(gpu, size);
            self.size = Some(size);
        }
        Ok(())
    }

    /// Processes one frame. The event decides whether history is valid.
    fn frame(&mut self, gpu: &Headless, index: u64, event: Event) -> Result<String, Box<dyn std::error::Error>> {
        if let Event::Resized(size) = event {
            self.resize(gpu, size)?;
        }
        let Some(size) = self.size else { return Ok("minimised: nothing to draw".into()) };
        let mut encoder = gpu.encoder();
        // Your renderer would draw the foveated frame into `color` here. This example clears it.
        draw(&mut encoder, &self.color, if let Event::Brighter(ratio) = event { 0.2 * f64::from(ratio) } else { 0.2 });
        let gaze = match event {
            Event::GazeLost => Gaze::Lost,
            _ => Gaze::At { px: [0.5 * size[0] as f32, 0.5 * size[1] as f32] },
        };
        let views = [ViewFrame::new(ViewGeometry::flat(size, 70.0)?, gaze)];
        let frame = Frame {
            reset: match event {
                Event::Cut => Reset::All,
                // After a pause anything may have moved.
                Event::ResumedAfter(seconds) if seconds > 0.5 => Reset::All,
                _ => Reset::None,
            },
            exposure: match event {
                Event::Brighter(ratio) => Exposure::Changed { ratio },
                _ => Exposure::Same,
            },
            ..Frame::new(&self.color, &views, index)
        };
        let target = Target { counters: Some(&self.counters), ..Target::new(&self.output) };
        let recorded = self.post.record(&gpu.device, &mut encoder, &frame, target)?;
        // Your tone mapping would draw `output` to the screen here.
        gpu.submit(encoder);
        let warnings: Vec<String> = recorded.warnings().map(|w| w.to_string()).collect();
        // An engine would read the counters a few frames later, or not at all.
        let stats = FrameStats::from_counters(&gpu.read_buffer(&self.counters)).ok_or("too few counters")?;
        let kept = 100 * stats.valid() / stats.pixels;
        Ok(format!("{}x{}, history for {kept:3} % {}", size[0], size[1], warnings.join("; ")))
    }
}

fn draw(encoder: &mut wgpu::CommandEncoder, target: &Texture, light: f64) {
    let view = target.create_view(&Default::default());
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color { r: light, g: light, b: light, a: 1.0 }),
                store: wgpu::StoreOp::Store,
            },
        })],
        ..Default::default()
    });
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Headless::new()?;
    let mut engine = Engine::new(&gpu, [320, 180])?;
    let story = [
        ("start", Event::Nothing),
        ("", Event::Nothing),
        ("the window grows", Event::Resized([400, 225])),
        ("", Event::Nothing),
        ("minimised", Event::Resized([0, 0])),
        ("", Event::Nothing),
        ("restored", Event::Resized([400, 225])),
        ("a blink", Event::GazeLost),
        ("exposure doubles", Event::Brighter(2.0)),
        ("a cut", Event::Cut),
        ("", Event::Nothing),
        ("ten seconds later", Event::ResumedAfter(10.0)),
        ("", Event::Nothing),
    ];
    for (index, (what, event)) in (0..).zip(story) {
        println!("frame {index:2} {what:18} {}", engine.frame(&gpu, index, event)?);
    }
    Ok(())
}
