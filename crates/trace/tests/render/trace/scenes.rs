//! Scenes for the path tracer tests.

use crate::given;
use afterimage::Image;
use afterimage_lab::scene::{
    Camera, Environment, Material, Pose, PunctualKind, PunctualLight, Scene, Texture, TextureRef, Triangles, Wrap,
};
use glam::{DVec3, Vec2, Vec3};

/// Small scenes of the shared data, made by others.
pub const SMALL: &[&str] = &[
    "alpha_blend_mode_test/AlphaBlendModeTest.glb",
    "animated_morph_cube/AnimatedMorphCube.gltf",
    "emissive_cornell_box/CornellBox.glb",
    "flight_helmet/FlightHelmet.gltf",
    "fox/Fox.glb",
    "lights_punctual/Lights.glb",
    "transmission_roughness_test/TransmissionRoughnessTest.glb",
    "vertex_color/22_vertex_color.gltf",
];

/// A scene of the shared data, under a sky; `None` if it is missing.
pub fn shared(name: &str) -> Option<Scene> {
    let mut scene = given::open(&given::path_of(name)?);
    scene.environment = Environment::Constant([0.6, 0.7, 0.9]);
    scene.name = name.to_owned();
    Some(scene)
}

/// A floor, a wall, a tilted metal sheet and a ball, seen from the front; no light.
pub fn stage() -> (Vec<Material>, Triangles, Camera) {
    let of = |name: &str, base_color| Material { name: name.into(), base_color, ..Material::default() };
    let materials = vec![
        Material { specular: 0.0, ..of("floor", [0.6, 0.5, 0.4]) },
        Material { roughness: 0.6, ..of("wall", [0.3, 0.5, 0.7]) },
        Material { metallic: 1.0, roughness: 0.4, ..of("metal", [0.9, 0.8, 0.6]) },
        Material { clearcoat: 1.0, clearcoat_roughness: 0.4, ..of("ball", [0.7, 0.2, 0.2]) },
    ];
    let mut t = Triangles::default();
    let v = Vec3::new;
    t.push_quad([v(-3., 0., 3.), v(3., 0., 3.), v(3., 0., -3.), v(-3., 0., -3.)], 0);
    t.push_quad([v(-3., 0., -3.), v(3., 0., -3.), v(3., 4., -3.), v(-3., 4., -3.)], 1);
    t.push_quad([v(-2.5, 0., 0.), v(-0.5, 0., -0.6), v(-0.5, 1.6, -1.4), v(-2.5, 1.6, -0.8)], 2);
    ball(&mut t, v(1.2, 0.8, 0.0), 0.8, 3);
    let camera = Camera::look_at(DVec3::new(0.0, 1.8, 6.0), DVec3::new(0.0, 1.2, 0.0), 45.0);
    (materials, t, camera)
}

/// The stage in an environment, its materials changed.
pub fn staged(name: &str, environment: Environment, change: impl FnOnce(&mut [Material])) -> Scene {
    let (mut materials, t, camera) = stage();
    change(&mut materials);
    made(name, materials, t, Pose { cameras: vec![camera], ..Pose::default() }, environment)
}

/// A flat-shaded ball.
pub fn ball(t: &mut Triangles, center: Vec3, radius: f32, material: u32) {
    let (columns, rows) = (24, 12);
    let at = |i: u32, j: u32| {
        let (a, b) = (std::f32::consts::TAU * i as f32 / columns as f32, std::f32::consts::PI * j as f32 / rows as f32);
        center + radius * Vec3::new(b.sin() * a.sin(), b.cos(), b.sin() * a.cos())
    };
    for i in 0..columns {
        for j in 0..rows {
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at((i + 1) % columns, j + 1), at((i + 1) % columns, j)];
            if j + 1 < rows {
                t.push_flat([a, b, c], material);
            }
            if j > 0 {
                t.push_flat([a, c, d], material);
            }
        }
    }
}

pub const DARK: Environment = Environment::Constant([0.0; 3]);

pub fn made(name: &str, materials: Vec<Material>, t: Triangles, pose: Pose, environment: Environment) -> Scene {
    Scene::from_parts(name, materials, t, pose, environment).unwrap()
}

/// The stage under an environment map with a bright spot.
pub fn under_a_map() -> Scene {
    let map = Image::from_fn([16, 8], |[x, y]| {
        let spot = if (x, y) == (10, 1) { 40.0 } else { 0.0 };
        [0.2 + 0.05 * x as f32 + spot, 0.3 + 0.8 * spot, 0.8 - 0.05 * y as f32 + 0.5 * spot]
    });
    staged("a map", Environment::Map(map), |_| {})
}

/// The stage with one punctual light of each kind.
pub fn under_lamps() -> Scene {
    let (materials, t, camera) = stage();
    let light = |kind, position, direction: Vec3, intensity, range| PunctualLight {
        kind,
        position,
        direction: direction.normalize(),
        intensity,
        range,
    };
    let spot = PunctualKind::Spot { cos_inner: 0.9, cos_outer: 0.7 };
    let lights = vec![
        light(PunctualKind::Directional, Vec3::ZERO, Vec3::new(0.5, -1.0, -0.6), [1.0, 0.9, 0.8], f32::INFINITY),
        light(PunctualKind::Point, Vec3::new(-1.0, 2.5, 1.5), Vec3::NEG_Y, [3.0, 2.0, 4.0], 6.0),
        light(spot, Vec3::new(1.5, 3.0, 1.0), Vec3::new(-0.3, -1.0, -0.3), [9.0, 9.0, 5.0], f32::INFINITY),
    ];
    made("lamps", materials, t, Pose { lights, cameras: vec![camera], ..Pose::default() }, DARK)
}

/// The stage lit by a screen with an emissive texture.
pub fn under_a_screen() -> Scene {
    let (mut materials, mut t, camera) = stage();
    materials.push(Material {
        name: "screen".into(),
        base_color: [0.0; 3],
        specular: 0.0,
        emissive: [8.0, 6.0, 4.0],
        emissive_texture: Some(TextureRef { texture: 0 }),
        ..Material::default()
    });
    let v = Vec3::new;
    t.push_quad([v(-1.5, 3.5, 1.0), v(-1.5, 3.5, -1.0), v(1.5, 3.5, -1.0), v(1.5, 3.5, 1.0)], 4);
    let n = t.len();
    let corner = [Vec2::ZERO, Vec2::Y, Vec2::ONE, Vec2::X];
    t.uvs[n - 2] = [corner[0], corner[1], corner[2]];
    t.uvs[n - 1] = [corner[0], corner[2], corner[3]];
    let mut scene = made("a screen", materials, t, Pose { cameras: vec![camera], ..Pose::default() }, DARK);
    let texel = |i: u8| [i * 21, 255 - i * 13, if i.is_multiple_of(3) { 255 } else { 0 }, 255];
    let (size, wrap, texels) = ([4, 3], [Wrap::Repeat; 2], (0..12).map(texel).collect());
    scene.textures.push(Texture { size, texels, wrap, nearest: false, coordinates: Default::default() });
    scene
}
