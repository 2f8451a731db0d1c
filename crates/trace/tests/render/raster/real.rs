//! Every available scene: finite, and similar to the path tracer's image.

use super::rig::{draw, psnr_db};
use crate::given;
use crate::given::{device, path_of};
use crate::trace::rig::Rig;
use afterimage::Image;
use afterimage::kernel::color::srgb_encode;
use afterimage_lab::scene::effects::{Effect, Effects};
use afterimage_lab::scene::{Environment, builtin};
use afterimage_lab::source::SceneCamera;
use afterimage_trace::settings::TraceSettings;
use afterimage_trace::world::World;
use std::path::Path;

fn shown(image: &Image<[f32; 3]>) -> Image<[f32; 3]> {
    image.map(|c| c.map(|v| srgb_encode((v / (1.0 + v)).clamp(0.0, 1.0))))
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
    let rig = Rig { name: input.to_owned(), world: World::new(&scene), view };
    let traced = shown(&rig.cpu(TraceSettings::default(), 16).color());
    let psnr = psnr_db(&shown(&frame.color), &traced);
    println!("{input}: {psnr:.1} dB");
    if input == "builtin:courtyard" {
        // Planted errors: a black image, and the image upside down.
        let turned = Image::from_fn(size, |[x, y]| frame.color.at(x as usize, (size[1] - 1 - y) as usize));
        for wrong in [Image::filled(size, [0.0; 3]), shown(&turned)] {
            let db = psnr_db(&wrong, &traced);
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
