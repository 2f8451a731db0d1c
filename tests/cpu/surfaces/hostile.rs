//! NaN, infinity and extreme radiance.

use super::rig::*;
use afterimage::Verdict;
use proptest::prelude::*;

const BAD: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

proptest! {
    #![proptest_config(afterimage_testing::property("nan in surfaces", 48))]

    #[test]
    fn h18_a_broken_pixel_over_a_history_touches_no_other(x in 0u32..52, y in 0u32..41, channel in 0usize..3, bad in prop::sample::select(BAD.to_vec())) {
        let mut clean = context(MethodKind::Smr);
        let first = clean.step(0, &sharp(noise(SIZE, "h18")));
        let coarse = LowPass::new(&first.stored(), 4).render(&Image::filled(SIZE, 1.5));
        let mut hurt = clean.clone();
        let i = (y * 52 + x) as usize;
        for index in 1..4 {
            let mut broken = coarse.clone();
            if index == 1 {
                broken.pixels_mut()[i][channel] = bad;
            }
            let a = clean.step(index, &at_lod(coarse.clone(), 1.5));
            let b = hurt.step(index, &at_lod(broken, 1.5));
            prop_assert_eq!(b.stats.nonfinite, u64::from(index == 1));
            // History is shown at non-finite pixels, too.
            prop_assert_eq!(&a.shown, &b.shown);
            prop_assert_eq!(&a.words, &b.words);
        }
    }

    #[test]
    fn h18_a_broken_pixel_is_not_taken_for_black_by_its_neighbours(x in 0u32..52, y in 0u32..41, bad in prop::sample::select(BAD.to_vec())) {
        // Uniform surfaces under changed light: neighbours show the change of light (smr) and the range of colors
        // (taa).
        for method in METHODS {
            let mut clean = context(method);
            clean.step(0, &sharp(Image::filled(SIZE, [0.5, 0.4, 0.3])));
            let mut hurt = clean.clone();
            let darker = Image::filled(SIZE, [0.2, 0.16, 0.12]);
            let mut broken = darker.clone();
            broken.pixels_mut()[(y * 52 + x) as usize][1] = bad;
            let a = clean.step(1, &at_lod(darker, 2.0));
            let b = hurt.step(1, &at_lod(broken, 2.0));
            for (i, (p, q)) in a.shown.pixels().iter().zip(b.shown.pixels()).enumerate() {
                prop_assert!(p == q || i == (y * 52 + x) as usize, "{:?}: {:?} became {:?}", method, p, q);
            }
        }
    }

    #[test]
    fn h18_a_broken_pixel_without_a_history_is_black_for_one_frame(x in 0u32..52, y in 0u32..41, bad in prop::sample::select(BAD.to_vec())) {
        for method in METHODS {
            let mut clean = context(method);
            let mut hurt = context(method);
            let picture = noise(SIZE, "h18 new").map(|c| c.map(|v| 0.4 + 0.2 * v));
            let mut broken = picture.clone();
            let i = (y * 52 + x) as usize;
            broken.pixels_mut()[i][2] = bad;
            let a = clean.step(0, &sharp(picture.clone()));
            let b = hurt.step(0, &sharp(broken));
            prop_assert_eq!(b.shown.at(x as usize, y as usize), [0.0; 3]);
            prop_assert_eq!(b.surfaces()[i], Surface::EMPTY);
            prop_assert!(a.shown.pixels().iter().zip(b.shown.pixels()).enumerate().all(|(k, (p, q))| p == q || k == i));
            // The empty pixel has no weight in the mip chain, so that the neighbours' history still fits.
            let coarse = LowPass::new(&a.stored(), 4).render(&Image::filled(SIZE, 1.5));
            let (a, b) = (clean.step(1, &at_lod(coarse.clone(), 1.5)), hurt.step(1, &at_lod(coarse.clone(), 1.5)));
            prop_assert_eq!(b.trace.at(x as usize, y as usize).verdict, Verdict::Empty);
            prop_assert_eq!(b.shown.at(x as usize, y as usize), coarse.at(x as usize, y as usize));
            prop_assert!(a.shown.pixels().iter().zip(b.shown.pixels()).enumerate().all(|(k, (p, q))| p == q || k == i));
        }
    }
}

#[test]
fn resampled_and_relit_highlights_stay_within_halves() {
    // The overshoot next to the brightest half, and a gain of five on it, both exceed the range.
    let bright = Image::from_fn(SIZE, |[x, y]| [if x / 4 % 2 == 0 || y % 8 == 0 { 65504.0 } else { 100.0 }; 3]);
    for method in METHODS {
        let mut post = context(method);
        post.step(0, &sharp(times(&bright, 0.6)));
        for index in 1..4 {
            let input = View { motion: Some(Image::filled(SIZE, [0.5, 0.5])), ..at_lod(bright.clone(), 1.0) };
            let made = post.step(index, &input);
            let brightest = peak(&made.shown);
            assert!(brightest <= 65504.0, "{method:?}, frame {index}: at the most {brightest}");
            assert!(made.trace.pixels().iter().any(|t| t.history_share > 0.0));
        }
    }
}

#[test]
fn h73_detail_of_bright_pictures_stays() {
    // Storage alone is off by 2^-10, which near 65504 is a difference of 100 * 256 * 2^-11 = 12 in the gate's units;
    // low-passes are of many such roundings, which cancel.
    for scale in [1.0, 100.0, 4_000.0, 60_000.0] {
        let mut post = context(MethodKind::Smr);
        let picture = times(&noise(SIZE, "h73"), scale);
        let first = post.step(0, &sharp(picture));
        let low_pass = LowPass::new(&first.stored(), 4);
        for index in 1..20 {
            let input = at_lod(low_pass.render(&Image::filled(SIZE, 2.0)), 2.0);
            assert_eq!(post.step(index, &input).shown, first.stored(), "scale {scale}, frame {index}");
        }
    }
}
