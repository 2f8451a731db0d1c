//! Self-test of an adapter: its floating-point behaviour, and equality of its passes with the CPU's.
//!
//! WGSL leaves much open: compilers may assume that NaN does not occur, flush denormals to zero, and fuse products with
//! sums. The passes need only that NaN keeps its bits. The other findings explain differences between the executors.
//!
//! An adapter that rounds every operation as the CPU does must give the CPU's bits. Others, as NVIDIA's with fused
//! products and sums, must give the CPU's picture: [`LEAST_PSNR_DB`].

use crate::device::{Backend, Headless};
use crate::error::InputError;
use crate::pipeline::{Pipeline, RunKind};
use crate::source::{AnalyticSource, FrameSource};
use afterimage::internal::{ComputeShader, filled};
use afterimage::internal::{Foveation, FoveationKind, MethodKind, Settings};
use afterimage::kernel::pack::{half_bits, half_value};
use afterimage::{CreateError, Image};
use std::sync::Arc;
use wgpu::{Buffer, BufferUsages, TextureFormat, TextureUsages};

const SHADER: &str = include_str!("../shaders/self_test.wgsl");
/// Input rows of probes that report a largest error.
const ROWS: u32 = 4096;
const SIZE: [u32; 2] = [96, 54];
const FRAMES: u64 = 6;

/// Least PSNR in dB of an adapter's output against the CPU's, where the adapter rounds differently. It stands for a
/// root mean square error of a quarter of a step of 8-bit output.
pub const LEAST_PSNR_DB: f64 = 60.0;

/// Result of one probe.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Behaviour that the probe examines.
    pub what: String,
    /// Observed behaviour.
    pub found: String,
    /// Whether the behaviour meets this library's requirement; `None` if the library does not depend on it.
    pub holds: Option<bool>,
}

impl Finding {
    fn fact(what: impl Into<String>, found: impl Into<String>) -> Self {
        Self { what: what.into(), found: found.into(), holds: None }
    }

    fn need(what: impl Into<String>, found: impl Into<String>, holds: bool) -> Self {
        Self { what: what.into(), found: found.into(), holds: Some(holds) }
    }
}

/// Probes, numbered as in `shaders/self_test.wgsl`.
#[derive(Clone, Copy)]
enum Question {
    IsNanEqual,
    MaxOfNan,
    Bits,
    Denormal,
    Fused,
    TwoSum,
    SquaredRoot,
    Quotient,
    Root,
    Exp2,
    Log2,
    Power,
    Sine,
    ToHalf,
    FromHalf,
}

/// Runs a probe: one 32-bit result for each row of three inputs.
type Ask<'a> = &'a dyn Fn(Question, &[[f32; 3]]) -> Vec<u32>;

/// Runs all probes on an adapter. Takes seconds on software devices.
///
/// # Errors
/// If the passes cannot be created or run on the device.
pub fn self_test(gpu: &Arc<Headless>) -> Result<Vec<Finding>, SelfTestError> {
    let ask: Ask<'_> = &|question, rows| ask(gpu, question, rows);
    let mut findings = arithmetic(ask);
    findings.push(formats(gpu));
    let is_exact = rounds_as_cpu(ask);
    for method in MethodKind::ALL.into_iter().filter(|&method| method != MethodKind::None) {
        findings.push(twins(gpu, method, is_exact)?);
    }
    Ok(findings)
}

