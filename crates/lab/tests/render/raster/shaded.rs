//! Pixels of the full-rate frame that are shaded alone.

use super::rig::{FAST, is_smooth};
use crate::given::{builtin, device};
use afterimage::Image;
use afterimage_lab::frame::{Content, ShadedColor, ShadingRequest};
use afterimage_lab::scene::Material;
use afterimage_lab::source::{FrameRequest, FrameSource, RasterSource, SceneCamera, Wanted};

/// Odd sides: the last quads lie half beyond the edges.
const SIZE: [u32; 2] = [159, 91];

/// They have the bits of that frame with the same jitter and one sample a pixel, and nothing else is shaded. So have
/// the surfaces that a plan is made from, which differ from those of the pixels' centres.
#[test]
fn chosen_pixels_are_those_of_the_full_rate_frame() {
    let Some(device) = device() else { return };
    for scene in ["courtyard", "cubes", "mirror-room"].map(builtin).into_iter().chain([super::noise::noise()]) {
        let camera = SceneCamera::choose(&scene, Some("walk"), SIZE, None).unwrap();
        let name = scene.name.clone();
        let mut source = RasterSource::new(device.clone(), scene, camera, None, FAST).unwrap();
        for (index, jitter_px) in [[0.3, -0.45], [-0.2, 0.1]].into_iter().enumerate() {
            let request = FrameRequest { jitter_px: Some(jitter_px), ..FrameRequest::full_rate(3 * index as u64) };
            let frame = source.render(&request).unwrap();
            let Content::Jittered(full) = &frame.content else { panic!("one sample a pixel") };
            let mut surfaces = |jitter_px| {
                let request = FrameRequest { wanted: Wanted::Surfaces, jitter_px, ..request.clone() };
                let frame = source.render(&request).unwrap();
                let Content::OnDevice(content) = &frame.content else { panic!("surfaces on the device") };
                content.read_geometry().map(|(depth, motion)| (Some(depth), Some(motion))).unwrap()
            };
            let expected = (full.depth.clone(), full.motion.clone());
            assert!(surfaces(None) != expected, "{name}: a planted error");
            assert!(surfaces(Some(jitter_px)) == expected, "{name}");
            let chosen = |[x, y]: [u32; 2]| (x * 7 + y * 5 + x * y) % 4 == index as u32;
            let mask = Image::from_fn(SIZE, |[x, y]| chosen([x / 2, y / 2]));
            let shaded = source.shade(&frame, &ShadingRequest::new(mask, None)).unwrap().unwrap();
            assert!(shaded.took.wall_ms > 0.0 && shaded.half.is_none());
            let ShadedColor::InMemory(color) = shaded.color else { panic!("asked for in memory") };
            let mut lit = 0;
            for [x, y] in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y])) {
                let [shaded, full] = [&color, &full.color].map(|image| image.at(x as usize, y as usize));
                let expected = if chosen([x / 2, y / 2]) { full } else { [0.0; 3] };
                assert_eq!(shaded.map(f32::to_bits), expected.map(f32::to_bits), "{name}, frame {index}, ({x}, {y})");
                lit += u32::from(shaded != [0.0; 3]);
            }
            assert!(lit > SIZE[0] * SIZE[1] / 8, "{name}: {lit} pixels have a color");
        }
    }
}

