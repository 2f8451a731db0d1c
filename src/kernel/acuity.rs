//! Visual acuity: eccentricity, and the candidate weight from the density of retinal ganglion cells.

use super::approx;
use glam::Vec3;

/// Watson 2014, horizontal temporal meridian; the weighted-reservoir paper, eq. 3. Share of the first term.
const A_K: f32 = 0.9851;
/// Eccentricity in degrees at which the first term's density falls to a quarter.
const R_2_DEG: f32 = 1.058;
/// Scale in degrees of the exponential term.
const R_E_DEG: f32 = 22.14;
/// Foveal cone density, per square degree.
const D_C0: f32 = 14804.6;
/// Scale in degrees at which the midget fraction falls (Watson 2014, eq. 7; the reservoir paper leaves it out).
const R_M_DEG: f32 = 41.03;

/// True visual angle in degrees, in \[0, 180\], between two rays of any non-zero length.
///
/// atan2 of cross and dot product: `acos(dot)` is 0 below 0.006 degrees in f32. Error below 1e-6 rad.
#[inline]
pub fn eccentricity_deg(ray: Vec3, gaze: Vec3) -> f32 {
    let cx = ray.y * gaze.z - ray.z * gaze.y;
    let cy = ray.z * gaze.x - ray.x * gaze.z;
    let cz = ray.x * gaze.y - ray.y * gaze.x;
    let cross = (cx * cx + cy * cy + cz * cz).sqrt();
    // The z product comes first: it is often a constant, and compilers may move a constant that comes last.
    let dot = ray.z * gaze.z + ray.x * gaze.x + ray.y * gaze.y;
    // The limit also keeps compilers from merging this factor with those of the functions that the angle is passed to.
    (approx::atan2_upper(cross, dot) * (180.0 / std::f32::consts::PI)).min(180.0)
}

/// Density of midget retinal ganglion cell receptive fields per square degree at eccentricity `e_deg` >= 0 (eq. 3).
#[inline(always)]
pub fn cell_density(e_deg: f32) -> f32 {
    let q = 1.0 + e_deg * (1.0 / R_2_DEG);
    let far = approx::exp_approx(e_deg * (-1.0 / R_E_DEG));
    // A quotient, because compilers reorder a sum of two products with constants.
    (2.0 * D_C0) * (A_K / (q * q) + (1.0 - A_K) * far) / (1.0 + e_deg * (1.0 / R_M_DEG))
}

/// Weight of a candidate shaded at eccentricity `e_deg`, in (0, 1\] (eq. 4): 1 inside the fovea of radius `fovea_deg`,
/// `cell_density(e) / cell_density(fovea)` outside. `inv_density_at_fovea` is `1 / cell_density(fovea_deg)`.
#[inline]
pub fn candidate_weight(e_deg: f32, fovea_deg: f32, inv_density_at_fovea: f32) -> f32 {
    if e_deg <= fovea_deg { 1.0 } else { (cell_density(e_deg) * inv_density_at_fovea).min(1.0) }
}
