//#use each_pixel
//#use lattices
//#use wrs_pixel
// Weighted reservoirs over sparse frames: candidates count by the place of their sample.

// Place of the sample nearest to a pixel. Without samples in the frame: the pixel itself, with a weight of 1.
fn place_of(px: vec2u, view: u32) -> Place {
    let lattice = lattice_at(px, view);
    if any(lattice.points == vec2u(0u)) {
        return Place(px, 1.0);
    }
    let first = lattice.first_px;
    let level = lattice.level;
    let nearest = vec2i(nearest_point(px.x, first.x, level), nearest_point(px.y, first.y, level));
    let point = clamp(nearest, vec2i(0), vec2i(lattice.points) - 1);
    let x = point_offset_px(px.x, first.x, level, point.x);
    let y = point_offset_px(px.y, first.y, level, point.y);
    return Place(first + (vec2u(point) << vec2u(level)), place_weight(vec2f(x, y)));
}

fn pixel(px: vec2u, view: u32) {
    weighted_pixel(px, view, place_of(px, view));
}
