//! Lights of the rasterizer: punctual lights, emissive panels, a sun with a shadow map, and ambient light.

use super::bounce;
use super::lights::{LightRecord, MAX_LIGHTS, panels, punctual};
use crate::scene::effects::{Effect, Effects};
use crate::scene::{Environment, PunctualKind, PunctualLight, Scene};
use afterimage::Image;
use afterimage::kernel::color::luma;
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use std::f32::consts::PI;

/// Sky radiance of scenes without light.
pub const DEFAULT_SKY: [f32; 3] = [0.35, 0.42, 0.5];
/// Irradiance of the sun added to scenes without light.
pub const DEFAULT_SUN: [f32; 3] = [3.6, 3.3, 2.9];
/// Direction in which that sun shines.
pub const DEFAULT_SUN_DIRECTION: [f32; 3] = [-0.35, -0.87, -0.35];

/// All lights in the shader's layout. Twin of `RasterLights` in `shaders/raster/raster_frame.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(super) struct LightingRecord {
    ambient: [[f32; 4]; 6],
    sun: [[f32; 4]; 3],
    bounced: [f32; 3],
    count: u32,
    texel: f32,
    last_level: f32,
    unused: [f32; 2],
    lights: [LightRecord; MAX_LIGHTS],
}

/// Lights that do not change over time.
#[derive(Clone, Debug)]
pub(super) struct Lighting {
    /// The scene's environment, or the default sky.
    pub environment: Environment,
    /// Whether a sun was added because the scene has no light.
    added_sun: bool,
    panels: Vec<LightRecord>,
    ambient: [Vec3; 6],
    bounced: Vec3,
    center: Vec3,
    /// Radius of the scene's bounding sphere, metres.
    pub radius: f32,
}

impl Lighting {
    pub fn new(scene: &Scene) -> Self {
        let needs = Effects::needed(scene);
        let added_sun = !needs.has_light();
        let environment = if added_sun { Environment::Constant(DEFAULT_SKY) } else { scene.environment.clone() };
        let rest = scene.pose(0.0);
        let panels = panels(&[scene.still(), &rest.moving], &scene.materials);
        let (low, high) = scene.bounds().map_or((Vec3::NEG_ONE, Vec3::ONE), |b| (b.min, b.max));
        let radius = (0.5 * (high - low).length()).clamp(1e-6, 1e9);
        let bounced = if needs.has(Effect::Environment) || added_sun {
            Vec3::ZERO
        } else {
            bounce::radiance(scene, &rest.moving, &rest.lights, &panels, high - low)
        };
        Self {
            ambient: ambient(&environment),
            environment,
            added_sun,
            panels,
            bounced,
            center: 0.5 * (low + high),
            radius,
        }
    }

    /// The strongest directional light of `lights`, or the added sun.
    pub fn sun(&self, lights: &[PunctualLight]) -> Option<PunctualLight> {
        if self.added_sun {
            return Some(PunctualLight::sun(Vec3::from(DEFAULT_SUN_DIRECTION), DEFAULT_SUN));
        }
        let far = lights.iter().filter(|l| l.kind == PunctualKind::Directional);
        far.copied().max_by(|a, b| strength(a).total_cmp(&strength(b)))
    }

    /// Shader record with the punctual lights at one time. `last_level` is the last mip level of the sky, `shadow_side`
    /// the shadow map's size in texels.
    pub fn record(&self, lights: &[PunctualLight], last_level: f32, shadow_side: u32) -> LightingRecord {
        let sun = self.sun(lights);
        let mut all = lights.to_vec();
        all.sort_by(|a, b| strength(b).total_cmp(&strength(a)));
        if let Some(sun) = sun {
            all.retain(|l| *l != sun);
            all.insert(0, sun);
        }
        let mut records: Vec<LightRecord> = all.iter().map(punctual).chain(self.panels.iter().copied()).collect();
        records.truncate(MAX_LIGHTS);
        if let (Some(_), Some(first)) = (sun, records.first_mut()) {
            first.has_shadow = 1.0;
        }
        let count = records.len() as u32;
        records.resize(MAX_LIGHTS, LightRecord::default());
        LightingRecord {
            ambient: self.ambient.map(|c| c.extend(0.0).to_array()),
            sun: self.sun_rows(sun.map_or(Vec3::NEG_Y, |s| s.direction)),
            bounced: self.bounced.to_array(),
            count,
            texel: 2.0 * self.radius / shadow_side as f32,
            last_level,
            unused: [0.0; 2],
            lights: records.try_into().expect("as many as there may be"),
        }
    }

