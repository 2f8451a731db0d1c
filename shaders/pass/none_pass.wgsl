//#use inputs
//#use output
// No method: outputs the sanitized candidate. CPU twin: src/cpu/none_pass.rs. One invocation a pixel; z is the view.

fn pixel(px: vec2u, view: u32) {
    let given = color_at(px, view);
    let candidate = color(given.xyz);
    // The verdict is not a constant, although there is never a past frame. Compilers would compute the debug view's
    // color of a constant with a different rounding.
    let verdict = select(VERDICT_EMPTY, VERDICT_RESET, frame.past_frame == NO_FRAME);
    count_if(!candidate.usable, COUNT_NONFINITE);
    count_if(true, COUNT_VERDICTS + verdict);
    write_output(px, view, candidate.color, given.w, PixelTrace(verdict, 0.0, 0.0, 0u, 0.0, 1.0, true, motion_at(px, view)));
}

@compute @workgroup_size(64, 1)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) invocation: u32,
) {
    if id.x < frame.size.x && id.y < frame.size.y {
        pixel(id.xy, frame.first_view + group.z);
    }
    add_counts(invocation);
}
