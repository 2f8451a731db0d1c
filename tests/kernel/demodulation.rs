//! Albedo of planned frames: quotients, what they explain, means, and their storage.

use afterimage::kernel::demodulation::{
    OwnAlbedo, PastAlbedo, Texture, add_albedo, candidate_change, explained, exposed_lumas, given_albedo, mean_albedo,
    no_albedos, no_lumas, pack_albedo, part, past_albedo, quotient, retextured, texture_of, textured, unpack_albedo,
    with_luma,
};
use glam::{Vec3, Vec4};
use proptest::prelude::*;

fn albedo() -> impl Strategy<Value = Vec3> {
    (0.0_f32..0.998, 0.0_f32..0.998, 0.0_f32..0.998).prop_map(|(r, g, b)| Vec3::new(r, g, b))
}

/// An albedo whose quotient with any other such is within its limits.
fn moderate() -> impl Strategy<Value = Vec3> {
    (0.2_f32..0.75, 0.2_f32..0.75, 0.2_f32..0.75).prop_map(|(r, g, b)| Vec3::new(r, g, b))
}

fn color() -> impl Strategy<Value = Vec3> {
    (0.0_f32..4.0, 0.0_f32..4.0, 0.0_f32..4.0).prop_map(|(r, g, b)| Vec3::new(r, g, b))
}

/// A pixel with one albedo around it.
fn flat(albedo: Vec3) -> OwnAlbedo {
    OwnAlbedo { albedo, around: [albedo; 2] }
}

