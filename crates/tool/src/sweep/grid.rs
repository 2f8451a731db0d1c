//! Points of a sweep: every combination of its axes, and switches changed one at a time.

use afterimage_lab::error::InputError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Options of `afterimage run` by name, without dashes; the value of a flag is empty.
pub type Options = BTreeMap<String, String>;

/// A method on an input.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Point {
    /// Input of `run`: a still, a folder of frames or a scene.
    pub input: String,
    /// Name of the method.
    pub method: String,
    /// Options of this point, without those that all points of the sweep share.
    pub options: Options,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Options that vary together, and their values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Axis {
    /// Names of the options.
    pub options: Vec<String>,
    /// Rows with one value per option. `None`: the option is left out.
    pub values: Vec<Vec<Option<String>>>,
}

/// The axes of a sweep.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Grid {
    /// Every combination of these values is a point.
    pub axes: Vec<Axis>,
    /// Each of these is changed alone, with the first value of every axis but the method.
    pub switches: Vec<(String, Option<String>)>,
}

const EXPECTED_AXIS: &str = "expected NAME=VALUE,VALUE,... with the name of an option of run, or NAME+NAME=VALUE+VALUE,... for options that vary together";

impl Axis {
    /// Reads `fovea=5,10`, `rate-mid+rate-far=2+4,8+16`, `no-gate=-,on`, or `region-spp=32,16,8;2,2,2`: values that
    /// contain commas are separated by semicolons.
    ///
    /// # Errors
    /// If the text has another form.
    pub fn parse(text: &str) -> Result<Self, InputError> {
        let wrong =
            |problem: String| InputError::request(format!("--axis {}", text.escape_debug()), problem, EXPECTED_AXIS);
        let (names, values) = text.split_once('=').ok_or_else(|| wrong("has no =".into()))?;
        let separator = if values.contains(';') { ';' } else { ',' };
        let values = values.split(separator).map(str::trim).filter(|v| !v.is_empty());
        Self::new(names, values).map_err(wrong)
    }

    /// Creates an axis from option names joined by `+` and a list of values.
    ///
    /// # Errors
    /// If a name or the number of values is wrong.
    pub fn new<'a>(names: &str, values: impl IntoIterator<Item = &'a str>) -> Result<Self, String> {
        let options: Vec<String> = names.split('+').map(|n| n.trim().trim_start_matches('-').to_owned()).collect();
        if options.iter().any(|o| !o.bytes().all(|b| b.is_ascii_lowercase() || b == b'-') || o.is_empty()) {
            return Err(format!("'{}' is not the name of an option", names.escape_debug()));
        }
        let rows = values.into_iter().map(|value| {
            let parts: Vec<_> = value.split('+').map(|v| setting(v.trim())).collect();
            let (found, expected) = (parts.len(), options.len());
            (found == expected)
                .then_some(parts)
                .ok_or_else(|| format!("'{}' has {found} values for {expected} options", value.escape_debug()))
        });
        let values = rows.collect::<Result<Vec<_>, _>>()?;
        if values.is_empty() {
            return Err("has no values".into());
        }
        Ok(Self { options, values })
    }
}

/// Parses the value of an option: `-` leaves it out, `on` sets a flag. (`off` is a value of `foveation`.)
fn setting(value: &str) -> Option<String> {
    match value {
        "-" => None,
        "on" => Some(String::new()),
        value => Some(value.to_owned()),
    }
}

/// Parses a switch such as `no-gate` or `wrs-bias=none`.
pub fn parse_switch(text: &str) -> (String, Option<String>) {
    let (name, value) = text.split_once('=').unwrap_or((text, "on"));
    (name.trim().trim_start_matches('-').to_owned(), setting(value.trim()))
}

impl Grid {
    /// The points for inputs and seeds, without duplicates. Options are dropped unless
    /// `concerns(option, method)`, and further seeds unless `is_random(method, options)`, since they would not
    /// change the result.
    pub fn points(
        &self,
        inputs: &[String],
        seeds: u64,
        concerns: impl Fn(&str, &str) -> bool,
        is_random: impl Fn(&str, &Options) -> bool,
    ) -> Vec<Point> {
        let mut points = vec![];
        let mut add = |input: &String, options: &Options| {
            let mut options = options.clone();
            let method = options.remove("method").unwrap_or_else(|| "smr".into());
            options.retain(|name, _| concerns(name, &method));
            for seed in 0..if is_random(&method, &options) { seeds.max(1) } else { 1 } {
                let point = Point { input: input.clone(), method: method.clone(), options: options.clone(), seed };
                if !points.contains(&point) {
                    points.push(point);
                }
            }
        };
        let combinations = self.combinations(|_| true);
        let bases = self.combinations(|axis| axis.options == ["method"]);
        for input in inputs {
            for options in &combinations {
                add(input, options);
            }
            for (base, (name, value)) in bases.iter().flat_map(|base| self.switches.iter().map(move |s| (base, s))) {
                if concerns(name, base.get("method").map_or("smr", String::as_str)) {
                    let mut options = base.clone();
                    put(&mut options, name, value.as_ref());
                    add(input, &options);
                }
            }
        }
        points
    }

    /// Every combination of the values of the axes that vary, with the first value of the others.
    fn combinations(&self, varies: impl Fn(&Axis) -> bool) -> Vec<Options> {
        self.axes.iter().fold(vec![Options::new()], |so_far, axis| {
            let rows = if varies(axis) { &axis.values[..] } else { &axis.values[..1] };
            let with = |options: &Options, row: &Vec<Option<String>>| {
                let mut options = options.clone();
                for (name, value) in axis.options.iter().zip(row) {
                    put(&mut options, name, value.as_ref());
                }
                options
            };
            so_far.iter().flat_map(|options| rows.iter().map(move |row| with(options, row))).collect()
        })
    }
}

fn put(options: &mut Options, name: &str, value: Option<&String>) {
    match value {
        Some(value) => options.insert(name.to_owned(), value.clone()),
        None => options.remove(name),
    };
}

impl Point {
    /// The command line of `run` for the point, without `--out`.
    pub fn command(&self, common: &Options) -> String {
        let mut words = vec!["afterimage run".to_owned(), quoted(&self.input), format!("--method {}", self.method)];
        let seed = (self.seed > 0).then(|| ("seed".to_owned(), self.seed.to_string()));
        for (name, value) in common.iter().chain(&self.options).chain(seed.iter().map(|(n, v)| (n, v))) {
            words.push(if value.is_empty() { format!("--{name}") } else { format!("--{name} {}", quoted(value)) });
        }
        words.join(" ")
    }
}

/// A word quoted for a shell.
pub fn quoted(word: &str) -> String {
    let plain = |b: u8| b.is_ascii_alphanumeric() || b"-_./:,+=@%".contains(&b);
    if !word.is_empty() && word.bytes().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// The command line, quoted for a shell.
pub fn command_line() -> String {
    let arguments = std::env::args().skip(1).map(|word| quoted(&word));
    ["afterimage".to_owned()].into_iter().chain(arguments).collect::<Vec<_>>().join(" ")
}