/// Whole quads around the middle, and one pixel of each other quad, which is drawn at half the size: that has other
/// levels of detail and rounding, but shows the same points.
#[test]
fn one_pixel_of_each_quad_is_drawn_at_half_the_size() {
    let Some(device) = device() else { return };
    for scene in ["courtyard", "cubes"].map(builtin).into_iter().chain([super::noise::noise()]) {
        let camera = SceneCamera::choose(&scene, Some("walk"), SIZE, None).unwrap();
        let name = scene.name.clone();
        let mut source = RasterSource::new(device.clone(), scene, camera, None, FAST).unwrap();
        let request = FrameRequest { jitter_px: Some([0.3, -0.45]), ..FrameRequest::full_rate(3) };
        let frame = source.render(&request).unwrap();
        let Content::Jittered(full) = &frame.content else { panic!("one sample a pixel") };
        let is_whole = |[x, y]: [u32; 2]| (60..100).contains(&x) && (30..60).contains(&y);
        for place in [[0, 0], [1, 0], [1, 1]] {
            let mask = Image::from_fn(SIZE, |px| is_whole(px) || px.map(|v| v % 2) == place);
            let request = ShadingRequest::new(mask, None);
            assert_eq!(request.half_place_px, Some(place));
            let shaded = source.shade(&frame, &request).unwrap().unwrap();
            let Some(ShadedColor::InMemory(half)) = shaded.half else { panic!("half the size") };
            assert_eq!(half.size(), SIZE.map(|side| side.div_ceil(2)));
            let depth = full.depth.as_ref().unwrap();
            // Errors of the pixel that is shown, and, planted, of its neighbour.
            let mut squares = [0.0; 2];
            let mut count = 0;
            for [x, y] in (2..SIZE[1] - 3).flat_map(|y| (2..SIZE[0] - 3).map(move |x| [x, y])) {
                let at = [x as usize, y as usize];
                if [x % 2, y % 2] == place && is_smooth(depth, at) {
                    let shown = half.at(at[0] / 2, at[1] / 2);
                    count += 1;
                    for (sum, shift) in squares.iter_mut().zip([0, 1]) {
                        let expected = full.color.at(at[0] + shift, at[1]);
                        *sum +=
                            (0..3).map(|c| f64::from(shown[c].min(1.0) - expected[c].min(1.0)).powi(2)).sum::<f64>();
                    }
                }
            }
            let [db, planted] = squares.map(|sum| -10.0 * (sum / f64::from(3 * count)).log10());
            println!("{name}, {place:?}: {db:.1} dB of {count} pixels, planted {planted:.1} dB");
            assert!(db > 35.0 && planted < db - 6.0, "{name}");
        }
    }
}

/// In white light from all sides, the color of a surface is its albedo: of a rough one, of metal, and below a coat. The
/// sky has none.
#[test]
fn albedo_is_the_color_in_white_light_from_all_sides() {
    let Some(device) = device() else { return };
    let plain = super::noise::noise();
    let material = || plain.materials[0].clone();
    let metal = Material { metallic: 0.7, roughness: 0.3, ..material() };
    let coated = Material { clearcoat: 0.5, clearcoat_roughness: 0.2, ..material() };
    for (name, material) in [("rough", material()), ("metal", metal), ("coated", coated)] {
        let mut scene = plain.clone();
        scene.materials = vec![material];
        let camera = SceneCamera::choose(&scene, Some("framing"), SIZE, None).unwrap();
        let mut source = RasterSource::new(device.clone(), scene, camera, None, FAST).unwrap();
        let jitter_px = [0.3, -0.45];
        let request = FrameRequest { jitter_px: Some(jitter_px), ..FrameRequest::full_rate(3) };
        let frame = source.render(&request).unwrap();
        let Content::Jittered(full) = &frame.content else { panic!("one sample a pixel") };
        let depth = full.depth.as_ref().unwrap();
        let [albedo, planted] = [jitter_px, [0.0; 2]].map(|jitter_px| source.albedo(3, jitter_px).unwrap());
        // The largest differences from the color, and from that with a planted jitter; number of surfaces and sky.
        let (mut off, mut counts) = ([0.0_f32; 2], [0; 2]);
        for [x, y] in (0..SIZE[1] as usize).flat_map(|y| (0..SIZE[0] as usize).map(move |x| [x, y])) {
            let is_sky = depth.at(x, y) > 1e9;
            counts[usize::from(is_sky)] += 1;
            let expected = if is_sky { [0.0; 3] } else { full.color.at(x, y) };
            for (off, found) in off.iter_mut().zip([&albedo, &planted]) {
                let found = found.at(x, y);
                *off = (0..3).map(|i| (found[i] - expected[i]).abs()).fold(*off, f32::max);
            }
        }
        assert!(counts.iter().all(|&count| count > 500), "{name}: {counts:?} pixels of surfaces and sky");
        // Half floats have 11 significant bits.
        assert!(off[0] < 1.0 / 512.0, "{name}: off by {}", off[0]);
        assert!(off[1] > 0.05, "{name}: a planted jitter is off by {} only", off[1]);
    }
}
