//! All triangles of a scene: static and moving.

use super::bvh::{Bvh, Hit, PreparedRay, Ray};
use super::triangle_records::{AttributeRecord, AttributesAt, TriangleRecord};
use glam::Vec3;

/// Static and moving triangles, each under a hierarchy of its own. Indices of moving triangles follow those of static
/// ones.
#[derive(Clone, Debug, Default)]
pub struct Geometry {
    /// Static triangles, built once.
    pub still: Bvh,
    /// Moving triangles, rebuilt every frame.
    pub moving: Bvh,
}

impl Geometry {
    /// Index of the first moving triangle.
    pub fn first_moving(&self) -> u32 {
        self.still.triangles().len() as u32
    }

    /// Number of triangles.
    pub fn len(&self) -> u32 {
        self.first_moving() + self.moving.triangles().len() as u32
    }

    /// Whether there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Stores the row of the light table that a triangle belongs to.
    ///
    /// # Panics
    /// If the index is out of range.
    pub fn set_light(&mut self, index: u32, light: u32) {
        let first_moving = self.first_moving();
        match index.checked_sub(first_moving) {
            None => self.still.triangles[index as usize].set_light(light),
            Some(i) => self.moving.triangles[i as usize].set_light(light),
        }
    }

    /// The triangle with index `index`, as hits report it.
    ///
    /// # Panics
    /// If the index is out of range.
    #[inline]
    pub fn triangle(&self, index: u32) -> &TriangleRecord {
        let (bvh, i) = self.place(index);
        &bvh.triangles()[i]
    }

    /// Shading attributes of a triangle.
    ///
    /// # Panics
    /// If the index is out of range.
    #[inline]
    pub fn attributes(&self, index: u32) -> &AttributeRecord {
        let (bvh, i) = self.place(index);
        &bvh.attributes()[i]
    }

    /// Attributes at a point of a triangle; its second texture coordinates only if `second` (and there are some).
    ///
    /// # Panics
    /// If the index is out of range.
    #[inline]
    pub fn attributes_at(&self, index: u32, u: f32, v: f32, second: bool) -> AttributesAt {
        let (bvh, i) = self.place(index);
        let mut place = bvh.attributes()[i].at(u, v);
        if second && let Some(records) = bvh.second_uvs() {
            place.second_uv = records[i].at(u, v);
        }
        place
    }

    /// Corner positions in the previous frame; `None` if the triangle is static or they are unknown.
    #[inline]
    pub fn previous(&self, index: u32) -> Option<[Vec3; 3]> {
        let (bvh, i) = self.place(index);
        bvh.previous.get(i).copied()
    }

    /// Nearest hit, as [`Bvh::closest`].
    #[inline]
    pub fn closest(&self, ray: &Ray, mut accept: impl FnMut(u32, f32, f32) -> bool) -> Option<Hit> {
        let prepared = PreparedRay::new(ray)?;
        let mut hit = Hit::none(ray.t_max);
        let still = self.still.traverse::<false>(&prepared, 0, &mut hit, &mut accept);
        let moving = self.moving.traverse::<false>(&prepared, self.first_moving(), &mut hit, &mut accept);
        (still || moving).then_some(hit)
    }

    /// Whether the ray hits anything, as [`Bvh::occluded`].
    #[inline]
    pub fn occluded(&self, ray: &Ray, mut accept: impl FnMut(u32, f32, f32) -> bool) -> bool {
        let Some(prepared) = PreparedRay::new(ray) else { return false };
        let mut hit = Hit::none(ray.t_max);
        self.still.traverse::<true>(&prepared, 0, &mut hit, &mut accept)
            || self.moving.traverse::<true>(&prepared, self.first_moving(), &mut hit, &mut accept)
    }

    #[inline]
    fn place(&self, index: u32) -> (&Bvh, usize) {
        match index.checked_sub(self.first_moving()) {
            None => (&self.still, index as usize),
            Some(i) => (&self.moving, i as usize),
        }
    }
}
