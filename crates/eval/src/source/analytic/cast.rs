//! Ray casting: color, depth and motion of the pixels of a [`Stage`].

use super::light;
use super::scene::{Placed, Stage};
use super::shape::{Ray, Shape, Surface};
use super::texture::Spot;
use super::tile::{Outline, Tile};
use crate::source::reference_offsets_px;
use afterimage::ViewGeometry;
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// Side in pixels of a [`Tile`].
const SIDE: usize = 16;
/// Footprint width of the only sample of a pixel, in pixels.
const SHARP: f32 = 1.2;
/// Nearest depth of a hit, in metres.
const NEAR: f32 = 1e-3;

/// Sample pattern of color: offsets from the pixel centre, the same for every pixel and frame.
#[derive(Clone)]
pub(super) struct Pattern {
    offsets: Vec<[f32; 2]>,
    /// Footprint width of one sample, in pixels.
    footprint: f32,
}

impl Pattern {
    /// A Hammersley set of `count` samples (a power of two), stratified in both axes.
    pub fn new(count: u32) -> Self {
        let offsets = (0..count)
            .map(|i| {
                let bits = count.trailing_zeros();
                let reversed = i.reverse_bits().checked_shr(32 - bits).unwrap_or(0);
                // With four samples a rotated grid, which separates their columns better.
                let y = if bits == 2 { [1, 3, 0, 2][i as usize] } else { reversed };
                [i, y].map(|k| (k as f32 + 0.5) / count as f32 - 0.5)
            })
            .collect();
        Self { offsets, footprint: SHARP / (count as f32).sqrt() }
    }

    /// `count` samples, each filtered like the only sample of a pixel, so that their mean equals the mean of jittered
    /// frames.
    pub fn supersampled(count: u32) -> Self {
        Self { offsets: reference_offsets_px(count).collect(), footprint: SHARP }
    }
}

/// Casts rays of a view into a stage.
pub(super) struct Caster<'a> {
    stage: &'a Stage,
    view: &'a ViewGeometry,
    pattern: &'a Pattern,
    outlines: Vec<Outline>,
}

/// Depth and motion of the surface at a pixel centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Geometry {
    /// Depth along the view axis; infinite for the sky.
    pub depth: f32,
    /// Motion vector in pixels, y down, previous minus current.
    pub motion: [f32; 2],
}

impl<'a> Caster<'a> {
    pub fn new(stage: &'a Stage, view: &'a ViewGeometry, pattern: &'a Pattern) -> Self {
        let outline = |object: &Placed| Outline::of(&object.shape, &stage.cameras[0], view);
        Self { stage, view, pattern, outlines: stage.objects.iter().map(outline).collect() }
    }

    /// Evaluates `pixel(x, y, tile)` for every pixel, in parallel. Results are in row-major order.
    pub fn render<T: Send + Copy>(&self, empty: T, pixel: impl Fn(u32, u32, &Tile) -> T + Sync) -> Vec<T> {
        let [width, height] = self.view.size_px().map(|s| s as usize);
        let mut pixels = vec![empty; width * height];
        pixels.par_chunks_mut(width * SIDE).enumerate().for_each(|(band, rows)| {
            let mut tile = Tile::default();
            for left in (0..width).step_by(SIDE) {
                let right = (left + SIDE).min(width);
                let top = band * SIDE;
                let bottom = top + rows.len() / width;
                let area = [[left, top], [right, bottom]].map(|p| p.map(|c| c as f32));
                let corners = self.corners(area);
                tile.fill(self.stage, &self.outlines, area.map(Vec2::from), &corners);
                for y in top..bottom {
                    for x in left..right {
                        rows[(y - top) * width + x] = pixel(x as u32, y as u32, &tile);
                    }
                }
            }
        });
        pixels
    }

    /// Rays through the corners of a rectangle of pixels, in cyclic order.
    fn corners(&self, [from, to]: [[f32; 2]; 2]) -> [Ray; 4] {
        [[from[0], from[1]], [to[0], from[1]], [to[0], to[1]], [from[0], to[1]]]
            .map(|corner| self.ray(corner.map(|c| c - 0.5)))
    }

    fn ray(&self, px: [f32; 2]) -> Ray {
        let camera = &self.stage.cameras[0];
        Ray { origin: camera.origin, direction: camera.axes * Vec3::from(self.view.ray(px)) }
    }

