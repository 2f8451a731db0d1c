//! Every available scene: finite, and similar to the path tracer's image.

use super::rig::draw;
use crate::given;
use crate::given::{device, path_of};
use afterimage::Image;
use afterimage::kernel::color::srgb_encode;
use afterimage_lab::scene::{Environment, builtin};
use afterimage_lab::source::SceneCamera;
use afterimage_lab::trace::cpu::CpuTracer;
use afterimage_lab::trace::effects::{Effect, Effects};
use afterimage_lab::trace::film::Film;
use afterimage_lab::trace::settings::TraceSettings;
use afterimage_lab::trace::work::Spans;
use afterimage_lab::trace::world::World;
use std::path::Path;

fn shown(image: &Image<[f32; 3]>) -> Image<[f32; 3]> {
    image.map(|c| c.map(|v| srgb_encode((v / (1.0 + v)).clamp(0.0, 1.0))))
}

fn psnr(a: &Image<[f32; 3]>, b: &Image<[f32; 3]>) -> f64 {
    let squares: f64 =
        a.pixels().iter().zip(b.pixels()).flat_map(|(a, b)| (0..3).map(move |i| f64::from(a[i] - b[i]).powi(2))).sum();
    -10.0 * (squares / (3 * a.pixels().len()) as f64).log10()
}

/// PSNR of the tone-mapped image against 16 paths per pixel; `None` without a device. Panics if the frame is not
/// finite.
fn likeness(input: &str) -> Option<f64> {
    let device = device()?;
    let mut scene = given::open(Path::new(input));
    let needs = Effects::needed(&scene);
    if ![Effect::EmissiveTriangles, Effect::PunctualLights, Effect::Environment].iter().any(|&e| needs.has(e)) {
        scene.environment = Environment::Constant([1.0; 3]);
    }
    let size = [160, 90];
    let view = SceneCamera::choose(&scene, None, size, None).unwrap().view(&scene, 0, 0.0);
    let frame = draw(&device, &scene, [&view; 2], [0.0; 2]);
    assert!(frame.color.pixels().iter().flatten().all(|v| v.is_finite() && *v >= 0.0), "{input}");
    assert!(frame.motion.pixels().iter().flatten().all(|v| v.is_finite()), "{input}");
    assert!(frame.distance.pixels().iter().all(|v| *v > 0.0), "{input}");
    let world = World::new(&scene);
    let mut film = Film::new(size);
    CpuTracer::new(TraceSettings::default()).trace(
        &world,
        &view,
        0,
        &Spans::uniform(size[0], 0..size[1], 0..16),
        &mut film,
    );
    let psnr = psnr(&shown(&frame.color), &shown(&film.color()));
    println!("{input}: {psnr:.1} dB");
    if input == "builtin:courtyard" {
        // Planted errors: a black image, and the image upside down.
        let (h, traced) = (size[1] as usize, shown(&film.color()));
        let turned = Image::from_fn(size, |[x, y]| frame.color.at(x as usize, h - 1 - y as usize));
        for wrong in [Image::filled(size, [0.0; 3]), shown(&turned)] {
            let db = self::psnr(&wrong, &traced);
            assert!(db < ALIKE_DB, "{db:.1} dB");
        }
    }
    Some(psnr)
}

/// Indirect light and sky occlusion are estimates, so images are similar, not equal. Half of the image black instead of
/// white gives 3 dB; everything off by a quarter of white, as when twice too bright, gives 12 dB.
const ALIKE_DB: f64 = 12.0;

#[test]
fn scenes_look_like_traced_ones() {
    let mut inputs: Vec<String> = builtin::NAMES.iter().map(|name| format!("builtin:{name}")).collect();
    for folder in path_of("").iter().flat_map(|folder| std::fs::read_dir(folder).unwrap()) {
        let files = std::fs::read_dir(folder.unwrap().path()).unwrap().map(|file| file.unwrap().path());
        let files = files.filter(|file| file.extension().is_some_and(|e| e == "gltf" || e == "glb"));
        inputs.extend(files.map(|file| file.to_str().unwrap().to_owned()));
    }
    assert!(inputs.len() == builtin::NAMES.len() || inputs.len() >= builtin::NAMES.len() + 9);
    for input in inputs {
        let Some(db) = likeness(&input) else { return };
        assert!(db > ALIKE_DB, "{input}: {db:.1} dB");
    }
}
