//! Hard cases of the kernel's functions on the device: its results, equal to Rust's in every bit.

use super::library::probes;
use super::modules::calls;
use crate::kernel_hard::*;
use afterimage::shader::SHADERS;
use afterimage_testing::holds;

/// What a law measured; `None`, after a message, without an adapter.
fn run_law(law: fn(Call<'_>) -> Option<String>) -> Option<String> {
    law(&|function, rows| probes().find(|probe| probe.name == function).expect(function).outputs(rows))
}

kernel_laws!(Gpu, run_law);

#[test]
fn h38_no_power_is_called() {
    // The accuracy of the device's own powers and logarithms is implementation-defined.
    let passes = ["wrs_pass", "smr_pass", "taa_pass"];
    for pass in passes {
        let source = SHADERS.compose(pass).source;
        let code: String = source.lines().map(|l| l.split("//").next().unwrap()).collect::<Vec<_>>().join("\n");
        assert!(!["pow", "log2", "log"].into_iter().any(|name| calls(&code, name)), "{pass}");
        assert!(calls(&code, "cbrt") || pass != "wrs_pass");
    }
    holds!("H38", Gpu, "no pow in {} passes", passes.len());
}
