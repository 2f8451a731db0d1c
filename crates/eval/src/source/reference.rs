//! Samples of antialiased references.

/// Offsets in pixels, each in \[-0.5, 0.5), of the `samples` samples of a pixel: Hammersley's set. Their mean is 0 if
/// their number is a power of two, so that the reference is not displaced.
pub fn reference_offsets_px(samples: u32) -> impl Iterator<Item = [f32; 2]> {
    let spacing = 1.0 / f64::from(samples.max(1));
    (0..samples.max(1)).map(move |k| {
        let reversed = f64::from(k.reverse_bits()) * 2.0_f64.powi(-32);
        [f64::from(k) * spacing, reversed].map(|v| (v + 0.5 * spacing - 0.5) as f32)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_lie_evenly_in_the_pixel_and_around_its_centre() {
        for samples in [1, 4, 16, 64] {
            let offsets: Vec<_> = reference_offsets_px(samples).collect();
            assert_eq!(offsets.len(), samples as usize);
            for axis in 0..2 {
                let mean = offsets.iter().map(|o| f64::from(o[axis])).sum::<f64>() / f64::from(samples);
                assert!(mean.abs() < 1e-7, "{mean} of {samples}");
                let strata: std::collections::BTreeSet<_> =
                    offsets.iter().map(|o| ((o[axis] + 0.5) * samples as f32) as u32).collect();
                assert_eq!(strata.len(), samples as usize);
            }
        }
    }
}
