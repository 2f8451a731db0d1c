// Probes an adapter's arithmetic: one invocation per input row. Not part of any pass.

@group(0) @binding(0) var<storage, read> given: array<u32>;
@group(0) @binding(1) var<storage, read_write> answered: array<u32>;

// Probe number, as in `Question` (src/self_test.rs).
override QUESTION: u32;

fn answer(a: f32, b: f32, c: f32) -> u32 {
    switch QUESTION {
        // NaN: comparison, and the result of max.
        case 0u: { return select(0u, 1u, a == a); }
        case 1u: { return bitcast<u32>(max(a, b)); }
        // Bit pattern kept through a float variable.
        case 2u: { return bitcast<u32>(a); }
        // Denormals.
        case 3u: { return bitcast<u32>(a + b); }
        // Product plus sum: one rounding (fused) or two.
        case 4u: { return bitcast<u32>(a * b + c); }
        // Knuth's two-sum: its error term is 0 if the compiler reassociates sums.
        case 5u: {
            let sum = a + b;
            let part = sum - a;
            return bitcast<u32>((a - (sum - part)) + (b - part));
        }
        case 6u: { return bitcast<u32>(sqrt(a) * sqrt(a)); }
        case 7u: { return bitcast<u32>(a / b); }
        case 8u: { return bitcast<u32>(sqrt(a)); }
        case 9u: { return bitcast<u32>(exp2(a)); }
        case 10u: { return bitcast<u32>(log2(a)); }
        case 11u: { return bitcast<u32>(pow(a, b)); }
        case 12u: { return bitcast<u32>(sin(a)); }
        case 13u: { return pack2x16float(vec2f(a, 0.0)); }
        case 14u: { return bitcast<u32>(unpack2x16float(bitcast<u32>(a)).x); }
        default: { return 0u; }
    }
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&answered) {
        return;
    }
    let row = 3u * id.x;
    answered[id.x] = answer(bitcast<f32>(given[row]), bitcast<f32>(given[row + 1u]), bitcast<f32>(given[row + 2u]));
}
