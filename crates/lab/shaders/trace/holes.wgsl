//#use rng
//#use surface_point
// Whether a path meets a surface with holes: Paths::meets. Whoever traces says which path it is first.

const DRAWS_HOLES: u32 = 0x80000000u;

var<private> hole_pixel: u32;
var<private> hole_sample: u32;
// Tells the rays of a path apart.
var<private> hole_ray: u32;

fn accept_hit(triangle: u32, u: f32, v: f32, key: u32) -> bool {
    let draws = path_draws(hole_pixel, hole_sample, DRAWS_HOLES | hole_ray, key ^ triangle);
    return is_there(triangle, u, v, draws.x);
}
