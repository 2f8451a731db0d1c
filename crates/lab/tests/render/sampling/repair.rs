//! Pixels that are traced beside the lattices of a sparse frame.

use super::super::trace::statistics::{p_of_means, p_of_pixels};
use crate::given::device_of_its_own;
use afterimage::{Image, wgpu};
use afterimage_lab::device::{Backend, Headless};
use afterimage_lab::frame::{DeviceSamples, OnDevice, RenderedFrame, ShadedColor, Wish};
use afterimage_lab::lattices::SampleOrder;
use afterimage_lab::source::{FrameRequest, FrameSource, ReadLimits, SceneOptions, TracedSamples, TracedSource};
use afterimage_lab::trace::film::{Film, Moments};
use afterimage_lab::trace::sampling::{Regions, Sampling};
use afterimage_lab::trace::settings::TraceSettings;
use afterimage_testing::{accept, reject};
use glam::Vec3;
use std::sync::Arc;

/// Odd sides: the last quads lie half beyond the edges.
const SIZE: [u32; 2] = [63, 35];
const GAZE_PX: [f32; 2] = [12.0, 9.0];

fn regions(samples: [u32; 3]) -> Regions {
    Regions { samples, diameters_deg: [20.0, 45.0], blocks: [2, 4], ..Regions::default() }
}

/// Direct light of a scene. `full_rate_samples`: of the reference.
fn source(input: &str, backend: &Backend, samples: [u32; 3], full_rate_samples: u32) -> TracedSource {
    let foveated = Some(Sampling::Regions(regions(samples)));
    let samples = TracedSamples { foveated, sparse: Some(SampleOrder::Bayer), samples: 1, full_rate_samples };
    let options = SceneOptions { size: Some(SIZE), ..SceneOptions::default() };
    let settings = TraceSettings { max_depth: 1, ..TraceSettings::default() };
    TracedSource::open(input, &ReadLimits::default(), &options, None, backend, settings, samples).unwrap()
}

fn request(index: u64) -> FrameRequest {
    FrameRequest { gaze_px: GAZE_PX, reference: false, ..FrameRequest::full_rate(index) }
}

/// Every third quad.
fn quads() -> Image<bool> {
    Image::from_fn(SIZE.map(|side| side.div_ceil(2)), |[x, y]| (x + y) % 3 == 0)
}

fn pixels() -> impl Iterator<Item = [u32; 2]> {
    (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]))
}

fn is_chosen([x, y]: [u32; 2]) -> bool {
    quads().at(x as usize / 2, y as usize / 2)
}

fn shade(source: &mut TracedSource, frame: &RenderedFrame) -> (Image<[f32; 3]>, Image<[f32; 2]>) {
    let shaded = source.shade(frame, &Wish { quads: quads(), on_device: None }).unwrap().unwrap();
    assert!(shaded.took.wall_ms > 0.0);
    let ShadedColor::InMemory(color) = shaded.color else { panic!("the frame is in memory") };
    (color, shaded.noise.unwrap())
}

#[test]
fn chosen_pixels_have_the_samples_of_their_lattice_and_no_other_is_traced() {
    let mut source = source("builtin:courtyard", &Backend::Cpu, [5, 3, 1], 1);
    for index in [0, 7] {
        let frame = source.render(&request(index)).unwrap();
        let lattices = frame.content.lattices().unwrap();
        let (color, noise) = shade(&mut source, &frame);
        let mut seen = [0; 6];
        for px in pixels() {
            let [x, y] = px.map(|v| v as usize);
            let expected = match lattices.at(px).unwrap().step {
                _ if !is_chosen(px) => 0,
                1 => 5,
                2 => 3,
                _ => 1,
            };
            assert_eq!(noise.at(x, y)[1], expected as f32, "samples of {px:?}, frame {index}");
            assert_eq!(color.at(x, y).iter().all(|v| v.is_finite()), expected > 0, "{px:?}, frame {index}");
            seen[expected] += 1;
        }
        assert!([0, 1, 3, 5].iter().all(|&samples| seen[samples] > 20), "pixels by samples: {seen:?}");
    }
}

