//! Ten thousand frames with resizes leak nothing. Alone in its file, for a process of its own: other tests' memory comes and goes.
#![cfg(feature = "gpu")]

#[path = "common/gpu.rs"]
mod gpu;

use afterimage::display::ViewGeometry;
use afterimage::frame::{Gaze, ViewFrame};
use afterimage::gpu::{Afterimage, Frame, GpuDesc};
use wgpu::{TextureFormat, TextureUsages};

/// Resident memory of this process in MiB, where the system tells.
fn resident_mib() -> Option<f64> {
    let pages: f64 = std::fs::read_to_string("/proc/self/statm").ok()?.split(' ').nth(1)?.parse().ok()?;
    Some(pages * 4096.0 / f64::from(1 << 20))
}

#[test]
fn ten_thousand_frames_with_resizes_leak_nothing() {
    let Some((device, queue)) = gpu::device() else { return };
    let desc = GpuDesc::new([24, 16], TextureFormat::Rgba16Float);
    let mut post = Afterimage::new(&device, &desc).unwrap();
    let mut resident = vec![];
    let mut textures = None;
    for index in 0..10_000_u64 {
        if index % 97 == 0 {
            let size = [16 + (index / 97 % 40) as u32, 24 - (index / 97 % 9) as u32];
            post.resize(&device, size).unwrap();
            let make = |usage| {
                device.create_texture(&wgpu::TextureDescriptor {
                    label: None,
                    size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                    mip_level_count: 1,
                    sample_count: 1,
                    dimension: wgpu::TextureDimension::D2,
                    format: TextureFormat::Rgba16Float,
                    usage,
                    view_formats: &[],
                })
            };
            textures = Some((make(TextureUsages::TEXTURE_BINDING), make(TextureUsages::STORAGE_BINDING)));
        }
        let (color, output) = textures.as_ref().unwrap();
        let geometry = ViewGeometry::flat(post.desc().context.size_px, 70.0).unwrap();
        let views = [ViewFrame { geometry, gaze: Gaze::Lost, previous_from_current: None }];
        let frame = Frame::new(color, output, &views, index);
        let mut encoder = device.create_command_encoder(&Default::default());
        post.record(&device, &mut encoder, &frame).unwrap();
        queue.submit([encoder.finish()]);
        if index % 50 == 49 {
            device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        }
        if index % 4_000 == 1_999 {
            resident.extend(resident_mib());
        }
    }
    println!("resident after 2,000, 6,000 and 10,000 frames: {resident:.1?} MiB");
    // A leak grows all the time, and one of a kilobyte a frame by 4 MiB each time; what the driver makes late, it makes once.
    let growth = resident.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
    assert!(resident.is_empty() || growth < 2.0, "{growth} MiB");
}
