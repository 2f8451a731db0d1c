//! Readbacks of several threads from one device.

use afterimage::Image;
use afterimage::wgpu::{self, TextureFormat, TextureUsages};
use afterimage_lab::device::Headless;

/// A thread's poll may hand its mapping to another thread, whose callback comes later than the poll ends.
#[test]
fn threads_that_share_a_device_all_get_their_pixels() {
    let Some(adapter) = afterimage_testing::gpu::adapter() else { return };
    let gpu = Headless::on(adapter, wgpu::Limits::default()).unwrap();
    let usage = TextureUsages::COPY_DST | TextureUsages::COPY_SRC;
    std::thread::scope(|scope| {
        for thread in 0..8 {
            let gpu = &gpu;
            scope.spawn(move || {
                let texture = gpu.texture([64, 4], 1, TextureFormat::Rgba32Float, usage);
                for round in 0..400 {
                    let color = [thread as f32, round as f32, 0.5];
                    gpu.write_rgb(&texture, 0, &Image::filled([64, 4], color));
                    assert!(gpu.read_rgb(&texture, 0).pixels().iter().all(|c| *c == color));
                }
            });
        }
    });
}
