//! Moving surfaces on the device: hard cases H51 to H60.

use super::surfaces::held;
use super::surfaces::{one, still, ungated_of, with_motion};
use crate::depth_hard::METHODS;
use crate::laws::laws;
use crate::motion_hard::*;
use afterimage::{MethodKind, Verdict};
use afterimage_testing::holds;

motion_laws!(Gpu, held);

#[test]
fn h57_the_last_texel_is_inside_and_a_hundredth_beyond_its_edge_is_not() {
    // The view ends half a pixel beyond the last centre, column 63.
    for method in METHODS {
        for (to, inside) in [(63.0, true), (63.49, true), (63.51, false), (-0.49, true), (-0.51, false), (0.0, true)] {
            let Some(mut rig) = ungated_of(method) else { return };
            one(&mut rig, 0, still("border"));
            let (_, trace) = one(&mut rig, 1, with_motion("border", |[x, _]| [to - x as f32, 0.0]));
            for (i, t) in trace.pixels().iter().enumerate() {
                // smr rejects vectors that are unlike their neighbours': these grow by a pixel from one to the next.
                let accepted =
                    if method == MethodKind::Smr && t.verdict == Verdict::Disoccluded { None } else { Some(t) };
                let verdict = if inside { Verdict::Valid } else { Verdict::OffScreen };
                assert!(accepted.is_none_or(|t| t.verdict == verdict), "{method:?}: pixel {i} to column {to}");
                assert!(inside || t.verdict == Verdict::OffScreen);
            }
        }
    }
    holds!("H57", Gpu, "wrs and smr: columns 63, 63.49 and -0.49 of 0 to 63 are accepted, 63.51 and -0.51 rejected");
}
