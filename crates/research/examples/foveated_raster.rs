//! Renders a scene at full rate and foveated, each lattice of samples as a small view of its own, and compares the CPU
//! time of both, frame by frame. On a GPU, it is wall time.
//!
//! `cargo run --release -p afterimage-research --example foveated_raster [SCENE [WIDTHxHEIGHT [FRAMES [CAMERA
//! [OUT.png]]]]]`; SCENE is a .gltf or .glb file, or builtin:NAME (default builtin:courtyard, 1920x1080, 12 frames,
//! walk). OUT.png gets the last atlas. Needs an adapter; a software one is enough.
//!
//! Makes the table "Foveated rasterising" of `docs/performance.md`.

use afterimage::gpu::{Afterimage, Frame, Target};
use afterimage::kernel::color::srgb_encode;
use afterimage::wgpu::{TextureFormat, TextureUsages};
use afterimage::{
    ContextDesc, DepthConvention, Filter, Foveation, Gaze, Lattices, MethodKind, Settings, ViewFrame, ViewGeometry,
};
use afterimage_lab::clock::{Quartiles, Stopwatch};
use afterimage_lab::device::Headless;
use afterimage_lab::picture::{to_rgb8, write_png};
use afterimage_lab::raster::AtlasLayout;
use afterimage_lab::source::{FrameSource, RasterSource, ReadLimits, SceneOptions};
use std::path::Path;
use std::sync::Arc;

/// First frames, which compile shaders.
const WARM_UP: u64 = 2;
const METHODS: [MethodKind; 4] = [MethodKind::None, MethodKind::Wrs, MethodKind::Smr, MethodKind::Taau];

/// Milliseconds of `work` and of what it submits.
fn timed<T>(device: &Headless, work: impl FnOnce() -> T) -> (f64, T) {
    device.wait();
    let watch = Stopwatch::start();
    let result = work();
    device.wait();
    let ms = if device.is_software() { watch.cpu_ms() } else { None };
    (ms.unwrap_or_else(|| watch.wall_ms()), result)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let arg = |i: usize, default| args.get(i).map_or(default, String::as_str);
    let (width, height) = arg(1, "1920x1080").split_once('x').ok_or("expected WIDTHxHEIGHT, such as 1920x1080")?;
    let size = [width.parse()?, height.parse()?];
    let frames: u64 = arg(2, "12").parse()?;
    let device = Headless::find_roomy(true).ok_or("there is no adapter; install mesa-vulkan-drivers")?;
    let options = SceneOptions { size: Some(size), ..Default::default() };
    let input = arg(0, "builtin:courtyard");
    let mut source = RasterSource::open(input, &ReadLimits::default(), &options, Some(arg(3, "walk")), device.clone())?;
    let geometry = ViewGeometry::flat(size, source.info().hfov_deg.unwrap_or(70.0))?;
    println!("{input}, {width}x{height}, {}", device.info.name);

    let foveation = Foveation { filter: Filter::Sparse, rate_mid: 4, rate_far: 8, ..Foveation::default() };
    let near = source.draw(0).near();
    let mut posts = METHODS.map(|method| {
        let settings = Settings { method: method.into(), foveation, ..Settings::default() };
        let depth = DepthConvention::Reversed { near, far: f32::INFINITY };
        let desc = ContextDesc { settings, depth, ..ContextDesc::new(size) };
        Afterimage::new(&device.device, &desc, TextureFormat::Rgba16Float)
    });
    let output = device.texture(size, 1, TextureFormat::Rgba16Float, TextureUsages::STORAGE_BINDING);
    let mut times: Vec<(&str, Vec<f64>)> = ["full rate", "foveated", "foveated, in place"]
        .into_iter()
        .chain(METHODS.map(MethodKind::name))
        .map(|n| (n, vec![]))
        .collect();
    let mut samples = 0;
    for index in 0..frames + WARM_UP {
        // The gaze jumps every fourth frame.
        let turn = (index / 4) as f32;
        let at = [0.5 + 0.35 * (turn * 2.4).cos(), 0.5 + 0.3 * (turn * 1.7).sin()];
        let gaze_px = [at[0] * size[0] as f32, at[1] * size[1] as f32];
        let lattices = foveation.lattices(&geometry, gaze_px, index);
        samples = lattices.as_slice().iter().map(|l| l.points[0] * l.points[1]).sum();
        let (views, _) = source.views(index);
        let mut ms = vec![timed(&device, || _ = source.draw(index)).0];
        ms.push(timed(&device, || _ = source.draw_foveated(index, &lattices, AtlasLayout::Compact)).0);
        let (targets, placed) = source.draw_foveated(index, &lattices, AtlasLayout::Compact);
        let view = ViewFrame {
            lattices: Some(placed.with_geometry_at_samples()),
            previous_from_current: Some(views[0].previous_from_current(&views[1])),
            ..ViewFrame::new(geometry, Gaze::At { px: gaze_px })
        };
        for post in &mut posts {
            let post = post.as_mut().map_err(|e| e.to_string())?;
            let view = [view];
            let frame = Frame {
                depth: Some((&targets.atlas.depth).into()),
                motion: Some((&targets.atlas.motion).into()),
                ..Frame::new(&targets.atlas.color, &view, index)
            };
            let (post_ms, recorded) = timed(&device, || {
                let mut encoder = device.device.create_command_encoder(&Default::default());
                let recorded = post.record(&device.device, &mut encoder, &frame, Target::new(&output)).map(|_| ());
                device.queue.submit([encoder.finish()]);
                recorded
            });
            recorded?;
            ms.push(post_ms);
        }
        if let (true, Some(path)) = (index + 1 == frames + WARM_UP, args.get(4)) {
            let color = targets.atlas.read_color(&device);
            write_png(Path::new(path), &to_rgb8(&color.map(|c| c.map(|v| srgb_encode(v.clamp(0.0, 1.0))))))?;
        }
        ms.insert(2, in_place(&device, &mut source, index, &lattices));
        if index >= WARM_UP {
            times.iter_mut().zip(ms).for_each(|((_, all), ms)| all.push(ms));
        }
    }
    let median = |i: usize| Quartiles::of(&times[i].1).map_or(0.0, |q| q.median);
    let share = f64::from(samples) / (f64::from(size[0]) * f64::from(size[1]));
    println!("samples: {:.1} % of the pixels", 100.0 * share);
    println!("{:20} {:>9} {:>14} {:>24}", "", "median ms", "of full rate", "with foveated rendering");
    for (i, (name, _)) in times.iter().enumerate() {
        let of_full = |ms: f64| format!("{:.3}", ms / median(0));
        let both = if i > 2 { of_full(median(1) + median(i)) } else { String::new() };
        println!("{name:20} {:9.1} {:>14} {both:>24}", median(i), of_full(median(i)));
    }
    Ok(())
}

/// Milliseconds of a frame whose full-rate lattice lies at its own pixels.
fn in_place(device: &Arc<Headless>, source: &mut RasterSource, index: u64, lattices: &Lattices) -> f64 {
    timed(device, || _ = source.draw_foveated(index, lattices, AtlasLayout::InPlace)).0
}
