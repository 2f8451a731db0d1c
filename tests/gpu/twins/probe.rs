//! A probe: one library function over a table of words, on the adapter and by its Rust twin.

use super::library::{SHADERS, probes, table_data};
use super::shape::Twin;
use afterimage::wgpu;
use afterimage_testing::Draws;
use afterimage_testing::planted::enough_caught;
use glam::Vec3;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

pub struct Probe {
    pub name: &'static str,
    /// The module it is in, or those it needs, with a space between.
    pub module: &'static str,
    /// Words of a row of input and of output.
    pub words: [usize; 2],
    /// WGSL statements that read `in_u`, `in_f`, `in_v` (word, float, three floats; by index) and call `out_u`,
    /// `out_f`, `out_v`, `out_b` in order.
    pub wgsl: fn() -> String,
    /// Calls the Rust twin on a row.
    pub rust: fn(&Row<'_>, &mut Out),
    /// Fills the table.
    pub rows: fn(Rows) -> Rows,
}

/// A probe of a function of the kernel, `module::name`. The types of the Rust function say how its arguments lie in a
/// row, and how WGSL spells the call:
///
/// ```ignore
/// // Rust: lobe(r.f(0)); WGSL: lobe(in_f(0u)); 20,000 random rows of one float.
/// probe!(taau::lobe, |rows| rows.random(|d, row| row.push(range(d, 0.0, 2.0))))
/// // Rust takes a reference, or something that is no word of the row; WGSL is the same call.
/// probe!(phong::phong_diffuse, |s: PhongSurface, wi: Vec3| phong::phong_diffuse(&s, wi), materials)
/// // WGSL differs: `$0` is the first argument; statements may stand before the result, or `out_` calls write it.
/// probe!(albedo::sheen_albedo, |x: f32, y: f32| albedo::sheen_albedo(&TABLES, x, y), "sheen_albedo(0u, $0, $1)", pair)
/// ```
///
/// Structs have their fields' shapes from `shape!`.
macro_rules! probe {
    ($module:ident::$name:ident, $rows:expr) => {
        probe!($module::$name, $module::$name, stringify!($name), $rows)
    };
    ($module:ident::$name:ident, $rust:expr, $rows:expr) => {
        probe!($module::$name, $rust, stringify!($name), $rows)
    };
    ($module:ident::$name:ident, $rust:expr, $wgsl:expr, $rows:expr) => {
        Probe {
            name: stringify!($name),
            module: stringify!($module),
            words: Probe::words_of(&$rust),
            wgsl: || Probe::spell(&$rust, $wgsl),
            rust: |row, out| Probe::run(&$rust, row, out),
            rows: $rows,
        }
    };
}
pub(crate) use probe;

pub struct Row<'a> {
    words: &'a [u32],
    /// A bit for each of the first words that was read as a float.
    floats: Cell<u128>,
    /// Whether a float that was read is [`outside`] what other devices compute alike.
    outside: Cell<bool>,
}

impl<'a> Row<'a> {
    pub fn of(words: &'a [u32]) -> Self {
        Self { words, floats: Cell::new(0), outside: Cell::new(false) }
    }
    pub fn u(&self, k: usize) -> u32 {
        self.words[k]
    }
    pub fn f(&self, k: usize) -> f32 {
        let x = f32::from_bits(self.words[k]);
        self.floats.set(self.floats.get() | 1_u128.checked_shl(k as u32).unwrap_or(0));
        self.outside.set(self.outside.get() || outside(x));
        x
    }
    pub fn v(&self, k: usize) -> Vec3 {
        Vec3::new(self.f(k), self.f(k + 1), self.f(k + 2))
    }
    fn read_as_float(&self, k: usize) -> bool {
        self.floats.get().checked_shr(k as u32).unwrap_or(0) & 1 == 1
    }
}

#[derive(Default)]
pub struct Out {
    words: Vec<u32>,
    /// Places of words that are floats.
    floats: Vec<usize>,
    /// Whether a float that was written is [`outside`] what other devices compute alike.
    outside: bool,
}

impl Out {
    pub fn u(&mut self, x: u32) {
        self.words.push(x);
    }
    pub fn f(&mut self, x: f32) {
        self.outside |= outside(x);
        self.floats.push(self.words.len());
        self.words.push(x.to_bits());
    }
    pub fn b(&mut self, x: bool) {
        self.words.push(x.into());
    }
    pub fn v(&mut self, x: Vec3) {
        x.to_array().into_iter().for_each(|x| self.f(x));
    }
}