/// Over many frames of a still, as each frame has other paths. Pixels beside the chosen ones would differ.
#[test]
fn chosen_pixels_show_on_average_what_a_full_rate_frame_shows() {
    const FRAMES: u64 = 48;
    let mut source = source("builtin:cornell", &Backend::Cpu, [8; 3], 8);
    let mut means = [(); 2].map(|()| Image::filled(SIZE, Moments::default()));
    let of = |color: [f32; 3]| Vec3::from(color);
    for index in 0..FRAMES {
        let frame = source.render(&request(index)).unwrap();
        let (color, _) = shade(&mut source, &frame);
        for (mean, color) in means[0].pixels_mut().iter_mut().zip(color.pixels()) {
            mean.add(of(*color));
        }
        // A steered camera: the reference of a still is traced once, and frames that differ are asked for here.
        let pose = source.camera_pose(0).unwrap().world_from_camera;
        source.steer(0, Some([pose; 2]));
        let reference = source.render(&FrameRequest { reference: true, ..request(index) }).unwrap().reference;
        for (mean, color) in means[1].pixels_mut().iter_mut().zip(reference.color.pixels()) {
            mean.add(of(*color));
        }
    }
    // Chosen pixels against those `shift` beside them.
    let p = |shift: [u32; 2]| {
        let chosen: Vec<_> =
            pixels().filter(|&px| is_chosen(px) && px[0] + 1 < SIZE[0] && px[1] + 1 < SIZE[1]).collect();
        let film = |of: &Image<Moments>, shift: [u32; 2]| {
            let moments = chosen.iter().map(|[x, y]| of.at((x + shift[0]) as usize, (y + shift[1]) as usize));
            let mut film = Film::new([chosen.len() as u32, 1]);
            for (moments, of_pixel) in film.moments.pixels_mut().iter_mut().zip(moments) {
                *moments = of_pixel;
            }
            film
        };
        let [a, b] = [film(&means[0], [0; 2]), film(&means[1], shift)];
        [p_of_pixels(&a, &b), p_of_means(&a, &b, |_| true)]
    };
    let [each, sum] = p([0, 0]);
    accept("each pixel of the full-rate frame", each);
    accept("their sum", sum);
    reject("the pixel to the right", p([1, 0])[0]);
    reject("the pixel below", p([0, 1])[0]);
}

/// Equal paths would have equal bits.
#[test]
fn chosen_pixels_share_no_path_with_the_reference_or_another_frame() {
    let mut source = source("builtin:courtyard", &Backend::Cpu, [3; 3], 3);
    let frame = source.render(&FrameRequest { reference: true, ..request(3) }).unwrap();
    let (color, _) = shade(&mut source, &frame);
    let later = source.render(&request(4)).unwrap();
    let (next, _) = shade(&mut source, &later);
    let lit = |[x, y]: &[u32; 2]| color.at(*x as usize, *y as usize).iter().any(|v| *v > 0.0);
    for (what, other) in [("the reference", &frame.reference.color), ("another frame", &next)] {
        let pairs = pixels().filter(lit).map(|[x, y]| [&color, other].map(|image| image.at(x as usize, y as usize)));
        let both: Vec<_> = pairs.filter(|[_, b]| b.iter().all(|v| v.is_finite())).collect();
        let equal = both.iter().filter(|[a, b]| a == b).count();
        println!("{what}: {equal} of {} chosen pixels equal", both.len());
        // The sky has no noise.
        assert!(both.len() > 100 && 2 * equal < both.len(), "{what}: {equal} of {}", both.len());
    }
}

/// Bits of the noise of a frame on a device.
fn noise_of(device: &Headless, frame: &DeviceSamples) -> Image<[u32; 2]> {
    let words = afterimage_testing::gpu::read_texture(&device.device, &device.queue, &frame.noise);
    Image::from_pixels(SIZE, words.chunks_exact(2).map(|texel| [texel[0], texel[1]]).collect()).unwrap()
}

#[test]
fn the_device_traces_the_same_pixels_and_reads_nothing_back() {
    let Some(device) = device_of_its_own() else { return };
    let samples = [3, 2, 1];
    let [mut cpu, mut gpu] =
        [Backend::Cpu, Backend::Gpu(device.clone())].map(|backend| source("builtin:courtyard", &backend, samples, 1));
    for index in [0, 5] {
        let frame = cpu.render(&request(index)).unwrap();
        let (color, noise) = shade(&mut cpu, &frame);
        let frame = gpu.render(&FrameRequest { device: Some(device.clone()), ..request(index) }).unwrap();
        let Some(OnDevice::Samples(held)) = OnDevice::of(&frame.content) else { panic!("on the device") };
        let of_frame = noise_of(&device, held);
        let before = device.readbacks();
        let shaded = gpu.shade(&frame, &Wish { quads: quads(), on_device: None }).unwrap().unwrap();
        assert_eq!(device.readbacks(), before);
        let ShadedColor::OnDevice(texture) = shaded.color else { panic!("on the device") };
        let texture: Arc<wgpu::Texture> = texture.downcast().unwrap();
        let (found, joined) = (device.read_rgb(&texture, 0), noise_of(&device, held));
        assert!(shaded.noise.is_none());
        for px in pixels() {
            let [x, y] = px.map(|v| v as usize);
            if is_chosen(px) {
                assert_eq!(found.at(x, y), color.at(x, y), "color of {px:?}, frame {index}");
                assert_eq!(joined.at(x, y), noise.at(x, y).map(f32::to_bits), "noise of {px:?}, frame {index}");
            } else {
                assert_eq!(joined.at(x, y), of_frame.at(x, y), "noise of the frame at {px:?}, frame {index}");
            }
        }
    }
}
