//! An engine's loop with planned frames: moving objects, a sky, glass, a window that is resized and minimised, a cut, a
//! gaze that is lost, a change of exposure, and a share of shaded pixels that keeps the frame's time.
//!
//! `cargo run --release --example 02_engine` (any adapter; software Vulkan: mesa-vulkan-drivers)

mod headless;

use afterimage::wgpu::{Color, PollType, TextureFormat};
use afterimage::{Afterimage, Camera, Desc, Exposure, Frame, Gaze, MotionConvention, Shading, ShareControl, Targets};
use glam::{Mat4, Vec3, camera::rh::proj::directx::perspective_infinite_reverse};
use headless::Headless;
use headless::renderer::{Renderer, View};
use std::time::Instant;

/// Format of colors and of the picture. Compute shaders can rarely write a swapchain's format: tone mapping reads this
/// one, and draws to the screen.
const FORMAT: TextureFormat = TextureFormat::Rgba16Float;

struct Engine {
    gpu: Headless,
    renderer: Renderer,
    post: Afterimage,
    control: ShareControl,
    /// Time of the last frame; an engine measures it with timestamps.
    last_ms: f32,
    targets: Targets,
}

/// What the game says of a frame.
struct Moment {
    size: [u32; 2],
    seconds: f32,
    is_cut: bool,
    gaze: Gaze,
    exposure: f32,
}

impl Engine {
    fn new(size: [u32; 2]) -> Result<Self, Box<dyn std::error::Error>> {
        let gpu = Headless::new()?;
        let vectors = MotionConvention { without_camera: true, ..MotionConvention::BEVY };
        let post = Afterimage::new(&gpu.device, &Desc { motion: Some(vectors), ..Desc::new(size, FORMAT) })?;
        let renderer = Renderer::new(&gpu, FORMAT, FORMAT);
        let (control, targets) =
            (ShareControl::new(50.0, [0.05, 0.5])?, Targets::new(&gpu.device, post.desc(), FORMAT));
        Ok(Self { gpu, renderer, post, control, last_ms: f32::NAN, targets })
    }

    fn frame(&mut self, moment: &Moment) -> Result<String, Box<dyn std::error::Error>> {
        // A minimised window is 0x0: draw nothing, and keep the history.
        if moment.size.contains(&0) {
            return Ok("nothing to draw".into());
        }
        if moment.size != self.post.desc().size_px {
            self.post.resize(moment.size)?;
            self.targets = Targets::new(&self.gpu.device, self.post.desc(), FORMAT);
        }
        let start = Instant::now();
        let share = self.control.share_for(self.last_ms);
        self.post.set_shading(Shading::Gaze { fovea_deg: 5.0, share })?;

        let world_from_view = Mat4::from_translation(Vec3::new(moment.seconds, 1.5, 0.0));
        let aspect = moment.size[0] as f32 / moment.size[1] as f32;
        let clip_from_view = perspective_infinite_reverse(0.75, aspect, 0.1).to_cols_array_2d();
        let seconds = [moment.seconds, moment.seconds - 1.0 / 60.0];
        let jittered = Mat4::from_cols_array_2d(&self.post.jittered(clip_from_view));
        let view = View { clip_from_world: jittered * world_from_view.inverse(), seconds };
        let pose = world_from_view.to_cols_array_2d();
        let camera = Camera { gaze: moment.gaze, ..Camera::new(clip_from_view, pose) };
        let frame = Frame {
            is_cut: moment.is_cut,
            exposure: Exposure::Scene { exposure: moment.exposure },
            ..self.targets.frame(camera)
        };
        let mut encoder = self.gpu.encoder();
        let (gpu, renderer, targets) = (&self.gpu, &self.renderer, &self.targets);
        renderer.prepass(gpu, targets.prepass(&mut encoder, 0, &camera), view);
        let plan = self.post.plan(&mut encoder, &frame)?;
        targets.close(&mut encoder, &mut self.post, &plan)?;
        renderer.colors(gpu, targets.color_pass(&mut encoder, 0, Color::BLACK), view);
        let shown = self.post.show(&mut encoder, plan, &targets.color, &targets.output)?;
        let warnings: Vec<_> = shown.warnings().collect();
        // After show: transparent things, without the jitter and with the depth that was not closed; then tone mapping.
        let clip_from_world = Mat4::from_cols_array_2d(&clip_from_view) * world_from_view.inverse();
        renderer.glass(gpu, targets.output_pass(&mut encoder, 0), View { clip_from_world, seconds });
        self.gpu.submit(encoder);
        self.gpu.device.poll(PollType::wait_indefinitely())?;
        self.last_ms = start.elapsed().as_secs_f32() * 1000.0;
        let [width, height] = moment.size;
        Ok(format!("{width}x{height}, {:.0} % in {:.0} ms {warnings:?}", 100.0 * share, self.last_ms))
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut engine = Engine::new([320, 180])?;
    for index in 0..40 {
        let (what, size) = match index {
            0 => ("start", [320, 180]),
            1..8 => ("", [320, 180]),
            8 => ("the window grows", [400, 225]),
            16 => ("minimised", [0, 0]),
            20 => ("a cut", [400, 225]),
            24 => ("the gaze is lost", [400, 225]),
            28 => ("darker", [400, 225]),
            _ => ("", [400, 225]),
        };
        let moment = Moment {
            size,
            seconds: index as f32 / 60.0,
            is_cut: index == 20,
            gaze: if index == 24 { Gaze::Lost } else { Gaze::At { px: [160.0, 90.0] } },
            exposure: if index < 28 { 1.0 } else { 0.5 },
        };
        let done = engine.frame(&moment)?;
        if !what.is_empty() || index % 8 == 7 {
            println!("frame {index:2} {what:17} {done}");
        }
    }
    Ok(())
}
