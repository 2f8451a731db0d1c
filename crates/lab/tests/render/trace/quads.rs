//! Quads that methods choose, path-traced after their choice.

use crate::given::backends;
use afterimage::{Foveation, Image, MethodKind, Settings, ViewGeometry};
use afterimage_lab::device::Backend;
use afterimage_lab::frame::{Content, QuadRequest, RenderedFrame, ShadedColor};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::source::{FrameSource, ReadLimits, SceneOptions, TracedSamples, TracedSource, Wanted};
use afterimage_lab::trace::sampling::Sampling;
use afterimage_lab::trace::settings::TraceSettings;
use std::error::Error;

/// Odd sides: the last quads lie half beyond the edges.
const SIZE: [u32; 2] = [79, 45];
const HFOV_DEG: f32 = 70.0;

fn source(backend: &Backend) -> TracedSource {
    let samples = TracedSamples { foveated: Some(Sampling::Uniform), sparse: None, samples: 8, full_rate_samples: 8 };
    let options = SceneOptions { size: Some(SIZE), hfov_deg: Some(HFOV_DEG), ..SceneOptions::default() };
    let (limits, settings) = (ReadLimits::default(), TraceSettings::default());
    TracedSource::open("builtin:cubes", &limits, &options, Some("orbit"), backend, settings, samples).unwrap()
}

fn shade(source: &mut TracedSource, frame: &RenderedFrame, quads: Image<bool>) -> Image<[f32; 3]> {
    let shaded = source.shade(frame, &QuadRequest { quads, on_device: None }).unwrap().unwrap();
    assert!(shaded.took.wall_ms > 0.0);
    let ShadedColor::InMemory(color) = shaded.color else { panic!("traced pixels are read back") };
    color
}

/// Number of pixels, of chosen quads or of the others, whose colors differ.
fn differing(a: &Image<[f32; 3]>, b: &Image<[f32; 3]>, quads: &Image<bool>, chosen: bool) -> usize {
    let pixels = (0..SIZE[1] as usize).flat_map(|y| (0..SIZE[0] as usize).map(move |x| (x, y)));
    let of = pixels.filter(|(x, y)| quads.at(x / 2, y / 2) == chosen);
    of.filter(|(x, y)| a.at(*x, *y).map(f32::to_bits) != b.at(*x, *y).map(f32::to_bits)).count()
}

fn mean(image: &Image<[f32; 3]>) -> f64 {
    let pixels = image.pixels();
    pixels.iter().flatten().map(|&v| f64::from(v)).sum::<f64>() / (3 * pixels.len()) as f64
}

/// A chosen pixel has the same samples whatever else is chosen, on either backend. They are draws of their own beside
/// those of the reference, and have its mean.
#[test]
fn a_chosen_pixel_is_that_of_the_whole_frame() {
    let geometry = ViewGeometry::flat(SIZE, HFOV_DEG).unwrap();
    let of_smr = RunKind::PostProcess(Settings { method: MethodKind::Smr.into(), ..Settings::default() });
    for backend in &backends() {
        let mut source = source(backend);
        let mut pipeline =
            Pipeline::new(geometry, Foveation::quads(), std::slice::from_ref(&of_smr), false, &[], backend).unwrap();
        for index in 0..3 {
            let request = pipeline.request(index, Some([30.0 + 10.0 * index as f32, 20.0]));
            assert_eq!(request.wanted, Wanted::Surfaces);
            let frame = source.render(&request).unwrap();
            assert!(matches!(frame.content, Content::Surfaces) && frame.render.unwrap().wall_ms > 0.0);
            let sides = SIZE.map(|side| side.div_ceil(2));
            let whole = shade(&mut source, &frame, Image::filled(sides, true));
            let mut requests = vec![];
            let mut chosen = |request: &QuadRequest| -> Result<_, Box<dyn Error>> {
                let shaded = source.shade(&frame, request)?;
                if let Some(ShadedColor::InMemory(color)) = shaded.as_ref().map(|shaded| &shaded.color) {
                    requests.push((request.quads.clone(), color.clone()));
                }
                Ok(shaded)
            };
            let step = pipeline.step_with(&frame, &mut chosen).unwrap();
            let share = step.outputs[0].chosen.unwrap().share;
            let [(quads, color)] = &requests[..] else { panic!("one method") };
            assert!((0.02..0.5).contains(&share), "{share}");
            assert_eq!(differing(color, &whole, quads, true), 0, "frame {index}");
            assert!(differing(color, &whole, quads, false) > SIZE[0] as usize, "others are traced, too");
            let [traced, reference] = [&whole, &frame.reference.color].map(mean);
            println!("frame {index}: {share:.3} of the pixels, mean {traced:.4} beside {reference:.4}");
            assert!((traced / reference - 1.0).abs() < 0.05, "{traced} beside {reference}");
            assert!(differing(&whole, &frame.reference.color, quads, true) > 10, "the draws of the reference");
            // A planted error: the draws of another frame.
            let other = RenderedFrame { index: index + 1, ..frame.clone() };
            let other = shade(&mut source, &other, Image::filled(sides, true));
            assert!(differing(color, &other, quads, true) > 10);
        }
    }
}
