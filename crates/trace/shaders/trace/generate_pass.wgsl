//#use direction
//#use rng
//#use frame
// Starts a camera path for each item of a batch.

const DRAWS_CAMERA: u32 = 0u;

@compute @workgroup_size(WORKGROUP)
fn generate(@builtin(global_invocation_id) id: vec3u) {
    let path = id.x;
    if path >= frame.items {
        return;
    }
    let item = work[path];
    let draws = path_draws(item.x, item.y, DRAWS_CAMERA, frame.key);
    let px = f32(item.x & 0xffffu) + (draws.x - 0.5) * frame.jitter;
    let py = f32(item.x >> 16u) + (draws.y - 0.5) * frame.jitter;
    set_path_row(path, PATH_ORIGIN, frame.origin, 0.0);
    set_path_row(path, PATH_DIRECTION, unit(frame.corner + frame.right * px + frame.down * py), 0.0);
    set_path_row(path, PATH_THROUGHPUT, vec3f(1.0), 0.0);
    set_path_row(path, PATH_RADIANCE, vec3f(0.0), 0.0);
    lists[path] = path;
}
