//! The plot of PSNR by frame: points where the axes say, gaps, labels, saccades.

use super::drawn::{assert_ends_before_the_border, has_text, mark_at, number, points, with_class};
use afterimage_cli::report::frame_plot::{FramePlot, Quantity, Series};
use resvg::usvg::roxmltree::{Document, Node};

const FPS: f32 = 50.0;

fn svg(methods: &[(&str, &[f64])], moves_deg: &[f32]) -> String {
    plot("sponza", "sparse 2 and 4", methods, moves_deg)
}

fn plot(input: &str, what: &str, methods: &[(&str, &[f64])], moves_deg: &[f32]) -> String {
    plot_of(Quantity::Psnr, input, what, methods, moves_deg)
}

fn plot_of(quantity: Quantity, input: &str, what: &str, methods: &[(&str, &[f64])], moves_deg: &[f32]) -> String {
    let series: Vec<_> = methods.iter().map(|&(name, values)| Series { name, mark: name, values }).collect();
    FramePlot { quantity, input, what, note: "errors", fps: FPS, moves_deg, series: &series }.svg()
}

/// Mean squared error of a PSNR.
fn mse(db: f64) -> f64 {
    10.0_f64.powf(-0.1 * db)
}

fn rising(from_db: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| mse(from_db + 8.0 * (1.0 - 0.9_f64.powi(i as i32)))).collect()
}

/// Values and positions of an axis' ticks: `x` or `y`.
fn ticks(document: &Document<'_>, axis: &str) -> Vec<(f64, f64)> {
    let anchor = if axis == "x" { "middle" } else { "end" };
    let tick = |n: Node<'_, '_>| Some((n.text()?.trim().parse().ok()?, number(&n, axis)));
    let axes = with_class(document, "axes").next().unwrap();
    axes.descendants().filter(|n| n.attribute("text-anchor") == Some(anchor)).filter_map(tick).collect()
}

/// Position of a value by the axis' first and last tick.
fn place(ticks: &[(f64, f64)], value: f64) -> f64 {
    let [(v0, p0), (v1, p1)] = [ticks[0], ticks[ticks.len() - 1]];
    p0 + (value - v0) / (v1 - v0) * (p1 - p0)
}

fn curve<'a>(document: &'a Document<'_>, method: &str) -> Node<'a, 'a> {
    with_class(document, "curve").find(|n| n.attribute("data-method") == Some(method)).unwrap()
}

/// Points of a method's line, without its marks.
fn line(document: &Document<'_>, method: &str) -> Vec<[f64; 2]> {
    let is_line = |n: &Node<'_, '_>| n.tag_name().name() == "path" && n.attribute("fill") == Some("none");
    curve(document, method).children().find(is_line).map_or_else(Vec::new, |n| points(n.attribute("d").unwrap()))
}

fn is_mark(node: &Node<'_, '_>) -> bool {
    node.attribute("class").is_some_and(|c| c.starts_with("mark "))
}

fn marks(document: &Document<'_>, method: &str) -> Vec<[f64; 2]> {
    curve(document, method).children().filter(is_mark).map(|n| mark_at(&n)).collect()
}

#[test]
fn points_are_where_the_axes_say() {
    for count in [2, 7, 48, 500] {
        let [none, smr] = [20.0, 27.5].map(|db| rising(db, count));
        let svg = svg(&[("none", &none), ("smr", &smr)], &vec![0.0; count]);
        let document = Document::parse(&svg).unwrap();
        let [x, y] = ["x", "y"].map(|axis| ticks(&document, axis));
        assert!(x.len() >= 2 && y.len() >= 3 && x.iter().all(|(frame, _)| frame.fract() == 0.0), "{x:?} {y:?}");
        for (method, errors) in [("none", &none), ("smr", &smr)] {
            let line = line(&document, method);
            assert_eq!(line.len(), count);
            for (frame, (at, error)) in line.iter().zip(errors).enumerate() {
                let db = -10.0 * error.log10();
                // Numbers are written 4.5 pixels below the height that they name, and positions are rounded to tenths.
                let expected = [place(&x, frame as f64), place(&y, db) - 4.5];
                let off = [0, 1].map(|i| (at[i] - expected[i]).abs());
                assert!(off[0] < 0.5 && off[1] < 0.5, "{method} {frame} of {count}: {at:?} is not at {expected:?}");
            }
            assert!(line[count - 1][1] < line[0][1], "up is more");
            // Marks lie on the line.
            let marks = marks(&document, method);
            assert!(!marks.is_empty() && marks.iter().all(|m| line.contains(m)), "{marks:?}");
        }
        let seconds = with_class(&document, "seconds").next().unwrap();
        let second =
            |n: Node<'_, '_>| Some((n.text()?.trim().strip_suffix(" s")?.parse::<f64>().ok()?, number(&n, "x")));
        let found: Vec<_> = seconds.descendants().filter(Node::is_element).filter_map(second).collect();
        assert!(found.len() >= 2);
        assert!(found.iter().all(|(s, at)| (place(&x, s * f64::from(FPS)) - at).abs() < 0.5), "{found:?} {x:?}");
    }
}

