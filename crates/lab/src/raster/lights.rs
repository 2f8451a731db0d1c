//! Lights in the shader's layout: punctual lights and emissive panels.

use crate::scene::shading_records::PunctualRecord;
use crate::scene::{Material, PunctualLight, Triangles};
use afterimage::kernel::color::luma;
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use std::f32::consts::PI;

/// Largest number of lights; beyond it, the strongest are kept.
pub(super) const MAX_LIGHTS: usize = 64;

/// A light in the shader's layout. Twin of `RasterLight` in `shaders/raster/raster_frame.wgsl`.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct LightRecord {
    position: [f32; 3],
    kind: u32,
    direction: [f32; 3],
    range: f32,
    intensity: [f32; 3],
    cos_inner: f32,
    cos_outer: f32,
    area: f32,
    /// 1 for the light of the shadow map.
    pub has_shadow: f32,
    unused: f32,
}

impl LightRecord {
    /// Power that a panel emits, per color channel.
    pub fn power(&self) -> Vec3 {
        let sides = if self.kind == TWO_SIDED { 2.0 } else { 1.0 };
        Vec3::from(self.intensity) * (sides * PI * self.area)
    }
}

/// Light kinds of one-sided and two-sided panels.
const ONE_SIDED: u32 = 3;
const TWO_SIDED: u32 = 4;

/// A punctual light with the tracer's parameters.
pub(super) fn punctual(l: &PunctualLight) -> LightRecord {
    let PunctualRecord { position, kind, direction, range, intensity, cos_inner, cos_outer, .. } =
        PunctualRecord::new(l);
    LightRecord { position, kind, direction, range, intensity, cos_inner, cos_outer, ..LightRecord::default() }
}

/// Panels: emissive triangles of one material and similar orientation, merged into a disk of their total area at their
/// centroid. Uses the pose at time 0 and ignores emissive textures.
pub(super) fn panels(parts: &[&Triangles], materials: &[Material]) -> Vec<LightRecord> {
    struct Sum {
        material: u32,
        facing: Vec3,
        area: f64,
        middle: DVec3,
        normal: DVec3,
    }
    let mut sums: Vec<Sum> = vec![];
    for triangles in parts {
        for (corners, &m) in triangles.positions.iter().zip(&triangles.materials) {
            let Some(material) = materials.get(m as usize).filter(|m| luma(Vec3::from(m.emissive)) > 0.0) else {
                continue;
            };
            let [a, b, c] = corners.map(|p| p.as_dvec3());
            let across = 0.5 * (b - a).cross(c - a);
            let (area, middle) = (across.length(), (a + b + c) / 3.0);
            let facing = across.normalize_or_zero().as_vec3();
            let alike = |s: &&mut Sum| s.material == m && s.facing.dot(facing) > 0.7;
            match sums.iter_mut().find(alike) {
                Some(sum) => {
                    sum.area += area;
                    sum.middle += middle * area;
                    sum.normal += across;
                }
                None if material.emissive.iter().all(|v| v.is_finite()) && area > 0.0 => {
                    sums.push(Sum { material: m, facing, area, middle: middle * area, normal: across });
                }
                None => {}
            }
        }
    }
    let records = |s: &Sum| {
        let material = &materials[s.material as usize];
        LightRecord {
            position: (s.middle / s.area).as_vec3().to_array(),
            kind: if material.double_sided { TWO_SIDED } else { ONE_SIDED },
            direction: s.normal.normalize_or(DVec3::NEG_Y).as_vec3().to_array(),
            intensity: material.emissive,
            area: s.area as f32,
            ..LightRecord::default()
        }
    };
    let mut panels: Vec<LightRecord> = sums.iter().map(records).collect();
    panels.sort_by(|a, b| luma(b.power()).total_cmp(&luma(a.power())));
    panels.truncate(MAX_LIGHTS / 2);
    panels
}
