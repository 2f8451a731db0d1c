//#use rng
//#use surface_point
// Alpha test of a path's hits: Paths::accept_hit. Callers set the three variables before they trace.

const DRAWS_ALPHA_TEST: u32 = 0x80000000u;

var<private> alpha_pixel: u32;
var<private> alpha_sample: u32;
// Distinguishes the rays of a path.
var<private> alpha_ray: u32;

fn accept_hit(triangle: u32, u: f32, v: f32, key: u32) -> bool {
    let draws = path_draws(alpha_pixel, alpha_sample, DRAWS_ALPHA_TEST | alpha_ray, key ^ triangle);
    return passes_alpha_test(triangle, u, v, draws.x);
}
