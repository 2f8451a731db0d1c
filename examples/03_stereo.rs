//! Stereo: two views in one context. Textures have an array layer for each eye, `plan` and `show` are one call for
//! both, and each eye has a camera with a gaze of its own.
//!
//! `cargo run --release --example 03_stereo` (any adapter; software Vulkan: mesa-vulkan-drivers)

mod headless;

use afterimage::wgpu::{Color, TextureFormat};
use afterimage::{Afterimage, Camera, Desc, Frame, Gaze, MotionConvention, Shading, Targets, ViewGeometry};
use glam::{Mat4, Vec3, Vec4};
use headless::Headless;
use headless::renderer::{Renderer, View};

const SIZE: [u32; 2] = [384, 384];
const COLOR: TextureFormat = TextureFormat::Rgba32Float;
/// Left, right, up and down edges of each eye's view in radians: wider on its outer side.
const ANGLES_RAD: [[f32; 4]; 2] = [[-0.876, 0.733, 0.83, -0.83], [-0.733, 0.876, 0.83, -0.83]];

/// Projection of an eye, with reversed depth and an infinite far plane.
fn projection(angles_rad: [f32; 4]) -> Mat4 {
    let [left, right, up, down] = angles_rad.map(f32::tan);
    let (width, height) = (right - left, up - down);
    Mat4::from_cols(
        Vec4::new(2.0 / width, 0.0, 0.0, 0.0),
        Vec4::new(0.0, 2.0 / height, 0.0, 0.0),
        Vec4::new((right + left) / width, (up + down) / height, 0.0, -1.0),
        Vec4::new(0.0, 0.0, 0.1, 0.0),
    )
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Headless::new()?;
    let renderer = Renderer::new(&gpu, COLOR, TextureFormat::Rgba16Float);
    // Once: all pixels within 10 degrees around the gaze of each eye, and 8 % of the others.
    let vectors = MotionConvention { without_camera: true, ..MotionConvention::BEVY };
    let shading = Shading::Gaze { fovea_deg: 10.0, share: 0.08 };
    let desc = Desc { view_count: 2, shading, motion: Some(vectors), ..Desc::new(SIZE, COLOR) };
    let mut post = Afterimage::new(&gpu.device, &desc)?;
    let [targets, full] = [0; 2].map(|_| Targets::new(&gpu.device, &desc, COLOR));

    for index in 0..32 {
        let seconds = [index as f32 / 60.0, (index as f32 - 1.0) / 60.0];
        let head = Vec3::new(0.01 * index as f32, 1.5, 0.0);
        let poses = [-0.032, 0.032].map(|x_m| Mat4::from_translation(head + Vec3::new(x_m, 0.0, 0.0)));
        let projections = ANGLES_RAD.map(projection);
        // An eye tracker between the eyes reports a ray; they look at a point 4 m ahead, each from its place.
        let ray = [0.1, -0.2, -1.0];
        let [left, right] = [0, 1].map(|eye| {
            let pose = poses[eye].to_cols_array_2d();
            let gaze = Gaze::on_ray(head.into(), ray, 4.0, pose);
            Camera { gaze, ..Camera::new(projections[eye].to_cols_array_2d(), pose) }
        });
        let view =
            |eye: usize, clip_from_view: Mat4| View { clip_from_world: clip_from_view * poses[eye].inverse(), seconds };
        let jittered = [0, 1].map(|eye| {
            let clip_from_view = post.jittered(projections[eye].to_cols_array_2d());
            view(eye, Mat4::from_cols_array_2d(&clip_from_view))
        });

        let mut encoder = gpu.encoder();
        for (eye, view) in jittered.into_iter().enumerate() {
            renderer.prepass(&gpu, targets.prepass(&mut encoder, eye, &left), view);
        }
        let plan = post.plan(&mut encoder, &Frame { others: &[right], ..targets.frame(left) })?;
        targets.close(&mut encoder, &mut post, &plan)?;
        for (eye, view) in jittered.into_iter().enumerate() {
            renderer.colors(&gpu, targets.color_pass(&mut encoder, eye, Color::BLACK), view);
        }
        let lists = plan.lists().to_vec();
        post.show(&mut encoder, plan, &targets.color, &targets.output)?;
        gpu.submit(encoder);

        for (eye, camera) in [left, right].iter().enumerate().filter(|_| index % 16 == 15) {
            let mut encoder = gpu.encoder();
            renderer.prepass(&gpu, full.prepass(&mut encoder, eye, camera), view(eye, projections[eye]));
            full.open(&mut encoder);
            renderer.colors(&gpu, full.color_pass(&mut encoder, eye, Color::BLACK), view(eye, projections[eye]));
            gpu.submit(encoder);
            let (shown, expected) = (gpu.read(&targets.output, eye as u32), gpu.read(&full.color, eye as u32));
            let squares: f32 = shown.iter().zip(&expected).map(|(a, b)| (a[0] - b[0]).powi(2)).sum();
            let psnr_db = -10.0 * (squares / shown.len() as f32).log10();
            let words: Vec<u32> = bytemuck::pod_collect_to_vec(&gpu.read_buffer(&lists[eye])[28..32]);
            let share = 400.0 * words[0] as f32 / (SIZE[0] * SIZE[1]) as f32;
            let geometry = ViewGeometry::from_angles(SIZE, ANGLES_RAD[eye])?;
            let [x, y] = camera.gaze.resolve(None, &geometry);
            println!(
                "frame {index}, {} eye at ({x:.0}, {y:.0}): {share:.0} % shaded; PSNR {psnr_db:.1} dB to full rate",
                ["left", "right"][eye]
            );
        }
    }
    println!("{} KiB of history for both", post.memory_bytes() / 1024);
    Ok(())
}
