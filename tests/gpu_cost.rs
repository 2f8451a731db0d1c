//! Cost of a turn of the head on the device: hard case H60. A process of its own, because a software device spends its
//! CPU time; a real one spends none, and there the elapsed time counts. And CPU time of recording a frame, on a device
//! that does nothing. The two take turns: each would count the other's time.

use afterimage::gpu::{Afterimage, Frame};
use afterimage::wgpu::{self, Device, Texture, TextureFormat, TextureUsages};
use afterimage::{ContextDesc, Filter, Foveation, Gaze, Image, MethodKind, Settings, ViewFrame, ViewGeometry};
use afterimage_testing::Draws;
use afterimage_testing::holds;
use rustix::time::{ClockId, clock_gettime};
use std::sync::{Mutex, MutexGuard, PoisonError};

const SIZE: [u32; 2] = [320, 180];

static PROCESS_TIME: Mutex<()> = Mutex::new(());

fn alone() -> MutexGuard<'static, ()> {
    PROCESS_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

fn clock_ns(is_software: bool) -> f64 {
    let t = clock_gettime(if is_software { ClockId::ProcessCPUTime } else { ClockId::Monotonic });
    t.tv_sec as f64 * 1e9 + t.tv_nsec as f64
}

#[test]
fn h60_a_turn_costs_no_more_than_any_other_frame() {
    let _alone = alone();
    let Some((device, queue)) = afterimage_testing::gpu::device() else { return };
    let is_software = afterimage_testing::gpu::adapter().unwrap().get_info().device_type == wgpu::DeviceType::Cpu;
    let texture = |format, usage| frame_texture(&device, format, usage);
    let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let [color, depth, motion] = [TextureFormat::Rgba32Float, TextureFormat::R32Float, TextureFormat::Rg32Float]
        .map(|format| texture(format, read));
    let output = texture(TextureFormat::Rgba16Float, TextureUsages::STORAGE_BINDING);
    let z = Image::from_fn(SIZE, |[x, y]| 2.0 + (x + y) as f32 * 0.01);
    afterimage_testing::gpu::write_layer(&queue, &depth, 0, bytemuck::cast_slice(z.pixels()));
    let views = [ViewFrame::new(ViewGeometry::flat(SIZE, 70.0).unwrap(), Gaze::At { px: [160.0, 90.0] })];
    let wait = || {
        queue.submit([]);
        device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    };
    let mut ratios = vec![];
    for method in [MethodKind::Wrs, MethodKind::Smr] {
        let settings = Settings { method: method.into(), ..Settings::paper() };
        let desc = ContextDesc { settings, ..ContextDesc::new(SIZE) };
        let mut post = Afterimage::new(&device, &desc, output.format()).unwrap();
        let mut times = [vec![], vec![]];
        let mut draws = Draws::new("cost on the device");
        for index in 0..102 {
            // A normal frame and a turn alternate, each of another picture.
            let is_turn = index % 2 == 1;
            let pixels: Vec<[f32; 4]> = (0..SIZE[0] * SIZE[1]).map(|_| [0; 4].map(|_| draws.uniform())).collect();
            afterimage_testing::gpu::write_layer(&queue, &color, 0, bytemuck::cast_slice(&pixels));
            let vector = [if is_turn { 5000.0_f32 } else { 0.25 }, 0.25];
            afterimage_testing::gpu::write_layer(&queue, &motion, 0, bytemuck::cast_slice(&vec![vector; pixels.len()]));
            wait();
            let from = clock_ns(is_software);
            let mut encoder = device.create_command_encoder(&Default::default());
            let frame = Frame {
                depth: Some((&depth).into()),
                motion: Some((&motion).into()),
                ..Frame::new(&color, &views, index)
            };
            post.record(&device, &mut encoder, &frame, &output).unwrap();
            queue.submit([encoder.finish()]);
            wait();
            // The first frames compile pipelines and have no history.
            if index > 1 {
                times[usize::from(is_turn)].push(clock_ns(is_software) - from);
            }
        }
        // Other load on the machine only adds time.
        let [normal, turn] = times.map(|times| times.into_iter().fold(f64::INFINITY, f64::min));
        println!("{method:?}: {normal:.0} ns, a turn {turn:.0} ns");
        ratios.push(turn / normal);
    }
    assert!(ratios.iter().all(|&r| r <= 1.1), "{ratios:?}");
    let [wrs, smr] = ratios[..] else { unreachable!() };
    holds!("H60", Gpu, "the same dispatches; a turn's time over a normal frame's: wrs {wrs:.2}, smr {smr:.2}");
}

