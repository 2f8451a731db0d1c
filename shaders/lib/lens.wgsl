//#use approx
// Twin of src/kernel/lens.rs.

// Whether pixel (`x`, `y`) lies in the octagon: x, y, x + y and x - y are within `lowest` and `highest`, in pixels.
fn is_visible(x: u32, y: u32, lowest: vec4f, highest: vec4f) -> bool {
    let along = vec4f(f32(x), f32(y), f32(x) + f32(y), f32(x) - f32(y));
    return all(along >= lowest) && all(along <= highest);
}

// True visual angle in degrees, in [0, 180], between two rays of any non-zero length.
fn eccentricity_deg(ray: vec3f, gaze: vec3f) -> f32 {
    let cx = ray.y * gaze.z - ray.z * gaze.y;
    let cy = ray.z * gaze.x - ray.x * gaze.z;
    let cz = ray.x * gaze.y - ray.y * gaze.x;
    let across = sqrt(cx * cx + cy * cy + cz * cz);
    let along = ray.z * gaze.z + ray.x * gaze.x + ray.y * gaze.y;
    return min(atan2_upper(across, along) * (180.0f / PI), 180.0);
}