/// Rounding errors of a row's floats, in units of the last place, and how many such rows are compared with.
const NUDGE: u32 = 4;
const NUDGES: usize = 27;

/// Rounding error of a result of size 1: of color differences, which are multiplied by 500.
const ROUNDED: f64 = 128.0 * f32::EPSILON as f64;

/// Rows that differ and are printed.
const SHOWN: usize = 8;

/// Rows of a table that are compared within tolerances, evenly spread.
const MOST_CLOSE_ROWS: usize = 10_007;

/// Functions whose words hold several quantized numbers: each may be a step off.
const PACKED: &[&str] =
    &["half_bits", "pack", "pack_noise", "float14_bits", "pack_surface", "round_mip", "pack_stored", "pack_lit"];

/// Functions whose results are sums and powers of hundreds of steps.
const SUMMED: &[&str] = &["gauss_next", "a stream of one weight"];

/// Number of signed powers of two whose sum is the difference of two words.
fn steps(a: u32, b: u32) -> u32 {
    let difference = u64::from(a.abs_diff(b));
    // The digits of the non-adjacent form.
    ((3 * difference) ^ difference).count_ones()
}

/// Rows whose results may be neither equal nor close: one in 1,000, where the adapter rounds otherwise. Tables have
/// many rows beside thresholds, and a decision there falls the other way.
fn may_differ(count: usize) -> usize {
    if afterimage_testing::gpu::rounds_as_the_cpu() { 0 } else { count / 1_000 }
}

/// Whether rows are left out whose floats are [`outside`]: for recordings, and on an adapter that flushes denormals or
/// rounds otherwise.
pub fn leaves_out() -> bool {
    let all = afterimage_testing::gpu::arithmetic().is_none_or(|a| a.keeps_denormals && a.rounds_as_the_cpu);
    !all || afterimage_testing::gpu::is_recorded()
}

/// Whether other devices may compute with this number in another way: NaN has many bits, and devices flush denormals to
/// zero, which are products of numbers below 2^-64. Those above 2^64 overflow sooner or later. The passes sanitize what
/// they read.
fn outside(x: f32) -> bool {
    let most = 18_446_744_073_709_551_616.0;
    x.is_nan()
        || (x != 0.0 && x.abs() < 1.0 / most)
        || (!afterimage_testing::gpu::rounds_as_the_cpu() && x.abs() > most)
}

/// A table of input, of the probe of that name.
pub struct Rows {
    pub name: &'static str,
    pub width: usize,
    pub words: Vec<u32>,
}

impl Probe {
    pub const fn words_of<Arguments, Function: Twin<Arguments>>(_: &Function) -> [usize; 2] {
        Function::WORDS
    }
    pub fn spell<Arguments>(function: &impl Twin<Arguments>, call: &str) -> String {
        function.wgsl(call)
    }
    pub fn run<Arguments>(function: &impl Twin<Arguments>, row: &Row<'_>, out: &mut Out) {
        function.run(row, out);
    }

    pub fn table(&self) -> Rows {
        (self.rows)(Rows { name: self.name, width: self.words[0], words: vec![] })
    }

    /// The library and an entry point `main` that runs one row per invocation.
    pub fn source(&self) -> String {
        let [ins, outs] = self.words;
        let table_data = table_data(self.module).len();
        let harness = format!(
            "@group(0) @binding(0) var<storage, read> probe_in: array<u32>;
@group(0) @binding(1) var<storage, read_write> probe_out: array<u32>;
var<private> probe_read: u32;
var<private> probe_write: u32;
fn load(i: u32) -> vec4u {{
    return vec4u(probe_in[4u * i], probe_in[4u * i + 1u], probe_in[4u * i + 2u], probe_in[4u * i + 3u]);
}}
fn in_u(k: u32) -> u32 {{ return probe_in[probe_read + k]; }}
fn in_f(k: u32) -> f32 {{ return bitcast<f32>(in_u(k)); }}
fn in_v(k: u32) -> vec3f {{ return vec3f(in_f(k), in_f(k + 1u), in_f(k + 2u)); }}
fn out_u(x: u32) {{ probe_out[probe_write] = x; probe_write += 1u; }}
fn out_f(x: f32) {{ out_u(bitcast<u32>(x)); }}
fn out_b(x: bool) {{ out_u(select(0u, 1u, x)); }}
fn out_v(x: vec3f) {{ out_f(x.x); out_f(x.y); out_f(x.z); }}
@compute @workgroup_size({workgroup})
fn main(@builtin(global_invocation_id) id: vec3u) {{
    if id.x >= (arrayLength(&probe_in) - {table_data}u) / {ins}u {{ return; }}
    probe_read = {table_data}u + id.x * {ins}u;
    probe_write = id.x * {outs}u;
    {wgsl}
}}
",
            workgroup = afterimage_testing::gpu::WORKGROUP,
            wgsl = (self.wgsl)()
        );
        SHADERS.compose_with(&self.module.split(' ').collect::<Vec<_>>(), &harness).source
    }

