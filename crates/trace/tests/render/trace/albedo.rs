//! Albedo of every pixel, against materials whose albedo is known.

use super::rig::Rig;
use super::scenes::{DARK, made};
use afterimage_lab::device::Backend;
use afterimage_lab::scene::{Camera, Material, Pose, Triangles};
use afterimage_lab::source::{FrameRequest, FrameSource, ReadLimits, SceneOptions, Wanted};
use afterimage_trace::settings::{Bsdf, TraceSettings};
use afterimage_trace::surfaces::albedo;
use afterimage_trace::{TracedSamples, TracedSource};
use glam::{DVec3, Vec3};

const SIZE: [u32; 2] = [16, 12];
const BEHIND_CAMERA: [f32; 3] = [0.2, 0.5, 0.8];
const BEHIND_SHEET: [f32; 3] = [0.7, 0.3, 0.1];

fn lambert(base_color: [f32; 3]) -> Material {
    Material { base_color, specular: 0.0, ..Material::default() }
}

fn mirror(base_color: [f32; 3]) -> Material {
    Material { base_color, metallic: 1.0, roughness: 0.0, ..Material::default() }
}

fn glass(volume: bool) -> Material {
    Material { transmission: 1.0, roughness: 0.0, volume, ..Material::default() }
}

/// A square of half the side `half` at `z`.
fn wall(t: &mut Triangles, z: f32, half: f32, material: u32) {
    let corner = |x: f32, y: f32| Vec3::new(x * half, y * half, z);
    t.push_quad([corner(-1., -1.), corner(1., -1.), corner(1., 1.), corner(-1., 1.)], material);
}

/// A camera at z = 2 before sheets at z = 0 and -0.2, between walls at z = 6 and -3. `half`: of the sheets' side.
fn room(front: Material, back: Material, sheet: Material, half: f32) -> Rig {
    let mut t = Triangles::default();
    wall(&mut t, 6.0, 40.0, 0);
    wall(&mut t, -3.0, 40.0, 1);
    wall(&mut t, 0.0, half, 2);
    wall(&mut t, -0.2, half, 2);
    let camera = Camera::look_at(DVec3::new(0.0, 0.0, 2.0), DVec3::new(0.1, 0.2, -3.0), 40.0);
    let pose = Pose { cameras: vec![camera], ..Pose::default() };
    Rig::new(made("room", vec![front, back, sheet], t, pose, DARK), SIZE)
}

fn behind(sheet: Material) -> Rig {
    room(lambert(BEHIND_CAMERA), lambert(BEHIND_SHEET), sheet, 40.0)
}

fn is_everywhere(name: &str, rig: &Rig, settings: &TraceSettings, expected: [f32; 3]) {
    let found = albedo(&rig.world, &rig.view, settings);
    for (i, a) in found.pixels().iter().enumerate() {
        assert!((0..3).all(|k| (a[k] - expected[k]).abs() < 1e-5), "{name}, pixel {i}: {a:?} instead of {expected:?}");
    }
}

#[test]
fn mirrors_and_clear_glass_show_the_albedo_of_what_is_behind_them() {
    let tinted = [0.9, 0.5, 1.0];
    let times = |a: [f32; 3], b: [f32; 3]| [0, 1, 2].map(|k| a[k] * b[k]);
    let cases = [
        ("lambert", lambert([0.1, 0.6, 0.3]), [0.1, 0.6, 0.3]),
        ("mirror", mirror([1.0; 3]), BEHIND_CAMERA),
        ("tinted mirror", mirror(tinted), times(BEHIND_CAMERA, tinted)),
        ("thin glass", glass(false), BEHIND_SHEET),
        ("slab of glass", glass(true), BEHIND_SHEET),
        // Rough: their own. White metal returns all light.
        ("rough metal", Material { roughness: 0.4, ..mirror([1.0; 3]) }, [1.0; 3]),
    ];
    for (name, sheet, expected) in cases {
        is_everywhere(name, &behind(sheet), &TraceSettings::default(), expected);
    }
    // Energy compensation leaves a few percent.
    let rig = behind(Material { roughness: 0.4, specular: 0.0, ..glass(false) });
    let found = albedo(&rig.world, &rig.view, &TraceSettings::default());
    let is_own = |a: &[f32; 3]| a.iter().all(|v| (v - 1.0).abs() < 0.2);
    assert!(found.pixels().iter().all(is_own), "rough glass: {:?}", found.at(8, 6));
}

#[test]
fn mirrors_that_face_each_other_and_the_sky_have_none() {
    let between = room(mirror([1.0; 3]), lambert(BEHIND_SHEET), mirror([1.0; 3]), 40.0);
    is_everywhere("mirrors", &between, &TraceSettings::default(), [0.0; 3]);
    let empty = made(
        "empty",
        vec![Material::default()],
        Triangles::default(),
        Pose { cameras: vec![Camera::look_at(DVec3::Z, DVec3::ZERO, 40.0)], ..Pose::default() },
        DARK,
    );
    is_everywhere("sky", &Rig::new(empty, SIZE), &TraceSettings::default(), [0.0; 3]);
}

#[test]
fn a_pixel_at_an_edge_has_the_mean_of_both() {
    let rig = room(lambert(BEHIND_CAMERA), lambert([0.0; 3]), lambert([1.0; 3]), 0.3);
    let found = albedo(&rig.world, &rig.view, &TraceSettings::default());
    let count = |is: fn(f32) -> bool| found.pixels().iter().filter(|a| is(a[0])).count();
    let [inside, outside] = [count(|v| v > 0.999), count(|v| v < 0.001)];
    println!("{inside} pixels of the sheet, {outside} beside it");
    assert!(inside > 8 && outside > 60 && found.pixels().len() - inside - outside > 8);
}

#[test]
fn phongs_model_has_its_own() {
    let phong = TraceSettings { bsdf: Bsdf::Phong, ..TraceSettings::default() };
    is_everywhere("Phong", &behind(lambert([0.1, 0.6, 0.3])), &phong, [0.1, 0.6, 0.3]);
}

#[test]
fn a_source_gives_it_where_it_is_asked_for() {
    let samples = TracedSamples { foveated: None, samples: 1, full_rate_samples: 1 };
    let options = SceneOptions { size: Some(SIZE), ..SceneOptions::default() };
    let settings = TraceSettings::default();
    let limits = ReadLimits::default();
    let mut source =
        TracedSource::open("builtin:cubes", &limits, &options, None, &Backend::Cpu, settings, samples).unwrap();
    for wanted in [Wanted::FullRate, Wanted::Surfaces] {
        let request = FrameRequest { wanted, ..FrameRequest::full_rate(0) };
        assert!(source.render(&request).unwrap().albedo.is_none());
        let frame = source.render(&FrameRequest { albedo: true, ..request }).unwrap();
        let found = frame.albedo.unwrap();
        assert!(found.size() == SIZE && found.pixels().iter().any(|a| a[0] > 0.1), "{:?}", found.at(8, 6));
    }
}
