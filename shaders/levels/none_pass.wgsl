//#use each_pixel
//#use output
// No method: outputs the sanitized candidate. CPU twin: src/cpu/levels/none_pass.rs.

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
