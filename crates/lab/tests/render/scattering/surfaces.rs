//! Surfaces and directions for the scattering tests.

use afterimage_lab::kernel::albedo::AlbedoTables;
use afterimage_lab::kernel::bsdf::Surface;
use afterimage_testing::Draws;
use glam::Vec3;
use std::sync::LazyLock;

/// Albedo tables, computed once for all tests.
pub static TABLES: LazyLock<AlbedoTables> = LazyLock::new(AlbedoTables::compute);

/// White Lambertian surface.
pub const WHITE: Surface = Surface {
    base_color: Vec3::ONE,
    metallic: 0.0,
    roughness: 0.5,
    specular: 0.0,
    specular_color: Vec3::ONE,
    ior: 1.5,
    anisotropy: 0.0,
    clearcoat: 0.0,
    clearcoat_roughness: 0.0,
    sheen_color: Vec3::ZERO,
    sheen_roughness: 0.5,
    transmission: 0.0,
    thin: false,
    entering: true,
};

/// Unit vector with cosine `z` and azimuth `turns`.
pub fn direction(z: f32, turns: f32) -> Vec3 {
    let r = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
    let angle = turns * std::f32::consts::TAU;
    Vec3::new(r * angle.cos(), r * angle.sin(), z)
}

/// 0, 1 or uniform in between.
pub fn share(d: &mut Draws) -> f32 {
    match d.bits() % 4 {
        0 => 0.0,
        1 => 1.0,
        _ => d.uniform(),
    }
}

/// Random white surface, which absorbs nothing.
pub fn white(d: &mut Draws) -> Surface {
    let sheen = share(d);
    Surface {
        metallic: share(d),
        roughness: share(d),
        specular: share(d),
        ior: d.range(1.0, 3.0),
        clearcoat: share(d),
        clearcoat_roughness: share(d),
        sheen_color: Vec3::splat(sheen),
        sheen_roughness: share(d),
        transmission: share(d),
        thin: d.bits() & 1 == 0,
        entering: d.bits() & 1 == 0,
        ..WHITE
    }
}
