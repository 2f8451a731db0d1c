//! Visual acuity: the weight of a candidate from the density of retinal ganglion cells.

use super::approx;

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
