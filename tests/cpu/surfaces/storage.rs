//! Storage of a surface in two words.

use super::rig::*;
use afterimage::kernel::lod::MAX_LOD;
use afterimage::kernel::noise::unpack_noise;
use afterimage::kernel::pack::disparity_value;
use afterimage::kernel::stored_reservoir::unpack;
use afterimage::kernel::stored_sample::{StoredSample, pack_stored, unpack_stored};
use afterimage::kernel::surface::{float14_value, mip_texel, pack_surface};
use glam::{Vec3, Vec4};
use proptest::prelude::*;

#[test]
fn h19_whatever_the_words_hold_is_finite_and_packing_it_again_changes_nothing() {
    let mut draws = Draws::new("surface words");
    for i in 0..500_000 {
        let words = [draws.bits(), draws.bits()];
        // Extremes of every field, too.
        let words =
            [words[0] | [0, 0x3fff, 0x3fff << 14, 0xf << 28][i % 4], words[1] | [0, 0xffff, 0xffff << 16][i % 3]];
        let s = unpack_surface(words);
        assert!(s.color.is_finite() && s.color.min_element() >= 0.0 && s.color.max_element() <= 65504.0, "{words:x?}");
        assert!(s.lod == -1.0 || (0.0..=MAX_LOD).contains(&s.lod));
        assert!(s.disparity == -1.0 || (0.0..1e10).contains(&s.disparity));
        assert_eq!(unpack_surface(pack_surface(s)), s, "{words:x?}");
        let again = pack_surface(s);
        assert_eq!(pack_surface(unpack_surface(again)), again);
    }
}

#[test]
fn every_code_of_a_field_is_its_own() {
    for code in 0..0x4000 {
        let value = float14_value(code);
        let s = Surface { color: Vec3::new(value, 0.0, value), lod: 1.0, disparity: -1.0 };
        let words = pack_surface(s);
        assert_eq!((words[0] & 0x3fff, words[1] & 0x3fff), (code, code));
        assert_eq!(unpack_surface(words), s);
    }
    for code in 0..63_u32 {
        let s = Surface { color: Vec3::ZERO, lod: code as f32 * (1.0 / 7.0), disparity: 0.0 };
        assert_eq!(unpack_surface(pack_surface(s)), s);
    }
    for code in 0..=0xffff_u32 {
        let s = Surface { color: Vec3::ZERO, lod: 0.0, disparity: disparity_value(code) };
        assert_eq!(pack_surface(s)[1] >> 16, code);
    }
}

#[test]
fn all_zeros_are_nothing() {
    assert_eq!(unpack_surface(pack_surface(Surface::EMPTY)), Surface::EMPTY);
    assert_eq!(unpack_stored(pack_stored(StoredSample::EMPTY)), StoredSample::EMPTY);
    assert_eq!(unpack_surface([0; 2]), Surface::EMPTY);
    assert_eq!(unpack_stored([0; 2]), StoredSample::EMPTY);
    assert_eq!(unpack([0; 3]).w_sum, 0.0);
    assert_eq!(unpack_noise(0).samples, 0.0);
    assert_eq!(mip_texel([0; 2]), Vec4::ZERO);
    // Black, sharp, infinitely far: the sample that is most like zeros is another one.
    let black = Surface { color: Vec3::ZERO, lod: 0.0, disparity: 0.0 };
    assert_eq!(unpack_surface(pack_surface(black)), black);
    let kept = StoredSample { lod: 0.0, disparity: 0.0, ..StoredSample::EMPTY };
    assert_eq!(unpack_stored(pack_stored(kept)), kept);
}

proptest! {
    #![proptest_config(afterimage_testing::property("surface errors", 4096))]

    #[test]
    fn errors_stay_within_their_bounds(exponent in -13.9f32..15.9, r in 0f32..1.0, g in 0f32..1.0, lod in 0f32..12.0, disparity in 1e-6f32..1e6) {
        let bright = exponent.exp2();
        let color = Vec3::new(bright, bright * r, bright * g);
        let s = unpack_surface(pack_surface(Surface { color, lod, disparity }));
        for i in 0..3 {
            // Ten significant bits; below 2^-15 the grid of halves.
            let bound = (color[i] / 1024.0).max(2.0_f32.powi(-25));
            prop_assert!((s.color[i] - color[i]).abs() <= bound, "{} became {}", color[i], s.color[i]);
        }
        prop_assert!((s.lod - lod.min(MAX_LOD)).abs() <= 0.5 / 7.0 + 1e-6);
        prop_assert!((s.disparity - disparity).abs() <= disparity / 2048.0);
    }
}

#[test]
fn what_is_beyond_halves_is_the_largest_and_below_zero_is_zero() {
    for (x, y) in [(65504.0, 65472.0), (1e30, 65472.0), (f32::MAX, 65472.0), (-1.0, 0.0), (-0.0, 0.0), (1e-30, 0.0)] {
        let s = unpack_surface(pack_surface(Surface { color: Vec3::splat(x), lod: 0.0, disparity: -1.0 }));
        assert_eq!(s.color.to_array().map(f32::to_bits), [f32::to_bits(y); 3], "{x}");
    }
}
