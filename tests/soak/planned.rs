//! Planned frames through the front door: whatever happens between two frames, nothing leaks, and no NaN is shown.

use afterimage::wgpu::{self, Device, Queue, Texture, TextureFormat, TextureUsages};
use afterimage::{Afterimage, Camera, Desc, Frame, Gaze, Shading};
use afterimage_testing::Draws;
use afterimage_testing::gpu::{device, read_texture, write_layer};
use glam::{Mat4, Quat, Vec3};

/// The largest size of a stream.
const SIZE: [u32; 2] = [36, 24];
/// The brightest color that is drawn, and the darkest, in broken pixels.
const BRIGHTEST: f32 = 1.0;
const DARKEST: f32 = -1.0;
/// Largest gain of history that follows a change of light, `SAMPLE_GAIN` of the kernel.
const GAIN: f32 = 5.0;

/// Findings of a soak test.
#[derive(Debug, Default)]
struct Found {
    frames: u64,
    /// Frames that were planned and given up, or whose encoder was dropped.
    dropped: u64,
    resizes: u64,
    cuts: u64,
    /// Shown components that are NaN, infinite, or darker or far brighter than all that was drawn.
    wrong: u64,
    resident_mib: Vec<f64>,
}

/// Textures of a size.
struct Pictures {
    depth: Texture,
    color: Texture,
    output: Texture,
}

impl Pictures {
    fn new(device: &Device, [width, height]: [u32; 2]) -> Self {
        let texture = |format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let written = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC;
        Self {
            depth: texture(TextureFormat::R32Float, read),
            color: texture(TextureFormat::Rgba32Float, read),
            output: texture(TextureFormat::Rgba32Float, written),
        }
    }

    /// Draws a frame: a wall with a pattern and a column in front of it. `is_broken`: some values are not finite.
    fn draw(&self, queue: &Queue, draws: &mut Draws, seconds: f32, is_broken: bool) {
        let (width, height) = (self.color.width(), self.color.height());
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x as f32, y as f32]));
        let mut depths: Vec<f32> = pixels.clone().map(|[x, _]| if x % 11.0 < 3.0 { 0.05 } else { 0.01 }).collect();
        let pattern = |[x, y]: [f32; 2]| 0.5 * BRIGHTEST * (1.0 + (x + 2.0 * seconds).sin() * (0.7 * y).cos());
        let mut colors: Vec<[f32; 4]> = pixels.map(|at| [pattern(at), 0.4, pattern(at) * 0.5, 1.0]).collect();
        if is_broken {
            for _ in 0..5 {
                let i = draws.bits() as usize % colors.len();
                let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, DARKEST, 1e-41][draws.bits() as usize % 5];
                colors[i][draws.bits() as usize % 3] = bad;
                depths[draws.bits() as usize % colors.len()] = bad;
            }
        }
        write_layer(queue, &self.depth, 0, bytemuck::cast_slice(&depths));
        write_layer(queue, &self.color, 0, bytemuck::cast_slice(&colors));
    }
}

/// One of the shadings that a controller or an eye tracker may ask for.
fn shading(draws: &mut Draws) -> Shading {
    let share = 0.05 + 0.95 * draws.uniform();
    match draws.bits() % 2 {
        0 => Shading::Everywhere { share },
        _ => Shading::Gaze { fovea_deg: 40.0 * draws.uniform(), share },
    }
}

fn camera(draws: &mut Draws, [width, height]: [u32; 2], seconds: f32) -> Camera {
    let aspect = width as f32 / height as f32;
    let clip_from_view = glam::camera::rh::proj::directx::perspective_infinite_reverse(0.9, aspect, 0.1);
    let turn = Quat::from_rotation_y(0.1 * (0.3 * seconds).sin());
    let pose = Mat4::from_rotation_translation(turn, Vec3::new(0.2 * seconds.sin(), 1.6, 0.0));
    let gaze = match draws.bits() % 8 {
        0 => Gaze::Lost,
        _ => Gaze::Uv { uv: [draws.uniform(), draws.uniform()] },
    };
    Camera { gaze, ..Camera::new(clip_from_view.to_cols_array_2d(), pose.to_cols_array_2d()) }
}

