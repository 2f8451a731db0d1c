//! Three words a pixel: precision, saturation, corruption.

use super::*;

#[test]
fn packing_halves_matches_the_exr_crate_s_halves() {
    // All 63,488 finite halves come back; conversions of floats agree with an independent implementation.
    for bits in (0..=0xffff_u32).filter(|b| b & 0x7c00 != 0x7c00) {
        let value = pack::half_value(bits);
        assert_eq!(value.to_bits(), half_oracle(bits).to_bits());
        assert_eq!(pack::half_bits(value), bits);
    }
    let mut draws = Draws::new("halves");
    for _ in 0..2_000_000 {
        let x = f32::from_bits(draws.bits());
        if !x.is_finite() {
            continue;
        }
        let nearest = pack::half_value(pack::half_bits(x));
        if x.abs() >= 65504.0 {
            assert_eq!(nearest, 65504.0_f32.copysign(x));
            continue;
        }
        // No half is nearer, and a tie goes to the even one.
        let bits = pack::half_bits(x);
        let error = (f64::from(nearest) - f64::from(x)).abs();
        for other in [bits.wrapping_sub(1), bits + 1] {
            if other & 0x7c00 != 0x7c00 && other & 0x8000 == bits & 0x8000 && other <= 0xffff {
                let distance = (f64::from(half_oracle(other)) - f64::from(x)).abs();
                assert!(distance > error || (distance == error && bits & 1 == 0), "{x:e}");
            }
        }
    }
}

/// Value of a half from its definition, in f64.
fn half_oracle(bits: u32) -> f32 {
    let (e, m) = ((bits >> 10) & 0x1f, f64::from(bits & 0x3ff));
    let magnitude = if e == 0 { m * 2.0_f64.powi(-24) } else { (1.0 + m / 1024.0) * 2.0_f64.powi(e as i32 - 15) };
    (if bits & 0x8000 != 0 { -magnitude } else { magnitude }) as f32
}

proptest! {
    #![proptest_config(afterimage_testing::property("storage", 5000))]

    #[test]
    fn h19_any_words_unpack_to_something_finite(words in any::<[u32; 3]>()) {
        let s = stored_reservoir::unpack(words);
        prop_assert!(s.color.is_finite() && s.w_sum.is_finite() && s.w_sum >= 0.0 && s.disparity.is_finite());
        prop_assert!(s.color.abs().max_element() <= 65504.0 && s.age <= 255);
        // Packing an unpacked reservoir gives the same words.
        let again = stored_reservoir::unpack(stored_reservoir::pack(s));
        prop_assert_eq!(again, s);
    }

    #[test]
    fn storage_is_as_precise_as_stated(w in 1e-20f32..1e20, d in 1e-9f32..1e9, age in 0u32..256, c in -65504f32..65504.) {
        let s = stored_reservoir::unpack(stored_reservoir::pack(Stored { color: Vec3::splat(c), disparity: d, w_sum: w, age }));
        prop_assert!((s.w_sum / w - 1.0).abs() <= 2.0_f32.powi(-16));
        prop_assert!((s.disparity / d - 1.0).abs() <= 2.0_f32.powi(-11));
        prop_assert!((s.color.x - c).abs() <= (c.abs() * 2.0_f32.powi(-11)).max(2.0_f32.powi(-25)));
        prop_assert_eq!(s.age, age);
    }
}

#[test]
fn special_disparities_survive_storage() {
    for (d, back) in [(0.0, 0.0), (-1.0, -1.0), (1e-12, 0.0), (f32::MAX, pack::disparity_value(0xfffe))] {
        assert_eq!(pack::disparity_value(pack::disparity_code(d)), back);
    }
}
