//! What `afterimage info adapters --self-test` asks, on the adapter of this machine: hard case H84.

use afterimage::{Image, wgpu};
use afterimage_lab::device::Headless;
use afterimage_lab::self_test::{Difference, LEAST_PSNR_DB, self_test};
use afterimage_testing::holds;

#[test]
fn passes_give_the_bits_of_the_cpu_and_the_adapter_says_how_it_computes() {
    let Some(adapter) = afterimage_testing::gpu::adapter() else { return };
    let device = Headless::on(adapter, wgpu::Limits::default()).unwrap();
    let findings = self_test(&device).unwrap();
    for finding in &findings {
        println!("{finding:?}");
        assert_ne!(finding.holds, Some(false), "{}: {}", finding.what, finding.found);
    }
    let of = |what: &str| &findings.iter().find(|f| f.what == what).unwrap().found;
    for what in
        ["NaN == NaN", "denormals", "a * b + c", "two-sum", "exp2", "pow", "16-bit floats against the CPU's", "outputs"]
    {
        assert!(!of(what).is_empty());
    }
    let (wrs, smr) = (of("wrs against the CPU"), of("smr against the CPU"));
    if afterimage_testing::gpu::rounds_as_the_cpu() {
        assert!(wrs.starts_with("equal bits") && wrs == smr);
    }
    let name = &device.info.name;
    holds!("H84", Gpu, "{name}: wrs, smr {wrs}; denormals {}, two-sum {}", of("denormals"), of("two-sum"));
}

/// Rounding in the last place passes where arithmetic differs anyway, a decision that flips in a few pixels, too; a
/// picture that is wrong does not.
#[test]
fn rounding_is_tolerated_only_where_the_adapter_rounds_differently_and_errors_never() {
    let picture = |f: &dyn Fn(u32, u32) -> f32| Image::from_fn([96, 54], |[x, y]| [f(x, y); 3]);
    let cpu = picture(&|x, y| 0.5 + 0.4 * ((x * 7 + y * 13) % 17) as f32 / 17.0);
    let compared = |adapter: &Image<[f32; 3]>| {
        let mut difference = Difference::default();
        difference.add(&cpu, adapter);
        difference
    };
    let changed = |f: &dyn Fn(usize, f32) -> f32| {
        let mut image = cpu.clone();
        image.pixels_mut().iter_mut().enumerate().for_each(|(i, c)| *c = c.map(|v| f(i, v)));
        compared(&image)
    };
    assert!(compared(&cpu).holds(true) && compared(&cpu).holds(false));
    let rounded = changed(&|_, v| f32::from_bits(v.to_bits() + 3));
    let flipped = changed(&|i, v| if i % 1000 == 0 { v + 0.014 } else { v });
    for (what, difference) in [("rounded", rounded), ("flipped", flipped)] {
        println!("{what}: {difference}");
        assert!(!difference.holds(true) && difference.holds(false), "{what}: {difference}");
    }
    let shifted = compared(&picture(&|x, y| 0.5 + 0.4 * (((x + 1) * 7 + y * 13) % 17) as f32 / 17.0));
    let dark = changed(&|_, v| v * 0.997);
    let broken = changed(&|i, v| if i % 1000 == 0 { f32::NAN } else { v });
    for (what, difference) in [("shifted", shifted), ("dark", dark), ("broken", broken)] {
        println!("{what}: {difference}, least {LEAST_PSNR_DB}");
        assert!(!difference.holds(false), "{what}: {difference}");
    }
}