/// Frames in which the mean is taken of the time to record one.
const RECORDED: u64 = 1000;

fn thread_ns() -> f64 {
    let t = clock_gettime(ClockId::ThreadCPUTime);
    t.tv_sec as f64 * 1e9 + t.tv_nsec as f64
}

fn frame_texture(device: &Device, format: TextureFormat, usage: TextureUsages) -> Texture {
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
}

/// Textures of a frame: color, depth, motion, trust, levels of detail and noise, and the output.
fn frame_textures(device: &Device) -> [Texture; 7] {
    use TextureFormat::{R8Unorm, R32Float, Rg16Float, Rg32Float, Rgba16Float};
    let formats = [Rgba16Float, R32Float, Rg16Float, R8Unorm, R32Float, Rg32Float];
    let [color, depth, motion, trust, lod, noise] =
        formats.map(|format| frame_texture(device, format, TextureUsages::TEXTURE_BINDING));
    [color, depth, motion, trust, lod, noise, frame_texture(device, Rgba16Float, TextureUsages::STORAGE_BINDING)]
}

/// Mean microseconds of CPU time to record a frame, and to finish and submit it. Its textures are two sets that
/// alternate, or new ones for each frame.
fn record_us(settings: Settings, has_all: bool, is_new: bool) -> [f64; 2] {
    let (device, queue) = Device::noop(&wgpu::DeviceDescriptor::default());
    let mut post =
        Afterimage::new(&device, &ContextDesc { settings, ..ContextDesc::new(SIZE) }, TextureFormat::Rgba16Float)
            .unwrap();
    let mut textures = [(); 2].map(|()| frame_textures(&device));
    let geometry = ViewGeometry::flat(SIZE, 70.0).unwrap();
    let gaze_px = [160.0, 90.0];
    let is_sparse = settings.foveation.filter == Filter::Sparse;
    let mut times = [0.0; 2];
    const WARM_UP: u64 = 20;
    for index in 0..WARM_UP + RECORDED {
        let set = &mut textures[(index % 2) as usize];
        if is_new {
            *set = frame_textures(&device);
        }
        let [color, depth, motion, trust, lod, noise, output] = &*set;
        let views = [ViewFrame {
            lattices: is_sparse.then(|| settings.foveation.lattices(&geometry, gaze_px, index)),
            ..ViewFrame::new(geometry, Gaze::At { px: gaze_px })
        }];
        let usual =
            Frame { depth: Some(depth.into()), motion: Some(motion.into()), ..Frame::new(color, &views, index) };
        let frame = if has_all {
            Frame { trust: Some(trust.into()), lod: Some(lod.into()), noise: Some(noise.into()), ..usual }
        } else {
            usual
        };
        let mut encoder = device.create_command_encoder(&Default::default());
        let from = thread_ns();
        post.record(&device, &mut encoder, &frame, output).unwrap();
        let recorded = thread_ns();
        queue.submit([encoder.finish()]);
        let submitted = thread_ns();
        device.poll(wgpu::PollType::Poll).unwrap();
        if index >= WARM_UP {
            times[0] += recorded - from;
            times[1] += submitted - recorded;
        }
    }
    times.map(|ns| ns / RECORDED as f64 / 1e3)
}

#[test]
fn recording_with_known_textures_makes_no_objects_anew() {
    let _alone = alone();
    let smr = Settings::default();
    let sparse = Foveation { filter: Filter::Sparse, ..Foveation::default() };
    let sparse = Settings { foveation: sparse, ..smr };
    let noisy = Settings { noisy: true, ..smr };
    for (name, settings, has_all) in [("smr", smr, false), ("smr, sparse", sparse, false), ("all inputs", noisy, true)]
    {
        let ([record, submit], [new, _]) = (record_us(settings, has_all, false), record_us(settings, has_all, true));
        println!(
            "{name}: record {record:.1} us, finish and submit {submit:.1} us; record with new textures {new:.1} us"
        );
        // Without kept bind groups both are equal.
        assert!(record < 0.8 * new, "{name}: {record:.1} us, {new:.1} us");
    }
}
