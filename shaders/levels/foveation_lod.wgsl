//#use foveate
//#use inputs
// Level of detail by eccentricity. CPU twin: Foveation::lod in src/foveation.rs.

// Filters of the foveation: src/foveation.rs. FILTER_OFF is full rate everywhere.
const FILTER_MIP: u32 = 0u;
const FILTER_GAUSS: u32 = 1u;
const FILTER_BLOCK: u32 = 2u;
const FILTER_OFF: u32 = 3u;
const FILTER_QUADS: u32 = 4u;

override FILTER: u32 = 0u;

// Foveation::lod
fn foveation_lod(e_deg: f32) -> f32 {
    if FILTER == FILTER_OFF {
        return 0.0;
    }
    if FILTER == FILTER_GAUSS {
        return blur_lod(e_deg, frame.fovea_radius_deg, frame.mid_radius_deg, frame.lod_mid, frame.lod_far);
    }
    return region_lod(
        e_deg,
        frame.fovea_radius_deg,
        frame.mid_radius_deg,
        frame.blend_deg,
        frame.lod_mid,
        frame.lod_far,
    );
}