    /// Results of the Rust twin for a row, and the row as it was read.
    fn twin<'a>(&self, words: &'a [u32]) -> (Row<'a>, Out) {
        let row = Row::of(words);
        let mut out = Out::default();
        (self.rust)(&row, &mut out);
        assert_eq!(out.words.len(), self.words[1], "{}", self.name);
        (row, out)
    }

    /// Words of the Rust twin for a row, and whether a float among the row or its results is [`outside`].
    fn expected(&self, words: &[u32]) -> (Vec<u32>, bool) {
        let (row, out) = self.twin(words);
        let outside = row.outside.get() || out.outside;
        (out.words, outside)
    }

    /// Whether results are what the Rust twin computes of a row with rounding errors in its floats: what must hold of
    /// an adapter that rounds otherwise. Each word must be the twin's for such a row; a float may lie between two of
    /// them, or a rounding error of a number of its size beside them.
    fn is_close(&self, words: &[u32], got: &[u32]) -> bool {
        let (row, exact) = self.twin(words);
        let mut draws = Draws::new(self.name);
        let mut nudged = |most_ulps: u32| {
            let floats = words.iter().enumerate().map(|(k, &word)| (row.read_as_float(k), word));
            let words = floats.map(|(is_float, word)| {
                let ulps = f64::from(draws.bits() % (2 * most_ulps + 1)) - f64::from(most_ulps);
                let x = f64::from(f32::from_bits(word)) * (1.0 + ulps * f64::from(f32::EPSILON));
                if is_float { (x as f32).to_bits() } else { word }
            });
            // Without those rows that the function is not made for.
            let words: Vec<u32> = words.collect();
            catch_unwind(AssertUnwindSafe(|| self.twin(&words).1.words)).unwrap_or_else(|_| exact.words.clone())
        };
        let near: Vec<_> = (0..NUDGES).map(|_| nudged(NUDGE)).chain([exact.words.clone()]).collect();
        let far: Vec<_> = (0..NUDGES).map(|i| nudged(NUDGE << (i % 9))).collect();
        let is_packed = PACKED.contains(&self.name);
        (0..got.len()).all(|k| {
            if near.iter().chain(&far).any(|words| words[k] == got[k]) {
                return true;
            }
            if !exact.floats.contains(&k) {
                return is_packed && steps(got[k], exact.words[k]) <= 3;
            }
            let floats = near.iter().map(|words| f64::from(f32::from_bits(words[k])));
            let (low, high) = (floats.clone().fold(f64::INFINITY, f64::min), floats.fold(f64::NEG_INFINITY, f64::max));
            let size = low.abs().max(high.abs());
            let coarse = if is_packed { size / 1024.0 } else { 0.0 };
            let summed = if SUMMED.contains(&self.name) { size / 64.0 } else { 0.0 };
            let slack = 2.0 * (high - low) + ROUNDED * size.max(1.0) + coarse + summed;
            (low - slack..=high + slack).contains(&f64::from(f32::from_bits(got[k])))
        })
    }

    /// Rows of the table, and a line for each whose results differ between `source` on the device and the Rust twin;
    /// those after the first [`SHOWN`] are empty.
    fn differences(&self, device: &wgpu::Device, queue: &wgpu::Queue, source: &str) -> (usize, Vec<String>) {
        let ([ins, outs], rows) = (self.words, self.table());
        let (leaves_out, is_exact) = (leaves_out(), afterimage_testing::gpu::rounds_as_the_cpu());
        // Comparing within tolerances takes long.
        let stride = if is_exact { 1 } else { (rows.words.len() / ins).div_ceil(MOST_CLOSE_ROWS).max(1) };
        let rows: Vec<_> = rows.words.chunks(ins).step_by(stride).map(|row| (row, self.expected(row))).collect();
        let rows: Vec<_> = rows.into_iter().filter(|(_, (_, outside))| !(leaves_out && *outside)).collect();
        let count = rows.len();
        // The table data comes first, so that where it lies does not depend on the rows.
        let table = rows.iter().flat_map(|(row, _)| row.iter().copied());
        let inputs: Vec<u32> = table_data(self.module).into_iter().chain(table).collect();
        let got = afterimage_testing::gpu::run_probe(device, queue, source, "main", &inputs, count * outs);
        let mut lines = vec![];
        for ((input, (expected, _)), got) in rows.iter().zip(got.chunks(outs)) {
            if got != expected && (is_exact || !self.is_close(input, got)) {
                lines.push(if lines.len() < SHOWN {
                    let floats: Vec<_> = input.iter().map(|&x| f32::from_bits(x)).collect();
                    format!("{input:08x?} {floats:?}: device {got:08x?}, Rust {expected:08x?}")
                } else {
                    String::new()
                });
            }
        }
        (count, lines)
    }

    /// Results of each row on a fresh device, after a check that Rust's are equal in every bit. `None` without an
    /// adapter.
    #[track_caller]
    pub fn outputs(&self, rows: &[Vec<u32>]) -> Option<Vec<Vec<u32>>> {
        let (device, queue) = afterimage_testing::gpu::device()?;
        let outs = self.words[1];
        let inputs = [table_data(self.module), rows.concat()].concat();
        let got =
            afterimage_testing::gpu::run_probe(&device, &queue, &self.source(), "main", &inputs, rows.len() * outs);
        let got: Vec<Vec<u32>> = got.chunks(outs).map(<[u32]>::to_vec).collect();
        let is_exact = afterimage_testing::gpu::rounds_as_the_cpu();
        for (input, got) in rows.iter().zip(&got) {
            assert_eq!(input.len(), self.words[0], "{}", self.name);
            let (expected, outside) = self.expected(input);
            let is_right = *got == expected || (leaves_out() && outside) || (!is_exact && self.is_close(input, got));
            assert!(is_right, "{} of {input:08x?}: device {got:08x?}, Rust {expected:08x?}", self.name);
        }
        Some(got)
    }

    /// Fails unless device and Rust agree in every bit of every row.
    fn check(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<usize, String> {
        let (count, lines) = self.differences(device, queue, &self.source());
        println!("{}::{}: {count} rows, {} differ", self.module, self.name, lines.len());
        if lines.len() <= may_differ(count) {
            return Ok(count);
        }
        let shown = &lines[..lines.len().min(SHOWN)];
        Err(format!("{}::{}: {} of {count} rows differ\n{}", self.module, self.name, lines.len(), shown.join("\n")))
    }
}

