//! Hard cases of frames shaded by quads, H109 to H114: laws that hold on either executor.

pub mod inputs;
pub mod old_light;
pub mod other_surfaces;
pub mod sliding;
pub mod still;
pub mod turning;

use crate::depth_hard::{Make, Steps};
use crate::images::View;
use afterimage::internal::{ContextDesc, Foveation, Method, Settings, Smr};
use afterimage::{Gaze, Image};

/// The laws as tests of an executor. `$run_law` runs one, and returns what it measured.
macro_rules! planned_laws {
    ($side:ident, $run_law:ident) => {
        crate::laws::laws! { $side, $run_law,
            h109_old_light_is_gone_after_two_visits: "H109", old_light;
            h109_single_pixels_show_a_fall_of_light_on_a_contrasted_floor: "H109", contrasted_floor;
            h110_lamps_change_no_wall: "H110", lamps_and_signs;
            h111_moire_is_no_change_of_light: "H111", moire;
            h112_a_still_wall_stays_sharp: "H112", still_wall;
            h113_what_slides_leaves_nothing_behind: "H113", sliding;
            h114_shadows_that_turn_leave_no_old_light: "H114", turning;
        }
    };
}
pub(crate) use planned_laws;

/// Laws of rows that full-size frames have, too.
macro_rules! planned_input_laws {
    ($side:ident, $run_law:ident) => {
        crate::laws::laws! { $side, $run_law,
            h36_h37_colors_beyond_all_screens_stay_finite_on_planned_frames: "H36", "H37", colors;
            h42_depth_beyond_its_ends_is_clamped_on_planned_frames: "H42", depth_ends;
            h57_the_edge_of_the_view_ends_history_on_planned_frames: "H57", edge_of_the_view;
            h47_a_nan_depth_stays_near_its_pixel_on_planned_frames: "H47", nan_depth;
            h51_a_still_picture_is_complete_and_stays_on_planned_frames: "H51", still_picture;
            h52_a_whole_shift_moves_history_exactly_on_planned_frames: "H52", whole_shift;
            h53_half_pixels_blur_no_more_than_stated_on_planned_frames: "H53", half_pixels;
            h54_garbage_motion_rejects_its_pixel_on_planned_frames: "H54", garbage_motion;
            h58_nothing_bleeds_over_a_depth_edge_on_planned_frames: "H58", depth_edge;
            h59_a_zoom_leaves_no_hole_on_planned_frames: "H59", zoom;
            h60_a_turn_is_a_full_reset_on_planned_frames: "H60", turn;
            h63_a_lost_gaze_is_held_on_planned_frames: "H63", lost_gaze;
            h66_the_old_fovea_stays_sharp_on_planned_frames: "H66", saccade;
            h72_a_declared_exposure_loses_nothing_on_planned_frames: "H72", exposure;
            h74_a_strobe_leaves_nothing_behind_on_planned_frames: "H74", strobe;
            h75_black_and_white_by_turns_on_planned_frames: "H75", black_and_white;
            h76_h79_other_sizes_and_back_equal_a_fresh_context_on_planned_frames: "H76", "H79", other_sizes;
            h77_h78_resets_equal_a_fresh_context_on_planned_frames: "H77", "H78", resets;
        }
    };
}
pub(crate) use planned_input_laws;

/// The whole tables, on the CPU: the device has its bits.
#[allow(unused_macros, reason = "the CPU's tests use it")]
macro_rules! planned_tables {
    ($side:ident, $run_law:ident) => {
        crate::laws::laws! { $side, $run_law,
            h47_a_nan_depth_stays_near_its_pixel_on_antialiased_frames: "H47", nan_depth_antialiased;
            h109_old_light_behind_slow_edges: "H109", slow_edges;
            h109_old_light_behind_fast_edges: "H109", fast_edges;
            h109_old_light_where_edges_stood: "H109", standing_edges;
            h109_old_light_after_steps: "H109", steps;
            h109_old_light_after_fades: "H109", fades;
            h109_old_light_in_short_and_long_means: "H109", lengths_of_means;
            h110_lamps_and_signs_of_many_kinds_change_no_wall: "H110", lamps_table;
            h111_moire_of_other_stripes_is_no_change_of_light: "H111", moire_table;
            h113_squares_of_many_speeds_leave_nothing_behind: "H113", sliding_table;
            h114_shadows_of_many_speeds_leave_no_old_light: "H114", turning_table;
        }
    };
}
#[allow(unused_imports, reason = "the CPU's tests use it")]
pub(crate) use planned_tables;

pub const SIZE: [u32; 2] = [64, 36];
/// Of all that is seen.
pub const DISTANCE: f32 = 5.0;

/// smr on quads, of which about a `share` is shaded everywhere.
pub fn context(make: Make<'_>, size: [u32; 2], share: f32, antialias: bool) -> Option<Box<dyn Steps>> {
    context_of(make, size, share, Method::Smr(Smr { antialias, ..Smr::default() }))
}

/// The same of any method.
pub fn context_of(make: Make<'_>, size: [u32; 2], share: f32, method: Method) -> Option<Box<dyn Steps>> {
    let settings = Settings { method, foveation: Foveation::uniform(share), ..Settings::default() };
    make(ContextDesc { settings, ..ContextDesc::new(size) })
}

/// Offset of a frame's samples in their pixels.
pub fn jitter_px(index: u64, antialias: bool) -> [f32; 2] {
    if antialias { Foveation::jitter_px(index) } else { [0.0; 2] }
}

/// A picture at one distance, seen with this jitter: `color` of a place, in pixels from the first one's centre.
pub fn frame(size: [u32; 2], jitter_px: [f32; 2], color: impl Fn([f32; 2]) -> [f32; 3]) -> View {
    let at = |[x, y]: [u32; 2]| color([x as f32 - jitter_px[0], y as f32 - jitter_px[1]]);
    View::still(Image::from_fn(size, at), [0.0; 2]).with(|view| {
        view.facts.gaze = Gaze::Lost;
        view.facts.jitter_px = jitter_px;
        view.depth = Some(Image::filled(size, DISTANCE));
    })
}

/// Random numbers of whole places.
pub fn hash(x: i64, y: i64) -> f32 {
    let mut h = (x as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ (y as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F);
    h ^= h >> 29;
    h = h.wrapping_mul(0xBF58_476D_1CE4_E5B9);
    h ^= h >> 32;
    (h & 0xffff) as f32 / 65535.0
}

/// Smooth noise of cells of unit size.
fn smooth_noise(x: f32, y: f32) -> f32 {
    let [left, top] = [x, y].map(f32::floor);
    let [u, v] = [x - left, y - top].map(|f| f * f * (3.0 - 2.0 * f));
    let at = |dx: i64, dy: i64| hash(left as i64 + dx, top as i64 + dy);
    let row = |dy: i64| at(0, dy) + (at(1, dy) - at(0, dy)) * u;
    row(0) + (row(1) - row(0)) * v
}

/// A wall with coarse and fine detail.
pub fn wall([x, y]: [f32; 2]) -> [f32; 3] {
    let coarse = smooth_noise(x / 19.0, y / 17.0);
    let fine = smooth_noise(x / 1.7 + 300.0, y / 1.7);
    let light = 0.05 + 0.5 * coarse * coarse + 0.35 * fine * coarse;
    [light, light * (0.8 + 0.2 * smooth_noise(x / 40.0 + 7.0, y / 40.0)), light * 0.7]
}
