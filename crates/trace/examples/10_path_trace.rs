//! Path-traces a foveated scene, and prints the savings.
//!
//!     cargo run --release -p afterimage-trace --example 10_path_trace

use afterimage_lab::device::{Backend, Headless};
use afterimage_lab::scene::{Scene, SceneLimits};
use afterimage_lab::view::View;
use afterimage_trace::Tracer;
use afterimage_trace::sampling::{Acuity, Layers, Regions, Sampling};
use afterimage_trace::settings::TraceSettings;
use afterimage_trace::world::World;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = Scene::open("builtin:mirror-room", &SceneLimits::default())?;
    let world = World::new(&scene);
    // A GPU, hardware or software; without one the CPU, which traces the same paths.
    let backend = Headless::find_roomy(true).map_or(Backend::Cpu, Backend::Gpu);
    let tracer = Tracer::new(&backend, &world, TraceSettings::default())?;
    let effects: Vec<_> = tracer.effects(&world).iter().map(|e| e.name()).collect();
    println!("simulated, as the scene calls for it: {}", effects.join(", "));

    let view = View::of_camera(&scene.pose(0.0).cameras[0], [320, 180], None)?;
    let gaze = [100.0, 90.0];
    let regions = Regions { samples: [8, 4, 2], ..Regions::default() };
    let patterns = [
        Sampling::Uniform,
        Sampling::Regions(regions),
        Sampling::Layers(Layers::default()),
        Sampling::Acuity(Acuity::default()),
    ];
    let names = ["uniform", "regions", "layers", "acuity"];
    let mut uniform = None;
    for (name, sampling) in names.iter().zip(patterns) {
        let frame = sampling.plan(view.geometry(), gaze, 8, 0).trace(&tracer, &world, &view, 0);
        let samples = frame.samples.iter().sum::<u64>();
        let (all, reference) = uniform.get_or_insert((samples, frame.color.clone()));
        let error = |(a, b): (&[f32; 3], &[f32; 3])| f64::from((a[1] - b[1]).powi(2));
        let mse = frame.color.pixels().iter().zip(reference.pixels()).map(error).sum::<f64>() / (320.0 * 180.0);
        println!(
            "{name:<8} {samples:>7} samples, {:>4.1} times fewer; squared error against uniform {mse:.5}",
            *all as f64 / samples as f64
        );
    }
    Ok(())
}
