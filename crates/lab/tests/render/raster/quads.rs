//! Frames whose quads are shaded after a method chose them.

use super::rig::FAST;
use crate::given::{builtin, device};
use afterimage::{Foveation, Image, Method, MethodKind, Settings, Smr};
use afterimage_lab::device::{Backend, Headless};
use afterimage_lab::frame::{Content, RenderedFrame};
use afterimage_lab::metric::encode;
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::scene::Scene;
use afterimage_lab::source::{FrameRequest, FrameSource, RasterSource, SceneCamera, Wanted};
use std::error::Error;
use std::sync::Arc;

/// Odd sides: the last quads lie half beyond the edges.
const SIZE: [u32; 2] = [159, 91];

/// Largest difference of encoded colors, of chosen pixels or of all.
fn largest(a: &Image<[f32; 3]>, b: &Image<[f32; 3]>, chosen: Option<&Image<bool>>) -> f32 {
    let [a, b] = [a, b].map(|image| encode(image, 0.0));
    let counts = |x: u32, y: u32| chosen.is_none_or(|quads| quads.at(x as usize / 2, y as usize / 2));
    let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))).filter(|&(x, y)| counts(x, y));
    let difference = |(x, y): (u32, u32)| {
        let [a, b] = [&a, &b].map(|image| image.at(x as usize, y as usize));
        (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f32::max)
    };
    pixels.map(difference).fold(0.0, f32::max)
}

/// Surfaces and quads of a scene from the rasteriser, and the same methods on whole frames of which a simulator gives
/// them the quads.
struct Twins {
    source: RasterSource,
    rendered: Pipeline,
    simulated: Pipeline,
    methods: Vec<Method>,
}

impl Twins {
    fn new(device: &Arc<Headless>, scene: Scene, is_jittered: bool) -> Self {
        let camera = SceneCamera::choose(&scene, Some("walk"), SIZE, None).unwrap();
        let geometry = *camera.geometry();
        let source = RasterSource::new(device.clone(), scene, camera, None, FAST).unwrap();
        let smr = Method::Smr(Smr { antialias: is_jittered, ..Smr::default() });
        let methods = vec![MethodKind::None.into(), MethodKind::Taau.into(), MethodKind::Wrs.into(), smr];
        let kinds = methods.iter().map(|&method| RunKind::PostProcess(Settings { method, ..Settings::default() }));
        let kinds: Vec<_> = kinds.collect();
        let pipeline = || {
            let made = Pipeline::new(geometry, Foveation::quads(), &kinds, false, &[], &Backend::Cpu).unwrap();
            if is_jittered { made.with_jitter() } else { made }
        };
        Self { source, rendered: pipeline(), simulated: pipeline(), methods }
    }

    /// The next frame: the largest difference of the outputs of each method, and of chosen pixels from the full-rate
    /// frame. `is_wrong`: a planted error, depth and motion of the pixels' centres.
    fn next(&mut self, index: u64, is_wrong: bool) -> (Vec<f32>, f32) {
        let gaze = Some([60.0 + 10.0 * index as f32, 50.0]);
        let request = self.rendered.request(index, gaze);
        self.simulated.request(index, gaze);
        assert_eq!(request.wanted, Wanted::Surfaces);
        // One sample a pixel, with or without jitter.
        let jitter_px = request.jitter_px.or(Some([0.0; 2]));
        let whole = FrameRequest { wanted: Wanted::FullRate, jitter_px, ..request.clone() };
        let whole = self.source.render(&whole).unwrap();
        assert!(matches!(whole.content, Content::Jittered(_)));
        let frame = if is_wrong {
            let frame = self.source.render(&FrameRequest { jitter_px: None, ..request.clone() }).unwrap();
            RenderedFrame { jitter_px: request.jitter_px.unwrap(), ..frame }
        } else {
            self.source.render(&request).unwrap()
        };
        assert!(frame.samples.is_none() && frame.render.unwrap().wall_ms > 0.0);
        let simulated = self.simulated.step(&whole).unwrap();
        let source = &mut self.source;
        let mut requests = vec![];
        let mut shade = |request: &_| -> Result<_, Box<dyn Error>> {
            requests.push(Clone::clone(request));
            Ok(source.shade(&frame, request)?)
        };
        let rendered = self.rendered.step_with(&frame, &mut shade).unwrap();
        assert_eq!(rendered.lods, simulated.lods);
        let mut worst = 0.0_f32;
        let first = index as usize % self.methods.len();
        for (i, (shown, whole_shown)) in rendered.outputs.iter().zip(&simulated.outputs).enumerate() {
            let [chosen, of_whole] = [shown, whole_shown].map(|output| output.chosen.unwrap());
            assert!(chosen.shading.unwrap().wall_ms > 0.0 && of_whole.shading.is_none());
            // The pipeline begins with another method in each frame.
            let request: &afterimage_lab::frame::QuadRequest =
                &requests[(i + self.methods.len() - first) % self.methods.len()];
            assert_eq!(chosen.share, request.share(SIZE));
            if self.methods[i] == MethodKind::None.into() {
                worst = worst.max(largest(&shown.image, &whole.given().color, Some(&request.quads)));
            }
        }
        let outputs = rendered.outputs.iter().zip(&simulated.outputs);
        (outputs.map(|(a, b)| largest(&a.image, &b.image, None)).collect(), worst)
    }
}

/// Colors between the chosen quads are black where a renderer shades them, and those of the frame where a simulator has
/// them: no method reads them.
#[test]
fn rendered_quads_show_what_a_simulator_shows_that_has_the_whole_frame() {
    let Some(device) = device() else { return };
    for (name, is_jittered) in [("courtyard", true), ("cubes", false)] {
        let mut twins = Twins::new(&device, builtin(name), is_jittered);
        for index in 0..4 {
            let (outputs, chosen) = twins.next(index, false);
            println!("{name}, jitter {is_jittered}, frame {index}: {outputs:?}, chosen pixels {chosen}");
            let limit = 1.0 / 255.0;
            assert!(chosen <= limit && outputs.iter().all(|&d| d <= limit), "{name}, frame {index}: {outputs:?}");
        }
    }
}

#[test]
fn surfaces_of_pixel_centres_show_something_else() {
    let Some(device) = device() else { return };
    let mut twins = Twins::new(&device, builtin("courtyard"), true);
    let wrong: Vec<f32> = (0..2).flat_map(|index| twins.next(index, true).0).collect();
    assert!(wrong.iter().any(|&d| d > 1.0 / 255.0), "a planted error is seen: {wrong:?}");
}
