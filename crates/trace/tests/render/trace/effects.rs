//! A kernel with more effects than a scene needs gives the same image, bit for bit.

use super::rig::{Rig, differing};
use super::scenes::DARK;
use crate::given::device;
use afterimage::Image;
use afterimage_lab::scene::effects::{Effect, Effects};
use afterimage_lab::scene::{
    Alpha, Camera, Coordinates, Environment, Material, Pose, PunctualKind, PunctualLight, Scene, Texture, TextureRef,
    Triangles, Wrap,
};
use afterimage_testing::Draws;
use afterimage_trace::gpu::scene_buffer::Storage;
use afterimage_trace::settings::{Bsdf, TraceSettings};
use glam::{DVec3, Vec2, Vec3, Vec4};

const SIZE: [u32; 2] = [24, 16];
const SPP: u32 = 4;

fn chance(d: &mut Draws, p: f32) -> bool {
    d.uniform() < p
}

fn color(d: &mut Draws) -> [f32; 3] {
    std::array::from_fn(|_| d.uniform())
}

fn vector(d: &mut Draws, half: f32) -> Vec3 {
    Vec3::from_array(std::array::from_fn(|_| d.range(-half, half)))
}

/// Usually 0, sometimes 1, otherwise uniform in between.
fn some(d: &mut Draws) -> f32 {
    match d.bits() % 6 {
        0 => d.uniform(),
        1 => 1.0,
        _ => 0.0,
    }
}

const TEXTURES: u32 = 3;

fn texture(d: &mut Draws) -> Texture {
    let size = [1 + d.bits() % 5, 1 + d.bits() % 4];
    let texels = (0..size[0] * size[1]).map(|_| d.bits().to_le_bytes()).collect();
    let wrap = [0; 2].map(|_| [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp][d.bits() as usize % 3]);
    let nearest = d.bits().is_multiple_of(4);
    let mut coordinates = Coordinates::default();
    if chance(d, 0.2) {
        coordinates.second = chance(d, 0.5);
        coordinates.rows = std::array::from_fn(|_| std::array::from_fn(|_| d.range(-2.0, 2.0)));
    }
    Texture { size, texels, wrap, nearest, coordinates }
}

fn material(d: &mut Draws) -> Material {
    let mut image = |p: f32| {
        let texture = d.bits() % TEXTURES;
        chance(d, p).then_some(TextureRef { texture })
    };
    let mut m = Material {
        base_color_texture: image(0.3),
        metallic_roughness_texture: image(0.1),
        normal_texture: image(0.2),
        emissive_texture: image(0.4),
        specular_texture: image(0.05),
        specular_color_texture: image(0.05),
        clearcoat_texture: image(0.1),
        clearcoat_roughness_texture: image(0.1),
        sheen_color_texture: image(0.1),
        sheen_roughness_texture: image(0.1),
        transmission_texture: image(0.1),
        ..Material::default()
    };
    m.base_color = color(d);
    m.metallic = some(d);
    m.roughness = d.uniform();
    m.specular = some(d);
    m.specular_color = color(d);
    m.specular_tint = some(d);
    m.ior = d.range(1.0, 2.0);
    m.anisotropy = some(d);
    m.clearcoat = some(d);
    m.clearcoat_roughness = d.uniform();
    if chance(d, 0.25) {
        m.sheen_color = color(d);
        m.sheen_roughness = d.uniform();
        m.sheen_tint = some(d);
    }
    m.transmission = some(d);
    m.volume = chance(d, 0.5);
    m.absorption = color(d);
    m.double_sided = chance(d, 0.5);
    m.normal_scale = d.range(0.0, 2.0);
    m.opacity = d.uniform();
    m.alpha = match d.bits() % 6 {
        0 => Alpha::Mask { cutoff: d.uniform() },
        1 => Alpha::Blend,
        _ => Alpha::Opaque,
    };
    if chance(d, 0.3) {
        m.emissive = color(d).map(|c| 4.0 * c);
    }
    m
}

fn triangles(d: &mut Draws, count: u32, materials: u32, colored: bool) -> Triangles {
    let mut t = Triangles::default();
    for _ in 0..count {
        let center = vector(d, 1.0);
        let corners = [vector(d, 1.0), vector(d, 1.0), vector(d, 1.0)].map(|v| center + v);
        t.push_flat(corners, d.bits() % materials);
        let i = t.len() - 1;
        let flat = t.normals[i][0];
        t.normals[i] = std::array::from_fn(|_| (flat + vector(d, 0.3)).normalize());
        t.tangents[i] =
            t.normals[i].map(|n| n.any_orthonormal_vector().extend(if chance(d, 0.5) { 1.0 } else { -1.0 }));
        t.uvs[i] = std::array::from_fn(|_| Vec2::new(d.range(-2.0, 2.0), d.range(-2.0, 2.0)));
        if chance(d, 0.3) {
            t.second_uvs.resize(i, [Vec2::ZERO; 3]);
            t.second_uvs.push(std::array::from_fn(|_| Vec2::new(d.range(-2.0, 2.0), d.range(-2.0, 2.0))));
        }
        if colored {
            t.colors[i] = std::array::from_fn(|_| Vec4::from_array(std::array::from_fn(|_| d.uniform())));
        }
    }
    t
}

