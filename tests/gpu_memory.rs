//! Ten thousand frames with resizes leak no memory. A file of its own, for a process of its own.

use afterimage::gpu::{Afterimage, Frame};
use afterimage::internal::{ContextDesc, ViewFrame};
use afterimage::wgpu::{self, TextureFormat, TextureUsages};
use afterimage::{Gaze, ViewGeometry};

#[test]
fn ten_thousand_frames_with_resizes_leak_nothing() {
    let Some((device, queue)) = afterimage_testing::gpu::device() else { return };
    let desc = ContextDesc::new([24, 16]);
    let mut post = Afterimage::new(&device, &desc, TextureFormat::Rgba16Float).unwrap();
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
        let geometry = ViewGeometry::flat(post.desc().size_px, 70.0).unwrap();
        let views = [ViewFrame::new(geometry, Gaze::Lost)];
        let frame = Frame::new(color, &views, index);
        let mut encoder = device.create_command_encoder(&Default::default());
        post.record(&device, &mut encoder, &frame, output).unwrap();
        queue.submit([encoder.finish()]);
        if index % 50 == 49 {
            device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        }
        if index % 4_000 == 1_999 {
            resident.extend(afterimage_testing::resident::resident_mib());
        }
    }
    println!("resident after 2,000, 6,000 and 10,000 frames: {resident:.1?} MiB");
    // A leak of a kilobyte a frame is 4 MiB each time.
    let growth = afterimage_testing::resident::least_growth_mib(&resident);
    assert!(resident.is_empty() || growth < 2.0, "{growth} MiB");
}
