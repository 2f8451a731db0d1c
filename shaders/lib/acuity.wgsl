//#use approx
// Twin of src/kernel/acuity.rs, which explains the constants (Watson 2014).

const A_K: f32 = 0.9851;
const R_2_DEG: f32 = 1.058;
const R_E_DEG: f32 = 22.14;
const D_C0: f32 = 14804.6;
const R_M_DEG: f32 = 41.03;

// Eq. 3.
fn cell_density(e_deg: f32) -> f32 {
    let q = 1.0 + e_deg * (1.0f / R_2_DEG);
    let far = exp_approx(e_deg * (-1.0f / R_E_DEG));
    return (2.0f * D_C0) * (A_K / (q * q) + (1.0f - A_K) * far) / (1.0 + e_deg * (1.0f / R_M_DEG));
}

// Eq. 4.
fn candidate_weight(e_deg: f32, fovea_deg: f32, inv_density_at_fovea: f32) -> f32 {
    if e_deg <= fovea_deg {
        return 1.0;
    }
    return min(cell_density(e_deg) * inv_density_at_fovea, 1.0);
}
