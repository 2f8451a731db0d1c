//! A doctor looks at planned frames whose motion vectors are of objects alone, which the description does not say. It
//! says so, and which line of code mends it.
//!
//! `cargo run --example 05_doctor` (any adapter; software Vulkan: mesa-vulkan-drivers)

mod headless;

use afterimage::wgpu::{BufferUsages, Color, TextureFormat};
use afterimage::{Afterimage, Camera, Desc, MotionConvention, Targets};
use glam::{Mat4, Vec3, camera::rh::proj::directx::perspective_infinite_reverse};
use headless::Headless;
use headless::renderer::{Renderer, View};

const SIZE: [u32; 2] = [320, 180];
const COLOR: TextureFormat = TextureFormat::Rgba32Float;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Headless::new()?;
    let renderer = Renderer::new(&gpu, COLOR, TextureFormat::Rgba16Float);
    // The mistake: those of this renderer lack the camera's motion.
    let desc = Desc { motion: Some(MotionConvention::BEVY), ..Desc::new(SIZE, COLOR) };
    let mut post = Afterimage::new(&gpu.device, &desc)?;
    let targets = Targets::new(&gpu.device, &desc, COLOR);
    let mut doctor = post.doctor()?;
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
    let words = gpu.buffer(doctor.words_bytes(), usage);

    let clip_from_view = perspective_infinite_reverse(0.75, 320.0 / 180.0, 0.1).to_cols_array_2d();
    for index in 0..8 {
        let world_from_view = Mat4::from_translation(Vec3::new(0.1 * index as f32, 1.5, 0.0));
        let jittered = Mat4::from_cols_array_2d(&post.jittered(clip_from_view));
        let seconds = [index as f32 / 60.0, (index as f32 - 1.0) / 60.0];
        let view = View { clip_from_world: jittered * world_from_view.inverse(), seconds };
        let camera = Camera::new(clip_from_view, world_from_view.to_cols_array_2d());

        let mut encoder = gpu.encoder();
        renderer.prepass(&gpu, targets.prepass(&mut encoder, 0, &camera), view);
        let plan = post.plan(&mut encoder, &targets.frame(camera))?;
        // The doctor wants every pixel: depth is not closed.
        targets.open(&mut encoder);
        renderer.colors(&gpu, targets.color_pass(&mut encoder, 0, Color::BLACK), view);
        post.examine(&mut encoder, &mut doctor, &plan, &targets.color, &words)?;
        post.show(&mut encoder, plan, &targets.color, &targets.output)?;
        gpu.submit(encoder);
        // An engine would read the words a few frames later.
        doctor.read(&gpu.read_buffer(&words));
    }
    for finding in doctor.findings() {
        println!("{finding}");
    }
    Ok(())
}
