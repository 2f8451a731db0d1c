//! Twins have the same constants: those of `src/kernel/NAME.rs` and of `shaders/lib/NAME.wgsl` by name and value.

use super::tree::{Tree, expect_none, read};
use std::collections::BTreeMap;

/// Constants of one language alone, as beginnings of names: module, language, beginning, reason.
const ONE_SIDED: [[&str; 4]; 9] = [
    ["approx", "wgsl", "", "Rust's standard library has them."],
    ["debug_view", "wgsl", "VIEW_", "An enum in Rust."],
    ["debug_view", "rs", "STOPS", "A local array in WGSL, which takes an index that is not constant."],
    ["depth", "wgsl", "DISPARITY_", "Flags of a struct in Rust."],
    ["reproject", "wgsl", "VERDICT_", "An enum in Rust."],
    ["reservoir", "wgsl", "LOWEST", "Rust's standard library has it."],
    ["rng", "wgsl", "PURPOSE_", "An enum in Rust."],
    ["smr", "rs", "OF_DIFFERENCE", "A text of notes."],
    ["wrs", "wgsl", "", "Enums in Rust."],
];

/// Constants of a module by name, with the text of their values.
type Constants = BTreeMap<String, String>;

/// Constants outside of functions and `impl` blocks.
fn constants(source: &str) -> Constants {
    let item = |item: &str| {
        let (name, rest) = item.split_once([':', ' '])?;
        let (_, value) = rest.split_once("= ")?;
        Some((name.to_owned(), value.split(';').next()?.to_owned()))
    };
    let starts = source.match_indices("const ").map(|(at, word)| (&source[..at], &source[at + word.len()..]));
    let top = starts.filter(|(before, _)| {
        let line = before.rsplit('\n').next().unwrap_or_default();
        line.is_empty() || line.starts_with("pub")
    });
    top.filter_map(|(_, rest)| item(rest)).collect()
}

/// Reader of a constant expression: numbers, names of constants, `+ - * / <<`, lists and vectors.
struct Expression<'a> {
    rest: &'a str,
    named: &'a dyn Fn(&str) -> Option<Vec<f64>>,
}

impl<'a> Expression<'a> {
    /// The numbers of `text`, one of a scalar; `None` if something else stands there.
    fn value(text: &'a str, named: &'a dyn Fn(&str) -> Option<Vec<f64>>) -> Option<Vec<f64>> {
        let mut expression = Self { rest: text, named };
        let value = expression.shift()?;
        expression.rest.trim().is_empty().then_some(value)
    }

    fn takes(&mut self, word: &str) -> bool {
        let rest = self.rest.trim_start().strip_prefix(word);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    fn shift(&mut self) -> Option<Vec<f64>> {
        let mut value = self.sum()?;
        while self.takes("<<") {
            value = scalars(value, self.sum()?, |a, b| a * b.exp2())?;
        }
        Some(value)
    }

    fn sum(&mut self) -> Option<Vec<f64>> {
        let mut value = self.product()?;
        loop {
            if self.takes("+") {
                value = scalars(value, self.product()?, |a, b| a + b)?;
            } else if self.takes("-") {
                value = scalars(value, self.product()?, |a, b| a - b)?;
            } else {
                return Some(value);
            }
        }
    }

    fn product(&mut self) -> Option<Vec<f64>> {
        let mut value = self.atom()?;
        loop {
            if self.takes("*") {
                value = scalars(value, self.atom()?, |a, b| a * b)?;
            } else if self.takes("/") {
                value = scalars(value, self.atom()?, |a, b| a / b)?;
            } else {
                return Some(value);
            }
        }
    }

    fn atom(&mut self) -> Option<Vec<f64>> {
        if self.takes("-") {
            return self.atom().map(|value| value.into_iter().map(|v| -v).collect());
        }
        if self.takes("f32::from_bits(") {
            let bits = self.list(")")?;
            return Some(vec![f64::from(f32::from_bits(*bits.first()? as u32))]);
        }
        for (open, close) in [("(", ")"), ("[", "]")] {
            if self.takes(open) {
                return self.list(close);
            }
        }
        let text = self.rest.trim_start();
        let exponent_sign = |i: usize, c: char| {
            let marks = if text.starts_with("0x") { ['p', 'P'] } else { ['e', 'E'] };
            c == '-' && text.starts_with(|c: char| c.is_ascii_digit()) && text[..i].ends_with(marks)
        };
        let is_part = |i: usize, c: char| c.is_alphanumeric() || "_.:".contains(c) || exponent_sign(i, c);
        let end = text.char_indices().find(|(i, c)| !is_part(*i, *c)).map_or(text.len(), |(i, _)| i);
        let word = &text[..end];
        self.rest = &text[end..];
        if self.takes("(") {
            return word.to_lowercase().starts_with("vec").then(|| self.list(")"))?;
        }
        number(word).map(|v| vec![v]).or_else(|| (self.named)(word))
    }

    /// Numbers between commas.
    fn list(&mut self, close: &str) -> Option<Vec<f64>> {
        let mut values = vec![];
        while !self.takes(close) {
            values.extend(self.shift()?);
            self.takes(",");
        }
        Some(values)
    }
}

fn scalars(a: Vec<f64>, b: Vec<f64>, f: impl Fn(f64, f64) -> f64) -> Option<Vec<f64>> {
    let (&[a], &[b]) = (&a[..], &b[..]) else { return None };
    Some(vec![f(a, b)])
}

/// A literal of Rust or WGSL; of floats in hexadecimal, powers of two.
fn number(word: &str) -> Option<f64> {
    let word = word.replace('_', "");
    if let Some(hex) = word.strip_prefix("0x") {
        return match hex.trim_end_matches('f').split_once('p') {
            Some(("1", exponent)) => Some(exponent.parse::<f64>().ok()?.exp2()),
            Some(_) => None,
            None => Some(f64::from(u32::from_str_radix(hex.trim_end_matches('u'), 16).ok()?)),
        };
    }
    word.starts_with(|c: char| c.is_ascii_digit()).then(|| word.trim_end_matches(['f', 'u', 'i']).parse().ok())?
}

/// Constants of the modules of one language.
struct Side {
    language: &'static str,
    modules: BTreeMap<String, Constants>,
}

impl Side {
    /// Value of a constant of a module, or of the module that it takes it from.
    fn value(&self, module: &str, name: &str) -> Option<Vec<f64>> {
        let own = self.modules.get(module).and_then(|constants| Some((module, constants.get(name)?)));
        let mut others = self.modules.iter();
        let (module, text) =
            own.or_else(|| others.find_map(|(module, constants)| Some((&**module, constants.get(name)?))))?;
        Expression::value(text, &|name| self.value(module, name))
    }
}

fn is_equal(a: &[f64], b: &[f64]) -> bool {
    // Both languages round to 24 bits, and at other places.
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 2e-7 * a.abs().max(b.abs()))
}

