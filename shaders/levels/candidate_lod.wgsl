//#use foveation_lod
//#use lod
// Level of detail of a candidate: the frame's input, or by eccentricity. CPU twin: Inputs::candidate_lod in
// src/cpu/inputs.rs.

override HAS_LOD: u32 = 0u;

@group(0) @binding(5) var lod_in: texture_2d_array<f32>;

// Level of detail of the candidate of a pixel at eccentricity `e_deg`.
fn candidate_lod(px: vec2u, view: u32, e_deg: f32) -> f32 {
    if HAS_LOD != 0u {
        let given = textureLoad(lod_in, texel_of(px, view, LOD_IN), layer_of(view), 0).x;
        // The test is on the bits: NaN gives 0.
        return select(0.0, clamp(given, 0.0, MAX_LOD), (bitcast<u32>(given) & 0x7fffffffu) <= 0x7f800000u);
    }
    return foveation_lod(e_deg);
}
