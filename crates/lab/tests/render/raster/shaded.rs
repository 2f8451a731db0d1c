//! Pixels of the full-rate frame that are shaded alone.

use super::rig::FAST;
use crate::given::{builtin, device};
use afterimage::Image;
use afterimage_lab::frame::{Content, QuadRequest, ShadedColor};
use afterimage_lab::source::{FrameRequest, FrameSource, RasterSource, SceneCamera, Wanted};

/// Odd sides: the last quads lie half beyond the edges.
const SIZE: [u32; 2] = [159, 91];

/// They have the bits of that frame with the same jitter and one sample a pixel, and nothing else is shaded. So have
/// the surfaces that a plan is made from, which differ from those of the pixels' centres.
#[test]
fn chosen_pixels_are_those_of_the_full_rate_frame() {
    let Some(device) = device() else { return };
    for scene in ["courtyard", "cubes", "mirror-room"].map(builtin).into_iter().chain([super::foveated::noise()]) {
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
            let quads = Image::from_fn(SIZE.map(|side| side.div_ceil(2)), chosen);
            let shaded = source.shade(&frame, &QuadRequest { quads, on_device: None }).unwrap().unwrap();
            assert!(shaded.took.wall_ms > 0.0);
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