/// Constants that one twin lacks, and those of other values. `one_sided`: exceptions, whose use is counted.
fn differences(rust: &Side, wgsl: &Side, uses: &mut [usize], one_sided: &[[&str; 4]]) -> Vec<String> {
    let mut found = vec![];
    for (module, constants) in &wgsl.modules {
        let twin = rust.modules.get(module).cloned().unwrap_or_default();
        let mut lacking = |side: &Side, name: &str| {
            let is_excepted = |e: &[&str; 4]| e[0] == module && e[1] == side.language && name.starts_with(e[2]);
            match one_sided.iter().position(is_excepted) {
                Some(at) => uses[at] += 1,
                None => found.push(format!("{module}: {name} is in .{} alone", side.language)),
            }
        };
        constants.keys().filter(|name| !twin.contains_key(*name)).for_each(|name| lacking(wgsl, name));
        twin.keys().filter(|name| !constants.contains_key(*name)).for_each(|name| lacking(rust, name));
        for name in constants.keys().filter(|name| twin.contains_key(*name)) {
            match (rust.value(module, name), wgsl.value(module, name)) {
                (Some(a), Some(b)) if is_equal(&a, &b) => {}
                (a, b) => found.push(format!("{module}: {name} is {a:?} in Rust and {b:?} in WGSL")),
            }
        }
    }
    found
}

#[test]
fn twins_have_the_same_constants() {
    let tree = Tree::read();
    let files: Vec<_> = tree.files("shaders/lib/", &[".wgsl"]).collect();
    let stem = |path: &str| path["shaders/lib/".len()..].trim_end_matches(".wgsl").to_owned();
    let of_wgsl = |path: &&str| (stem(path), constants(&read(path)));
    let wgsl = Side { language: "wgsl", modules: files.iter().map(of_wgsl).collect() };
    let of_rust = |path: &&str| (stem(path), constants(&read(&format!("src/kernel/{}.rs", stem(path)))));
    let rust = Side { language: "rs", modules: files.iter().map(of_rust).collect() };
    let count: usize = wgsl.modules.values().map(Constants::len).sum();
    println!("{count} constants in {} modules", files.len());
    assert!(count > 150);
    let mut uses = [0; ONE_SIDED.len()];
    let mut violations = differences(&rust, &wgsl, &mut uses, &ONE_SIDED);
    let unused = ONE_SIDED.iter().zip(uses).filter(|(_, uses)| *uses == 0);
    violations.extend(unused.map(|(e, _)| format!("{}: no constant {}: remove the exception", e[0], e[2])));
    expect_none("constants of twins", &violations);
}

#[test]
fn a_constant_that_differs_is_found() {
    let side = |language, source: &str| Side { language, modules: [("m".to_owned(), constants(source))].into() };
    let rust = "pub const STEPS: f32 = 7.0;\nconst LEAST: f32 = 0.5 / STEPS;\npub(super) const PAIR: [f32; 2] = [0.6, -1e-3];\n\
        const BITS: u32 = 63 << 4;\nconst TINY: f32 = f32::from_bits((127 - 100) << 23);\nimpl A {\n    const B: u32 = 1;\n}\n";
    let wgsl = "const STEPS: f32 = 7.0;\nconst LEAST: f32 = 0.5f / STEPS;\nconst PAIR: vec2f = vec2f(0.6, -1e-3);\n\
        const BITS = 1008u;\nconst TINY: f32 = 0x1p-100f;\nfn a() { const C = 1; }\n";
    let found = |wgsl: &str| differences(&side("rs", rust), &side("wgsl", wgsl), &mut [], &[]);
    assert_eq!(found(wgsl), [""; 0]);
    let planted = [
        (
            "STEPS: f32 = 7.0",
            "STEPS: f32 = 8.0",
            "m: LEAST is Some([0.07142857142857142]) in Rust and Some([0.0625]) in WGSL",
        ),
        ("LEAST", "LOWEST", "m: LOWEST is in .wgsl alone"),
        ("const BITS = 1008u;", "", "m: BITS is in .rs alone"),
        ("-1e-3", "-1.001e-3", "m: PAIR is Some([0.6, -0.001]) in Rust and Some([0.6, -0.001001]) in WGSL"),
        ("vec2f(0.6, -1e-3)", "g()", "m: PAIR is Some([0.6, -0.001]) in Rust and None in WGSL"),
    ];
    for (right, wrong, expected) in planted {
        assert!(found(&wgsl.replacen(right, wrong, 1)).contains(&expected.to_owned()), "{wrong}: {:?}", found(wgsl));
    }
}
