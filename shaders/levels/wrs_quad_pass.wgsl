//#use each_pixel
//#use lattice
//#use quad_samples
//#use wrs_pixel
// Weighted reservoirs over planned frames: candidates count by the place of their sample. CPU twin: `nearest_sample` in
// src/cpu/quads.rs.

// Place of the sample nearest to a pixel, the first of equally near ones. Without samples around: the pixel itself,
// with a weight of 1.
fn place_of(px: vec2u, view: u32) -> Place {
    let mask_word = mask_at(px, view);
    var place = Place(px, 1.0);
    if is_shaded(mask_word, px) {
        return place;
    }
    let around = around_pixel(px, view, mask_word);
    var nearest_px2 = 0xffffffffu;
    for (var tap = 0u; tap < 4u; tap++) {
        let sample = sample_tap(around, tap, px, view);
        let offset = vec2i(sample.at) - vec2i(px);
        let px2 = u32(offset.x * offset.x + offset.y * offset.y);
        if sample.is_there && px2 < nearest_px2 {
            nearest_px2 = px2;
            place = Place(sample.at, place_weight(vec2f(offset)));
        }
    }
    return place;
}

fn pixel(px: vec2u, view: u32) {
    weighted_pixel(px, view, place_of(px, view));
}
