//! Time that sources state for what they render.

use afterimage::{Filter, Foveation, ViewGeometry};
use afterimage_lab::clock::Stopwatch;
use afterimage_lab::device::{Backend, Headless};
use afterimage_lab::source::{
    AnalyticSource, FrameSource, PeekedSource, RasterSource, ReadLimits, SceneOptions, TracedSamples, TracedSource,
};
use afterimage_lab::trace::sampling::{Regions, Sampling};
use afterimage_lab::trace::settings::TraceSettings;

const SIZE: [u32; 2] = [320, 180];
const OPTIONS: SceneOptions = SceneOptions { size: Some(SIZE), hfov_deg: None, fps: None };

#[test]
fn rasterised_frames_state_the_time_of_rendering_alone() {
    if afterimage_testing::gpu::adapter().is_none() {
        return;
    }
    let device = Headless::find_roomy(true).unwrap();
    let mut source =
        RasterSource::open("builtin:cubes", &ReadLimits::default(), &OPTIONS, None, device.clone()).unwrap();
    assert_eq!(source.render_time(), None, "nothing was rendered yet");
    let mut source = PeekedSource::new(&mut source).unwrap();
    let peeked = source.render_time().unwrap();
    source.frame(0).unwrap();
    assert_eq!(source.render_time(), Some(peeked), "that frame was rendered when it was peeked at");

    let watch = Stopwatch::start();
    source.frame(1).unwrap();
    let whole = watch.elapsed();
    let full_rate = source.render_time().unwrap();
    assert!(full_rate.wall_ms > 0.0 && full_rate.wall_ms < whole.wall_ms, "{full_rate:?} of {whole:?}");
    assert_eq!(full_rate.device_ms.is_some(), !device.is_software(), "{full_rate:?}");

    // Small regions, so that few samples are left; the first such frame compiles pipelines.
    let foveation = Foveation { filter: Filter::Sparse, rate_mid: 4, rate_far: 8, ..Foveation::default() };
    let geometry = ViewGeometry::flat(SIZE, source.info().hfov_deg.unwrap()).unwrap();
    // The least of frames in turn, since other work on the machine makes single ones slower.
    let [mut everywhere, mut at_samples] = [f64::INFINITY; 2];
    for index in 0..16 {
        let lattices = foveation.lattices(&geometry, [160.0, 90.0], index);
        for (lattices, least) in [(lattices, &mut everywhere), (lattices.with_geometry_at_samples(), &mut at_samples)] {
            source.sparse(index, &lattices).unwrap().unwrap();
            *least = least.min(source.render_time().unwrap().cost_ms());
        }
    }
    println!("full rate {full_rate:?}, sparse {everywhere:.2} ms, with depth and motion at samples {at_samples:.2} ms");
    assert!(at_samples < everywhere, "depth and motion at every pixel take time");
}

#[test]
fn traced_frames_state_the_time_of_tracing_and_stills_repeat_it() {
    let samples = TracedSamples {
        foveated: Some(Sampling::Regions(Regions { samples: [1, 1, 1], ..Regions::default() })),
        sparse: None,
        samples: 1,
        full_rate_samples: 4,
    };
    let (limits, settings) = (ReadLimits::default(), TraceSettings::default());
    let camera = Some("still");
    let mut source =
        TracedSource::open("builtin:cornell", &limits, &OPTIONS, camera, &Backend::Cpu, settings, samples).unwrap();
    assert!(source.info().still);
    source.frame(0).unwrap();
    let full_rate = source.render_time().unwrap();
    source.foveated(0, [160.0, 90.0], None).unwrap().unwrap();
    let foveated = source.render_time().unwrap();
    println!("full rate {full_rate:?}, foveated {foveated:?}");
    assert!(0.0 < foveated.cost_ms() && foveated.cost_ms() < full_rate.cost_ms());
    assert_eq!(foveated.device_ms, None, "the CPU has no timestamps");
    source.frame(1).unwrap();
    assert_eq!(source.render_time(), Some(full_rate), "the frame is that of before");
}

#[test]
fn frames_that_are_not_rendered_have_no_time() {
    let mut source = AnalyticSource::new("still", [32, 18], 70.0, 60.0).unwrap();
    source.frame(0).unwrap();
    assert_eq!(source.render_time(), None);
}
