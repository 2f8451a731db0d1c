//#use plan
//#use alpha_test
//#use traverse
// Adds the contribution of unoccluded light samples.

@compute @workgroup_size(WORKGROUP)
fn shadow(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= plan[SHADOW_RAYS] {
        return;
    }
    let path = lists[2u * frame.capacity + id.x];
    if ALPHA {
        let item = work[path];
        alpha_pixel = item.x;
        alpha_sample = item.y;
        alpha_ray = 2u * plan[BOUNCE] + 1u;
    }
    let origin = path_row(path, PATH_SHADOW);
    let ray = Ray(origin.xyz, path_row(path, PATH_SHADOW + 1u).xyz, origin.w);
    if !occluded(ray, frame.key) {
        let radiance = path_row(path, PATH_RADIANCE).xyz + path_row(path, PATH_SHADOW + 2u).xyz;
        set_path_row(path, PATH_RADIANCE, radiance, 0.0);
    }
}