/// Lines that differ by a fifth of the least range are no farther apart, wherever they are.
#[test]
fn small_differences_do_not_fill_the_plot() {
    for (quantity, value, least) in [(Quantity::Psnr, mse as fn(f64) -> f64, 1.0), (Quantity::Jod, |jod| jod, 0.5)] {
        for high in [9.99, 5.0, 0.1] {
            let low = [value(high - 0.2 * least * 0.5), value(high - 0.2 * least)];
            let methods: [(&str, &[f64]); 2] = [("none", &low), ("smr", &[value(high), value(high)])];
            let svg = plot_of(quantity, "sponza", "quads 4 and 8", &methods, &[0.0; 2]);
            let document = Document::parse(&svg).unwrap();
            let y = ticks(&document, "y");
            let apart = line(&document, "none")[1][1] - line(&document, "smr")[1][1];
            let unit = (place(&y, 1.0) - place(&y, 0.0)).abs();
            let axis = with_class(&document, "axis").last().unwrap();
            let height = (number(&axis, "y2") - number(&axis, "y1")).abs();
            println!("{quantity:?} {high}: {apart} of {height} px, {unit} px a unit");
            assert!((apart - 0.2 * least * unit).abs() < 1.0, "the axis says how much it is");
            assert!((0.1..0.21).contains(&(apart / height)), "{quantity:?} {high}: {apart} of {height}");
            let last = y.iter().map(|tick| tick.0).fold(f64::NEG_INFINITY, f64::max);
            assert!(quantity == Quantity::Psnr || last <= 10.0, "there is no JOD of {last}");
        }
    }
}

#[test]
fn exact_frames_are_gaps_and_marks_at_the_top() {
    let mut errors = rising(25.0, 12);
    (errors[4], errors[5], errors[8]) = (0.0, 0.0, f64::NAN);
    let plain = rising(20.0, 12);
    let svg = svg(&[("oracle", &errors), ("none", &plain)], &[0.0; 12]);
    assert!(!svg.contains("NaN") && !svg.contains("inf\""));
    let document = Document::parse(&svg).unwrap();
    let curve = curve(&document, "oracle");
    let path = curve.children().find(|n| n.attribute("fill") == Some("none")).unwrap().attribute("d").unwrap();
    let parts: Vec<usize> = path.split('M').skip(1).map(|part| part.split('L').count()).collect();
    assert_eq!(parts, [4, 2, 3], "a line before, between and behind the gaps");
    let bar = with_class(&document, "exact").next().unwrap();
    let x = ticks(&document, "x");
    for (name, frame) in [("x1", 4.0), ("x2", 5.0)] {
        assert!((number(&bar, name) - place(&x, frame)).abs() < 0.5);
    }
    let highest = line(&document, "oracle").iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
    assert!(number(&bar, "y1") < highest - 4.0, "above the scale");
    assert!(marks(&document, "oracle").iter().any(|m| m[1] == number(&bar, "y1")));
    assert!(has_text(&document, "PSNR is infinite") && has_text(&document, "error is no number"));
    let document_without = self::svg(&[("none", &plain)], &[0.0; 12]);
    assert!(!document_without.contains("infinite") && !document_without.contains("no number"), "nothing to explain");
}

#[test]
fn jumps_of_the_gaze_have_ticks_and_a_note() {
    let errors = rising(22.0, 20);
    let mut moves = vec![0.3; 20];
    (moves[6], moves[7], moves[11]) = (2.1, 9.0, 1.9);
    let drawn = svg(&[("smr", &errors)], &moves);
    let document = Document::parse(&drawn).unwrap();
    let x = ticks(&document, "x");
    let jumps = with_class(&document, "jumps").next().unwrap();
    let at: Vec<f64> =
        jumps.children().filter(|n| n.attribute("stroke-width").is_some()).map(|n| number(&n, "x1")).collect();
    assert_eq!(at.len(), 2, "only moves of more than 2 degrees");
    assert!((at[0] - place(&x, 6.0)).abs() < 0.5 && (at[1] - place(&x, 7.0)).abs() < 0.5, "{at:?}");
    assert!(has_text(&document, "saccades; 2 frames"));
    let still = svg(&[("smr", &errors)], &[0.0; 20]);
    assert!(!still.contains("saccades") && still.contains("never moves by more than 2 degrees"));
}

#[test]
fn names_are_text_and_fit() {
    let errors = rising(22.0, 5);
    let long = "a\u{1}<b>&\"'\u{fffe}".to_owned() + &"/folder".repeat(40);
    let method = "<i>&".to_owned() + &"x".repeat(300);
    let svg = plot(&long, "gauss 8 and 16", &[(&method, &errors), ("smr", &errors)], &[0.0; 5]);
    let document = Document::parse(&svg).unwrap();
    assert!(has_text(&document, "<b>&\"'") && has_text(&document, "<i>&"), "names are text");
    assert!(has_text(&document, "…: PSNR by frame, gauss 8 and 16"), "the end of the title stays");
    assert_ends_before_the_border(&svg);
}
