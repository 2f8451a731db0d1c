//! Extreme scenes: the tracer never panics, and no pixel becomes NaN.

use super::rig::{Rig, differing};
use super::scenes::{DARK, made, stage};
use crate::given::device;
use afterimage::Image;
use afterimage_lab::rays::Bvh;
use afterimage_lab::scene::effects::Effects;
use afterimage_lab::scene::{Camera, Environment, Material, Pose, PunctualKind, PunctualLight, Scene, Triangles};
use afterimage_testing::holds;
use afterimage_trace::film::{Film, Moments};
use afterimage_trace::gpu::GpuTracer;
use afterimage_trace::gpu::scene_buffer::Storage;
use afterimage_trace::settings::{Bsdf, Integrator, TraceSettings};
use afterimage_trace::surfaces::Surfaces;
use afterimage_trace::work::Spans;
use glam::{DVec3, Vec3, Vec4};

const SIZE: [u32; 2] = [16, 12];
const TRIANGLE: [Vec3; 3] = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::Y];

fn one_triangle(corners: [Vec3; 3]) -> Triangles {
    let mut t = Triangles::default();
    t.push_flat(corners, 0);
    t
}

fn glowing() -> Material {
    Material { emissive: [1.0; 3], ..Material::default() }
}

fn pose_of(eye: DVec3, target: DVec3) -> Pose {
    Pose { cameras: vec![Camera::look_at(eye, target, 50.0)], ..Pose::default() }
}

fn sky() -> Environment {
    Environment::Constant([1.0; 3])
}

/// The stage, scaled and translated, lit by a lamp.
fn far_away(scale: f32, offset: Vec3) -> Scene {
    let (materials, mut t, camera) = stage();
    t.positions.iter_mut().flatten().for_each(|p| *p = *p * scale + offset);
    let eye = camera.world_from_camera.w_axis.truncate() * f64::from(scale) + offset.as_dvec3();
    let target = DVec3::new(0.0, 1.2, 0.0) * f64::from(scale) + offset.as_dvec3();
    made(&format!("scale {scale}, at {offset}"), materials, t, pose_of(eye, target), sky())
}

fn scenes() -> Vec<Scene> {
    let front = || pose_of(DVec3::Z * 3.0, DVec3::ZERO);
    let lamp = |intensity, position, range| PunctualLight {
        kind: PunctualKind::Point,
        position,
        direction: Vec3::NEG_Z,
        intensity: [intensity; 3],
        range,
    };
    let lit = |lights| Pose { lights, ..front() };
    let mut nan = Triangles::default();
    nan.push_flat([Vec3::NAN, Vec3::X, Vec3::Y], 0);
    nan.push_flat(TRIANGLE, 0);
    nan.push_flat([Vec3::ZERO; 3], 0);
    nan.push_flat([Vec3::INFINITY, Vec3::X, Vec3::Y], 0);
    nan.normals[1] = [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY];
    nan.tangents[1] = [Vec4::NAN; 3];
    nan.colors[1] = [Vec4::NAN; 3];
    let mut long = one_triangle(TRIANGLE);
    long.positions[0][2] = Vec3::new(0.0, 1e9, 0.0);
    let mirror = Material { metallic: 1.0, roughness: 0.0, ..Material::default() };
    let weird = Material {
        roughness: 7.0,
        metallic: -3.0,
        ior: 0.0,
        specular: 9.0,
        clearcoat: 4.0,
        anisotropy: 5.0,
        transmission: 2.0,
        volume: true,
        absorption: [1e30; 3],
        base_color: [4.0; 3],
        ..Material::default()
    };
    let bright = Environment::Map(Image::from_fn([3, 2], |[x, _]| [if x == 0 { 1e30 } else { 0.0 }; 3]));
    let black_map = Environment::Map(Image::filled([4, 2], [0.0; 3]));
    let bad_map = Environment::Map(Image::from_fn([4, 2], |[x, _]| if x == 1 { [f32::NAN; 3] } else { [1.0; 3] }));
    let empty = |name, pose, environment| made(name, vec![], Triangles::default(), pose, environment);
    let one = |name, material: Material, pose, sky| made(name, vec![material], one_triangle(TRIANGLE), pose, sky);
    let gray = Material::default;
    vec![
        empty("nothing", Pose::default(), DARK),
        empty("nothing but sky", Pose::default(), sky()),
        empty("nothing but a lamp", lit(vec![lamp(5.0, Vec3::ZERO, f32::INFINITY)]), DARK),
        one("one triangle", gray(), front(), sky()),
        one("one triangle that glows", glowing(), front(), DARK),
        one("one triangle without light", gray(), front(), DARK),
        made("a point that glows", vec![glowing()], one_triangle([Vec3::ZERO; 3]), front(), DARK),
        made("a line that glows", vec![glowing()], one_triangle([Vec3::X, Vec3::ZERO, -Vec3::X]), front(), DARK),
        made("a very long triangle", vec![glowing()], long, front(), sky()),
        made("no numbers", vec![glowing()], nan, front(), sky()),
        one("a lamp on a surface", gray(), lit(vec![lamp(5.0, Vec3::ZERO, 9.0)]), DARK),
        one("a lamp without range", gray(), lit(vec![lamp(5.0, Vec3::Z, 0.0)]), DARK),
        one("a lamp of nothing", gray(), lit(vec![lamp(0.0, Vec3::Z, 9.0)]), DARK),
        one("parameters out of range", weird, front(), sky()),
        one("a camera in a mirror's plane", mirror, pose_of(DVec3::ZERO, DVec3::X), sky()),
        one("a very bright texel", gray(), front(), bright),
        one("a black map", gray(), front(), black_map),
        one("a map that is no number", gray(), front(), bad_map),
        far_away(1e-3, Vec3::ZERO),
        far_away(1e5, Vec3::ZERO),
        far_away(1.0, Vec3::new(1e5, -1e6, 1e5)),
        far_away(1e7, Vec3::splat(1e8)),
    ]
}