proptest! {
    #![proptest_config(afterimage_testing::property("demodulation", 2000))]

    #[test]
    fn packing_is_unbiased_and_exact_where_it_can_be(
        a in albedo(), n in 1_u32..30, draws in prop::collection::vec(0.0_f32..1.0, 4),
    ) {
        let n = n as f32;
        let packed = |i: u16| pack_albedo(a, n, (f32::from(i) + 0.5) / 512.0);
        let stored: Vec<Vec4> = (0..512).map(|i| unpack_albedo(packed(i))).collect();
        let mean = stored.iter().sum::<Vec4>() / 512.0;
        // The draws are 512 steps apart.
        prop_assert!((mean - a.extend(n)).abs().max_element() <= 1.01 / (512.0 * 512.0), "{mean} for {a}");
        prop_assert!(stored.iter().all(|s| (s.truncate() - a).abs().max_element() <= 1.0 / 512.0 && s.w == n));
        for up in draws {
            let once = unpack_albedo(pack_albedo(a, n, up));
            prop_assert_eq!(unpack_albedo(pack_albedo(once.truncate(), n, 1.0 - up)), once);
        }
    }

    #[test]
    fn any_word_and_any_albedo_give_finite_numbers(word: u32, r: f32, g: f32, b: f32, up in 0.0_f32..1.0) {
        let (stored, given) = (unpack_albedo(word).truncate(), given_albedo(Vec3::new(r, g, b)));
        prop_assert!(stored.is_finite() && given.is_finite());
        prop_assert!(given.truncate().min_element() >= 0.0 && given.truncate().max_element() < 1.0);
        prop_assert_eq!(given.w > 0.0, (r + g + b).is_finite());
        let given = given.truncate();
        let factor = quotient(given, stored);
        prop_assert!(factor.min_element() >= 0.25 && factor.max_element() <= 4.0);
        let past = past_albedo(flat(given), stored, stored, 1.0);
        let texture = texture_of(flat(given), past, 3.0);
        let result = retextured(texture, stored, 4.0, up);
        prop_assert!(textured(texture, stored).is_finite() && result.factor.is_finite() && result.place_share <= 1.0);
    }

    /// Bit for bit: samples, and history whose stored albedos differ by their rounding.
    #[test]
    fn a_constant_albedo_changes_nothing(
        a in albedo(), colors in prop::collection::vec(color(), 4), draws in prop::collection::vec(0.0_f32..1.0, 3),
    ) {
        let own = a.extend(1.0);
        let sums = colors.iter().fold(no_albedos(a), |s, c| add_albedo(s, own, own, *c, 0.3));
        prop_assert_eq!(candidate_change(sums, own, true).factor, Vec3::ONE);
        let [shown, kept] = [0, 1].map(|i| unpack_albedo(pack_albedo(a, 2.0, draws[i])).truncate());
        let past = past_albedo(flat(a), shown, kept, 1.0);
        let texture = texture_of(flat(a), past, 7.0);
        prop_assert_eq!([shown, kept].map(|of_color| textured(texture, of_color)), [Vec3::ONE; 2]);
        let result = retextured(texture, kept, 8.0, draws[2]);
        prop_assert_eq!((result.factor, result.place_share), (Vec3::ONE, 0.0));
    }

    /// Light that is the same everywhere under a texture: the pixel's color is that light times its albedo.
    #[test]
    fn a_texture_under_even_light_is_right_between_its_samples(
        own in moderate(), others in prop::collection::vec(moderate(), 4), light in 0.2_f32..2.0,
    ) {
        let lit = |a: Vec3| (a + 0.04) * light;
        let sums = others
            .iter()
            .fold(no_albedos(own), |s, a| add_albedo(s, own.extend(1.0), a.extend(1.0), lit(*a), 0.25));
        let change = candidate_change(sums, own.extend(1.0), true);
        // A faint contrast is not explained in full.
        prop_assume!(explained(sums.lumas) == 1.0);
        let mean = others.iter().map(|a| lit(*a)).sum::<Vec3>() / 4.0;
        let off = (mean * change.factor - lit(own)).abs().max_element();
        prop_assert!(off <= 1e-4, "off by {off}");
    }

    /// An unknown albedo, of the pixel or its samples, leaves everything as it is.
    #[test]
    fn an_unknown_albedo_changes_nothing(a in albedo(), c in color(), d in color(), up in 0.0_f32..1.0) {
        let unknown = given_albedo(Vec3::splat(f32::NAN));
        for (own, there) in [(unknown, a.extend(1.0)), (a.extend(1.0), unknown), (unknown, unknown)] {
            let sums = [c, d].iter().fold(no_albedos(own.truncate()), |s, c| add_albedo(s, own, there, *c, 0.5));
            prop_assert_eq!(candidate_change(sums, own, true).factor, Vec3::ONE);
        }
        let texture = texture_of(flat(a), past_albedo(flat(a), c, d, 0.0), 3.0);
        let result = retextured(texture, a, 0.0, up);
        prop_assert_eq!((textured(texture, a), result.factor, result.word), (Vec3::ONE, Vec3::ONE, 0));
    }

    /// Errors do not add up: after a frame the color has the texture that is stored beside it.
    #[test]
    fn a_stored_color_follows_the_rounding_of_its_albedo(a in albedo(), own in albedo(), up in 0.0_f32..1.0) {
        prop_assume!((a - own).abs().max_element() > 0.01);
        let own = OwnAlbedo { albedo: own, around: [a.min(own), a.max(own)] };
        let texture = texture_of(own, past_albedo(own, a, a, 1.0), 7.0);
        let result = retextured(texture, a, 8.0, up);
        let expected = quotient(unpack_albedo(result.word).truncate(), texture.albedo);
        prop_assert!((result.factor / expected - 1.0).abs().max_element() < 1e-5);
    }

    /// Light that stays under a texture that changes: history of the old one shows the new one at once.
    #[test]
    fn another_texture_replaces_the_mean_of_the_last_one(
        a in moderate(), other in moderate(), light in 0.2_f32..2.0, count in 1.0_f32..29.0,
    ) {
        // A channel differs by more than a quarter.
        let own = Vec3 { x: if a.x < 0.475 { a.x + 0.27 } else { a.x - 0.27 }, ..other };
        let past = PastAlbedo { shown: a, kept: a, explained: 1.0 };
        let texture = texture_of(flat(own), past, count);
        prop_assert_eq!(texture, Texture { albedo: own, stored: own, explained: 1.0, kept: 0.0 });
        let off = ((a + 0.04) * light * textured(texture, a) - (own + 0.04) * light).abs().max_element();
        prop_assert!(off <= 1e-5, "off by {off}");
    }

    /// Stored colors are of another exposure than those of this frame, with which they are compared.
    #[test]
    fn an_exposure_is_no_contrast(albedos in [moderate(), moderate()], exposure in 0.1_f32..10.0) {
        let [a, b] = albedos;
        let stored = with_luma(no_lumas(a), (a + 0.04) / exposure, a);
        let ranges = with_luma(exposed_lumas(stored, exposure), b + 0.04, b);
        let [low, high] = ranges.lit.to_array();
        prop_assert!((high - low) <= 1e-5 * high, "{ranges:?}");
    }
}

#[test]
fn black_and_white_have_finite_quotients() {
    let [black, white] = [Vec3::ZERO, Vec3::splat(2.0)].map(|given| given_albedo(given).truncate());
    assert_eq!([quotient(white, black), quotient(black, white)], [Vec3::splat(4.0), Vec3::splat(0.25)]);
    assert_eq!(quotient(black, black), Vec3::ONE);
    assert_eq!(part(Vec3::splat(4.0), 0.0), Vec3::ONE);
    assert_eq!(mean_albedo(black, flat(white), 0.0), white);
}

/// Light that changes as its albedo leaves no contrast; light that changes alone, all of it.
#[test]
fn contrast_is_explained_by_albedo_alone() {
    let [dark, bright] = [Vec3::splat(0.1), Vec3::splat(0.6)];
    let of = |colors: [Vec3; 2], albedos: [Vec3; 2]| {
        let ranges = [0, 1].iter().fold(no_lumas(dark), |r, &i| with_luma(r, colors[i], albedos[i]));
        explained(ranges)
    };
    assert_eq!(of([dark + 0.04, bright + 0.04], [dark, bright]), 1.0);
    assert_eq!(of([dark, bright], [dark, dark]), 0.0);
    assert_eq!(of([dark, dark], [dark, bright]), 0.0);
}
