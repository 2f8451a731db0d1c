//! Samples that keep their places: storage, and interpolation between them.

use afterimage::kernel::stored_sample::{
    Around, EXACT_PX, FARTHEST_PX, INVERSE_REACH, MAX_COLOR, STIFF_PX2, StoredSample, UNKNOWN_MOVED_PX, add_stored,
    code_word, interpolate, moved_alike, pack_color, pack_stored, resized_stored, unpack_color, unpack_stored,
    with_motion,
};
use glam::{Mat2, Vec2, Vec3};
use proptest::prelude::*;

fn around(samples: &[(Vec3, Vec2)]) -> Around {
    samples.iter().fold(Around::NOTHING, |a, &(color, at)| {
        add_stored(a, StoredSample { color, lod: 0.0, disparity: 1.0, place_px: Vec2::ZERO }, at, true, INVERSE_REACH)
    })
}

/// Places of 3x3 texels around a position, each sample moved within its texel.
fn places(shift: Vec2, jitter: &[f32]) -> Vec<Vec2> {
    let texel = |i: usize| Vec2::new((i % 3) as f32 - 1.0, (i / 3) as f32 - 1.0) + shift;
    (0..9).map(|i| texel(i) + Vec2::new(jitter[2 * i], jitter[2 * i + 1])).collect()
}

/// Error at the position of a plane of this slope, if variances grow by the stiffness `s`. With the mean place `m` of
/// the samples and its covariance `V`: `m . s (V + s)^-1 slope`.
fn bias_of_stiffness(a: Around, slope: Vec2) -> f32 {
    let mean = a.place / a.weight;
    let [xx, xy, yy] = (a.square / a.weight - Vec3::new(mean.x * mean.x, mean.x * mean.y, mean.y * mean.y)).to_array();
    let stiffened = Mat2::from_cols(Vec2::new(xx + STIFF_PX2, xy), Vec2::new(xy, yy + STIFF_PX2));
    STIFF_PX2 * mean.dot(stiffened.inverse() * slope)
}

