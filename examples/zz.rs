//! x
use afterimage::scene::{Environment, Scene, SceneLimits, builtin};
use afterimage::trace::{cpu::CpuTracer, film::Film, gpu::GpuTracer, settings::*, view::View, work, world::World};
fn main() {
    let dev = afterimage::pipeline::Headless::find_roomy(true).unwrap();
    let mut scenes = vec![
        (builtin::cornell(), [64u32, 64u32], 16),
        (builtin::furnace(), [64, 64], 16),
        (builtin::courtyard(), [320, 180], 2),
    ];
    for f in [
        "sponza/sponza.glb",
        "flight_helmet",
        "alpha_blend_mode_test",
        "transmission_roughness_test",
        "fox",
        "animated_morph_cube",
        "lights_punctual",
        "vertex_color",
        "emissive_cornell_box",
    ] {
        let p = format!("../shared/data/scenes/{f}");
        let path = if f.ends_with("glb") {
            p
        } else {
            let d = std::fs::read_dir(&p)
                .unwrap()
                .map(|e| e.unwrap().path())
                .find(|p| p.extension().is_some_and(|e| e == "gltf" || e == "glb"))
                .unwrap();
            d.display().to_string()
        };
        let Ok(mut s) = Scene::open(&path, &SceneLimits::default()) else {
            println!("no {path}");
            continue;
        };
        s.environment = Environment::Constant([1.0; 3]);
        println!("{:?}", s.warnings);
        scenes.push((s, [160, 90], 4));
    }
    for (s, size, spp) in scenes {
        let w = World::new(&s);
        let cam = s.pose(0.0).cameras.first().cloned().unwrap_or_else(|| s.framing_camera(16.0 / 9.0));
        let view = View::of_camera(&cam, size, None).unwrap();
        let set = TraceSettings::default();
        let items = work::uniform(size[0], 0..size[1], 0..spp);
        let mut a = Film::new(size);
        let t = std::time::Instant::now();
        CpuTracer::new(set).trace(&w, &view, 0, &items, &mut a);
        println!(
            "{} cpu {:?} {} rays needs {:?}",
            s.name,
            t.elapsed(),
            a.rays,
            w.needs.iter().map(|e| e.name()).collect::<Vec<_>>()
        );
        let g = GpuTracer::new(dev.clone(), &w, set).unwrap();
        let enc = a.color().map(|p| p.map(|v| afterimage::kernel::color::srgb_encode((v / (1.0 + v)).clamp(0.0, 1.0))));
        afterimage::report::picture::write_png(
            std::path::Path::new(&format!("/tmp/zz_{}.png", s.name.rsplit('/').next().unwrap().replace(':', "_"))),
            &afterimage::report::picture::to_rgb8(&enc),
        )
        .unwrap();
        for i in 0..2 {
            let mut b = Film::new(size);
            let t = std::time::Instant::now();
            g.trace(&w, &view, 0, &items, &mut b);
            let d = t.elapsed();
            let same = a.color().pixels().iter().zip(b.color().pixels()).filter(|(x, y)| x == y).count();
            let mean =
                |f: &Film| f.color().pixels().iter().map(|p| p[1] as f64).sum::<f64>() / (size[0] * size[1]) as f64;
            println!(
                "  gpu {i} {:?} {} rays {:.2} Mray/s; equal pixels {same} of {}; mean {} {} nonfinite {} {} compile {:?} bytes {}",
                d,
                b.rays,
                b.rays as f64 / d.as_secs_f64() / 1e6,
                size[0] * size[1],
                mean(&a),
                mean(&b),
                a.nonfinite,
                b.nonfinite,
                g.compile_time,
                g.scene_bytes()
            );
        }
    }
}
