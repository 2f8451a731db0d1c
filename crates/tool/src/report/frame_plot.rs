//! Plot of a quality by frame, one line a method, as SVG.

use super::plot::{
    FAINT, HIGH_PX, INK, LOW_PX, Mark, OF_JOD, OF_PSNR, Scale, axes, chars_from, document, legend, line, mark, px,
    reading, shortened, spread, text, visible,
};
use afterimage_lab::metric::psnr_db;
use svg::node::element::{Group, Path};

/// Visual angle between the gaze of two frames from which it counts as a jump.
const JUMP_DEG: f32 = 2.0;

/// Room between the plot area's border and the first and last frame.
const INSET_PX: f64 = 10.0;

/// Height of a row of exact frames, above the scale.
const ROW_PX: f64 = 14.0;

/// Least distance of marks along a line.
const MARKS_PX: f64 = 56.0;

/// Position of the marks of labels, right of the plot area.
const LABEL_PX: f64 = HIGH_PX[0] + 14.0;

/// Width of a title's character in characters of notes, whose font is smaller.
const TITLE_CHARS: f64 = 1.35;

/// What a plot shows of each frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// PSNR, of values that are mean squared errors.
    Psnr,
    /// JOD, of values that are JOD.
    Jod,
}

impl Quantity {
    /// Name in titles.
    fn name(self) -> &'static str {
        match self {
            Self::Psnr => "PSNR",
            Self::Jod => "JOD",
        }
    }

    /// Name of the axis.
    fn axis(self) -> &'static str {
        match self {
            Self::Psnr => "PSNR, dB; higher is better",
            Self::Jod => "JOD; higher is better, 10 is no visible difference",
        }
    }

    /// Least length and end of the axis.
    fn least(self) -> [f64; 2] {
        match self {
            Self::Psnr => OF_PSNR,
            Self::Jod => OF_JOD,
        }
    }

    /// CSS class of the plot.
    fn class(self) -> &'static str {
        match self {
            Self::Psnr => "psnr",
            Self::Jod => "jod",
        }
    }

    /// What a value is on the scale, if it has a place there.
    fn shown(self, value: f64) -> Option<f64> {
        match self {
            Self::Psnr => psnr_db(value),
            Self::Jod => Some(value),
        }
        .filter(|v| v.is_finite())
    }

    /// Whether a value has its place in the row of exact frames.
    fn is_exact(self, value: f64) -> bool {
        self == Self::Psnr && value == 0.0
    }
}

/// The values of a method.
#[derive(Clone, Copy, Debug)]
pub struct Series<'a> {
    /// Name in the legend.
    pub name: &'a str,
    /// Method whose mark it has.
    pub mark: &'a str,
    /// Value of each frame.
    pub values: &'a [f64],
}

/// A clip, frame by frame.
pub struct FramePlot<'a> {
    /// What is shown.
    pub quantity: Quantity,
    /// Name of the input.
    pub input: &'a str,
    /// What the frames are, such as `quads 8 and 8`.
    pub what: &'a str,
    /// The first line of the notes.
    pub note: &'a str,
    /// Frames a second.
    pub fps: f32,
    /// Angle between the gaze of each frame and of the one before, degrees; 0 for the first.
    pub moves_deg: &'a [f32],
    /// The methods.
    pub series: &'a [Series<'a>],
}

/// A method's values: a point a frame, in a scale or in the row of exact frames.
struct Curve<'a> {
    method: &'a str,
    mark: &'a str,
    /// Height of each frame's point; `None` where the frame is exact or its error is not a number.
    heights: Vec<Option<f64>>,
    /// Whether each frame is exact.
    exact: Vec<bool>,
    /// Height of the row of exact frames.
    row: f64,
}

