//! Saved pictures: the output of both sides as `run` writes it, and the contents of the window.

use super::screen::{Scene, Screen};
use crate::failure::Failure;
use afterimage::wgpu::{Texture, TextureFormat, TextureUsages};
use afterimage_lab::device::Headless;
use afterimage_lab::metric;
use afterimage_lab::picture::{to_rgb8, write_png};
use image::RgbImage;
use std::path::{Path, PathBuf};

/// The output of both sides at its own resolution, split as on screen, without overlays.
pub fn picture(gpu: &Headless, sides: [&Texture; 2], divider: Option<f32>, exposure_ev: f32) -> RgbImage {
    let read = |texture| to_rgb8(&metric::encode(&gpu.read_rgb(texture, 0), exposure_ev));
    let mut picture = read(sides[0]);
    if let Some(share) = divider {
        let right = read(sides[1]);
        let divider = share * picture.width() as f32;
        for (x, y, pixel) in picture.enumerate_pixels_mut() {
            if x as f32 + 0.5 >= divider {
                *pixel = *right.get_pixel(x, y);
            }
        }
    }
    picture
}

/// The contents of a window of `size`.
pub fn window(gpu: &Headless, size: [u32; 2], panel: &RgbImage, scene: &Scene<'_>) -> RgbImage {
    let format = TextureFormat::Rgba32Float;
    let target = gpu.texture(size, 1, format, TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC);
    let mut screen = Screen::new(gpu, format);
    screen.set_panel(gpu, panel);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    screen.record(gpu, &mut encoder, (&target.create_view(&Default::default()), size), scene, None);
    gpu.queue.submit([encoder.finish()]);
    to_rgb8(&metric::encode(&gpu.read_rgb(&target, 0), 0.0))
}

/// Writes a picture to `path`, by default to a new numbered file in the current folder, and prints the path.
pub fn write(picture: &RgbImage, path: Option<&Path>) -> Result<(), Failure> {
    let path = path.map_or_else(free_name, Path::to_owned);
    write_png(&path, picture).map_err(|e| Failure::writing(&path, e))?;
    say!("{}", path.display());
    Ok(())
}

/// The first numbered name that does not exist yet.
fn free_name() -> PathBuf {
    let names = (1..).map(|i| PathBuf::from(format!("afterimage-{i:04}.png")));
    names.into_iter().find(|path| !path.exists()).expect("the numbers are endless")
}