fn light(d: &mut Draws) -> PunctualLight {
    let kind = match d.bits() % 3 {
        0 => PunctualKind::Directional,
        1 => PunctualKind::Point,
        _ => PunctualKind::Spot { cos_inner: d.range(0.8, 1.0), cos_outer: d.range(0.3, 0.8) },
    };
    let direction = vector(d, 1.0).normalize_or(Vec3::Y);
    let range = if chance(d, 0.5) { f32::INFINITY } else { d.range(2.0, 8.0) };
    PunctualLight { kind, position: vector(d, 3.0), direction, intensity: color(d).map(|c| 6.0 * c), range }
}

fn random_scene(number: u32) -> Scene {
    let d = &mut Draws::new(&format!("effects {number}"));
    let materials: Vec<_> = (0..1 + d.bits() % 4).map(|_| material(d)).collect();
    let count = materials.len() as u32;
    let colored = chance(d, 0.3);
    let still = triangles(d, 2 + number % 8, count, colored);
    let movers = if chance(d, 0.3) { 1 + d.bits() % 3 } else { 0 };
    let moving = triangles(d, movers, count, colored);
    let lights = (0..(d.bits() % 4).saturating_sub(1)).map(|_| light(d)).collect();
    let environment = match d.bits() % 4 {
        0 => Environment::Constant(color(d)),
        1 => Environment::Map(Image::from_fn([6, 4], |_| color(d).map(|c| 3.0 * c))),
        _ => DARK,
    };
    let camera = Camera::look_at(DVec3::new(0.3, 0.5, 3.5), DVec3::ZERO, 50.0);
    let pose = Pose { moving, lights, cameras: vec![camera] };
    let mut scene = Scene::from_parts(&format!("random scene {number}"), materials, still, pose, environment).unwrap();
    scene.textures = (0..TEXTURES).map(|_| texture(d)).collect();
    scene
}

fn settings(effects: Effects, number: u32) -> TraceSettings {
    let bsdf = if number % 7 == 6 { Bsdf::Phong } else { Bsdf::Principled };
    TraceSettings { effects: Some(effects), bsdf, max_depth: 3, seed: u64::from(number), ..TraceSettings::default() }
}

/// Supersets of `needed`: all effects, and random ones.
fn supersets(needed: Effects, number: u32) -> Vec<Effects> {
    let d = &mut Draws::new(&format!("supersets {number}"));
    let mut random = || needed.union(Effect::ALL.iter().copied().filter(|_| chance(d, 0.4)).collect());
    vec![Effects::all(), random(), random()]
}

#[test]
fn unneeded_effects_change_no_bit_on_the_cpu_and_needed_ones_are_missed() {
    let mut missed = Effects::NONE;
    for number in 0..40 {
        let rig = Rig::new(random_scene(number), SIZE);
        let needed = rig.world.needs;
        let film = rig.cpu(settings(needed, number), SPP);
        assert_eq!(film.nonfinite, 0, "{}", rig.name);
        for more in supersets(needed, number) {
            let count = differing(&film, &rig.cpu(settings(more, number), SPP));
            let beside: Vec<_> = more.without(needed).iter().map(Effect::name).collect();
            assert_eq!(count, 0, "{} differs with {beside:?}", rig.name);
        }
        // Planted errors: effects that are left out, until each was missed.
        for effect in needed.without(missed).iter() {
            let without = settings(needed.set(effect, false), number);
            missed = missed.set(effect, differing(&film, &rig.cpu(without, SPP)) > 0);
        }
    }
    let unseen: Vec<_> = Effects::all().without(missed).iter().map(Effect::name).collect();
    assert!(unseen.is_empty(), "{unseen:?} are not missed");
}

#[test]
fn unneeded_effects_change_no_bit_on_the_gpu() {
    let Some(device) = device() else { return };
    // Each set compiles a kernel of its own.
    for number in 0..3 {
        let rig = Rig::new(random_scene(number), SIZE);
        let needed = rig.world.needs;
        let film = rig.cpu(settings(needed, number), SPP);
        let superset = supersets(needed, number)[number as usize];
        for effects in if number == 0 { vec![needed, superset] } else { vec![superset] } {
            let count = differing(&film, &rig.gpu(&device, settings(effects, number), Storage::Texture, SPP));
            let beside: Vec<_> = effects.without(needed).iter().map(Effect::name).collect();
            assert_eq!(count, 0, "{} differs from the CPU's with {beside:?}", rig.name);
        }
    }
}
