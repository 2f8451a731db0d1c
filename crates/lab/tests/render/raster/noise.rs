//! A scene of random texels, and two views of it.

use afterimage::ViewGeometry;
use afterimage_lab::scene::{Environment, Material, Pose, Scene, Texture, TextureRef, Triangles, Wrap};
use afterimage_lab::view::View;
use glam::{DMat4, DQuat, DVec3, Vec2, vec3};

/// A floor and a wall of random texels, whose mean is gray: a wrong level of detail shows.
pub(super) fn noise() -> Scene {
    let mut triangles = Triangles::default();
    triangles.push_quad([vec3(-8.0, 0.0, 8.0), vec3(8.0, 0.0, 8.0), vec3(8.0, 0.0, -8.0), vec3(-8.0, 0.0, -8.0)], 0);
    triangles.push_quad([vec3(-8.0, 0.0, -8.0), vec3(8.0, 0.0, -8.0), vec3(8.0, 9.0, -4.0), vec3(-8.0, 9.0, -4.0)], 0);
    for (uvs, corners) in triangles.uvs.iter_mut().zip(&triangles.positions) {
        *uvs = corners.map(|p| Vec2::new(p.x, p.y + p.z) * 0.25);
    }
    let texels = (0..256 * 256_u32).map(|i| {
        let bits = afterimage::kernel::rng::bits(i % 256, i / 256, 0, 1);
        [bits as u8, (bits >> 8) as u8, (bits >> 16) as u8, 255]
    });
    let material = Material { base_color_texture: Some(TextureRef { texture: 0 }), ..Material::default() };
    let environment = Environment::Constant([1.0; 3]);
    let mut scene = Scene::from_parts("noise", vec![material], triangles, Pose::default(), environment).unwrap();
    let (size, wrap, texels) = ([256; 2], [Wrap::Repeat; 2], texels.collect());
    scene.textures = vec![Texture { size, texels, wrap, nearest: false, coordinates: Default::default() }];
    scene
}

/// A view of 70 degrees from 1.6 m above the floor, and the previous one: turned, moved and set back.
pub(super) fn views(geometry: ViewGeometry) -> [View; 2] {
    let now = DMat4::from_translation(DVec3::new(0.5, 1.6, 5.0)) * DMat4::from_rotation_y(0.2);
    let step = DMat4::from_translation(DVec3::new(0.05, -0.01, 0.03)) * DMat4::from_quat(DQuat::from_rotation_y(0.01));
    [now, now * step].map(|world_from_camera| View::new(geometry, world_from_camera))
}

pub(super) fn flat(size: [u32; 2]) -> ViewGeometry {
    ViewGeometry::flat(size, 70.0).unwrap()
}