    /// Matrix rows from world space to the shadow map, which covers the scene's bounding sphere. Depth is 1 nearest to
    /// the sun.
    fn sun_rows(&self, direction: Vec3) -> [[f32; 4]; 3] {
        let along = direction.normalize_or(Vec3::NEG_Y);
        let right = along.any_orthonormal_vector();
        let up = right.cross(along);
        // Slightly larger than the sphere, to allow for rounding.
        let scale = 1.0 / (1.01 * self.radius);
        let row = |axis: Vec3, scale: f32, middle: f32| {
            (axis * scale).extend(middle - axis.dot(self.center) * scale).to_array()
        };
        [row(right, scale, 0.0), row(up, scale, 0.0), row(-along, 0.5 * scale, 0.5)]
    }
}

fn strength(light: &PunctualLight) -> f32 {
    luma(Vec3::from(light.intensity))
}

/// Irradiance from the environment on faces towards +x, -x, +y, -y, +z, -z.
fn ambient(environment: &Environment) -> [Vec3; 6] {
    match environment {
        Environment::Constant(radiance) => [Vec3::from(*radiance) * PI; 6],
        Environment::Map(map) => irradiance(map),
    }
}

fn irradiance(map: &Image<[f32; 3]>) -> [Vec3; 6] {
    let [w, h] = [map.width(), map.height()];
    let mut sums = [DVec3::ZERO; 6];
    for y in 0..h {
        let v = (y as f64 + 0.5) / h as f64 * std::f64::consts::PI;
        let solid = v.sin() * (std::f64::consts::PI / h as f64) * (std::f64::consts::TAU / w as f64);
        for x in 0..w {
            let u = ((x as f64 + 0.5) / w as f64 - 0.5) * std::f64::consts::TAU;
            let direction = DVec3::new(u.sin() * v.sin(), v.cos(), -u.cos() * v.sin());
            let radiance = Vec3::from(map.at(x, y)).as_dvec3();
            for axis in 0..3 {
                let cosine = direction[axis];
                sums[2 * axis + usize::from(cosine < 0.0)] += radiance * (cosine.abs() * solid);
            }
        }
    }
    sums.map(|s| s.as_vec3())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_map_lights_like_a_constant() {
        let map = Image::filled([64, 32], [0.5, 1.0, 2.0]);
        for face in irradiance(&map) {
            // The midpoint rule on 32 rows has a relative error of (pi / 32)^2 / 12, and as much again at the horizon.
            assert!((face / PI - Vec3::new(0.5, 1.0, 2.0)).abs().max_element() < 0.005, "{face}");
        }
    }

    #[test]
    fn the_middle_of_a_sunlit_scene_is_in_the_middle_of_the_map() {
        let scene = crate::scene::builtin::courtyard();
        let lighting = Lighting::new(&scene);
        let rows = lighting.sun_rows(Vec3::new(0.3, -1.0, 0.2).normalize());
        let at = |p: Vec3| rows.map(|r| Vec3::new(r[0], r[1], r[2]).dot(p) + r[3]);
        let [x, y, z] = at(lighting.center);
        assert!(x.abs() < 1e-5 && y.abs() < 1e-5 && (z - 0.5).abs() < 1e-5);
        // Depth grows towards the sun.
        assert!(at(lighting.center + Vec3::Y * 0.1)[2] > z);
    }
}
