//! Batches: points that are measured on the same frames, one after the other in each frame.

use crate::args::input::{InputArgs, SourceName};
use crate::args::pattern::SamplingName;
use crate::args::{FilterName, MethodName};
use crate::commands::run::RunArgs;
use crate::failure::Failure;
use crate::sweep::{Options, Point};
use afterimage::internal::{FoveationKind, MethodKind};
use std::collections::BTreeMap;

/// Limit on points per batch: an interrupted sweep loses at most one batch.
const MAX_POINTS: usize = 24;
/// Limit on pixels per batch, summed over its points, whose histories are in memory at the same time.
const MAX_PIXELS: u64 = 24_000_000;

/// The method that an option affects, or all that keep history (`Some(None)`); `None` if it affects the input frames.
fn method_of(option: &str) -> Option<Option<MethodKind>> {
    Some(match option {
        "no-gate" => Some(MethodKind::Wrs),
        "no-relight" => Some(MethodKind::Smr),
        // The last one is another name of the third.
        "depth-relative" | "depth-slope" | "no-depth-test" | "no-flush" => None,
        _ if option.starts_with("wrs-") || option.starts_with("gate-") => Some(MethodKind::Wrs),
        _ if option.starts_with("smr-") => Some(MethodKind::Smr),
        _ => return None,
    })
}

/// Whether an option affects a method.
pub fn concerns(option: &str, method: &str) -> bool {
    let kind = MethodKind::from_name(method);
    match method_of(option) {
        Some(Some(only)) => kind == Some(only),
        Some(None) => kind.is_some_and(|kind| kind != MethodKind::None),
        None => true,
    }
}

/// A point, and its arguments for `run`.
pub struct Planned {
    pub point: Point,
    pub args: RunArgs,
    pub method: MethodName,
}

/// Points with the same input frames.
pub struct Batch {
    pub subjects: Vec<Planned>,
}

impl Planned {
    fn new(point: Point, common: &Options) -> Result<Self, Failure> {
        let mut words = vec!["--out=unused".to_owned(), format!("--seed={}", point.seed)];
        words.push(format!("--method={}", point.method));
        for (name, value) in common.iter().chain(&point.options) {
            words.push(if value.is_empty() { format!("--{name}") } else { format!("--{name}={value}") });
        }
        words.extend(["--".into(), point.input.clone()]);
        let args = RunArgs::from_words(&words)?;
        let &[method] = &args.method[..] else {
            return Err(Failure::Input(format!("method {}: expected one method per point", point.method)));
        };
        Ok(Self { point, args, method })
    }

    /// Key of a batch: points with the same key have the same input frames.
    fn key(&self) -> (String, Options, Option<u64>) {
        let mut options = self.point.options.clone();
        options.retain(|name, _| method_of(name).is_none());
        let traced = self.args.input.source == Some(SourceName::Trace);
        (self.point.input.clone(), options, traced.then_some(self.point.seed))
    }

    /// Samples per pixel of a full-rate frame with the fovea's quality; 1 if a simulator foveates.
    pub fn full_rate_samples(&self) -> u32 {
        match self.args.sampling.sampling {
            SamplingName::Uniform if self.args.foveation.filter() != FilterName::Of(FoveationKind::Off) => 1,
            _ => self.args.sampling.most_samples(self.args.input.spp),
        }
    }
}

/// Whether the result depends on the seed.
pub fn is_random<'a>(method: &str, options: impl IntoIterator<Item = (&'a String, &'a String)>) -> bool {
    method == MethodKind::Wrs.name() || options.into_iter().any(|(name, value)| name == "source" && value == "trace")
}

/// Groups points into batches. The order does not depend on finished points.
pub fn batches(
    points: Vec<Point>,
    common: &Options,
    mut pixels: impl FnMut(&InputArgs) -> Result<u64, Failure>,
) -> Result<Vec<Batch>, Failure> {
    let mut groups: BTreeMap<_, Vec<Planned>> = BTreeMap::new();
    for point in points {
        let subject = Planned::new(point, common)?;
        groups.entry(subject.key()).or_default().push(subject);
    }
    let mut batches = vec![];
    for subjects in groups.into_values() {
        let max = (MAX_PIXELS / pixels(&subjects[0].args.input)?.max(1)).clamp(2, MAX_POINTS as u64) as usize;
        let mut rest = subjects.into_iter().peekable();
        while rest.peek().is_some() {
            batches.push(Batch { subjects: rest.by_ref().take(max).collect() });
        }
    }
    Ok(batches)
}