/// Checks every probe of `module`, on a fresh device; how many rows agree, or `None` without an adapter.
pub fn check_module(module: &str) -> Option<usize> {
    let (device, queue) = afterimage_testing::gpu::device()?;
    let chosen: Vec<_> = probes().filter(|p| p.module == module).collect();
    assert!(!chosen.is_empty());
    let (counts, failures): (Vec<_>, Vec<_>) = chosen.iter().map(|p| p.check(&device, &queue)).partition(Result::is_ok);
    let failures: Vec<_> = failures.into_iter().filter_map(Result::err).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n\n"));
    Some(counts.into_iter().flatten().sum())
}

/// Planted errors: a function, a text of its source, and what stands there instead. Fails unless the comparison sees
/// each.
#[track_caller]
pub fn caught(errors: &[(&str, &str, &str)]) {
    let Some((device, queue)) = afterimage_testing::gpu::device() else { return };
    let mut missed = vec![];
    for (function, right, wrong) in errors {
        let probe = probes().find(|p| format!("{}::{}", p.module, p.name) == *function).expect(function);
        let source = probe.source();
        assert_eq!(source.matches(right).count(), 1, "'{right}' in the source of {function}");
        let (count, lines) = probe.differences(&device, &queue, &source.replace(right, wrong));
        println!("{function}, '{right}' -> '{wrong}': {} of {count} rows differ", lines.len());
        if lines.len() <= may_differ(count) {
            missed.push(format!("{function}, '{right}' -> '{wrong}'"));
        }
    }
    enough_caught(errors.len(), &missed);
}