    fn nearest(&self, ray: &Ray, tile: &Tile) -> Option<(usize, f32)> {
        let mut found = None;
        let mut far = f32::INFINITY;
        for &index in &tile.candidates {
            if let Some(t) = self.stage.objects[index as usize].shape.hit(ray, NEAR, far) {
                far = t;
                found = Some((index as usize, t));
            }
        }
        found
    }

    /// Mean linear color of a pixel.
    pub fn color(&self, x: u32, y: u32, tile: &Tile) -> [f32; 3] {
        let mut sum = Vec3::ZERO;
        for offset in &self.pattern.offsets {
            let ray = self.ray([x as f32 + offset[0], y as f32 + offset[1]]);
            sum += match self.nearest(&ray, tile) {
                Some((index, t)) => self.shade(&ray, index, t, tile),
                None => light::sky(ray.direction),
            };
        }
        (sum / self.pattern.offsets.len() as f32).to_array()
    }

    /// Whether any color sample of a pixel hits the object with index `object`.
    pub fn touches(&self, x: u32, y: u32, tile: &Tile, object: usize) -> bool {
        self.pattern.offsets.iter().any(|offset| {
            let ray = self.ray([x as f32 + offset[0], y as f32 + offset[1]]);
            self.nearest(&ray, tile).is_some_and(|(index, _)| index == object)
        })
    }

    /// Depth and motion at a pixel's centre.
    pub fn geometry(&self, x: u32, y: u32, tile: &Tile) -> Geometry {
        let [now, before] = &self.stage.cameras;
        let ray = self.ray([x as f32, y as f32]);
        let Some((index, depth)) = self.nearest(&ray, tile) else {
            // The sky is at infinity: only the camera's rotation moves it.
            return Geometry {
                depth: f32::INFINITY,
                motion: self.motion(before.axes.transpose() * ray.direction, now.axes.transpose() * ray.direction),
            };
        };
        let point = ray.at(depth);
        let object = &self.stage.objects[index];
        let previous = object.previous(object.shape.bound().0, point);
        Geometry { depth, motion: self.motion(before.view(previous), now.view(point)) }
    }

    /// Motion vector between two points in view space. A difference of two projections, not of a projection and the
    /// pixel centre, is exactly zero where nothing moved. A point behind the previous camera gets a vector far outside
    /// of the frame.
    fn motion(&self, previous: Vec3, current: Vec3) -> [f32; 2] {
        let outside = self.view.size_px().map(|s| 4.0 * s as f32);
        match (self.view.project(previous.into()), self.view.project(current.into())) {
            (Some(a), Some(b)) => [a[0] - b[0], a[1] - b[1]],
            _ => outside,
        }
    }

    fn shade(&self, ray: &Ray, index: usize, t: f32, tile: &Tile) -> Vec3 {
        let object = &self.stage.objects[index];
        let point = ray.at(t);
        let surface = object.shape.surface(point, ray.direction);
        let spot = self.spot(ray, t, point, &surface, object);
        let albedo = object.material.albedo(&spot);
        let occluders = light::Occluders { casters: &tile.casters[index], standing: &tile.standing };
        albedo * light::arriving(self.stage, &occluders, index, point, surface.normal)
    }

    /// Texture coordinates and the sample's footprint there.
    fn spot(&self, ray: &Ray, t: f32, point: Vec3, surface: &Surface, object: &Placed) -> Spot {
        let axes = self.stage.cameras[0].axes;
        let (scale, _) = self.view.scale_offset();
        let d = ray.direction;
        // Ray differentials on the tangent plane. The bound on the slope keeps grazing rays finite.
        let slope = surface.normal.dot(d);
        let slope = if slope.abs() < 1e-3 { -1e-3 } else { slope };
        let aside = |axis: Vec3, scale: f32| {
            let step = axis * scale;
            (step - d * (surface.normal.dot(step) / slope)) * t
        };
        let (dx, dy) = (aside(axes.x_axis, scale[0]), aside(axes.y_axis, scale[1]));
        let [u, v] = surface.tangents;
        let width = |axis: Vec3| (axis.dot(dx).abs() + axis.dot(dy).abs()) * self.pattern.footprint;
        let ball = match object.shape {
            Shape::Sphere { centre, radius } => {
                let spin = object.poses.map(|p| p[0].spin);
                let out = (point - centre) / radius;
                (spin.map_or(out, |s| s.transpose() * out), radius)
            }
            _ => (Vec3::ZERO, 1.0),
        };
        Spot { uv: surface.uv, w: Vec2::new(width(u), width(v)), ball }
    }
}
