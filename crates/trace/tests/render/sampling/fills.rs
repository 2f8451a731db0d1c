//! Reconstruction: constants stay constant, ramps stay ramps, no pixel is left empty, both tracers agree.

use crate::given;
use crate::given::device;
use afterimage::ViewGeometry;
use afterimage_lab::device::Backend;
use afterimage_lab::frame::FoveatedFrame;
use afterimage_lab::scene::{Scene, builtin};
use afterimage_lab::view::View;
use afterimage_trace::Tracer;
use afterimage_trace::sampling::{Acuity, Layers, Regions, Sampling};
use afterimage_trace::settings::TraceSettings;
use afterimage_trace::world::World;

fn patterns() -> [Sampling; 4] {
    [
        Sampling::Uniform,
        Sampling::Regions(Regions { samples: [4, 2, 1], ..Regions::default() }),
        Sampling::Layers(Layers::default()),
        Sampling::Acuity(Acuity::default()),
    ]
}

/// A scene, seen by its camera, with a tracer on the CPU.
pub(super) struct Yard {
    pub world: World,
    pub view: View,
    pub tracer: Tracer,
}

impl Yard {
    /// The courtyard.
    pub fn new(size: [u32; 2], settings: TraceSettings) -> Self {
        Self::of(&builtin::courtyard_of(2000), size, settings)
    }

    fn of(scene: &Scene, size: [u32; 2], settings: TraceSettings) -> Self {
        let world = World::new(scene);
        let view = View::of_camera(&scene.pose(0.0).cameras[0], size, None).unwrap();
        let tracer = Tracer::new(&Backend::Cpu, &world, settings).unwrap();
        Self { world, view, tracer }
    }

    pub fn geometry(&self) -> &ViewGeometry {
        self.view.geometry()
    }

    /// Tracers on the CPU and on the device; `None` without one.
    pub fn on_both(self) -> Option<(Self, Tracer)> {
        let on_device = Tracer::new(&Backend::Gpu(device()?), &self.world, TraceSettings::default()).unwrap();
        Some((self, on_device))
    }

    fn trace(&self, sampling: Sampling, gaze_px: [f32; 2], samples: u32, frame: u64) -> FoveatedFrame {
        sampling.plan(self.geometry(), gaze_px, samples, frame).trace(&self.tracer, &self.world, &self.view, frame)
    }
}

#[test]
fn a_furnace_without_a_ball_is_one_everywhere() {
    // Every sample is 1, so every pixel must be 1, for any gaze.
    let mut scene = given::builtin("control");
    scene.environment = afterimage_lab::scene::Environment::Constant([1.0; 3]);
    let yard = Yard::of(&scene, [161, 91], TraceSettings::default());
    for sampling in patterns() {
        for gaze in [[80.0, 45.0], [0.0, 0.0], [160.0, 90.0], [-500.0, 40.0], [1e9, f32::NAN]] {
            let done = yard.trace(sampling, gaze, 2, 1);
            let worst = done.color.pixels().iter().flatten().map(|v| (v - 1.0).abs()).fold(0.0, f32::max);
            assert!(worst < 1e-5, "{sampling:?}, gaze {gaze:?}: {worst}");
        }
    }
}

#[test]
fn the_fovea_is_what_uniform_sampling_gives() {
    let yard = Yard::new([160, 90], TraceSettings::default());
    let uniform = yard.trace(Sampling::Uniform, [0.0; 2], 4, 0).color;
    for &sampling in &patterns()[1..] {
        let done = yard.trace(sampling, [80.0, 45.0], 4, 0);
        // Within one degree of the gaze, which every pattern samples fully.
        for (x, y) in [(80, 45), (79, 44), (81, 46), (80, 44)] {
            assert_eq!(done.color.at(x, y), uniform.at(x, y), "{sampling:?} at {x}, {y}");
        }
        assert!(done.color.pixels().iter().flatten().all(|v| v.is_finite() && *v >= 0.0));
        assert_eq!(done.lod.at(80, 45), 0.0);
    }
}

#[test]
fn the_device_traces_the_same_foveated_frames() {
    let Some((yard, on_device)) = Yard::new([160, 90], TraceSettings::default()).on_both() else { return };
    for sampling in patterns() {
        let plan = sampling.plan(yard.geometry(), [60.0, 50.0], 2, 5);
        let [a, b] = [&yard.tracer, &on_device].map(|tracer| plan.trace(tracer, &yard.world, &yard.view, 5));
        assert_eq!((a.samples, a.rays), (b.samples, b.rays), "{sampling:?}");
        assert!(a.color == b.color, "{sampling:?}");
    }
}