/// Failure to compare the two executors.
#[derive(Debug, thiserror::Error)]
pub enum SelfTestError {
    /// The device cannot create the passes.
    #[error(transparent)]
    Create(#[from] CreateError),
    /// The test scene cannot be created.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A frame was rejected.
    #[error(transparent)]
    Frame(#[from] afterimage::FrameError),
}

/// Whether the device fuses products with sums: (1 + 2^-12)^2 - (1 + 2^-11) is 2^-24, which two roundings lose.
fn fuses(ask: Ask<'_>) -> bool {
    let (near_one, below) = (1.0 + 2.0_f32.powi(-12), -(1.0 + 2.0_f32.powi(-11)));
    f32::from_bits(ask(Question::Fused, &[[near_one, near_one, below]])[0]) != 0.0
}

/// Whether sums, products, quotients and roots have the CPU's bits. Then so have the passes, which use nothing else.
fn rounds_as_cpu(ask: Ask<'_>) -> bool {
    let tiny = 2.0_f32.powi(-30);
    let sums = f32::from_bits(ask(Question::TwoSum, &[[1.0, tiny, 0.0]])[0]) == tiny;
    let rows: Vec<[f32; 3]> = (1..=ROWS).map(|i| [i as f32 * 0.37, 8.0 / i as f32, 0.0]).collect();
    let same = |question, exact: fn(f32, f32) -> f32| {
        ask(question, &rows).iter().zip(&rows).all(|(&bits, [a, b, _])| bits == exact(*a, *b).to_bits())
    };
    !fuses(ask) && sums && same(Question::Quotient, |a, b| a / b) && same(Question::Root, |a, _| a.sqrt())
}

/// Findings of all arithmetic probes.
fn arithmetic(ask: Ask<'_>) -> Vec<Finding> {
    let one = |question, row: [f32; 3]| ask(question, &[row])[0];
    let value = |question, row| f32::from_bits(one(question, row));
    let payload = f32::from_bits(0x7fc1_2345);
    let denormal = f32::from_bits(100);
    let tiny = 2.0_f32.powi(-30);
    let is_kept = one(Question::Bits, [payload, 0.0, 0.0]) == payload.to_bits();
    vec![
        Finding::need("bits of NaN through a variable", yes(is_kept, "kept", "changed"), is_kept),
        Finding::fact(
            "NaN == NaN",
            yes(
                one(Question::IsNanEqual, [payload; 3]) == 1,
                "true: the compiler assumes that NaN does not occur",
                "false",
            ),
        ),
        Finding::fact("max(NaN, 1)", format!("{}", value(Question::MaxOfNan, [payload, 1.0, 0.0]))),
        Finding::fact(
            "denormals",
            yes(value(Question::Denormal, [denormal, denormal, 0.0]) == 0.0, "flushed to zero", "kept"),
        ),
        Finding::fact("a * b + c", yes(fuses(ask), "fused", "rounded twice")),
        Finding::fact(
            "two-sum",
            yes(value(Question::TwoSum, [1.0, tiny, 0.0]) == tiny, "exact", "simplified: its error term is lost"),
        ),
        Finding::fact(
            "sqrt(2) * sqrt(2)",
            yes(value(Question::SquaredRoot, [2.0; 3]) == 2.0, "simplified to 2", "as computed"),
        ),
        error_of(ask, "a / b", Question::Quotient, |[a, b]| a / b),
        error_of(ask, "sqrt", Question::Root, |[a, _]| a.sqrt()),
        error_of(ask, "exp2", Question::Exp2, |[a, _]| a.exp2()),
        error_of(ask, "log2", Question::Log2, |[a, _]| a.log2()),
        error_of(ask, "pow", Question::Power, |[a, b]| a.powf(b)),
        error_of(ask, "sin", Question::Sine, |[a, _]| a.sin()),
        halves(ask),
    ]
}

/// Largest error over inputs in (0, 8], in units of the last place.
fn error_of(ask: Ask<'_>, what: &'static str, question: Question, exact: fn([f64; 2]) -> f64) -> Finding {
    let rows: Vec<[f32; 3]> =
        (0..ROWS).map(|i| [(i + 1) as f32 * (8.0 / ROWS as f32), 0.1 + (i * 37 % ROWS) as f32 * 1e-3, 0.0]).collect();
    let worst = ask(question, &rows).iter().zip(&rows).fold(0.0_f64, |worst, (&word, row)| {
        let exact = exact([f64::from(row[0]), f64::from(row[1])]);
        // Results below 1 are measured in the last place of 1, because log2 near 1 and sin near pi are close to 0.
        let ulp = f64::from(f32::EPSILON) * 2.0_f64.powi(exact.abs().max(1.0).log2().floor() as i32);
        worst.max((f64::from(f32::from_bits(word)) - exact).abs() / ulp)
    });
    Finding::fact(what, format!("within {worst:.1} units of the last place"))
}

/// Compares conversions to and from 16-bit floats with the CPU's, which round to nearest even.
fn halves(ask: Ask<'_>) -> Finding {
    let rows: Vec<[f32; 3]> = (0..ROWS)
        .map(|i| {
            let magnitude = 2.0_f32.powf((i % 40) as f32 - 24.0) * (1.0 + i as f32 / ROWS as f32);
            [if i % 2 == 0 { magnitude } else { -magnitude }, 0.0, 0.0]
        })
        .filter(|row| row[0].abs() < 65504.0)
        .collect();
    let packed = ask(Question::ToHalf, &rows);
    let wrong = packed.iter().zip(&rows).filter(|(word, row)| (*word & 0xffff) != half_bits(row[0])).count();
    let codes: Vec<u32> = (0..0x7c00).collect();
    let given: Vec<[f32; 3]> = codes.iter().map(|&c| [f32::from_bits(c), 0.0, 0.0]).collect();
    let unpacked = ask(Question::FromHalf, &given);
    let misread = codes.iter().zip(&unpacked).filter(|(code, word)| half_value(**code).to_bits() != **word).count();
    let found =
        format!("{wrong} of {} packed differently, {misread} of {} unpacked differently", rows.len(), codes.len());
    Finding::fact("16-bit floats against the CPU's", found)
}

/// Output texture formats that the device can write.
fn formats(gpu: &Headless) -> Finding {
    let able = |format: TextureFormat, usage: TextureUsages| {
        format.guaranteed_format_features(gpu.device.features()).allowed_usages.contains(usage)
    };
    let output = [TextureFormat::Rgba8Unorm, TextureFormat::Rgba16Float, TextureFormat::Rgba32Float];
    let missing: Vec<_> = output.iter().filter(|f| !able(**f, TextureUsages::STORAGE_BINDING)).collect();
    Finding::need(
        "outputs",
        if missing.is_empty() { "rgba8, rgba16f, rgba32f".to_owned() } else { format!("not {missing:?}") },
        missing.is_empty(),
    )
}

/// Compares a method's output on the device with that on the CPU, for a few frames of a moving scene.
fn twins(gpu: &Arc<Headless>, method: MethodKind, is_exact: bool) -> Result<Finding, SelfTestError> {
    let mut source = AnalyticSource::new("lateral", SIZE, 70.0, 60.0)?;
    let foveation = Foveation { rate_mid: 4, rate_far: 8, kind: FoveationKind::Mip, ..Foveation::default() };
    let settings = Settings { method: method.into(), ..Settings::default() };
    let pipeline = |backend: &Backend| {
        Pipeline::new(*source.view(), foveation, &[RunKind::PostProcess(settings)], false, &[], backend)
    };
    let mut pipelines = [pipeline(&Backend::Cpu)?, pipeline(&Backend::Gpu(gpu.clone()))?];
    let mut difference = Difference::default();
    for index in 0..FRAMES {
        let gaze = Some([20.0 + 10.0 * index as f32, 27.0]);
        let mut outputs = Vec::new();
        for pipeline in &mut pipelines {
            let frame = source.render(&pipeline.request(index, gaze))?;
            outputs.push(pipeline.step(&frame)?.outputs.swap_remove(0).image);
        }
        difference.add(&outputs[0], &outputs[1]);
    }
    let holds = difference.holds(is_exact);
    Ok(Finding::need(format!("{} against the CPU", method.name()), difference.to_string(), holds))
}

/// Difference of an adapter's output from the CPU's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    pixels: u64,
    differ: u64,
    largest: f32,
    squared: f64,
}

impl Difference {
    /// Adds a frame of both.
    pub fn add(&mut self, cpu: &Image<[f32; 3]>, adapter: &Image<[f32; 3]>) {
        for (a, b) in cpu.pixels().iter().zip(adapter.pixels()) {
            self.pixels += 1;
            self.differ += u64::from(a.map(f32::to_bits) != b.map(f32::to_bits));
            for (a, b) in a.iter().zip(b) {
                // NaN on one side only counts as a full step.
                let off = if a.to_bits() == b.to_bits() { 0.0 } else { (a - b).abs() };
                let off = if off.is_finite() { off } else { 1.0 };
                self.largest = self.largest.max(off);
                self.squared += f64::from(off * off);
            }
        }
    }

