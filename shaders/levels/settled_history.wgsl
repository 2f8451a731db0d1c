//#use surface_history
//#use taa
// Luma of settled history: to compare it with samples; shared by taa and taau. CPU twin:
// src/cpu/levels/surface_history.rs.

// Luma of history at `offset_px` from the texel nearest to a position, regardless of its surface.
fn luma_beside(source: Source, offset_px: vec2i, view: u32) -> f32 {
    let nearest = source.texel + vec2i(source.fraction >= vec2f(0.5));
    return root_luma(exposed(surface_at(nearest + offset_px, view).color));
}
