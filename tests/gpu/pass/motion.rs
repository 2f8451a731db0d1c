//! Moving surfaces on the device: hard cases H51 to H60.

use super::surfaces::{still, with_motion};
use super::*;
use crate::depth_hard::{METHODS, SIZE, Steps};
use crate::motion_hard::*;
use afterimage::{MotionUnit, Verdict};

motion_laws!(Gpu, run_law);

#[test]
fn h55_half_float_motion_is_off_by_its_quantum_and_no_more() {
    // Half a view and half a pixel, nearly, in texture coordinates, where halves step by 2^-11: a 32nd of these pixels.
    let motion = MotionConvention { unit: MotionUnit::Uv, ..MotionConvention::default() };
    let desc = ContextDesc { motion, ..ContextDesc::new(SIZE) };
    let Some(mut rig) = Rig::new(desc, ungated()) else { return };
    rig.halve_motion();
    rig.step(0, &still("before"));
    let wanted_px = 32.0 + 0.49;
    let stored = pack::half_value(pack::half_bits(wanted_px / 64.0));
    let made = rig.step(1, &with_motion("after", |_| [stored, 0.0]));
    let read_px = made.trace.at(0, 0).motion[0];
    println!("{wanted_px} px is read as {read_px} px");
    assert!(read_px != wanted_px && (read_px - wanted_px).abs() <= 0.5 * 64.0 * 2.0_f32.powi(-11));
    // 0.49 would round to the same texel; as read it is the next one's: one column more has left the view.
    let columns = if read_px >= 32.5 { 33 } else { 32 };
    assert_eq!(made.stats.verdicts[Verdict::OffScreen as usize], columns * 48);
    holds!("H55", Gpu, "{wanted_px} px of 64 in uv as a half is read as {read_px}: off by less than half its quantum");
}

#[test]
fn h57_the_last_texel_is_inside_and_a_hundredth_beyond_its_edge_is_not() {
    // The view ends half a pixel beyond the last centre, column 63.
    for method in METHODS {
        for (to, inside) in [(63.0, true), (63.49, true), (63.51, false), (-0.49, true), (-0.51, false), (0.0, true)] {
            let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), ungated_of(method)) else { return };
            rig.step(0, &still("border"));
            let trace = rig.step(1, &with_motion("border", |[x, _]| [to - x as f32, 0.0])).trace;
            for (i, t) in trace.pixels().iter().enumerate() {
                // smr rejects vectors that are unlike their neighbours': these grow by a pixel from one to the next.
                let is_silhouette = method == MethodKind::Smr && t.verdict == Verdict::Disoccluded;
                let verdict = if inside { Verdict::Valid } else { Verdict::OffScreen };
                assert!(is_silhouette || t.verdict == verdict, "{method:?}: pixel {i} to column {to}");
                assert!(inside || t.verdict == Verdict::OffScreen);
            }
        }
    }
    holds!("H57", Gpu, "wrs and smr: columns 63, 63.49 and -0.49 of 0 to 63 are accepted, 63.51 and -0.51 rejected");
}
