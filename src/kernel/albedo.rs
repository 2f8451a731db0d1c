//! Directional albedos of the lobes, interpolated in tables that are computed once by quadrature.

use super::microfacet::{MIN_SHEEN_ROUGHNESS, MIN_WIDTH};
use glam::{Vec2, Vec4};

/// Cosines of the tables of GGX and of sheen.
pub const COSINES: u32 = 32;
/// Roughnesses of the tables of GGX and of sheen.
pub const ROUGHNESSES: u32 = 32;
/// Cosines of the table of refraction.
pub const GLASS_COSINES: u32 = 24;
/// Roughnesses of the table of refraction.
pub const GLASS_ROUGHNESSES: u32 = 16;
/// Indices of refraction of the table of refraction.
pub const GLASS_IORS: u32 = 8;
/// Cells before the table of refraction.
pub const GLASS_BASE: u32 = COSINES * ROUGHNESSES;
/// Cells of all tables.
pub const CELLS: u32 = GLASS_BASE + GLASS_COSINES * GLASS_ROUGHNESSES * GLASS_IORS;

/// The tables, one flat list of cells.
#[derive(Clone, Debug, PartialEq)]
pub struct AlbedoTables {
    pub(super) cells: Vec<Vec4>,
}

impl AlbedoTables {
    /// As they are uploaded, four words a cell.
    pub fn words(&self) -> impl Iterator<Item = [u32; 4]> + '_ {
        self.cells.iter().map(|c| c.to_array().map(f32::to_bits))
    }
}

/// One cell.
#[inline]
fn albedo_cell(tables: &AlbedoTables, index: u32) -> Vec4 {
    tables.cells[index as usize]
}

/// Position on an axis of `count` knots of `t` in \[0, 1\]: the knot before it, and how far it is to the next.
#[inline]
fn albedo_knot(t: f32, count: u32) -> Vec2 {
    let x = t.clamp(0.0, 1.0) * (count - 1) as f32;
    let knot = x.floor().min((count - 2) as f32);
    Vec2::new(knot, x - knot)
}

/// Where a cosine lies on its axis. Masking changes over cosines of about the width, however small it is, so the axis is
/// stretched there.
#[inline]
pub fn albedo_cosine(cosine: f32, roughness: f32) -> f32 {
    let k = (roughness * roughness).max(MIN_WIDTH);
    (cosine * (1.0 + k)) / (cosine + k)
}

/// Bilinear interpolation in the first table.
#[inline]
fn albedo_plane(tables: &AlbedoTables, x: f32, y: f32) -> Vec4 {
    let kx = albedo_knot(x, COSINES);
    let ky = albedo_knot(y, ROUGHNESSES);
    let i = ky.x as u32 * COSINES + kx.x as u32;
    let a = albedo_cell(tables, i);
    let b = albedo_cell(tables, i + 1);
    let c = albedo_cell(tables, i + COSINES);
    let d = albedo_cell(tables, i + COSINES + 1);
    let low = a + (b - a) * kx.y;
    let high = c + (d - c) * kx.y;
    low + (high - low) * ky.y
}

/// Directional albedo of GGX with reflectance 1, and with reflectance (1 - v.h)^5. Reflectance `f0` at normal incidence has
/// f0 (x - y) + y.
#[inline]
pub fn ggx_albedo(tables: &AlbedoTables, cosine: f32, roughness: f32) -> Vec2 {
    let e = albedo_plane(tables, albedo_cosine(cosine, roughness), roughness);
    Vec2::new(e.x, e.y)
}

/// Directional albedo of white sheen; may exceed 1.
#[inline]
pub fn sheen_albedo(tables: &AlbedoTables, cosine: f32, roughness: f32) -> f32 {
    let y = (roughness - MIN_SHEEN_ROUGHNESS) / (1.0 - MIN_SHEEN_ROUGHNESS);
    albedo_plane(tables, cosine.sqrt(), y).z
}

/// What single scattering at a rough boundary returns in reflection and refraction together: by Fresnel's equations, and with
/// no reflection but the total one.
#[inline]
pub fn glass_albedo(tables: &AlbedoTables, cosine: f32, roughness: f32, ior: f32, entering: bool) -> Vec2 {
    let kx = albedo_knot(albedo_cosine(cosine, roughness), GLASS_COSINES);
    let ky = albedo_knot(roughness, GLASS_ROUGHNESSES);
    let kz = albedo_knot(2.0 * ((ior - 1.0) / (ior + 1.0)), GLASS_IORS);
    let row = GLASS_COSINES;
    let plane = GLASS_COSINES * GLASS_ROUGHNESSES;
    let mut sums = [Vec4::ZERO; 2];
    for (k, sum) in sums.iter_mut().enumerate() {
        let i = GLASS_BASE + (kz.x as u32 + k as u32) * plane + ky.x as u32 * row + kx.x as u32;
        let a = albedo_cell(tables, i);
        let b = albedo_cell(tables, i + 1);
        let c = albedo_cell(tables, i + row);
        let d = albedo_cell(tables, i + row + 1);
        let low = a + (b - a) * kx.y;
        let high = c + (d - c) * kx.y;
        *sum = low + (high - low) * ky.y;
    }
    let e = sums[0] + (sums[1] - sums[0]) * kz.y;
    if entering { Vec2::new(e.x, e.y) } else { Vec2::new(e.z, e.w) }
}
