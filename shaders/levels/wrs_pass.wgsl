//#use each_pixel
//#use wrs_pixel
// Weighted reservoirs over whole frames.

fn pixel(px: vec2u, view: u32) {
    weighted_pixel(px, view, Place(px, 1.0));
}
