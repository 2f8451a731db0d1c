//#use inputs
// Entry point of the methods' passes: processes each pixel by the function `pixel` of the pass, and counts it. One
// invocation a pixel; z is the view.

@compute @workgroup_size(64, 1)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) invocation: u32,
) {
    if id.x < frame.size.x && id.y < frame.size.y {
        // View index from the workgroup id, which is uniform: the view's constants are loaded once.
        pixel(id.xy, frame.first_view + group.z);
    }
    add_counts(invocation);
}
