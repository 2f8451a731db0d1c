//! CPU time of recording a frame, on a device that does nothing: textures that repeat, and new ones in every frame.
//!
//! `RUST_BACKTRACE=0 cargo run -p afterimage-research -- record-cost`
//!
//! Makes the table "Recording a frame" of `docs/performance.md`; ten seconds.

use afterimage::gpu::{Afterimage, Frame};
use afterimage::internal::{ContextDesc, Foveation, FoveationKind, Settings, ViewFrame};
use afterimage::wgpu::{self, Device, Texture, TextureFormat, TextureUsages};
use afterimage::{Gaze, ViewGeometry};
use afterimage_lab::clock::Stopwatch;

const SIZE: [u32; 2] = [320, 180];
const WARM_UP: u64 = 20;
/// Frames in which the mean is taken.
const RECORDED: u64 = 1000;

pub fn bench() {
    let smr = Settings::default();
    let planned = Settings { foveation: Foveation::quads(), ..smr };
    let noisy = Settings { noisy: true, ..smr };
    say!("{:12} {:>9} {:>16} {:>9}", "us", "record", "finish, submit", "new");
    for (name, settings, has_all) in
        [("smr", smr, false), ("smr, planned", planned, false), ("all inputs", noisy, true)]
    {
        let ([record, submit], [new, _]) = (record_us(settings, has_all, false), record_us(settings, has_all, true));
        say!("{name:12} {record:9.1} {submit:16.1} {new:9.1}");
    }
}

/// Textures of a frame: color, depth, motion, trust, levels of detail and noise, and the output.
fn frame_textures(device: &Device) -> [Texture; 7] {
    use TextureFormat::{R8Unorm, R32Float, Rg16Float, Rg32Float, Rgba16Float};
    let texture = |format, usage| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    };
    let formats = [Rgba16Float, R32Float, Rg16Float, R8Unorm, R32Float, Rg32Float];
    let [color, depth, motion, trust, lod, noise] =
        formats.map(|format| texture(format, TextureUsages::TEXTURE_BINDING));
    [color, depth, motion, trust, lod, noise, texture(Rgba16Float, TextureUsages::STORAGE_BINDING)]
}

/// Mean microseconds of CPU time to record a frame, and to finish and submit it. Its textures are two sets that
/// alternate, or new ones for each frame.
fn record_us(settings: Settings, has_all: bool, is_new: bool) -> [f64; 2] {
    let (device, queue) = Device::noop(&wgpu::DeviceDescriptor::default());
    let desc = ContextDesc { settings, ..ContextDesc::new(SIZE) };
    let mut post = Afterimage::new(&device, &desc, TextureFormat::Rgba16Float).unwrap();
    let mut textures = [(); 2].map(|()| frame_textures(&device));
    let geometry = ViewGeometry::flat(SIZE, 70.0).unwrap();
    let gaze_px = [160.0, 90.0];
    let is_planned = settings.foveation.kind == FoveationKind::Quads;
    let mut times = [0.0; 2];
    for index in 0..WARM_UP + RECORDED {
        let set = &mut textures[(index % 2) as usize];
        if is_new {
            *set = frame_textures(&device);
        }
        let [color, depth, motion, trust, lod, noise, output] = &*set;
        let views = [ViewFrame::new(geometry, Gaze::At { px: gaze_px })];
        let usual =
            Frame { depth: Some(depth.into()), motion: Some(motion.into()), ..Frame::new(color, &views, index) };
        let frame = if has_all {
            Frame { trust: Some(trust.into()), lod: Some(lod.into()), noise: Some(noise.into()), ..usual }
        } else {
            usual
        };
        let mut encoder = device.create_command_encoder(&Default::default());
        let watch = Stopwatch::start();
        if is_planned {
            post.plan(&device, &mut encoder, &frame).unwrap();
        }
        post.record(&device, &mut encoder, &frame, output).unwrap();
        let recorded_ms = watch.elapsed().cost_ms();
        queue.submit([encoder.finish()]);
        let submitted_ms = watch.elapsed().cost_ms();
        device.poll(wgpu::PollType::Poll).unwrap();
        if index >= WARM_UP {
            times[0] += recorded_ms;
            times[1] += submitted_ms - recorded_ms;
        }
    }
    times.map(|ms| ms * 1e3 / RECORDED as f64)
}
