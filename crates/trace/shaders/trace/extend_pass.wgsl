//#use plan
//#use alpha_test
//#use traverse
// Finds the nearest hit of every live path.

@compute @workgroup_size(WORKGROUP)
fn extend(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= plan[PATHS_ALIVE] {
        return;
    }
    let path = active_path(id.x);
    if ALPHA {
        let item = work[path];
        alpha_pixel = item.x;
        alpha_sample = item.y;
        alpha_ray = 2u * plan[BOUNCE];
    }
    let ray = Ray(path_row(path, PATH_ORIGIN).xyz, path_row(path, PATH_DIRECTION).xyz, FAR_AWAY);
    let hit = closest(ray, frame.key);
    paths[path * PATH_ROWS + PATH_HIT] =
        vec4u(hit.triangle, bitcast<u32>(hit.t), bitcast<u32>(hit.u), bitcast<u32>(hit.v));
}

// Largest finite f32: rays have no limit.
const FAR_AWAY: f32 = 3.4028234e38;
