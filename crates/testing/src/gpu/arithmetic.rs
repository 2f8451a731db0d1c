//! What the adapter's arithmetic does, measured: by it, tests compare bits or within tolerances.

use super::adapter::{found, say};
use super::run_probe;
use crate::Draws;
use std::sync::OnceLock;

/// What the adapter's arithmetic does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arithmetic {
    /// Sums, products, quotients and roots of normal numbers have the CPU's bits, and so has what consists of them.
    pub rounds_as_the_cpu: bool,
    /// Results below the normal numbers are not zero.
    pub keeps_denormals: bool,
}

/// Writes a word an invocation: a row's sum, product, quotient, root, and a product and a sum, which devices may fuse.
const SHADER: &str = "
@group(0) @binding(0) var<storage, read> rows: array<f32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;
fn result(operation: u32, a: f32, b: f32, c: f32) -> f32 {
    switch operation {
        case 0u: { return a + b; }
        case 1u: { return a * b; }
        case 2u: { return a / b; }
        case 3u: { return sqrt(a); }
        default: { return a * b + c; }
    }
}
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&results) { return; }
    let at = 3u * (id.x / 5u);
    results[id.x] = bitcast<u32>(result(id.x % 5u, rows[at], rows[at + 1u], rows[at + 2u]));
}
";

fn on_the_cpu([a, b, c]: [f32; 3]) -> [f32; 5] {
    [a + b, a * b, a / b, a.sqrt(), a * b + c]
}

/// What results say that a device gave for rows. The first row's product is below the normal numbers.
fn judged(rows: &[[f32; 3]], results: &[u32]) -> Arithmetic {
    let results: Vec<&[u32]> = results.chunks_exact(5).collect();
    let is_equal = |(row, results): (&[f32; 3], &&[u32])| on_the_cpu(*row).map(f32::to_bits) == **results;
    Arithmetic {
        rounds_as_the_cpu: rows.iter().zip(&results).skip(1).all(is_equal),
        keeps_denormals: results[0][1] == on_the_cpu(rows[0])[1].to_bits(),
    }
}

fn rows() -> Vec<[f32; 3]> {
    let mut draws = Draws::new("arithmetic of the adapter");
    let others = (0..4096).map(|_| {
        let [a, b] = [0; 2].map(|_| draws.range(0.01, 100.0));
        // What is left of the product shows how it was rounded.
        [a, b, -(a * b)]
    });
    [[1e-30, 1e-10, 0.0]].into_iter().chain(others).collect()
}

/// The arithmetic of this run's adapter, measured once. `None` without an adapter.
pub fn arithmetic() -> Option<Arithmetic> {
    static ARITHMETIC: OnceLock<Option<Arithmetic>> = OnceLock::new();
    *ARITHMETIC.get_or_init(|| {
        // Not `device`, which is recorded.
        let desc = wgpu::DeviceDescriptor { label: Some("arithmetic"), ..Default::default() };
        let (device, queue) = pollster::block_on(found()?.request_device(&desc)).expect("a device with default limits");
        let rows = rows();
        let inputs: Vec<u32> = rows.as_flattened().iter().map(|x| x.to_bits()).collect();
        let arithmetic = judged(&rows, &run_probe(&device, &queue, SHADER, "main", &inputs, 5 * rows.len()));
        if arithmetic != (Arithmetic { rounds_as_the_cpu: true, keeps_denormals: true }) {
            say(&format!("arithmetic: {arithmetic:?}; see CONTRIBUTING.md for what is compared"));
        }
        Some(arithmetic)
    })
}

/// Whether the adapter must give the CPU's bits.
pub fn rounds_as_the_cpu() -> bool {
    arithmetic().is_none_or(|arithmetic| arithmetic.rounds_as_the_cpu)
}

#[cfg(test)]
mod tests {
    use super::{Arithmetic, judged, on_the_cpu, rows};

    /// A device that computes in this way.
    fn found(compute: impl Fn([f32; 3]) -> [f32; 5]) -> Arithmetic {
        let rows = rows();
        let results: Vec<u32> = rows.iter().flat_map(|row| compute(*row).map(f32::to_bits)).collect();
        judged(&rows, &results)
    }

    #[test]
    fn each_deviation_is_noticed() {
        let strict = Arithmetic { rounds_as_the_cpu: true, keeps_denormals: true };
        assert_eq!(found(on_the_cpu), strict);
        let flush = |x: f32| if x.is_normal() { x } else { 0.0 };
        assert_eq!(found(|row| on_the_cpu(row).map(flush)), Arithmetic { keeps_denormals: false, ..strict });
        let loose = Arithmetic { rounds_as_the_cpu: false, ..strict };
        let changed = |operation: usize, f: fn([f32; 3]) -> f32| {
            found(move |row| {
                let mut results = on_the_cpu(row);
                results[operation] = f(row);
                results
            })
        };
        assert_eq!(changed(4, |[a, b, c]| a.mul_add(b, c)), loose, "fused");
        assert_eq!(changed(2, |[a, b, _]| a * (1.0 / b)), loose, "a reciprocal");
        assert_eq!(changed(3, |[a, ..]| a.sqrt() * 1.000_000_1), loose, "a root");
        assert_eq!(changed(0, |[a, b, _]| (f64::from(a) + f64::from(b)) as f32 * 1.000_000_1), loose, "a sum");
    }
}
