//! Moving surfaces on the device: hard cases H51 to H60.

use super::rig::{Rig, View, with_w_sum};
use super::surfaces::{PIXELS, bits, one, sticky, still, ungated, ungated_of, with_depth, with_motion};
use crate::depth_hard::{METHODS, SIZE};
use afterimage::kernel::pack;
use afterimage::{ContextDesc, Image, MethodKind, MotionConvention, MotionUnit, Reset, Verdict};
use afterimage_testing::holds;

#[test]
fn h51_a_thousand_still_frames_never_move_a_sample() {
    // Alternating pictures: each output pixel is that of one of them, bit for bit.
    let Some(mut rig) = ungated() else { return };
    let views: Vec<View> = (0..8).map(|i| with_motion(&format!("still {i}"), |_| [0.0; 2])).collect();
    let pictures: Vec<Vec<[u32; 3]>> =
        views.iter().map(|v| v.color.pixels().iter().map(|&c| bits(c)).collect()).collect();
    let mut kept = 0;
    for index in 0..1000_usize {
        let made = rig.on_gpu(index as u64, Reset::None, &views[index % 8..=index % 8]);
        assert_eq!(made.stats.rejected(), 0, "frame {index}");
        for (i, c) in made.shown.iter().enumerate() {
            assert!(pictures.iter().any(|p| p[i] == *c), "frame {index}, pixel {i}");
            kept += usize::from(pictures[index % 8][i] != *c);
        }
    }
    holds!("H51", Gpu, "wrs, 1000 frames of noise: {kept} samples of other frames, each at its own pixel, bit for bit");
}

#[test]
fn h52_an_integer_shift_moves_history_exactly_and_marks_the_border_new() {
    for (shift, right) in [([3.0, -2.0], true), ([-3.0, 2.0], false)] {
        let Some(mut rig) = ungated() else { return };
        let before = still("before");
        sticky(&mut rig, before.clone());
        let after = with_motion("after", |_| shift);
        let color = after.color.clone();
        let (made, trace) = one(&mut rig, 1, after);
        let as_expected = (0..48_usize).flat_map(|y| (0..64_usize).map(move |x| (x, y))).all(|(x, y)| {
            let shown = made.shown[y * 64 + x];
            if x + 3 < 64 && y >= 2 {
                shown == bits(before.color.at(x + 3, y - 2)) && trace.at(x, y).verdict == Verdict::Valid
            } else {
                shown == bits(color.at(x, y)) && trace.at(x, y).verdict == Verdict::OffScreen
            }
        });
        assert_eq!(as_expected, right, "the planted error: the other sign");
    }
    holds!("H52", Gpu, "wrs: {} samples moved bit for bit, {} of the border new", 61 * 46, PIXELS - 61 * 46);
}

#[test]
fn h53_half_pixel_motion_never_blurs() {
    let Some(mut rig) = ungated() else { return };
    let mut known = std::collections::HashSet::new();
    let mut kept = 0;
    for index in 0..200 {
        let view = with_motion(&format!("h53 {index}"), |_| [-0.5, 0.5]);
        known.extend(view.color.pixels().iter().map(|&c| bits(c)));
        let (made, trace) = one(&mut rig, index, view);
        assert!(made.shown.iter().all(|c| known.contains(c)), "an invented color");
        kept += trace.pixels().iter().filter(|t| !t.take).count();
    }
    holds!(
        "H53",
        Gpu,
        "wrs, 0.5 px x 200: {kept} samples kept, no color that no frame brought; nearest, nothing is mixed"
    );
}

#[test]
fn h54_garbage_motion_shows_the_candidate() {
    for method in METHODS {
        let Some(mut rig) = ungated_of(method) else { return };
        one(&mut rig, 0, still("a"));
        for (index, bad) in (1..).zip([f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e9, -1e9, f32::MAX]) {
            if method == MethodKind::Wrs {
                let words = rig.read().words;
                rig.restore(&with_w_sum(&words, 1e12));
            }
            let view = with_motion("b", |at| match at {
                [7, 5] => [bad, 0.0],
                [7, 6] => [0.0, bad],
                _ => [0.0; 2],
            });
            let color = [5, 6].map(|y| bits(view.color.at(7, y)));
            let (made, _) = one(&mut rig, index, view);
            assert_eq!((made.stats.verdicts[Verdict::BadMotion as usize], made.stats.rejected()), (2, 2), "{bad}");
            assert_eq!([5, 6].map(|y| made.shown[y * 64 + 7]), color);
        }
    }
    holds!("H54", Gpu, "wrs and smr: NaN, infinities, +-1e9, 3e38 on either axis show the candidate, and return");
}

