//! What must hold of pictures and counters of an adapter that rounds otherwise than the CPU. One that rounds alike must
//! give the CPU's bits (`gpu::rounds_as_the_cpu`).

/// Least PSNR in dB of pixels that show the same: a root mean square error of a quarter of a step of 8-bit output, as
/// of the lab's self-test.
pub const LEAST_PSNR_DB: f64 = 60.0;

/// Largest share of pixels that may show something else: those whose decision fell the other way. The tests' frames are
/// full of ties: on llvmpipe made to round toward zero, at most 4.5 % of a frame of thousands of pixels differ.
pub const DECIDED_OTHERWISE: f64 = 0.0625;

/// Error from which a pixel shows something else, as a share of the CPU's value or of 1: a step of 8-bit output.
const OTHER: f64 = 1.0 / 255.0;

/// Pixels that may be decided otherwise in a picture of so many: in a small one, by chance, a larger share.
fn may_differ(pixels: u64) -> u64 {
    let expected = DECIDED_OTHERWISE * pixels as f64;
    (expected + 3.0 * expected.sqrt()) as u64
}

/// Compares the bits of colors: those of an adapter that rounds as the CPU must be equal, others [`pictures`].
///
/// # Errors
/// How they differ.
pub fn colors(adapter: &[[u32; 3]], cpu: &[[u32; 3]]) -> Result<(), String> {
    if !crate::gpu::rounds_as_the_cpu() {
        return pictures(adapter, cpu);
    }
    let differ = adapter.iter().zip(cpu).filter(|(a, b)| a != b).count();
    if adapter == cpu { Ok(()) } else { Err(format!("{differ} of {} pixels differ", cpu.len())) }
}

/// Compares colors of an adapter that rounds otherwise: few pixels may differ by more than a step of 8-bit output, and
/// the others must be close.
///
/// # Errors
/// How they differ.
pub fn pictures(adapter: &[[u32; 3]], cpu: &[[u32; 3]]) -> Result<(), String> {
    if adapter.len() != cpu.len() {
        return Err(format!("{} pixels, not {}", adapter.len(), cpu.len()));
    }
    let (mut others, mut squared, mut first) = (0, 0.0, None);
    for (i, (a, b)) in adapter.iter().zip(cpu).enumerate() {
        let errors = [0, 1, 2].map(|c| {
            let [a, b] = [a[c], b[c]].map(|word| f64::from(f32::from_bits(word)));
            // NaN on both sides is no error, and on one side infinite.
            let error = if a.is_nan() && b.is_nan() || a == b { 0.0 } else { (a - b).abs() / b.abs().max(1.0) };
            if error.is_finite() { error } else { f64::INFINITY }
        });
        if errors.iter().any(|&error| error > OTHER) {
            others += 1;
            first = first.or(Some(i));
        } else {
            squared += errors.map(|error| error * error).iter().sum::<f64>();
        }
    }
    let psnr_db = -10.0 * (squared / (3 * cpu.len().max(1)) as f64).log10();
    let said = format!("{others} of {} pixels show something else, first {first:?}; others {psnr_db:.0} dB", cpu.len());
    println!("{said}");
    if others <= may_differ(cpu.len() as u64) && psnr_db >= LEAST_PSNR_DB { Ok(()) } else { Err(said) }
}

/// Compares counters of pixels in a frame of so many.
///
/// # Errors
/// How they differ.
pub fn counts(adapter: &[u64], cpu: &[u64], pixels: u64) -> Result<(), String> {
    let is_close = |(a, b): (&u64, &u64)| a.abs_diff(*b) <= may_differ(pixels);
    let all = adapter.len() == cpu.len() && adapter.iter().zip(cpu).all(is_close);
    if all { Ok(()) } else { Err(format!("counters {adapter:?}, not {cpu:?}, of {pixels} pixels")) }
}

#[cfg(test)]
mod tests {
    use super::{counts, pictures};
    use crate::Draws;

    fn noise() -> Vec<[f32; 3]> {
        let mut draws = Draws::new("a picture");
        (0..4000).map(|_| [0; 3].map(|_| 0.05 + draws.uniform())).collect()
    }

    fn compared(change: impl Fn(usize, f32) -> f32) -> Result<(), String> {
        let cpu = noise();
        let bits = |picture: &[[f32; 3]]| picture.iter().map(|c| c.map(f32::to_bits)).collect::<Vec<_>>();
        let changed: Vec<_> = cpu.iter().enumerate().map(|(i, c)| c.map(|v| change(i, v))).collect();
        pictures(&bits(&changed), &bits(&cpu))
    }

    #[test]
    fn rounding_and_few_decisions_pass_and_errors_do_not() {
        assert_eq!(compared(|_, v| v), Ok(()));
        assert_eq!(compared(|i, v| f32::from_bits(v.to_bits() + i as u32 % 1000)), Ok(()), "rounded, summed up");
        assert_eq!(compared(|i, v| if i % 20 == 0 { v + 0.3 } else { v }), Ok(()), "5 % decided otherwise");
        for (what, wrong) in [
            ("a tenth", compared(|i, v| if i % 10 == 0 { v + 0.3 } else { v })),
            ("dark", compared(|_, v| v * 0.997)),
            ("broken", compared(|i, v| if i % 10 == 0 { f32::NAN } else { v })),
            ("infinite", compared(|i, v| if i % 10 == 0 { f32::INFINITY } else { v })),
        ] {
            println!("{what}: {wrong:?}");
            assert!(wrong.is_err(), "{what}");
        }
        assert!(pictures(&[[0; 3]; 2], &[[0; 3]; 3]).is_err());
    }

    #[test]
    fn counters_may_differ_by_few_pixels() {
        assert_eq!(counts(&[3, 100], &[3, 103], 1000), Ok(()));
        assert!(counts(&[3, 100], &[3, 203], 1000).is_err() && counts(&[3], &[3, 4], 1000).is_err());
    }
}