proptest! {
    #![proptest_config(afterimage_testing::property("kept samples", 2000))]

    #[test]
    fn colors_are_stored_to_nine_bits_of_their_largest_channel(
        exponent in -13.0_f32..16.0, r in 0.0_f32..1.0, g in 0.0_f32..1.0, b in 0.0_f32..1.0,
    ) {
        let color = (Vec3::new(r, g, b) * exponent.exp2()).min(Vec3::splat(MAX_COLOR));
        let stored = unpack_color(pack_color(color));
        let allowed = color.max_element().max((-14.0_f32).exp2()) / 511.0;
        prop_assert!((stored - color).abs().max_element() <= allowed, "{color} became {stored}");
        prop_assert_eq!(pack_color(stored), pack_color(color));
    }

    #[test]
    fn any_words_unpack_to_finite_samples_that_stay_as_they_are(a: u32, b: u32) {
        let sample = unpack_stored([a, b]);
        prop_assert!(sample.color.is_finite() && sample.disparity.is_finite() && sample.place_px.is_finite());
        let again = unpack_stored(pack_stored(sample));
        prop_assert_eq!(again, sample);
    }

    #[test]
    fn places_and_disparities_are_stored_closely(
        x in -FARTHEST_PX..FARTHEST_PX, y in -FARTHEST_PX..FARTHEST_PX, log_z in -20.0_f32..20.0, lod in 0.0_f32..8.0,
    ) {
        let sample = StoredSample { color: Vec3::ONE, lod, disparity: log_z.exp2(), place_px: Vec2::new(x, y) };
        let stored = unpack_stored(pack_stored(sample));
        prop_assert!((stored.place_px - sample.place_px).abs().max_element() <= 0.5 / 24.0 + 1e-6);
        // Half a step of five bits, and half a step of the ten of the code.
        prop_assert!((stored.disparity / sample.disparity - 1.0).abs() <= 1.0 / 64.0 + 1.0 / 2048.0);
        prop_assert!((stored.lod - lod).abs() <= 0.5 / 7.0 + 1e-6);
    }

    /// The bit changes nothing else, and stays in an image of another size.
    #[test]
    fn motion_in_the_world_is_stored_beside_a_sample(
        x in -FARTHEST_PX..FARTHEST_PX, log_z in -20.0_f32..20.0, lod in 0.0_f32..8.0, moved_px in 0.0_f32..4.0,
        now_px in 0.0_f32..4.0,
    ) {
        let sample = StoredSample { color: Vec3::ONE, lod, disparity: log_z.exp2(), place_px: Vec2::splat(x) };
        let still = pack_stored(sample);
        let words = with_motion(still, moved_px);
        prop_assert_eq!(unpack_stored(words), unpack_stored(still));
        prop_assert_eq!(code_word(words), code_word(still));
        prop_assert_eq!(resized_stored(words, sample), words);
        // Slow changes keep history; a stop and a start do not; nothing is known to contradict an unknown motion.
        let is_slow = (0.125..=2.0).contains(&now_px);
        prop_assert_eq!(moved_alike(words, now_px), is_slow || (moved_px > 0.5) == (now_px > 2.0));
        prop_assert!(moved_alike(words, UNKNOWN_MOVED_PX));
        prop_assert!(moved_alike(with_motion(still, UNKNOWN_MOVED_PX), 0.0));
    }

    /// The fit is a ridge regression: it takes a part of the slope for noise. Its bias is known in closed form.
    #[test]
    fn a_plane_is_interpolated_up_to_the_bias_of_its_stiffness(
        x in -0.5_f32..0.5, y in -0.5_f32..0.5, jitter in prop::collection::vec(-0.4_f32..0.4, 18),
        across in -0.1_f32..0.1, down in -0.1_f32..0.1,
    ) {
        let value = |at: Vec2| Vec3::new(1.0 + across * at.x, 1.0 + down * at.y, 2.0);
        let samples: Vec<_> = places(Vec2::new(x, y), &jitter).into_iter().map(|at| (value(at), at)).collect();
        let around = around(&samples);
        let found = interpolate(around).color;
        let nearest = around.nearest.place_px;
        let expected = if nearest.abs().max_element() <= EXACT_PX {
            value(nearest)
        } else {
            let [across, down] = [Vec2::X * across, Vec2::Y * down].map(|slope| bias_of_stiffness(around, slope));
            value(Vec2::ZERO) + Vec3::new(across, down, 0.0)
        };
        prop_assert!((found - expected).abs().max_element() <= 1e-4, "{found} instead of {expected}");
    }

    #[test]
    fn interpolation_is_finite_and_keeps_the_nearest_sample(
        x in -0.5_f32..0.5, y in -0.5_f32..0.5, jitter in prop::collection::vec(-1.3_f32..1.3, 18),
        colors in prop::collection::vec(0.0_f32..65000.0, 9),
    ) {
        let at = places(Vec2::new(x, y), &jitter);
        let samples: Vec<_> = at.iter().zip(&colors).map(|(&at, &c)| (Vec3::splat(c), at)).collect();
        let found = interpolate(around(&samples));
        prop_assert!(found.color.is_finite() && found.color.min_element() >= 0.0);
        let nearest = at.iter().map(|at| at.length_squared()).fold(f32::MAX, f32::min);
        let kept = found.nearest.place_px;
        prop_assert!(kept == Vec2::ZERO || (kept.length_squared() - nearest).abs() < 1e-5);
    }
}

#[test]
fn a_sample_at_the_position_is_shown_bit_for_bit() {
    let own = Vec3::new(0.123, 4.5, 0.01);
    let mut samples: Vec<_> = places(Vec2::ZERO, &[0.0; 18]).into_iter().map(|at| (Vec3::splat(9.0), at)).collect();
    samples[4].0 = own;
    assert_eq!(interpolate(around(&samples)).color, own);
}

#[test]
fn nothing_is_empty() {
    assert_eq!(interpolate(Around::NOTHING).nearest.lod, -1.0);
    assert_eq!(unpack_color(pack_color(Vec3::ONE)), Vec3::ONE);
    assert_eq!(unpack_color(pack_color(Vec3::new(-1.0, f32::INFINITY, 0.0))), Vec3::new(0.0, MAX_COLOR, 0.0));
}
