//! Pixels that methods choose, path-traced after their choice, with numbers of paths of their own.

use super::rig::backends;
use afterimage::internal::{Foveation, MethodKind, Settings};
use afterimage::{Image, ViewGeometry};
use afterimage_lab::device::Backend;
use afterimage_lab::frame::{Content, RenderedFrame, Shaded, ShadedColor, ShadingRequest};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::source::{FrameSource, ReadLimits, SceneOptions, Wanted};
use afterimage_trace::sampling::Sampling;
use afterimage_trace::settings::TraceSettings;
use afterimage_trace::{TracedSamples, TracedSource};
use std::error::Error;

/// Odd sides: the last quads lie half beyond the edges.
const SIZE: [u32; 2] = [79, 45];
const HFOV_DEG: f32 = 70.0;

fn source(backend: &Backend) -> TracedSource {
    let samples = TracedSamples { foveated: Some(Sampling::Uniform), samples: 8, full_rate_samples: 8 };
    let options = SceneOptions { size: Some(SIZE), hfov_deg: Some(HFOV_DEG), ..SceneOptions::default() };
    let (limits, settings) = (ReadLimits::default(), TraceSettings::default());
    TracedSource::open("builtin:cubes", &limits, &options, Some("orbit"), backend, settings, samples).unwrap()
}

fn color_of(shaded: &Shaded) -> &Image<[f32; 3]> {
    let ShadedColor::InMemory(color) = &shaded.color else { panic!("traced pixels are read back") };
    color
}

fn shade(source: &mut TracedSource, frame: &RenderedFrame, paths: Option<u8>) -> Shaded {
    let request = ShadingRequest::new(Image::filled(SIZE, true), None);
    let shaded = source.shade(frame, &request.with_paths(paths.map(|n| Image::filled(SIZE, n)))).unwrap().unwrap();
    assert!(shaded.took.wall_ms > 0.0 && shaded.half.is_none());
    shaded
}

fn pixels() -> impl Iterator<Item = [usize; 2]> {
    (0..SIZE[1] as usize).flat_map(|y| (0..SIZE[0] as usize).map(move |x| [x, y]))
}

/// Number of pixels, chosen or not, whose colors differ.
fn differing(a: &Image<[f32; 3]>, b: &Image<[f32; 3]>, mask: &Image<bool>, chosen: bool) -> usize {
    let of = pixels().filter(|&[x, y]| mask.at(x, y) == chosen);
    of.filter(|&[x, y]| a.at(x, y).map(f32::to_bits) != b.at(x, y).map(f32::to_bits)).count()
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
            let whole = shade(&mut source, &frame, None);
            let whole = color_of(&whole);
            let mut requests = vec![];
            let mut chosen = |request: &ShadingRequest| -> Result<_, Box<dyn Error>> {
                let shaded = source.shade(&frame, request)?;
                requests.extend(shaded.as_ref().map(|shaded| (request.mask.clone(), color_of(shaded).clone())));
                Ok(shaded)
            };
            let step = pipeline.step_with(&frame, &mut chosen).unwrap();
            let share = step.outputs[0].chosen.unwrap().share;
            let [(mask, color)] = &requests[..] else { panic!("one method") };
            assert!((0.02..0.5).contains(&share), "{share}");
            assert_eq!(differing(color, whole, mask, true), 0, "frame {index}");
            assert!(differing(color, whole, mask, false) > SIZE[0] as usize, "others are traced, too");
            let [traced, reference] = [whole, &frame.reference.color].map(mean);
            println!("frame {index}: {share:.3} of the pixels, mean {traced:.4} beside {reference:.4}");
            assert!((traced / reference - 1.0).abs() < 0.05, "{traced} beside {reference}");
            assert!(differing(whole, &frame.reference.color, mask, true) > 10, "the draws of the reference");
            // A planted error: the draws of another frame.
            let other = RenderedFrame { index: index + 1, ..frame.clone() };
            let other = shade(&mut source, &other, None);
            assert!(differing(color, color_of(&other), mask, true) > 10);
        }
    }
}

/// Pixels of a noisy plan get the paths that it asks for: each is the pixel of a frame with as many everywhere. Their
/// noise says how many there were.
#[test]
fn pixels_have_the_paths_that_were_asked_for() {
    let geometry = ViewGeometry::flat(SIZE, HFOV_DEG).unwrap();
    let foveation = Foveation { single_pixels: true, budget: 0.2, ..Foveation::quads() };
    let of_smr = RunKind::PostProcess(Settings { foveation, ..Settings::traced() });
    for backend in &backends() {
        let mut source = source(backend);
        let mut pipeline =
            Pipeline::new(geometry, foveation, std::slice::from_ref(&of_smr), false, &[], backend).unwrap();
        let mut most = 0;
        for index in 0..4 {
            let frame = source.render(&pipeline.request(index, Some([30.0, 20.0]))).unwrap();
            let mut answers = vec![];
            let mut chosen = |request: &ShadingRequest| -> Result<_, Box<dyn Error>> {
                let shaded = source.shade(&frame, request)?;
                answers.extend(shaded.iter().map(|shaded| (request.clone(), shaded.clone())));
                Ok(shaded)
            };
            pipeline.step_with(&frame, &mut chosen).unwrap();
            let [(request, shaded)] = &answers[..] else { panic!("one method") };
            let (paths, noise) = (request.paths.as_ref().unwrap(), shaded.noise.as_ref().unwrap());
            for n in 1..=16 {
                if paths.pixels().iter().all(|&paths| paths != n) {
                    continue;
                }
                most = most.max(n);
                let whole = shade(&mut source, &frame, Some(n));
                for [x, y] in pixels().filter(|&[x, y]| paths.at(x, y) == n) {
                    assert_eq!(color_of(shaded).at(x, y), color_of(&whole).at(x, y), "{n} paths at {x}, {y}");
                    assert_eq!(noise.at(x, y)[1], f32::from(n));
                }
            }
            for [x, y] in pixels() {
                assert_eq!(paths.at(x, y) > 0, request.mask.at(x, y));
                assert_eq!(noise.at(x, y)[1], f32::from(paths.at(x, y)));
            }
        }
        assert!(most > 1, "no pixel has several paths");
    }
}