    /// PSNR in dB on a scale of 1; infinite for equal frames.
    pub fn psnr_db(&self) -> f64 {
        -10.0 * (self.squared / (3 * self.pixels) as f64).log10()
    }

    /// Whether the adapter's output is right: the CPU's bits if its arithmetic is the CPU's, else the CPU's picture.
    pub fn holds(&self, is_exact: bool) -> bool {
        self.differ == 0 || (!is_exact && self.psnr_db() >= LEAST_PSNR_DB)
    }
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { pixels, differ, largest, .. } = self;
        match differ {
            0 => write!(f, "equal bits in all {pixels} pixels"),
            _ => {
                let db = self.psnr_db();
                write!(f, "{differ} of {pixels} pixels differ, by up to {largest:.1e}; PSNR {db:.0} dB")
            }
        }
    }
}

fn yes(is: bool, so: &str, otherwise: &str) -> String {
    if is { so } else { otherwise }.to_owned()
}

/// Runs a probe on the device: one 32-bit result for each row.
fn ask(gpu: &Headless, question: Question, rows: &[[f32; 3]]) -> Vec<u32> {
    let device = &gpu.device;
    let shader = ComputeShader::new(device, "self-test", SHADER);
    let given = filled(device, "rows", bytemuck::cast_slice(rows), BufferUsages::STORAGE);
    let answered = gpu.buffer(4 * rows.len() as u64, BufferUsages::STORAGE | BufferUsages::COPY_SRC);
    let group = shader.group(device, [&given, &answered].map(Buffer::as_entire_binding));
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    shader.dispatch(device, &mut pass, &[("QUESTION", question as u32)], &group, [rows.len() as u32, 1], 1);
    drop(pass);
    gpu.queue.submit([encoder.finish()]);
    bytemuck::pod_collect_to_vec(&gpu.read_buffer(&answered))
}

