//! x
use afterimage::scene::builtin;
use afterimage::trace::{cpu::CpuTracer, film::Film, gpu::GpuTracer, settings::*, view::View, work, world::World};
fn main() {
    let dev = afterimage::pipeline::Headless::find_roomy(true).unwrap();
    for (s, size, spp) in [
        (builtin::cornell(), [64u32, 64u32], 16),
        (builtin::furnace(), [64, 64], 16),
        (builtin::courtyard(), [320, 180], 2),
    ] {
        let w = World::new(&s);
        let view = View::of_camera(&s.pose(0.0).cameras[0], size, None).unwrap();
        let set = TraceSettings::default();
        let items = work::uniform(size[0], 0..size[1], 0..spp);
        let mut a = Film::new(size);
        let t = std::time::Instant::now();
        CpuTracer::new(set).trace(&w, &view, 0, &items, &mut a);
        println!("{} cpu {:?} {} rays", s.name, t.elapsed(), a.rays);
        let g = GpuTracer::new(dev.clone(), &w, set).unwrap();
        println!("compile {:?} bytes {}", g.compile_time, g.scene_bytes());
        for i in 0..2 {
            let mut b = Film::new(size);
            let t = std::time::Instant::now();
            g.trace(&w, &view, 0, &items, &mut b);
            let d = t.elapsed();
            let same = a.color().pixels().iter().zip(b.color().pixels()).filter(|(x, y)| x == y).count();
            let mean =
                |f: &Film| f.color().pixels().iter().map(|p| p[1] as f64).sum::<f64>() / (size[0] * size[1]) as f64;
            println!(
                "gpu {i} {:?} {} rays {:.2} Mray/s; equal pixels {same} of {}; mean {} {} nonfinite {}",
                d,
                b.rays,
                b.rays as f64 / d.as_secs_f64() / 1e6,
                size[0] * size[1],
                mean(&a),
                mean(&b),
                b.nonfinite
            );
        }
    }
}
