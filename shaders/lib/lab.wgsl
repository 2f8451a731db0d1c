//#use color
// Twin of src/kernel/lab.rs, which explains the constants.

const LAB_EPSILON: f32 = 216.0f / 24389.0f;
const LAB_SLOPE: f32 = 841.0f / 108.0f;
const LAB_OFFSET: f32 = 16.0f / 116.0f;

// f(t) of CIE Lab: the cube root, or a line for small t.
fn lab_f(t: f32) -> f32 {
    if t > LAB_EPSILON {
        return cbrt(t);
    }
    return LAB_SLOPE * t + LAB_OFFSET;
}

// CIE L*a*b* (white: D65 at linear 1) of a linear Rec.
fn lab(c: vec3f) -> vec3f {
    let fx = lab_f(0.43388735 * c.x + 0.376224 * c.y + 0.18988865 * c.z);
    let fy = lab_f(0.212639 * c.x + 0.7151687 * c.y + 0.0721923 * c.z);
    let fz = lab_f(0.01775004 * c.x + 0.10944762 * c.y + 0.8728023 * c.z);
    return vec3f(116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz));
}

// CIE 116: `reference` sets the weights.
fn delta_e94(reference: vec3f, stored: vec3f) -> f32 {
    let d = reference - stored;
    let c1 = sqrt(reference.y * reference.y + reference.z * reference.z);
    let c2 = sqrt(stored.y * stored.y + stored.z * stored.z);
    let dc = c1 - c2;
    let dh2 = max(d.y * d.y + d.z * d.z - dc * dc, 0.0);
    let sc = 1.0 + 0.045 * c1;
    let sh = 1.0 + 0.015 * c1;
    return sqrt(d.x * d.x + (dc * dc) / (sc * sc) + dh2 / (sh * sh));
}