#[test]
fn every_scene_gives_an_image_of_numbers_h81_h82_h83() {
    let (scenes, variants) = (scenes(), 3 * 2 * 2);
    let said = format!("{} scenes x {variants} variants of the tracer: no pixel but numbers >= 0", scenes.len());
    for scene in scenes {
        let rig = Rig::new(scene, SIZE);
        for variant in 0..variants {
            let integrator = [Integrator::Mis, Integrator::Nee, Integrator::Naive][variant / 4];
            let bsdf = [Bsdf::Principled, Bsdf::Phong][variant / 2 % 2];
            let effects = [None, Some(Effects::all())][variant % 2];
            let settings = TraceSettings { integrator, bsdf, effects, ..TraceSettings::default() };
            let film = rig.cpu(settings, 4);
            let sound = |m: &Moments| m.mean.is_finite() && m.mean.min_element() >= 0.0;
            assert!(film.moments.pixels().iter().all(sound), "{}, {settings:?}", rig.name);
        }
        let seen = Surfaces::trace(&rig.world, &rig.view, &rig.view, rig.world.needs);
        assert!(seen.depth.pixels().iter().all(|d| *d > 0.0), "{}", rig.name);
        assert!(seen.motion.pixels().iter().all(|m| m.iter().all(|x| x.is_finite())), "{}", rig.name);
    }
    holds!("H81", Cpu, "{said}");
    holds!("H82", Cpu, "{said}, scaled from 1e-3 to 1e7 and moved by up to 1e8 m among them");
    holds!("H83", Cpu, "{said}");
}

#[test]
fn every_scene_gives_the_same_image_on_the_gpu() {
    let Some(device) = device() else { return };
    let scenes = scenes();
    let said = format!("{} scenes: every pixel the CPU's bit for bit, all of them numbers", scenes.len());
    for scene in scenes {
        let rig = Rig::new(scene, SIZE);
        let settings = TraceSettings::default();
        let (cpu, gpu) = (rig.cpu(settings, 4), rig.gpu(&device, settings, Storage::Texture, 4));
        let count = differing(&cpu, &gpu);
        println!("{}: {count} pixels differ", rig.name);
        assert!(gpu.moments.pixels().iter().all(|m| m.mean.is_finite()), "{}", rig.name);
        assert_eq!((count, cpu.nonfinite), (0, gpu.nonfinite), "{}", rig.name);
    }
    holds!("H81", Gpu, "{said}");
    holds!("H82", Gpu, "{said}");
    holds!("H83", Gpu, "{said}");
}

