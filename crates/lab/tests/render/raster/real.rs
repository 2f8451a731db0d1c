//! Every available scene: finite, and similar to the path tracer's image.

use super::rig::draw;
use crate::explained::explained_db;
use crate::given;
use crate::given::{device, path_of};
use afterimage::Image;
use afterimage::kernel::color::srgb_encode;
use afterimage_lab::scene::{Environment, builtin};
use afterimage_lab::source::{FrameSource, RasterSource, SceneCamera};
use afterimage_lab::trace::cpu::CpuTracer;
use afterimage_lab::trace::effects::{Effect, Effects};
use afterimage_lab::trace::film::Film;
use afterimage_lab::trace::settings::TraceSettings;
use afterimage_lab::trace::work;
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
        &work::uniform(size[0], 0..size[1], 0..16),
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
fn builtin_scenes_look_like_traced_ones() {
    for name in builtin::NAMES {
        let Some(db) = likeness(&format!("builtin:{name}")) else { return };
        assert!(db > ALIKE_DB, "{name}: {db:.1} dB");
    }
}

#[test]
fn files_look_like_traced_ones() {
    let Some(folder) = path_of("") else { return };
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .flat_map(|e| std::fs::read_dir(e.unwrap().path()).unwrap())
        .map(|e| e.unwrap().path())
        .collect();
    files.retain(|p| p.extension().is_some_and(|e| e == "gltf" || e == "glb"));
    files.sort();
    assert!(files.len() >= 9);
    for file in files {
        let Some(db) = likeness(file.to_str().unwrap()) else { return };
        assert!(db > ALIKE_DB, "{}: {db:.1} dB", file.display());
    }
}

/// The previous frame warped by the motion vectors matches this frame wherever the surface was visible: bilinear,
/// distances within 2 %.
#[test]
fn vectors_explain_the_next_frame() {
    let (Some(device), Some(folder)) = (device(), path_of("")) else { return };
    let scene = given::open(&folder.join("sponza/sponza.gltf"));
    let size = [640, 360];
    let file = folder.join("../sequences/sponza_lateral/cameras.json");
    let camera = SceneCamera::choose(&scene, file.to_str(), size, None).unwrap();
    let mut source = RasterSource::new(device, scene, camera, None, super::rig::FAST).unwrap();
    let frames = [3, 4].map(|i| source.frame(i).unwrap());
    let [before, now] = [&frames[0], &frames[1]];
    let (depth, previous) = (now.depth.as_ref().unwrap(), before.depth.as_ref().unwrap());
    let row = now.previous_from_current.unwrap()[2];
    let view = source.views(4).0[0];
    let is_same = |px: [usize; 2], from: [f32; 2]| {
        let ray = view.geometry().ray(px.map(|v| v as f32));
        let expected = (row[0] * ray[0] + row[1] * ray[1] + row[2]) * depth.at(px[0], px[1]) + row[3];
        let [i, j] = from.map(|v| v as usize);
        let four = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)];
        let there = four.map(|(i, j)| previous.at(i.min(size[0] as usize - 1), j.min(size[1] as usize - 1)));
        there.iter().all(|z| (z / expected - 1.0).abs() < 0.02)
    };
    let db = |sign| explained_db(before, now, [sign; 2], |c| c.map(|v| srgb_encode(v.clamp(0.0, 1.0))), is_same);
    let ((with, share), (without, _)) = (db(1.0), db(0.0));
    println!("explained {with:.2} dB, without vectors {without:.2} dB, {share:.3} of the pixels");
    assert!(share > 2.0 / 3.0);
    assert!(with >= 35.0 && without < with - 6.0);
}