impl FramePlot<'_> {
    /// The plot. The first frame is a cut.
    pub fn svg(&self) -> String {
        let count = self.series.iter().map(|series| series.values.len()).max().unwrap_or(0);
        let x = Scale::counting(count, LOW_PX[0] + INSET_PX, HIGH_PX[0] - INSET_PX);
        let quantity = self.quantity;
        let has_exact = |series: &&Series<'_>| series.values.iter().any(|v| quantity.is_exact(*v));
        let rows = self.series.iter().filter(has_exact).count();
        let top = LOW_PX[1] + ROW_PX * rows as f64 + if rows > 0 { 8.0 } else { 0.0 };
        let y = Scale::new(
            self.series.iter().flat_map(|series| series.values.iter().filter_map(|v| quantity.shown(*v))),
            false,
            HIGH_PX[1],
            top,
        )
        .of_at_least(quantity.least());
        let curves = self.curves(&y);
        let jumps: Vec<usize> = (0..count).filter(|&i| self.moves_deg.get(i).is_some_and(|d| *d > JUMP_DEG)).collect();
        let stride = (MARKS_PX / (x.px(1.0) - x.px(0.0)).max(f64::MIN_POSITIVE)).ceil().max(1.0) as usize;

        let along = format!("frames; above: seconds at {} frames a second", self.fps);
        let mut plot = Group::new().add(legend(self.series.iter().map(|series| (series.name, series.mark))));
        plot = plot.add(axes(&x, &y, &along, quantity.axis())).add(seconds(&x, self.fps));
        if rows > 0 {
            let at = [LOW_PX[0] - 8.0, 0.5 * (LOW_PX[1] + top) + 0.5];
            plot = plot.add(text("exact", at, "end").set("class", "ink"));
        }
        plot = plot.add(ticks(&jumps, &x));
        for (i, curve) in curves.iter().enumerate() {
            plot = plot.add(curve.draw(&x, stride, i * stride / curves.len()));
        }
        plot = plot.add(labels(&curves, &x));
        let (notes, height) = reading(&self.notes(&curves, jumps.len(), stride), HIGH_PX[1] + 68.0);
        document(quantity.class(), &self.title(), height, plot.add(notes))
    }

    fn title(&self) -> String {
        let what = format!(": {} by frame, {}", self.quantity.name(), visible(self.what));
        let room = (chars_from(LOW_PX[0]) as f64 / TITLE_CHARS) as usize;
        shortened(&visible(self.input), room.saturating_sub(what.chars().count()).max(8)) + &what
    }

    fn curves(&self, y: &Scale) -> Vec<Curve<'_>> {
        let mut next_row = LOW_PX[1] + 0.5 * ROW_PX + 2.0;
        let mut curves = vec![];
        for &Series { name: method, mark, values } in self.series {
            let heights = values.iter().map(|&v| self.quantity.shown(v).map(|v| px(y.px(v)))).collect();
            let exact: Vec<bool> = values.iter().map(|&v| self.quantity.is_exact(v)).collect();
            let row = next_row;
            next_row += if exact.contains(&true) { ROW_PX } else { 0.0 };
            curves.push(Curve { method, mark, heights, exact, row });
        }
        curves
    }

    fn notes(&self, curves: &[Curve<'_>], jumps: usize, stride: usize) -> Vec<String> {
        let mut notes = vec![
            self.note.to_owned(),
            match stride {
                1 => "marks: the methods, as in the legend".into(),
                _ => format!("marks: the methods, as in the legend; each at one frame in {stride}"),
            },
            match jumps {
                0 => format!("the gaze never moves by more than {JUMP_DEG} degrees from a frame to the next"),
                _ => format!(
                    "dotted, with a tick at the bottom: the gaze is more than {JUMP_DEG} degrees from that of the frame before (saccades; {jumps} frames)"
                ),
            },
        ];
        if curves.iter().any(|c| c.exact.contains(&true)) {
            notes.push(
                "exact, at the top: frames without any error, whose PSNR is infinite; the lines have gaps there".into(),
            );
        }
        if curves.iter().any(Curve::has_unknown) {
            notes.push("other gaps: frames whose error is no number".into());
        }
        notes
    }
}