/// Runs a stream of `frames` frames with an event in about every third.
fn soak(antialias: bool, frames: u64) -> Option<Found> {
    let (device, queue) = device()?;
    let mut draws = Draws::new(&format!("soak of planned frames {antialias}"));
    let mut post =
        Afterimage::new(&device, &Desc { antialias, ..Desc::new(SIZE, TextureFormat::Rgba32Float) }).unwrap();
    let mut pictures = Pictures::new(&device, SIZE);
    let mut found = Found { frames, ..Found::default() };
    for index in 0..frames {
        let seconds = index as f32 / 60.0;
        let mut encoder = device.create_command_encoder(&Default::default());
        if draws.bits().is_multiple_of(50) {
            let [w, h] = SIZE;
            let sizes = [[w, h], [w, h], [w - 1, h + 1], [w / 2, h / 2], [1, 1], [7, 2]];
            let size = sizes[draws.bits() as usize % sizes.len()];
            match draws.bits() % 2 {
                0 => post.resize(size).unwrap(),
                _ => post.resize_keeping_history(&mut encoder, size).unwrap(),
            }
            pictures = Pictures::new(&device, size);
            found.resizes += 1;
        }
        if draws.bits().is_multiple_of(10) {
            post.set_shading(shading(&mut draws)).unwrap();
        }
        let is_broken = draws.bits().is_multiple_of(8);
        pictures.draw(&queue, &mut draws, seconds, is_broken);
        let camera = camera(&mut draws, post.desc().size_px, seconds);
        let is_cut = draws.bits().is_multiple_of(60);
        found.cuts += u64::from(is_cut);
        let frame = Frame { is_cut, ..Frame::new(&pictures.depth, camera) };
        let plan = post.plan(&mut encoder, &frame).unwrap();
        // A frame is given up after its plan, or recorded and never submitted.
        let fate = draws.bits() % 40;
        if fate != 0 {
            post.show(&mut encoder, plan, &pictures.color, &pictures.output).unwrap();
        }
        if fate <= 1 {
            found.dropped += 1;
            continue;
        }
        queue.submit([encoder.finish()]);
        let shown = read_texture(&device, &queue, &pictures.output);
        let is_right = |bits: &u32| (DARKEST..=GAIN * BRIGHTEST).contains(&f32::from_bits(*bits));
        found.wrong += shown.iter().filter(|bits| !is_right(bits)).count() as u64;
        if frames >= 10 && index % (frames / 10) == frames / 20 {
            found.resident_mib.extend(afterimage_testing::resident::resident_mib());
            if frames > 5000 {
                println!("antialiased: {antialias}: frame {index}, {found:?}");
            }
        }
    }
    Some(found)
}

fn assert_sound(found: &Found) {
    println!("{found:?}");
    assert!(found.dropped * 40 > found.frames && found.resizes * 100 > found.frames, "too little happened: {found:?}");
    assert_eq!(found.wrong, 0, "{found:?}");
    let late = &found.resident_mib[found.resident_mib.len().min(2)..];
    if found.frames >= 10_000 && late.len() > 2 {
        let growth = afterimage_testing::resident::least_growth_mib(late);
        assert!(growth < 0.5, "{growth} MiB in {} frames: {:?}", found.frames / 10, found.resident_mib);
    }
}

#[test]
fn a_short_stream_of_planned_frames_is_sound() {
    for antialias in [false, true] {
        let Some(found) = soak(antialias, 600) else { return };
        assert_sound(&found);
    }
}

#[test]
#[ignore = "hours: tests/soak.sh"]
fn planned_for_1_000_000_frames() {
    for antialias in [false, true] {
        let Some(found) = soak(antialias, super::frames(500_000)) else { return };
        assert_sound(&found);
    }
}
