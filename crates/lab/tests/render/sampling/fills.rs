//! Reconstruction: constants stay constant, ramps stay ramps, no pixel is left empty, both tracers agree.

use afterimage_lab::device::{Backend, Headless};
use afterimage_lab::scene::{Scene, SceneLimits, builtin};
use afterimage_lab::trace::Tracer;
use afterimage_lab::trace::sampling::{Acuity, Layers, Regions, Sampling};
use afterimage_lab::trace::settings::TraceSettings;
use afterimage_lab::trace::view::View;
use afterimage_lab::trace::world::World;

fn patterns() -> [Sampling; 4] {
    [
        Sampling::Uniform,
        Sampling::Regions(Regions { samples: [4, 2, 1], ..Regions::default() }),
        Sampling::Layers(Layers::default()),
        Sampling::Acuity(Acuity::default()),
    ]
}

pub(super) fn view(scene: &Scene, size: [u32; 2]) -> View {
    View::of_camera(&scene.pose(0.0).cameras[0], size, None).unwrap()
}

#[test]
fn a_furnace_without_a_ball_is_one_everywhere() {
    // Every sample is 1, so every pixel must be 1, for any gaze.
    let mut scene = Scene::open("builtin:control", &SceneLimits::default()).unwrap();
    scene.environment = afterimage_lab::scene::Environment::Constant([1.0; 3]);
    let world = World::new(&scene);
    let tracer = Tracer::new(&Backend::Cpu, &world, TraceSettings::default()).unwrap();
    let view = view(&scene, [161, 91]);
    for sampling in patterns() {
        for gaze in [[80.0, 45.0], [0.0, 0.0], [160.0, 90.0], [-500.0, 40.0], [1e9, f32::NAN]] {
            let done = sampling.plan(view.geometry(), gaze, 2, 1).trace(&tracer, &world, &view, 1);
            let worst = done.color.pixels().iter().flatten().map(|v| (v - 1.0).abs()).fold(0.0, f32::max);
            assert!(worst < 1e-5, "{sampling:?}, gaze {gaze:?}: {worst}");
        }
    }
}

#[test]
fn the_fovea_is_what_uniform_sampling_gives() {
    let scene = builtin::courtyard_of(2000);
    let world = World::new(&scene);
    let tracer = Tracer::new(&Backend::Cpu, &world, TraceSettings::default()).unwrap();
    let view = view(&scene, [160, 90]);
    let uniform = Sampling::Uniform.plan(view.geometry(), [0.0; 2], 4, 0).trace(&tracer, &world, &view, 0).color;
    for sampling in &patterns()[1..] {
        let done = sampling.plan(view.geometry(), [80.0, 45.0], 4, 0).trace(&tracer, &world, &view, 0);
        // Within one degree of the gaze, which every pattern samples fully.
        for (x, y) in [(80, 45), (79, 44), (81, 46), (80, 44)] {
            assert_eq!(done.color.at(x, y), uniform.at(x, y), "{sampling:?} at {x}, {y}");
        }
        assert!(done.color.pixels().iter().flatten().all(|v| v.is_finite() && *v >= 0.0));
        assert_eq!(done.lod.at(80, 45), 0.0);
    }
}

#[test]
fn foveated_means_are_those_of_uniform_sampling() {
    // Reconstruction blurs but does not brighten: the frame's mean stays within noise.
    let scene = builtin::courtyard_of(2000);
    let world = World::new(&scene);
    let tracer = Tracer::new(&Backend::Cpu, &world, TraceSettings::default()).unwrap();
    let view = view(&scene, [320, 180]);
    let mean = |sampling: &Sampling, samples: u32| {
        let done = sampling.plan(view.geometry(), [160.0, 90.0], samples, 0).trace(&tracer, &world, &view, 0);
        done.color.pixels().iter().map(|c| f64::from(c[1])).sum::<f64>() / (320.0 * 180.0)
    };
    let uniform = mean(&Sampling::Uniform, 8);
    for sampling in &patterns()[1..] {
        let foveated = mean(sampling, 8);
        println!("{sampling:?}: {foveated:.5} of {uniform:.5}");
        assert!((foveated / uniform - 1.0).abs() < 0.02, "{sampling:?}: {foveated} of {uniform}");
    }
}

#[test]
fn the_device_traces_the_same_foveated_frames() {
    // Prints that there is no adapter, and fails where one is required.
    if afterimage_testing::gpu::device().is_none() {
        return;
    }
    let device = Headless::find_roomy(true).expect("there is an adapter");
    let scene = builtin::courtyard_of(2000);
    let world = World::new(&scene);
    let [cpu, gpu] = [Backend::Cpu, Backend::Gpu(device)]
        .map(|backend| Tracer::new(&backend, &world, TraceSettings::default()).unwrap());
    let view = view(&scene, [160, 90]);
    for sampling in patterns() {
        let plan = sampling.plan(view.geometry(), [60.0, 50.0], 2, 5);
        let [a, b] = [&cpu, &gpu].map(|tracer| plan.trace(tracer, &world, &view, 5));
        let same = a.color.pixels().iter().zip(b.color.pixels()).filter(|(a, b)| a == b).count();
        assert_eq!((a.samples, a.rays), (b.samples, b.rays), "{sampling:?}");
        assert!(same == a.color.pixels().len(), "{sampling:?}: {same} pixels are equal");
    }
}