#[test]
fn a_camera_inside_a_body_sees_it_from_inside() {
    let mut t = Triangles::default();
    super::scenes::ball(&mut t, Vec3::ZERO, 1.0, 0);
    // Closed: no sky light enters.
    let pose = || pose_of(DVec3::new(0.1, 0.2, 0.3), DVec3::X);
    let dark = Rig::new(made("inside", vec![Material::default()], t.clone(), pose(), sky()), SIZE);
    let film = dark.cpu(TraceSettings { max_depth: 8, ..TraceSettings::default() }, 16);
    assert!(film.moments.pixels().iter().all(|m| m.mean == Vec3::ZERO));
    // A closed room that emits: radiance 1 at depth 0, then a geometric series in its albedo.
    let half = Material { base_color: [0.5; 3], specular: 0.0, emissive: [1.0; 3], ..Material::default() };
    let lit = Rig::new(made("inside a lamp", vec![half], t, pose(), DARK), SIZE);
    let naive = TraceSettings { integrator: Integrator::Naive, ..TraceSettings::default() };
    for (max_depth, expected) in [(0, 1.0), (1, 1.5), (3, 1.875)] {
        for m in lit.cpu(TraceSettings { max_depth, ..naive }, 4).moments.pixels() {
            // Each bounce adds a few rounding errors.
            assert!((m.mean.x - expected).abs() < 1e-5, "{} {expected}", m.mean.x);
        }
    }
}

#[test]
fn the_image_is_the_same_far_from_the_origin_h82() {
    let mean = |scale, offset| {
        let settings = TraceSettings { max_depth: 2, ..TraceSettings::default() };
        super::statistics::mean_of(&Rig::new(far_away(scale, offset), [32, 24]).cpu(settings, 64), 0, |_| true)
    };
    let (expected, se) = mean(1.0, Vec3::ZERO);
    // Offsets are powers of two, so that they hardly round the scene itself.
    for (scale, offset) in
        [(1e-3, Vec3::ZERO), (1e4, Vec3::ZERO), (1.0, Vec3::splat(1024.0)), (1.0, Vec3::splat(16384.0))]
    {
        let (got, _) = mean(scale, offset);
        println!("{scale}, {offset}: {got:.5}, {expected:.5} +- {se:.5}");
        // At 16 km positions have steps of 2 mm and the ray offset is 6 cm; the stage is 6 m wide.
        assert!((got / expected - 1.0).abs() < 0.02, "{scale}, {offset}");
    }
}

#[test]
fn what_had_no_area_at_first_may_grow_on_the_device() {
    let Some(device) = device() else { return };
    let mut grown = Triangles::default();
    [0.0, -0.5, -1.0].into_iter().for_each(|z| grown.push_flat(TRIANGLE.map(|p| p + Vec3::Z * z), 0));
    let mut shrunk = grown.clone();
    shrunk.positions.fill([Vec3::ZERO; 3]);
    let pose = Pose { moving: shrunk, ..pose_of(DVec3::Z * 3.0, DVec3::ZERO) };
    let materials = vec![Material { base_color: [0.5; 3], ..Material::default() }];
    let mut rig = Rig::new(made("growing", materials.clone(), Triangles::default(), pose, sky()), SIZE);
    let settings = TraceSettings::default();
    let mut tracer = GpuTracer::new(device, &rig.world, settings).unwrap();
    rig.world.geometry.moving = Bvh::build(&grown, Some(&grown.positions), &materials);
    tracer.update(&rig.world).unwrap();
    let mut film = Film::new(SIZE);
    tracer.trace(&rig.world, &rig.view, 0, &Spans::uniform(SIZE[0], 0..SIZE[1], 0..2), &mut film);
    assert_eq!(differing(&film, &rig.cpu(settings, 2)), 0);
    assert!(film.color().pixels().iter().any(|c| c[0] < 0.9), "the triangle is seen");
}
