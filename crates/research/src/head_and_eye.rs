//! What head and eye do in one gaze shift of about 60 degrees, as a plot: `cargo research head-and-eye [FILE.svg]`.
//!
//! Makes the plot of `docs/scanpaths.md`; a second.

use crate::error::AnyError;
use afterimage_lab::scanpath::{EventKind, HeadOptions, HeadTurn, Scanpath, SyntheticHead, generate_head, in_a_room};
use clap::Args;
use glam::{DQuat, DVec3};
use std::fmt::Write;
use std::path::PathBuf;

const RATE_HZ: f64 = 500.0;
/// Seconds before and after the begin of the shift.
const WINDOW_S: [f64; 2] = [-0.1, 0.65];
/// Left, right, and the heights of 0 and of the top, of both panels in pixels.
const ACROSS_PX: [f64; 2] = [70.0, 740.0];
const PANELS_PX: [[f64; 2]; 2] = [[290.0, 60.0], [470.0, 360.0]];
const CURVES: [(&str, &str); 3] = [("gaze in space", "#1b6ac9"), ("head", "#c9471b"), ("eye in head", "#1b8a5a")];

/// What head and eye do in one gaze shift of about 60 degrees, as a plot
#[derive(Args, Clone, Debug)]
pub struct HeadAndEyeArgs {
    /// The plot
    #[arg(value_name = "FILE.svg", default_value = "out/head_and_eye.svg")]
    pub plot: PathBuf,
}

pub fn bench(args: &HeadAndEyeArgs) -> Result<(), AnyError> {
    let file = &args.plot;
    let (made, turn) = (0..1000).find_map(find).ok_or("no such shift")?;
    let curves = curves(&made.path, &turn);
    let [gaze, head, eye] = [0, 1, 2].map(|i| curves.iter().map(|c| c.1[i]).fold(f64::MIN, f64::max));
    say!("gaze {gaze:.1} degrees, head {head:.1}, eye at most {eye:.1}; written to {}", file.display());
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder)?;
    }
    std::fs::write(file, svg(&curves)?)?;
    Ok(())
}

/// A level shift of 58 to 62 degrees by a head that has been at rest, and is not turned again soon.
fn find(seed: u64) -> Option<(SyntheticHead, HeadTurn)> {
    let options = HeadOptions { seed, duration_s: 30.0, rate_hz: RATE_HZ, ..HeadOptions::default() };
    let made = generate_head(&options, &in_a_room).ok()?;
    let is_wanted = |turn: &&HeadTurn| {
        let shift = made.events.iter().find(|e| e.kind == EventKind::Saccade && e.start_s == turn.gaze_start_s);
        let [from, to] = WINDOW_S.map(|s| turn.gaze_start_s + s);
        let others = made.turns.iter().filter(|t| t.start_s < to && t.end_s > from).count();
        let jumps = made.events.iter().filter(|e| e.kind == EventKind::Saccade && e.start_s > from && e.start_s < to);
        others == 1
            && jumps.count() == 1
            && from > 0.0
            && to < options.duration_s
            && turn.by_deg[1].abs() < 0.1 * turn.by_deg[0].abs()
            && shift.is_some_and(|e| (58.0..62.0).contains(&e.intended_deg))
    };
    let turn = *made.turns.iter().find(is_wanted)?;
    Some((made, turn))
}

/// Seconds from the shift's begin; angles of gaze, head and eye in its direction, from those at the begin.
fn curves(path: &Scanpath, turn: &HeadTurn) -> Vec<(f64, [f64; 3])> {
    let slope = path.screen().tangent_per_px().expect("a screen of known size");
    let side = turn.by_deg[0].signum();
    let azimuth = |d: DVec3| side * (-d.x).atan2(-d.z).to_degrees();
    let samples = path.samples().iter().zip(path.poses().expect("poses"));
    let angles: Vec<_> = samples
        .filter_map(|(sample, pose)| {
            let px = sample.px?;
            let [x, y] = [0, 1].map(|i| (f64::from(px[i]) - 1000.0) * slope[i]);
            let head = DQuat::from_array(pose.orientation.map(f64::from));
            let (gaze, head) = (azimuth(head * DVec3::new(x, -y, -1.0)), azimuth(head * DVec3::NEG_Z));
            Some((sample.t_s - turn.gaze_start_s, [gaze, head]))
        })
        .filter(|(t, _)| (WINDOW_S[0]..WINDOW_S[1]).contains(t))
        .collect();
    let start = angles.iter().rfind(|(t, _)| *t <= 0.0).map_or([0.0; 2], |a| a.1);
    let from_start = |a: [f64; 2]| [a[0] - start[0], a[1] - start[1]];
    angles.iter().map(|&(t, a)| (t, from_start(a))).map(|(t, [gaze, head])| (t, [gaze, head, gaze - head])).collect()
}

fn svg(curves: &[(f64, [f64; 3])]) -> Result<String, std::fmt::Error> {
    let mut svg = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 780 570\" font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"780\" height=\"570\" fill=\"#fff\"/>\n",
    );
    let x = |t: f64| {
        let share = (t - WINDOW_S[0]) / (WINDOW_S[1] - WINDOW_S[0]);
        ACROSS_PX[0] + share * (ACROSS_PX[1] - ACROSS_PX[0])
    };
    // Speeds over two samples, of 4 ms.
    let speeds: Vec<_> =
        curves.windows(3).map(|w| (w[1].0, [0, 1, 2].map(|i| (w[2].1[i] - w[0].1[i]) / (w[2].0 - w[0].0)))).collect();
    let panels = [("angle, degrees", curves, 20.0, 80.0), ("speed, degrees/s", &speeds[..], 200.0, 400.0)];
    for ((name, values, step, top), [zero_px, top_px]) in panels.into_iter().zip(PANELS_PX) {
        let y = |v: f64| zero_px + (top_px - zero_px) * v / top;
        let least = if step > 100.0 { -200.0 } else { 0.0 };
        let mut tick = least;
        while tick <= top {
            let at = y(tick);
            writeln!(svg, "<path d=\"M{} {at:.1}H{}\" stroke=\"#ddd\"/>", ACROSS_PX[0], ACROSS_PX[1])?;
            writeln!(
                svg,
                "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{tick}</text>",
                ACROSS_PX[0] - 8.0,
                at + 4.0
            )?;
            tick += step;
        }
        writeln!(svg, "<text x=\"{}\" y=\"{:.1}\">{name}</text>", ACROSS_PX[0], top_px - 12.0)?;
        for (i, (_, color)) in CURVES.iter().enumerate() {
            let points: Vec<_> = values.iter().map(|(t, v)| format!("{:.1},{:.1}", x(*t), y(v[i]))).collect();
            let points = points.join(" ");
            writeln!(svg, "<polyline points=\"{points}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\"/>")?;
        }
    }
    for (i, (name, color)) in CURVES.iter().enumerate() {
        let at = 330.0 + 140.0 * i as f64;
        writeln!(svg, "<path d=\"M{at} 24h22\" stroke=\"{color}\" stroke-width=\"3\"/>")?;
        writeln!(svg, "<text x=\"{}\" y=\"28\">{name}</text>", at + 28.0)?;
    }
    for t in [0.0, 0.2, 0.4, 0.6] {
        writeln!(svg, "<text x=\"{:.1}\" y=\"555\" text-anchor=\"middle\">{t} s</text>", x(t))?;
    }
    svg.push_str("</svg>\n");
    Ok(svg)
}
