//! A scene prepared for tracing, as both tracers read it.

use super::alias::alias_table;
use crate::records::{
    LIGHT_ENVIRONMENT, LIGHT_INDEX, LIGHT_PUNCTUAL, LIGHT_TRIANGLE, MapRecord, PickRecord, TextureRecord,
};
use afterimage::Image;
use afterimage::kernel::color::{luma, srgb_decode};
use afterimage_lab::kernel::albedo::AlbedoTables;
use afterimage_lab::rays::{Bvh, Geometry, TriangleFlags, TriangleRecord};
use afterimage_lab::scene::effects::{Effect, Effects};
use afterimage_lab::scene::shading_records::{MaterialRecord, PunctualRecord};
use afterimage_lab::scene::{Environment, PunctualKind, PunctualLight, Scene, Texture};
use glam::Vec3;
use std::f64::consts::PI;

/// Geometry, materials, textures and lights of a scene at one time.
#[derive(Clone, Debug)]
pub struct World {
    /// Static and moving triangles.
    pub geometry: Geometry,
    /// Materials of the scene; at least one.
    pub materials: Vec<MaterialRecord>,
    /// Textures of the scene.
    pub textures: Vec<TextureRecord>,
    /// Texels of all textures, four bytes each, red lowest. Every texture begins at a multiple of four texels.
    pub texels: Vec<u32>,
    /// Alias table over all lights; empty without lights.
    pub picks: Vec<PickRecord>,
    /// Punctual lights.
    pub punctual: Vec<PunctualRecord>,
    /// Radiance of a constant environment; black if there is an environment map.
    pub sky: Vec3,
    /// Width and height of the environment map in texels; 0 without a map.
    pub map_size: [u32; 2],
    /// Texels of the environment map, row by row.
    pub map: Vec<MapRecord>,
    /// Probability that light sampling picks the environment.
    pub sky_probability: f32,
    /// Tables of the lobes' directional albedos.
    pub tables: AlbedoTables,
    /// Effects that the scene needs.
    pub needs: Effects,
    /// Capacity: largest number of moving triangles and of lights at any time. Triangles without area at a time count,
    /// too.
    pub(super) max_moving: usize,
    pub(super) max_lights: usize,
    /// Luminance that each material emits, summed over both sides if it is double-sided.
    emitted_luma: Vec<f64>,
    /// Mean luminance of the environment.
    sky_luma: f64,
    still_bounds: [Vec3; 2],
}

impl World {
    /// Prepares the scene at time 0, without motion.
    pub fn new(scene: &Scene) -> Self {
        let materials: Vec<_> = scene.materials.iter().map(MaterialRecord::new).collect();
        let mut textures = vec![];
        let mut texels = vec![];
        for t in &scene.textures {
            textures.push(TextureRecord::new(t, (texels.len() / 4) as u32));
            texels.extend(t.texels.iter().map(|&bytes| u32::from_le_bytes(bytes)));
            texels.resize(texels.len().next_multiple_of(4), 0);
        }
        let (sky, map_size, map) = match &scene.environment {
            Environment::Constant(radiance) => (Vec3::from(*radiance), [0, 0], vec![]),
            Environment::Map(image) => (Vec3::ZERO, image.size(), map_records(image)),
        };
        let sky_luma = match &scene.environment {
            Environment::Constant(radiance) => f64::from(luma(Vec3::from(*radiance))),
            Environment::Map(image) => mean_radiance(image),
        };
        let emitted_luma = scene
            .materials
            .iter()
            .map(|m| {
                let texture = m.emissive_texture.and_then(|t| scene.textures.get(t.texture as usize));
                let sides = if m.double_sided { 2.0 } else { 1.0 };
                sides * f64::from(luma(Vec3::from(m.emissive))) * texture.map_or(1.0, mean_luma)
            })
            .collect();
        let rest = scene.pose(0.0);
        let shining = |m: &&u32| scene.materials.get(**m as usize).is_some_and(|m| m.emissive.iter().any(|&e| e > 0.0));
        let max_lights = scene.still().materials.iter().chain(&rest.moving.materials).filter(shining).count()
            + rest.lights.len()
            + 1;
        let mut world = Self {
            geometry: Geometry { still: Bvh::build(scene.still(), None, &scene.materials), moving: Bvh::default() },
            materials: if materials.is_empty() { vec![MaterialRecord::new(&Default::default())] } else { materials },
            textures,
            texels,
            picks: vec![],
            punctual: vec![],
            sky,
            map_size,
            map,
            sky_probability: 0.0,
            tables: AlbedoTables::compute(),
            needs: Effects::needed(scene),
            emitted_luma,
            sky_luma,
            max_moving: rest.moving.len(),
            max_lights,
            still_bounds: [Vec3::INFINITY, Vec3::NEG_INFINITY],
        };
        world.still_bounds = bounds(world.geometry.still.triangles());
        world.pose(scene, 0.0, 0.0);
        world
    }

    /// Poses the scene at `time_s` (seconds). Motion vectors refer to the pose at `previous_s`.
    pub fn pose(&mut self, scene: &Scene, time_s: f64, previous_s: f64) {
        let pose = scene.pose(time_s);
        if !pose.moving.is_empty() {
            let previous = scene.pose(previous_s).moving.positions;
            self.geometry.moving = Bvh::build(&pose.moving, Some(&previous), &scene.materials);
        }
        self.punctual = pose.lights.iter().map(PunctualRecord::new).collect();
        self.pick_lights(&pose.lights);
    }

