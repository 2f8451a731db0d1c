//! All triangles of a scene, at rest and in motion.

use super::bvh::{Bvh, Hit, Prepared, Ray};
use super::triangle_records::{AttributeRecord, PreviousRecord, TriangleRecord};

/// The triangles that never move and those that do. Indices of the moving ones come after those at rest.
#[derive(Clone, Debug, Default)]
pub struct Geometry {
    /// Built once.
    pub still: Bvh,
    /// Built for each frame.
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

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Says which row of the table of lights a triangle is.
    pub(super) fn set_light(&mut self, index: u32, light: u32) {
        let first_moving = self.first_moving();
        match index.checked_sub(first_moving) {
            None => self.still.triangles[index as usize].set_light(light),
            Some(i) => self.moving.triangles[i as usize].set_light(light),
        }
    }

    /// A triangle of a hit.
    ///
    /// # Panics
    /// If there is no such triangle.
    #[inline]
    pub fn triangle(&self, index: u32) -> &TriangleRecord {
        let (bvh, i) = self.place(index);
        &bvh.triangles()[i]
    }

    /// Its shading.
    ///
    /// # Panics
    /// If there is no such triangle.
    #[inline]
    pub fn attributes(&self, index: u32) -> &AttributeRecord {
        let (bvh, i) = self.place(index);
        &bvh.attributes()[i]
    }

    /// Where it was a frame ago; `None` if it is at rest or that is not known.
    #[inline]
    pub fn previous(&self, index: u32) -> Option<&PreviousRecord> {
        let (bvh, i) = self.place(index);
        bvh.previous().get(i)
    }

    /// The nearest hit, as [`Bvh::closest`].
    #[inline]
    pub fn closest(&self, ray: &Ray, mut accept: impl FnMut(u32, f32, f32) -> bool) -> Option<Hit> {
        let prepared = Prepared::new(ray)?;
        let mut hit = Hit::none(ray.t_max);
        let still = self.still.traverse::<false>(&prepared, 0, &mut hit, &mut accept);
        let moving = self.moving.traverse::<false>(&prepared, self.first_moving(), &mut hit, &mut accept);
        (still || moving).then_some(hit)
    }

    /// Whether anything is hit, as [`Bvh::occluded`].
    #[inline]
    pub fn occluded(&self, ray: &Ray, mut accept: impl FnMut(u32, f32, f32) -> bool) -> bool {
        let Some(prepared) = Prepared::new(ray) else { return false };
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
