//! Small frames of arbitrary bit patterns through every method: the output is finite and comes from the inputs, and no
//! view affects another one.

use super::*;
use crate::any_frame::{SIZE, all_settings, any_frame};
use crate::images::{held_words, traced};
use afterimage::kernel::stored_reservoir;
use afterimage::kernel::surface::unpack_surface;
use std::collections::HashSet;

const FRAMES: u64 = 3;
const WILD: [f32; 4] = [0.0, 0.02, 0.3, 1.0];

fn new(settings: Settings, view_count: u32) -> CpuAfterimage {
    CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc { view_count, ..ContextDesc::new(SIZE) } }).unwrap()
}

fn show(post: &mut CpuAfterimage, index: u64, frames: &[&View]) -> (Vec<Color>, Vec<Image<PixelTrace>>) {
    let images = Images::of(frames.iter().copied());
    let frame = images.frame(index);
    let noise = frame.noise.filter(|_| post.desc().settings.noisy);
    let (shown, trace, _) = traced(post, &Frame { noise, ..frame });
    (shown, trace)
}

/// Possible outputs of a color: itself, and its stored value in wrs.
fn presented(c: [f32; 3]) -> [[u32; 3]; 2] {
    let (color, _) = afterimage::kernel::sanitize::color(glam::Vec3::from(c));
    let stored = stored_reservoir::unpack(stored_reservoir::pack(stored_reservoir::Stored {
        color,
        disparity: 1.0,
        w_sum: 1.0,
        age: 0,
    }))
    .color;
    [color, stored].map(|c| c.to_array().map(f32::to_bits))
}

proptest! {
    #![proptest_config(afterimage_testing::property("whole pass", 120))]

    #[test]
    fn any_bits_give_finite_colors_of_what_was_presented(name in any::<u64>(), wild in prop::sample::select(WILD.to_vec())) {
        for settings in all_settings() {
            let mut draws = Draws::new(&name.to_string());
            let mut post = new(settings, 1);
            let mut known = HashSet::from([[0; 3]]);
            for index in 0..FRAMES {
                let frame = any_frame(&mut draws, wild);
                known.extend(frame.color.pixels().iter().flat_map(|&c| presented(c)));
                let before: Vec<_> = post.history().surfaces().iter().map(|&w| unpack_surface(w)).collect();
                let (out, trace) = show(&mut post, index, &[&frame]);
                for (i, c) in out[0].pixels().iter().enumerate() {
                    prop_assert!(c.iter().all(|v| v.abs() <= 65504.0), "{:?}: {:?}", settings.method, c);
                    let t = trace[0].pixels()[i];
                    match settings.method {
                        // Means invent colors, within those presented.
                        Method::Wrs(Wrs { sampler: Sampler::AChaoMean, .. }) => {}
                        Method::None | Method::Wrs(_) => prop_assert!(known.contains(&c.map(f32::to_bits)), "an invented color: {:?}", c),
                        Method::Smr(_) if t.motion.iter().all(|m| m.fract() == 0.0) && !settings.noisy => {
                            // Between the candidate and the history at a gain of 1/5 to 5.
                            let candidate = glam::Vec3::from(presented(frame.color.pixels()[i])[0].map(f32::from_bits));
                            let (mut low, mut high) = (candidate, candidate);
                            if t.verdict == Verdict::Valid {
                                let [x, y] = [i % 8, i / 8];
                                let at = |v: usize, m: f32| (v as f32 + m) as usize;
                                let h = before[at(y, t.motion[1]) * 8 + at(x, t.motion[0])].color;
                                low = low.min(0.2 * h);
                                high = high.max(5.0 * h);
                            }
                            let c = glam::Vec3::from(*c);
                            let rounding = 1e-5 * (1.0 + high.abs().max(low.abs()).max_element());
                            prop_assert!((c - low).min_element() >= -rounding && (high - c).min_element() >= -rounding, "{} in {} to {}", c, low, high);
                        }
                        _ => {}
                    }
                }
                // Stored values are finite, and packing unpacked ones gives the same words.
                for s in post.history().surfaces().iter().map(|&w| unpack_surface(w)) {
                    prop_assert!(s.color.is_finite() && s.color.min_element() >= 0.0 && s.color.max_element() <= 65504.0);
                }
            }
        }
    }

    #[test]
    fn what_one_view_is_given_changes_no_bit_of_the_other(name in any::<u64>(), wild in prop::sample::select(WILD.to_vec())) {
        for settings in all_settings() {
            let mut draws = Draws::new(&name.to_string());
            let [mut one, mut other] = [new(settings, 2), new(settings, 2)];
            for index in 0..FRAMES {
                let [left, a, b] = [0; 3].map(|_| any_frame(&mut draws, wild));
                let ((x, _), (y, _)) = (show(&mut one, index, &[&left, &a]), show(&mut other, index, &[&left, &b]));
                let bits = |c: &Color| c.pixels().iter().map(|c| c.map(f32::to_bits)).collect::<Vec<_>>();
                prop_assert_eq!(bits(&x[0]), bits(&y[0]), "{:?}", settings);
                prop_assert!(bits(&x[1]) != bits(&y[1]), "the planted error: the same view");
                let (x, y) = (one.history(), other.history());
                prop_assert_eq!(&x.words()[..x.words().len() / 2], &y.words()[..y.words().len() / 2]);
                prop_assert_eq!(&x.surfaces()[..x.surfaces().len() / 2], &y.surfaces()[..y.surfaces().len() / 2]);
            }
        }
    }

    #[test]
    fn a_broken_pixel_reaches_no_further_than_documented_and_is_gone_with_the_next_frame(name in any::<u64>(), at in 0usize..48, channel in 0usize..3, bad in prop::sample::select(vec![f32::NAN, f32::INFINITY, f32::NEG_INFINITY])) {
        for settings in all_settings() {
            let mut draws = Draws::new(&name.to_string());
            let [mut clean, mut hurt] = [new(settings, 1), new(settings, 1)];
            for index in 0..4 {
                let frame = any_frame(&mut draws, 0.0);
                let mut broken = frame.clone();
                if index == 1 {
                    broken.color.pixels_mut()[at][channel] = bad;
                }
                let ((a, _), (b, _)) = (show(&mut clean, index, &[&frame]), show(&mut hurt, index, &[&broken]));
                prop_assert!(b[0].pixels().iter().flatten().all(|v| v.is_finite()));
                if index != 1 {
                    continue;
                }
                for (i, (p, q)) in a[0].pixels().iter().zip(b[0].pixels()).enumerate() {
                    let far = (i % 8).abs_diff(at % 8).max((i / 8).abs_diff(at / 8));
                    // taa reads 3x3 candidates; smr at four that lie 3/4 of a block off, at twice that where blocks are
                    // point samples, and where candidates are noisy at means of the 8x8 around them.
                    let reach = match settings.method {
                        Method::None | Method::Wrs(_) => 0,
                        Method::Taa => 1,
                        _ if settings.noisy => 48,
                        _ => (2.0 * 0.75 * frame.lod.as_ref().unwrap().pixels()[i].max(0.0).exp2()).ceil() as usize + 1,
                    };
                    prop_assert!(p == q || far <= reach, "{:?}: {} pixels off", settings.method, far);
                }
            }
            // No non-finite value is left, and empty pixels are filled again.
            prop_assert!(hurt.history().surfaces().iter().all(|&w| unpack_surface(w).lod >= 0.0));
            prop_assert!(held_words(&hurt).len() == held_words(&clean).len());
            prop_assert!(hurt.history().words().iter().all(|&w| stored_reservoir::unpack(w).w_sum > 0.0));
        }
    }
}
