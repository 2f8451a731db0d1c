//! Culling for small squares of pixels: the objects visible in them, and the objects that cast shadows on these.

use super::light;
use super::scene::{Camera, Placed, Stage, may_shade};
use super::shape::{Ray, Shape};
use afterimage::ViewGeometry;
use glam::{Vec2, Vec3};

/// Object lists of a square of pixels. Culling is conservative: it changes no pixel.
#[derive(Debug, Default)]
pub(super) struct Tile {
    /// Objects that rays of the tile can hit.
    pub candidates: Vec<u16>,
    /// For each candidate, by object index: objects that may cast a shadow on its part in the tile.
    pub casters: Vec<Vec<u16>>,
    /// Objects with ambient occlusion on the floor in the tile.
    pub standing: Vec<u16>,
}

impl Tile {
    /// Fills the lists for the pixels in [`from`, `to`); `corners` are the rays through the tile's corners, in cyclic
    /// order.
    pub fn fill(&mut self, stage: &Stage, outlines: &[Outline], [from, to]: [Vec2; 2], corners: &[Ray; 4]) {
        self.casters.resize(stage.objects.len(), Vec::new());
        self.candidates.clear();
        self.standing.clear();
        for (index, object) in stage.objects.iter().enumerate() {
            if !outlines[index].meets(from - 0.5, to - 0.5) {
                continue;
            }
            self.candidates.push(index as u16);
            let part = visible_part(object, corners);
            let casters = &mut self.casters[index];
            casters.clear();
            casters
                .extend(object.casters.iter().filter(|&&c| may_shade(stage.objects[c as usize].shape.bound(), part)));
            if index == stage.floor {
                self.standing.extend(
                    (0..stage.objects.len() as u16)
                        .filter(|&i| light::occludes_floor(&stage.objects[i as usize].shape, part)),
                );
            }
        }
    }
}

/// Bounding sphere of the part of an object that rays between `corners` can hit.
fn visible_part(object: &Placed, corners: &[Ray; 4]) -> (Vec3, f32) {
    let whole = object.shape.bound();
    let Shape::Rect { centre, u, v, .. } = object.shape else {
        return whole;
    };
    let n = u.cross(v);
    let distance = |ray: &Ray| n.dot(centre - ray.origin) / n.dot(ray.direction);
    let in_front = |ray: &Ray| (0.0..1e6).contains(&distance(ray));
    if !corners.iter().all(in_front) {
        // The tile crosses the horizon of the plane.
        return whole;
    }
    let points = corners.map(|ray| ray.at(distance(&ray)));
    let middle = points.iter().sum::<Vec3>() / 4.0;
    let radius = points.iter().map(|p| p.distance(middle)).fold(0.0, f32::max);
    if radius < whole.1 { (middle, radius * 1.001 + 1e-3) } else { whole }
}

/// Screen-space bounding rectangle of an object, in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outline {
    from: Vec2,
    to: Vec2,
}

impl Outline {
    /// Bounding rectangle of the projected bounding box, clipped at the near plane.
    pub fn of(shape: &Shape, camera: &Camera, view: &ViewGeometry) -> Self {
        const NEAR: f32 = 1e-2;
        let corners = shape.corners().map(|corner| camera.view(corner));
        let mut outline = Self { from: Vec2::INFINITY, to: Vec2::NEG_INFINITY };
        for (i, &a) in corners.iter().enumerate() {
            if a.z >= NEAR {
                outline.add(a, view);
            }
            for &b in &corners[..i] {
                if (a.z >= NEAR) != (b.z >= NEAR) {
                    let on_plane = a.lerp(b, (NEAR - a.z) / (b.z - a.z));
                    outline.add(on_plane.with_z(NEAR), view);
                }
            }
        }
        outline
    }

    fn add(&mut self, point: Vec3, view: &ViewGeometry) {
        if let Some(px) = view.project(point.into()) {
            // A margin for rounding.
            self.from = self.from.min(Vec2::from(px) - 0.01);
            self.to = self.to.max(Vec2::from(px) + 0.01);
        }
    }

    fn meets(&self, from: Vec2, to: Vec2) -> bool {
        self.from.cmple(to).all() && self.to.cmpge(from).all()
    }
}