#[cfg(test)]
mod tests {
    use super::{Difference, Question, arithmetic, rounds_as_cpu};
    use afterimage::Image;
    use afterimage::kernel::pack::{half_bits, half_value};

    /// A simulated adapter: one that follows IEEE 754 (`is_strict`), or one with the deviations that WGSL permits.
    fn adapter(is_strict: bool) -> impl Fn(Question, &[[f32; 3]]) -> Vec<u32> {
        let compute = move |question, [a, b, c]: [f32; 3]| match (question, is_strict) {
            (Question::IsNanEqual, strict) => u32::from(!strict),
            (Question::MaxOfNan, true) => 1.0_f32.to_bits(),
            (Question::Denormal | Question::TwoSum, false) => 0,
            (Question::Denormal, true) => (a + b).to_bits(),
            (Question::Fused, true) => (a * b + c).to_bits(),
            (Question::Fused, false) => a.mul_add(b, c).to_bits(),
            (Question::TwoSum, true) => b.to_bits(),
            (Question::SquaredRoot, true) => (a.sqrt() * a.sqrt()).to_bits(),
            (Question::Quotient, true) => (a / b).to_bits(),
            (Question::Quotient, false) => (a / b * 1.000_001).to_bits(),
            (Question::Root, _) => a.sqrt().to_bits(),
            (Question::Exp2, _) => a.exp2().to_bits(),
            (Question::Log2, _) => a.log2().to_bits(),
            (Question::Power, _) => a.powf(b).to_bits(),
            (Question::Sine, _) => a.sin().to_bits(),
            (Question::ToHalf, true) => half_bits(a),
            // Rounded towards zero.
            (Question::ToHalf, false) => half_bits(f32::from_bits(a.to_bits() & !0x1fff)),
            (Question::FromHalf, _) => half_value(a.to_bits()).to_bits(),
            (Question::Bits, false) => 0x7fc0_0000,
            _ => a.to_bits(),
        };
        move |question, rows| rows.iter().map(|&row| compute(question, row)).collect()
    }

    #[test]
    fn strict_and_loose_adapters_get_different_findings() {
        let findings =
            |is_strict| arithmetic(&adapter(is_strict)).into_iter().map(|f| (f.what, f.found)).collect::<Vec<_>>();
        let (strict, loose) = (findings(true), findings(false));
        let of =
            |findings: &[(String, String)], what: &str| findings.iter().find(|f| f.0.contains(what)).unwrap().1.clone();
        for (what, one, other) in [
            ("bits of NaN", "kept", "changed"),
            ("NaN == NaN", "false", "does not occur"),
            ("denormals", "kept", "flushed"),
            ("a * b + c", "twice", "fused"),
            ("two-sum", "exact", "lost"),
            ("sqrt(2)", "computed", "simplified"),
        ] {
            assert!(of(&strict, what).contains(one) && of(&loose, what).contains(other), "{what}");
        }
        assert!(of(&strict, "a / b").contains(" 0.5 units") && !of(&loose, "a / b").contains(" 0.5 units"));
        assert!(of(&strict, "16-bit").starts_with("0 of") && !of(&loose, "16-bit").starts_with("0 of"));
        let kept: Vec<_> = arithmetic(&adapter(false)).into_iter().filter_map(|f| f.holds).collect();
        assert_eq!(kept, [false], "NaN must keep its bits: sanitizing tests them");
    }

    #[test]
    fn only_an_adapter_that_rounds_as_the_cpu_does_must_give_its_bits() {
        assert!(rounds_as_cpu(&adapter(true)) && !rounds_as_cpu(&adapter(false)));
        // Each deviation alone is enough.
        for deviant in [Question::Fused, Question::TwoSum, Question::Quotient] {
            let mixed =
                |question: Question, rows: &[[f32; 3]]| adapter(question as u32 != deviant as u32)(question, rows);
            assert!(!rounds_as_cpu(&mixed), "{}", deviant as u32);
        }
    }

    #[test]
    fn one_bit_is_a_difference() {
        let a = Image::filled([2, 2], [1.0_f32; 3]);
        let mut b = a.clone();
        let of = |b: &Image<[f32; 3]>| {
            let mut difference = Difference::default();
            difference.add(&a, b);
            difference
        };
        assert!(of(&b).holds(true));
        b.pixels_mut()[3][1] = 1.0_f32.next_up();
        assert!(!of(&b).holds(true) && of(&b).holds(false));
    }
}
