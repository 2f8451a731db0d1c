//! The least that a renderer adds to shade a quarter of its pixels: a jittered projection, `plan`, `close` and `show`.
//! The post-process chooses the pixels, the depth test rejects the rest before it is shaded, and the picture is that of
//! full rate, antialiased. Shaders and draw calls (`headless/renderer.rs`) stay as they are.
//!
//! `cargo run --release --example 01_planned` (any adapter; software Vulkan: mesa-vulkan-drivers)

mod headless;

use afterimage::wgpu::{Color, TextureFormat};
use afterimage::{Afterimage, Camera, Desc, MotionConvention, Targets};
use glam::{Mat4, Vec3, camera::rh::proj::directx::perspective_infinite_reverse};
use headless::Headless;
use headless::renderer::{Renderer, View};

const SIZE: [u32; 2] = [640, 360];
const COLOR: TextureFormat = TextureFormat::Rgba32Float;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Headless::new()?;
    let renderer = Renderer::new(&gpu, COLOR, TextureFormat::Rgba16Float);
    // Once: a quarter of the pixels; where an eye tracker says where the eye looks, a tenth.
    let vectors = MotionConvention { without_camera: true, ..MotionConvention::BEVY };
    let mut post = Afterimage::new(&gpu.device, &Desc { motion: Some(vectors), ..Desc::new(SIZE, COLOR) })?;
    // Its textures; an engine has its own.
    let [targets, full] = [0; 2].map(|_| Targets::new(&gpu.device, post.desc(), COLOR));

    let clip_from_view = perspective_infinite_reverse(0.75, 640.0 / 360.0, 0.1);
    for index in 0..48 {
        let world_from_view = Mat4::from_translation(Vec3::new(0.03 * index as f32, 1.5, 0.0));
        let seconds = [index as f32 / 60.0, (index as f32 - 1.0) / 60.0];

        // Each frame, all of which is drawn with the jittered projection.
        let mut encoder = gpu.encoder();
        let jittered = Mat4::from_cols_array_2d(&post.jittered(clip_from_view.to_cols_array_2d()));
        let view = View { clip_from_world: jittered * world_from_view.inverse(), seconds };
        let camera = Camera::new(clip_from_view.to_cols_array_2d(), world_from_view.to_cols_array_2d());
        renderer.prepass(&gpu, targets.prepass(&mut encoder, 0, &camera), view);
        let plan = post.plan(&mut encoder, &targets.frame(camera))?;
        // The post-process reads depth, too: a copy of it is closed.
        targets.close(&mut encoder, &mut post, &plan)?;
        renderer.colors(&gpu, targets.color_pass(&mut encoder, 0, Color::BLACK), view);
        let list = plan.lists()[0].clone();
        post.show(&mut encoder, plan, &targets.color, &targets.output)?;
        gpu.submit(encoder);

        if index == 0 || index % 16 == 15 {
            let mut encoder = gpu.encoder();
            let view = View { clip_from_world: clip_from_view * world_from_view.inverse(), seconds };
            renderer.prepass(&gpu, full.prepass(&mut encoder, 0, &camera), view);
            full.open(&mut encoder);
            renderer.colors(&gpu, full.color_pass(&mut encoder, 0, Color::BLACK), view);
            gpu.submit(encoder);
            let (shown, expected) = (gpu.read(&targets.output, 0), gpu.read(&full.color, 0));
            let squares: f32 = shown.iter().zip(&expected).map(|(a, b)| (a[0] - b[0]).powi(2)).sum();
            let psnr_db = -10.0 * (squares / shown.len() as f32).log10();
            let words: Vec<u32> = bytemuck::pod_collect_to_vec(&gpu.read_buffer(&list)[28..32]);
            let share = 400.0 * words[0] as f32 / (SIZE[0] * SIZE[1]) as f32;
            println!(
                "frame {index}: quads with {share:.0} % of the pixels are shaded; PSNR {psnr_db:.1} dB to full rate"
            );
        }
    }
    Ok(())
}
