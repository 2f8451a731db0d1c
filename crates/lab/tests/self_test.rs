//! What `afterimage info adapters --self-test` asks, on the adapter of this machine: hard case H84.

use afterimage::wgpu;
use afterimage_lab::device::Headless;
use afterimage_lab::self_test::self_test;
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
    assert!(wrs.starts_with("equal bits") && wrs == smr);
    let name = &device.info.name;
    holds!("H84", Gpu, "{name}: wrs, smr {wrs}; denormals {}, two-sum {}", of("denormals"), of("two-sum"));
}