    /// Builds the light table. A light's probability is its approximate share of the power sent into the scene's
    /// bounding sphere.
    fn pick_lights(&mut self, lights: &[PunctualLight]) {
        let moving = bounds(self.geometry.moving.triangles());
        let [low, high] = [self.still_bounds[0].min(moving[0]), self.still_bounds[1].max(moving[1])];
        let radius = (0.5 * f64::from((high - low).length())).max(1e-6);
        let disk = if radius.is_finite() { PI * radius * radius } else { 1.0 };
        let mut kinds_and_indices = vec![];
        let mut power = vec![];
        for i in 0..self.geometry.len() {
            let triangle = self.geometry.triangle(i);
            let emitted_luma = self.emitted_luma.get(triangle.material() as usize).copied().unwrap_or(0.0);
            if triangle.has(TriangleFlags::EMISSIVE) && emitted_luma > 0.0 {
                let [a, b, c] = triangle.positions().map(|p| p.as_dvec3());
                kinds_and_indices.push(LIGHT_TRIANGLE << 30 | i);
                power.push(PI * emitted_luma * 0.5 * (b - a).cross(c - a).length());
            }
        }
        for (i, l) in lights.iter().enumerate() {
            let intensity = f64::from(luma(Vec3::from(l.intensity)));
            kinds_and_indices.push(LIGHT_PUNCTUAL << 30 | i as u32);
            power.push(
                intensity
                    * match l.kind {
                        PunctualKind::Directional => disk,
                        PunctualKind::Point => 4.0 * PI,
                        PunctualKind::Spot { cos_outer, .. } => 2.0 * PI * (1.0 - f64::from(cos_outer)),
                    },
            );
        }
        if self.needs.has(Effect::Environment) {
            kinds_and_indices.push(LIGHT_ENVIRONMENT << 30);
            power.push(4.0 * PI * self.sky_luma * disk);
        }
        let (rows, probability) = alias_table(&power);
        self.picks.clear();
        for (i, (keep, alias)) in rows.into_iter().enumerate() {
            self.picks.push(PickRecord {
                keep,
                alias,
                probability: probability[i],
                kind_and_index: kinds_and_indices[i],
            });
            if kinds_and_indices[i] >> 30 == LIGHT_TRIANGLE {
                self.geometry.set_light(kinds_and_indices[i] & LIGHT_INDEX, i as u32);
            }
        }
        let has_sky = self.needs.has(Effect::Environment);
        self.sky_probability = if has_sky { probability.last().copied().unwrap_or(0.0) } else { 0.0 };
    }
}

/// Smallest and largest corner coordinates.
fn bounds(triangles: &[TriangleRecord]) -> [Vec3; 2] {
    let corners = triangles.iter().flat_map(|t| t.positions());
    corners.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)])
}

/// Mean luminance of an emissive texture.
fn mean_luma(texture: &Texture) -> f64 {
    let decoded: Vec<f32> = (0..=255).map(|byte| srgb_decode(byte as f32 / 255.0)).collect();
    let value = |b: u8| decoded[usize::from(b)];
    let sum: f64 =
        texture.texels.iter().map(|t| f64::from(luma(Vec3::new(value(t[0]), value(t[1]), value(t[2]))))).sum();
    // Never 0: a path can hit any emitting texel, so light sampling must have a density there.
    (sum / texture.texels.len().max(1) as f64).max(1e-6)
}

/// Share of all directions that a row of environment texels covers.
fn row_share(height: usize, row: usize) -> f64 {
    let edge = |r: usize| (PI * r as f64 / height as f64).cos();
    0.5 * (edge(row) - edge(row + 1))
}

fn mean_radiance(map: &Image<[f32; 3]>) -> f64 {
    let rows = (0..map.height()).map(|y| {
        let sum: f64 = map.row(y).iter().map(|&c| f64::from(luma(Vec3::from(c)))).sum();
        sum / map.width() as f64 * row_share(map.height(), y)
    });
    rows.sum()
}

/// Environment texels with probabilities proportional to radiance times solid angle. The neighbours of a texel add to
/// its probability, because bilinear filtering reads them.
fn map_records(map: &Image<[f32; 3]>) -> Vec<MapRecord> {
    let [w, h] = [map.width(), map.height()];
    let at = |x: usize, y: usize| f64::from(luma(Vec3::from(map.at(x % w, y.min(h - 1)))));
    let weights: Vec<f64> = (0..w * h)
        .map(|i| {
            let (x, y) = (i % w, i / w);
            let share = [(w - 1, 0.125), (0, 0.75), (1, 0.125)];
            let row = |y: usize| share.iter().map(|&(dx, s)| s * at(x + dx, y)).sum::<f64>();
            (0.125 * row(y.saturating_sub(1)) + 0.75 * row(y) + 0.125 * row(y + 1)) * row_share(h, y)
        })
        .collect();
    let (rows, probability) = alias_table(&weights);
    let records = map.pixels().iter().zip(rows).zip(probability);
    records
        .map(|((&radiance, (keep, alias)), probability)| MapRecord {
            radiance,
            probability,
            keep,
            alias,
            unused: [0.0; 2],
        })
        .collect()
}
