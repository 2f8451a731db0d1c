//! Time that sources state for what they render.

use crate::roomy::roomy_device;
use afterimage::{Filter, Foveation, ViewGeometry};
use afterimage_lab::clock::Stopwatch;
use afterimage_lab::device::Backend;
use afterimage_lab::lattices::SparseGeometry;
use afterimage_lab::source::{
    AnalyticSource, FrameRequest, FrameSource, RasterSource, ReadLimits, SceneOptions, TracedSamples, TracedSource,
    Wanted,
};
use afterimage_lab::trace::sampling::{Regions, Sampling};
use afterimage_lab::trace::settings::TraceSettings;

const SIZE: [u32; 2] = [320, 180];
const OPTIONS: SceneOptions = SceneOptions { size: Some(SIZE), hfov_deg: None, fps: None };

#[test]
fn rasterised_frames_state_the_time_of_rendering_alone() {
    // A software device spends CPU time of the process.
    afterimage_testing::alone(time_rasterised_frames);
}

fn time_rasterised_frames() {
    let Some(device) = roomy_device() else { return };
    let mut source =
        RasterSource::open("builtin:cubes", &ReadLimits::default(), &OPTIONS, None, device.clone()).unwrap();
    let watch = Stopwatch::start();
    let frame = source.render(&FrameRequest::full_rate(1)).unwrap();
    let whole = watch.elapsed();
    let full_rate = frame.full_rate.unwrap();
    assert_eq!(frame.render, Some(full_rate), "nothing else was rendered");
    assert!(full_rate.wall_ms > 0.0 && full_rate.wall_ms < whole.wall_ms, "{full_rate:?} of {whole:?}");
    assert_eq!(full_rate.device_ms.is_some(), !device.is_software(), "{full_rate:?}");

    // Small regions, so that few samples are left; the first such frame compiles pipelines.
    let foveation = Foveation { filter: Filter::Sparse, rate_mid: 4, rate_far: 8, ..Foveation::default() };
    let geometry = ViewGeometry::flat(SIZE, source.info().hfov_deg.unwrap()).unwrap();
    // The least of frames in turn, since other work on the machine makes single ones slower.
    let [mut everywhere, mut at_samples] = [f64::INFINITY; 2];
    for index in 0..16 {
        let lattices = foveation.lattices(&geometry, [160.0, 90.0], index);
        let wanted = Wanted::Lattices(lattices);
        for (geometry, least) in [(SparseGeometry::Full, &mut everywhere), (SparseGeometry::Samples, &mut at_samples)] {
            let request = FrameRequest { wanted: wanted.clone(), geometry, ..FrameRequest::full_rate(index) };
            let frame = source.render(&request).unwrap();
            assert!(frame.full_rate.is_some() && frame.samples.is_some());
            *least = least.min(frame.render.unwrap().cost_ms());
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
    // The reference has other samples a pixel: it has no time that says anything about foveation.
    let watch = Stopwatch::start();
    let frame = source.render(&FrameRequest { gaze_px: [160.0, 90.0], ..FrameRequest::full_rate(0) }).unwrap();
    let (whole, foveated) = (watch.elapsed(), frame.render.unwrap());
    assert_eq!((frame.full_rate, frame.reference.color.size()), (None, SIZE));
    println!("both {whole:?}, foveated {foveated:?}");
    assert!(0.0 < foveated.cost_ms() && foveated.cost_ms() < whole.cost_ms());
    assert_eq!(foveated.device_ms, None, "the CPU has no timestamps");
    // Without a sampling pattern, the frame is the full-rate one.
    let samples = TracedSamples { foveated: None, ..samples };
    let mut source =
        TracedSource::open("builtin:cornell", &limits, &OPTIONS, camera, &Backend::Cpu, settings, samples).unwrap();
    let [first, second] = [0, 1].map(|index| source.render(&FrameRequest::full_rate(index)).unwrap());
    assert!(first.render.is_some() && first.render == first.full_rate);
    assert_eq!(second.render, first.render, "the frame is that of before");
}

#[test]
fn frames_that_are_not_rendered_have_no_time() {
    let mut source = AnalyticSource::new("still", [32, 18], 70.0, 60.0).unwrap();
    let frame = source.render(&FrameRequest::full_rate(0)).unwrap();
    assert_eq!((frame.render, frame.full_rate), (None, None));
}