#[test]
fn h55_half_float_motion_is_off_by_its_quantum_and_no_more() {
    // Half a view and half a pixel, nearly, in texture coordinates, where halves step by 2^-11: a 32nd of these pixels.
    let motion = MotionConvention { unit: MotionUnit::Uv, ..MotionConvention::default() };
    let desc = ContextDesc { motion, ..ContextDesc::new(SIZE) };
    let Some(mut rig) = Rig::new(desc, crate::settings::ungated()) else { return };
    rig.halve_motion();
    sticky(&mut rig, still("before"));
    let wanted_px = 32.0 + 0.49;
    let stored = pack::half_value(pack::half_bits(wanted_px / 64.0));
    let (made, trace) = one(&mut rig, 1, with_motion("after", |_| [stored, 0.0]));
    let read_px = trace.at(0, 0).motion[0];
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

#[test]
fn h58_nothing_bleeds_over_a_depth_edge() {
    let Some(mut rig) = ungated() else { return };
    for index in 0..24_u64 {
        let left = 4.0 + 1.5 * index as f32;
        let inside = |[x, y]: [u32; 2]| (left..left + 10.0).contains(&(x as f32)) && (10..30).contains(&y);
        let mut view = with_depth("", |at| if inside(at) { 1.0 } else { 8.0 });
        view.color = Image::from_fn(SIZE, |at| if inside(at) { [1.0; 3] } else { [0.125; 3] });
        view.motion = Some(Image::from_fn(SIZE, |at| if inside(at) { [-1.5, 0.0] } else { [0.0; 2] }));
        let color: Vec<[u32; 3]> = view.color.pixels().iter().map(|&c| bits(c)).collect();
        assert!(one(&mut rig, index, view).0.shown == color, "frame {index}");
    }
    holds!("H58", Gpu, "wrs, a square at 1.5 px a frame over a wall, 24 frames: no pixel bleeds");
}

#[test]
fn h59_a_zoom_leaves_no_hole() {
    let zoomed = |factor: f32| {
        let mut rig = ungated()?;
        let before = still("zoom");
        sticky(&mut rig, before.clone());
        let view =
            with_motion("zoom 2", |[x, y]| [(x as f32 - 32.0) * (factor - 1.0), (y as f32 - 24.0) * (factor - 1.0)]);
        let color = view.color.clone();
        let (made, trace) = one(&mut rig, 1, view);
        let (mut kept, mut sources) = (0, std::collections::HashSet::new());
        for (i, t) in trace.pixels().iter().enumerate() {
            let [x, y] = [i % 64, i / 64];
            let source = |at: usize, middle: f32| (middle + (at as f32 - middle) * factor + 0.5).floor();
            let [qx, qy] = [source(x, 32.0), source(y, 24.0)];
            if (0.0..64.0).contains(&qx) && (0.0..48.0).contains(&qy) {
                assert_eq!((made.shown[i], t.age), (bits(before.color.at(qx as usize, qy as usize)), 1));
                sources.insert((qx as usize, qy as usize));
                kept += 1;
            } else {
                assert_eq!((made.shown[i], t.verdict), (bits(color.at(x, y)), Verdict::OffScreen));
            }
        }
        Some([kept, sources.len()])
    };
    let (Some([near, originals]), Some([far, all])) = (zoomed(0.5), zoomed(2.0)) else { return };
    assert!(near == PIXELS as usize && near > 3 * originals && far == all && far < 1000);
    holds!(
        "H59",
        Gpu,
        "wrs, in x2: {near} show {originals} samples, ages kept; out x2: {far} kept, the rest is the candidate"
    );
}

#[test]
fn h60_a_turn_is_a_full_reset() {
    for method in METHODS {
        let Some(mut rig) = ungated_of(method) else { return };
        one(&mut rig, 0, still("turn 0"));
        let turn = with_motion("turn", |_| [5000.0, 0.0]);
        let color: Vec<[u32; 3]> = turn.color.pixels().iter().map(|&c| bits(c)).collect();
        let (made, _) = one(&mut rig, 1, turn);
        assert!(made.shown == color && made.stats.rejected() == PIXELS, "{method:?}");
    }
}
