//! Directional albedos of the BSDF lobes, interpolated from tables that are computed once by quadrature.

use super::microfacet::{MIN_SHEEN_COSINE, MIN_SHEEN_ROUGHNESS, schlick_weight};
use glam::{Vec2, Vec3, Vec4};

/// Knots along the cosine in the tables of GGX and sheen.
pub const COSINES: u32 = 48;
/// Knots along roughness in the tables of GGX and sheen.
pub const ROUGHNESSES: u32 = 32;
/// Knots along the cosine in the table of refraction.
pub const GLASS_COSINES: u32 = 24;
/// Knots along roughness in the table of refraction.
pub const GLASS_ROUGHNESSES: u32 = 12;
/// Knots along the index of refraction in the table of refraction.
pub const GLASS_IORS: u32 = 12;
/// First cell of the table of refraction.
pub const GLASS_BASE: u32 = COSINES * ROUGHNESSES;
/// First cell of the table of anisotropic GGX.
pub const ANISOTROPIC_BASE: u32 = GLASS_BASE + GLASS_COSINES * GLASS_ROUGHNESSES * GLASS_IORS;
/// Knots of the table of anisotropic GGX along cosine, azimuth, larger width and aspect.
pub const ANISOTROPIC: [u32; 4] = [12, 5, 10, 5];
/// Smallest aspect: square root of the ratio of the smaller to the larger width.
pub const MIN_ASPECT: f32 = 0.316_227_77;
/// Number of cells of all tables.
pub const CELLS: u32 = ANISOTROPIC_BASE + ANISOTROPIC[0] * ANISOTROPIC[1] * ANISOTROPIC[2] * ANISOTROPIC[3];

/// Start of the sheen's cosine axis: fourth root of the smallest cosine.
pub const SHEEN_ROOT: f32 = 0.177_827_94;
/// Start of the axis of indices of refraction: sqrt(2 (n - 1) / (n + 1)) of the smallest index.
pub const IOR_ROOT: f32 = 0.171_913_92;

/// All tables in one flat list of cells.
#[derive(Clone, Debug, PartialEq)]
pub struct AlbedoTables {
    pub(super) cells: Vec<Vec4>,
}

impl AlbedoTables {
    /// Cells as bits for upload, four words each.
    pub fn words(&self) -> impl Iterator<Item = [u32; 4]> + '_ {
        self.cells.iter().map(|c| c.to_array().map(f32::to_bits))
    }
}

/// Reads one cell.
#[inline]
fn albedo_cell(tables: &AlbedoTables, index: u32) -> Vec4 {
    tables.cells[index as usize]
}

/// Position of `t` in \[0, 1\] on an axis of `count` knots: the knot before it, and the fraction of the way to the
/// next.
#[inline]
pub fn albedo_knot(t: f32, count: u32) -> Vec2 {
    let x = t.clamp(0.0, 1.0) * (count - 1) as f32;
    let knot = x.floor().min((count - 2) as f32);
    Vec2::new(knot, x - knot)
}

/// Position of a cosine on its axis. Masking changes over a range of cosines about as wide as `width`, so the axis is
/// stretched there. Takes GGX' width, not its square root, because compilers replace the square of a root by its
/// argument.
#[inline]
pub fn albedo_cosine(cosine: f32, width: f32) -> f32 {
    let k = (1.0 - 0.75 * width) * width;
    (cosine * (1.0 + k)) / (cosine + k)
}

/// Bilinear interpolation between cell `i`, the next one, and the two that follow them after `row` cells.
#[inline]
fn albedo_between(tables: &AlbedoTables, i: u32, row: u32, x: f32, y: f32) -> Vec4 {
    let a = albedo_cell(tables, i);
    let b = albedo_cell(tables, i + 1);
    let c = albedo_cell(tables, i + row);
    let d = albedo_cell(tables, i + row + 1);
    let low = a + (b - a) * x;
    let high = c + (d - c) * x;
    low + (high - low) * y
}

/// Bilinear interpolation in the tables of GGX and sheen.
#[inline]
pub fn albedo_plane(tables: &AlbedoTables, x: f32, y: f32) -> Vec4 {
    let kx = albedo_knot(x, COSINES);
    let ky = albedo_knot(y, ROUGHNESSES);
    albedo_between(tables, ky.x as u32 * COSINES + kx.x as u32, COSINES, kx.y, ky.y)
}