impl Curve<'_> {
    /// The line, with marks at every `stride`th frame from `first` on, and at points without a line.
    fn draw(&self, x: &Scale, stride: usize, first: usize) -> Group {
        let Mark { color, class, .. } = Mark::of(self.mark);
        let known = |i: Option<usize>| i.and_then(|i| self.heights.get(i).copied().flatten());
        let at = |i: usize| px(x.px(i as f64));
        let mut group = Group::new().set("class", "curve").set("data-method", visible(self.method));
        let (mut path, mut marks) = (String::new(), vec![]);
        for i in 0..self.heights.len() {
            let (before, after) = (known(i.checked_sub(1)), known(Some(i + 1)));
            let is_exact = |i: Option<usize>| i.is_some_and(|i| self.exact.get(i) == Some(&true));
            if let Some(y) = known(Some(i)) {
                path += &format!("{}{} {y}", if before.is_some() { 'L' } else { 'M' }, at(i));
                if i % stride == first || before.is_none() && after.is_none() {
                    marks.push([at(i), y]);
                }
            } else if is_exact(Some(i)) && (i % stride == first || !is_exact(i.checked_sub(1))) {
                marks.push([at(i), self.row]);
            }
        }
        let line_of = |path: String| Path::new().set("d", path).set("fill", "none").set("stroke", color);
        if !path.is_empty() {
            group = group.add(
                line_of(path)
                    .set("stroke-width", 1.8)
                    .set("stroke-linejoin", "round")
                    .set("class", format!("line {class}")),
            );
        }
        for (from, to) in runs(&self.exact) {
            let bar = line([at(from), self.row], [at(to), self.row], color).set("stroke-width", 1.8);
            group = group.add(bar.set("class", format!("line {class} exact")));
        }
        marks.into_iter().fold(group, |group, at| group.add(mark(self.mark, at, true)))
    }

    /// The last point that is drawn: its frame and height.
    fn end(&self) -> Option<(usize, f64)> {
        let point = |i: usize| self.heights[i].or_else(|| self.exact[i].then_some(self.row));
        (0..self.heights.len()).rev().find_map(|i| Some((i, point(i)?)))
    }

    fn has_unknown(&self) -> bool {
        self.heights.iter().zip(&self.exact).any(|(height, exact)| height.is_none() && !exact)
    }
}

/// First and last index of each run of `true`.
fn runs(of: &[bool]) -> Vec<(usize, usize)> {
    let starts = (0..of.len()).filter(|&i| of[i] && !i.checked_sub(1).is_some_and(|j| of[j]));
    starts.map(|i| (i, i + of[i..].iter().take_while(|v| **v).count() - 1)).collect()
}

/// A label for each method, beside the end of its line.
fn labels(curves: &[Curve<'_>], x: &Scale) -> Group {
    let ends: Vec<(&Curve<'_>, (usize, f64))> = curves.iter().filter_map(|c| Some((c, c.end()?))).collect();
    let heights: Vec<f64> = ends.iter().map(|(_, (_, y))| *y).collect();
    let places = spread(&heights, LOW_PX[1] + 6.0, HIGH_PX[1] - 6.0);
    let mut labels = Group::new().set("class", "labels");
    for ((curve, (frame, from)), y) in ends.into_iter().zip(places) {
        let (color, y) = (Mark::of(curve.mark).color, px(y));
        let leader = line([px(x.px(frame as f64)), from], [LABEL_PX, y], color).set("stroke-dasharray", "2 2");
        let name_at = LABEL_PX + 11.0;
        let name = text(&shortened(&visible(curve.method), chars_from(name_at)), [name_at, y + 4.5], "start");
        labels = labels.add(leader).add(mark(curve.mark, [LABEL_PX, y], true)).add(name.set("class", "ink"));
    }
    labels
}

/// The second scale: seconds, at the top.
fn seconds(x: &Scale, fps: f32) -> Group {
    let scale = x.in_unit(1.0 / f64::from(fps));
    scale.ticks().into_iter().fold(Group::new().set("class", "seconds"), |group, (value, name)| {
        let at = px(scale.px(value));
        let name = text(&format!("{name} s"), [at, LOW_PX[1] - 5.0], "middle").set("fill", FAINT).set("font-size", 11);
        group.add(line([at, LOW_PX[1]], [at, LOW_PX[1] + 5.0], FAINT)).add(name)
    })
}

/// A tick and a dotted line at every frame to which the gaze jumped.
fn ticks(jumps: &[usize], x: &Scale) -> Group {
    jumps.iter().fold(Group::new().set("class", "jumps"), |group, &frame| {
        let at = px(x.px(frame as f64));
        let dotted = line([at, LOW_PX[1]], [at, HIGH_PX[1]], FAINT).set("stroke-dasharray", "1 4");
        group.add(dotted).add(line([at, HIGH_PX[1] - 10.0], [at, HIGH_PX[1]], INK).set("stroke-width", 1.5))
    })
}