/// Directional albedo of GGX of `width`: x for reflectance 1, y for reflectance (1 - v.h)^5. For reflectance `f0` at
/// normal incidence it is f0 (x - y) + y.
#[inline]
pub fn ggx_albedo(tables: &AlbedoTables, cosine: f32, width: f32) -> Vec2 {
    let e = albedo_plane(tables, albedo_cosine(cosine, width), width.sqrt());
    // The table stores the difference from a smooth surface.
    Vec2::new(e.x, e.x * schlick_weight(cosine) + e.y)
}

/// Correction that anisotropy adds to both components of [`ggx_albedo`] at the mean width.
///
/// Shadowing of anisotropic facets depends on the direction along both axes, so no single isotropic width can replace
/// it.
#[inline]
pub fn anisotropic_albedo(tables: &AlbedoTables, wo: Vec3, a: Vec2) -> Vec2 {
    let slanted = wo.x.abs() + wo.y.abs();
    let azimuth = if slanted > 1e-6 { wo.x.abs() / slanted } else { 0.5 };
    let aspect = ((a.y / a.x).sqrt() - MIN_ASPECT) * (1.0 / (1.0 - MIN_ASPECT));
    let kx = albedo_knot(albedo_cosine(wo.z, a.x), ANISOTROPIC[0]);
    let ky = albedo_knot(azimuth, ANISOTROPIC[1]);
    let kz = albedo_knot(a.x.sqrt(), ANISOTROPIC[2]);
    let kw = albedo_knot(aspect, ANISOTROPIC[3]);
    let row = ANISOTROPIC[0];
    let mut parts = [Vec4::ZERO; 4];
    for (corner, part) in parts.iter_mut().enumerate() {
        let z = kz.x as u32 + (corner as u32 & 1);
        let w = kw.x as u32 + (corner as u32 >> 1);
        let i = ANISOTROPIC_BASE + ((w * ANISOTROPIC[2] + z) * ANISOTROPIC[1] + ky.x as u32) * row + kx.x as u32;
        *part = albedo_between(tables, i, row, kx.y, ky.y);
    }
    let low = parts[0] + (parts[1] - parts[0]) * kz.y;
    let high = parts[2] + (parts[3] - parts[2]) * kz.y;
    let sum = low + (high - low) * kw.y;
    Vec2::new(sum.x, sum.x * schlick_weight(wo.z) + sum.y)
}

/// Directional albedo of white sheen. May exceed 1.
#[inline]
pub fn sheen_albedo(tables: &AlbedoTables, cosine: f32, roughness: f32) -> f32 {
    let y = (roughness - MIN_SHEEN_ROUGHNESS) * (1.0 / (1.0 - MIN_SHEEN_ROUGHNESS));
    let x = (cosine.max(MIN_SHEEN_COSINE).sqrt().sqrt() - SHEEN_ROOT) * (1.0 / (1.0 - SHEEN_ROOT));
    albedo_plane(tables, x, y).z
}

/// Directional albedo of single scattering at a rough boundary, reflection and refraction together: x with Fresnel's
/// equations, y with total internal reflection as the only reflection.
#[inline]
pub fn glass_albedo(tables: &AlbedoTables, cosine: f32, width: f32, ior: f32, entering: bool) -> Vec2 {
    let kx = albedo_knot(albedo_cosine(cosine, width).sqrt(), GLASS_COSINES);
    let ky = albedo_knot(width.sqrt(), GLASS_ROUGHNESSES);
    let kz =
        albedo_knot((((2.0 * (ior - 1.0)) / (ior + 1.0)).sqrt() - IOR_ROOT) * (1.0 / (1.0 - IOR_ROOT)), GLASS_IORS);
    let row = GLASS_COSINES;
    let plane = GLASS_COSINES * GLASS_ROUGHNESSES;
    let mut sums = [Vec4::ZERO; 2];
    for (k, sum) in sums.iter_mut().enumerate() {
        let i = GLASS_BASE + (kz.x as u32 + k as u32) * plane + ky.x as u32 * row + kx.x as u32;
        *sum = albedo_between(tables, i, row, kx.y, ky.y);
    }
    let e = sums[0] + (sums[1] - sums[0]) * kz.y;
    if entering { Vec2::new(e.x, e.y) } else { Vec2::new(e.z, e.w) }
}
