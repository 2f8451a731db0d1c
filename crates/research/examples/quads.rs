//! Frames shaded by quads that the post-process chooses, beside lattices with as many samples.
//!
//! Each row says the share of the pixels that are shaded in percent, JOD, PSNR in dB (sRGB), the flicker of the luma
//! and FLIP, over the frames from `--warm` on; jittered frames against a supersampled reference.
//!
//! `cargo run --release -p afterimage-research --example quads -- SCENE [--size WxH] [--frames N] [--warm N]
//! [--set NAME] [--camera NAME] [--offset N] [--jitter off] [--gaze fixed] [--out FOLDER]`
//!
//! Makes tables of `docs/quads.md`; a minute a clip of 320x180.

use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::{
    ContextDesc, Filter, Foveation, Gaze, Image, Method, Repair, Reset, Settings, Smr, ViewFrame, ViewGeometry,
};
use afterimage_lab::device::Headless;
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::metric::{Flip, References, Scorer, Tracker, encode};
use afterimage_lab::picture::to_rgb8;
use afterimage_lab::source::{
    FrameRequest, FrameSource, ReadLimits, SceneChoice, SceneOptions, ViewedScene, is_scene, open,
};
use afterimage_metric::{Display, Viewing};
use rayon::prelude::*;
use std::path::Path;

type Failure = Box<dyn std::error::Error>;

/// Gaze positions as shares of the size, 16 frames each.
const GAZES: [[f32; 2]; 4] = [[0.25, 0.33], [0.75, 0.33], [0.75, 0.72], [0.25, 0.72]];
const FRAMES_PER_GAZE: u64 = 16;

struct Row {
    name: String,
    foveation: Foveation,
    repair: Option<Repair>,
    post: CpuAfterimage,
    scorer: Scorer,
    /// Sum over frames of the share of the pixels that were shaded.
    shaded: f64,
    shown: Image<[f32; 3]>,
    mask: Option<Image<bool>>,
    tune: [f32; 12],
}

fn sparse(fovea_deg: f32, mid_deg: f32, rate_mid: u32, rate_far: u32) -> Foveation {
    Foveation { filter: Filter::Sparse, fovea_deg, mid_deg, rate_mid, rate_far, ..Foveation::default() }
}

fn quads(fovea_deg: f32, mid_deg: f32, [rate_mid, rate_far]: [u32; 2], budget: f32) -> Foveation {
    Foveation { fovea_deg, mid_deg, rate_mid, rate_far, budget, ..Foveation::quads() }
}

/// Rows of a table, by its name.
fn rows(set: &str, size: [u32; 2], antialias: bool) -> Result<Vec<Row>, Failure> {
    let mut rows = vec![];
    let mut add_tuned =
        |name: &str, foveation: Foveation, repair: Option<Repair>, change: &[(usize, f32)]| -> Result<(), Failure> {
            let method = Method::Smr(Smr { antialias, repair, ..Smr::default() });
            let settings = Settings { method, foveation, ..Settings::default() };
            let mut tune = afterimage::kernel::quads::DEFAULTS;
            change.iter().for_each(|&(i, v)| tune[i] = v);
            rows.push(Row {
                name: name.into(),
                foveation,
                repair,
                post: CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(size) })?,
                scorer: Scorer::default(),
                shaded: 0.0,
                shown: Image::filled(size, [0.0; 3]),
                mask: None,
                tune,
            });
            Ok(())
        };
    let mut add = |name: &str, foveation: Foveation, change: &[(usize, f32)]| add_tuned(name, foveation, None, change);
    match set {
        "second" => {
            add("pixels 1/2/4", sparse(5.0, 15.0, 2, 4), &[])?;
            add("a", quads(5.0, 5.0, [8, 8], 0.050), &[])?;
            add("mid 4/8", quads(5.0, 15.0, [4, 8], 0.037), &[])?;
            add("whole", quads(5.0, 5.0, [8, 8], 0.019), &[(5, 0.0)])?;
            add("none 900", quads(5.0, 5.0, [8, 8], 0.050), &[(0, 900.0)])?;
            add("none 60", quads(5.0, 5.0, [8, 8], 0.050), &[(0, 60.0)])?;
            add("few .3", quads(5.0, 5.0, [8, 8], 0.050), &[(2, 0.3)])?;
            add("few .03", quads(5.0, 5.0, [8, 8], 0.050), &[(2, 0.03)])?;
            add("coarse contrast 10", quads(5.0, 5.0, [8, 8], 0.050), &[(1, 10.0)])?;
            add("half deg 8", quads(5.0, 5.0, [8, 8], 0.050), &[(3, 8.0)])?;
            add("half deg 100", quads(5.0, 5.0, [8, 8], 0.050), &[(3, 100.0)])?;
            add("block 1", quads(5.0, 5.0, [8, 8], 0.050), &[(4, 1.0)])?;
            add("block .25", quads(5.0, 5.0, [8, 8], 0.050), &[(4, 0.25)])?;
            add("block 0", quads(5.0, 5.0, [8, 8], 0.050), &[(4, 0.0)])?;
            add("corr 1", quads(5.0, 5.0, [8, 8], 0.050), &[(6, 1.0)])?;
            add("corr 4", quads(5.0, 5.0, [8, 8], 0.050), &[(6, 4.0)])?;
        }
        "third" => {
            add("pixels 1/2/4", sparse(5.0, 15.0, 2, 4), &[])?;
            add("a", quads(5.0, 5.0, [8, 8], 0.051), &[])?;
            add("mid 4/8", quads(5.0, 15.0, [4, 8], 0.038), &[])?;
            add("whole", quads(5.0, 5.0, [8, 8], 0.020), &[(5, 0.0)])?;
            add("none 60", quads(5.0, 5.0, [8, 8], 0.051), &[(0, 60.0)])?;
            add("n60 cc10 few.2", quads(5.0, 5.0, [8, 8], 0.051), &[(0, 60.0), (1, 10.0), (2, 0.2)])?;
        }
        "light" => {
            add("pixels 1/2/4", sparse(5.0, 15.0, 2, 4), &[])?;
            add("none 60", quads(5.0, 5.0, [8, 8], 0.051), &[(0, 60.0)])?;
            add("whole n60", quads(5.0, 5.0, [8, 8], 0.020), &[(5, 0.0), (0, 60.0)])?;
            add("whole n60 few 1", quads(5.0, 5.0, [8, 8], 0.020), &[(5, 0.0), (0, 60.0), (2, 1.0)])?;
            add("whole n60 corr1", quads(5.0, 5.0, [8, 8], 0.020), &[(5, 0.0), (0, 60.0), (6, 1.0)])?;
            add("whole n60 corr4", quads(5.0, 5.0, [8, 8], 0.020), &[(5, 0.0), (0, 60.0), (6, 4.0)])?;
            add("whole even", quads(5.0, 15.0, [4, 8], 0.0), &[(5, 0.0)])?;
        }
        "grid" => {
            for (name, half) in [("whole", 0.0), ("half", 1.0)] {
                let budget = if half == 0.0 { 0.020 } else { 0.051 };
                for few in [0.5, 1.0, 2.0] {
                    for corr in [1.0, 1.4] {
                        add(
                            &format!("{name} few {few} corr {corr}"),
                            quads(5.0, 5.0, [8, 8], budget),
                            &[(5, half), (0, 60.0), (2, few), (6, corr)],
                        )?;
                    }
                }
            }
        }
        "grid2" => {
            for few in [0.25, 0.5] {
                for corr in [1.0, 1.2] {
                    add(
                        &format!("few {few} corr {corr}"),
                        quads(5.0, 5.0, [8, 8], 0.051),
                        &[(0, 60.0), (2, few), (6, corr)],
                    )?;
                }
            }
            add("n30", quads(5.0, 5.0, [8, 8], 0.051), &[(0, 30.0), (2, 0.5), (6, 1.0)])?;
            add("cc10", quads(5.0, 5.0, [8, 8], 0.051), &[(0, 60.0), (1, 10.0), (2, 0.5), (6, 1.0)])?;
        }
        "ratio" => {
            for ratio in [1.0, 0.95, 0.9, 0.8, 0.7, 0.5] {
                add(&format!("ratio {ratio}"), quads(5.0, 5.0, [8, 8], 0.051), &[(10, ratio)])?;
            }
            add("asked", quads(5.0, 5.0, [8, 8], 0.051), &[(11, 1.0)])?;
        }
        "four" => {
            let q = |fovea, mid, budget| quads(fovea, mid, [8, 8], budget);
            add("default", q(5.0, 5.0, 0.051), &[])?;
            add("coarse 1", q(5.0, 5.0, 0.051), &[(7, 1.0)])?;
            add("coarse .3", q(5.0, 5.0, 0.051), &[(7, 0.3)])?;
            add("lod 3", q(5.0, 5.0, 0.051), &[(9, 3.0)])?;
            add("corr .7", q(5.0, 5.0, 0.051), &[(6, 0.7)])?;
            add("hd 10", q(5.0, 5.0, 0.051), &[(3, 10.0)])?;
            add("fovea 0", q(0.0, 0.0, 0.058), &[])?;
            add("fovea 8", q(8.0, 8.0, 0.040), &[])?;
            add("block .02", q(5.0, 5.0, 0.051), &[(4, 0.02)])?;
        }
        "five" => {
            let q = |fovea, mid, budget| quads(fovea, mid, [8, 8], budget);
            add("c1", q(5.0, 5.0, 0.051), &[(7, 1.0)])?;
            add("c2", q(5.0, 5.0, 0.051), &[(7, 2.0)])?;
            add("c1 cc10", q(5.0, 5.0, 0.051), &[(7, 1.0), (1, 10.0)])?;
            add("c1 cc1", q(5.0, 5.0, 0.051), &[(7, 1.0), (1, 1.0)])?;
            add("c1 few.2", q(5.0, 5.0, 0.051), &[(7, 1.0), (2, 0.2)])?;
            add("c1 few.8", q(5.0, 5.0, 0.051), &[(7, 1.0), (2, 0.8)])?;
            add("c1 n200", q(5.0, 5.0, 0.051), &[(7, 1.0), (0, 200.0)])?;
            add("c1 corr1.4", q(5.0, 5.0, 0.051), &[(7, 1.0), (6, 1.4)])?;
        }
        "six" => {
            let q = |fovea, mid, budget| quads(fovea, mid, [8, 8], budget);
            add("c1 half", q(5.0, 5.0, 0.051), &[(7, 1.0)])?;
            add("c1 whole", q(5.0, 5.0, 0.0203), &[(7, 1.0), (5, 0.0)])?;
            add("c1 whole few 1", q(5.0, 5.0, 0.0203), &[(7, 1.0), (5, 0.0), (2, 1.0)])?;
            add("c1 half 4 px", q(5.0, 5.0, 0.051), &[(7, 1.0), (11, 1.0)])?;
            add("c1 half 1 px", q(5.0, 5.0, 0.051), &[(7, 1.0), (11, 2.0)])?;
        }
        "scene" => {
            let q = |fovea, mid, budget| quads(fovea, mid, [8, 8], budget);
            add("pixels 1/2/4", sparse(5.0, 15.0, 2, 4), &[])?;
            add("c1 half", q(5.0, 5.0, 0.051), &[(7, 1.0)])?;
            add("c1 whole", q(5.0, 5.0, 0.0203), &[(7, 1.0), (5, 0.0)])?;
            add("c1 half few .2", q(5.0, 5.0, 0.051), &[(7, 1.0), (2, 0.2)])?;
            add("c1 half 1 px", q(5.0, 5.0, 0.051), &[(7, 1.0), (11, 2.0)])?;
            add("half mid 4", quads(5.0, 15.0, [4, 8], 0.038), &[(7, 1.0)])?;
        }
        "first" => {
            add("pixels 1/2/4", sparse(5.0, 15.0, 2, 4), &[])?;
            add("quads 8, budget 4.7", quads(5.0, 5.0, [8, 8], 0.047), &[])?;
            add("quads 4/8, budget 3.2", quads(5.0, 15.0, [4, 8], 0.032), &[])?;
            add("quads 4/8, budget 2.5", quads(5.0, 15.0, [4, 8], 0.025), &[])?;
            add("quads 8 whole, 1.7", quads(5.0, 5.0, [8, 8], 0.017), &[(5, 0.0)])?;
        }
        _ => return Err(format!("no table {set}").into()),
    }
    Ok(rows)
}

impl Row {
    /// Shows a frame; the share of the pixels that are shaded.
    fn show(&mut self, frame: &SourceFrame, view: &ViewFrame, index: u64) -> Result<f64, Failure> {
        let size = frame.color.size();
        let (depth, motion) = (frame.depth.as_ref().ok_or("no depth")?, frame.motion.as_ref().ok_or("no motion")?);
        let is_sparse = self.foveation.filter == Filter::Sparse;
        let gaze_px = view.gaze.resolve(None, &view.geometry);
        let lattices = is_sparse.then(|| self.foveation.lattices(&view.geometry, gaze_px, index));
        let (colors, depths, motions) = ([&frame.color], [depth], [motion]);
        let views = [ViewFrame { lattices, ..*view }];
        let reset = if frame.cut { Reset::All } else { Reset::None };
        let input = Frame { depth: Some(&depths), motion: Some(&motions), reset, ..Frame::new(&colors, &views, index) };
        let is_planned = !is_sparse || self.repair.is_some();
        let mask = if is_planned { Some(self.post.plan(&input)?[0].clone()) } else { None };
        let repaired = self.repair.map(|_| &colors[..]);
        let mut shown = [Image::filled(size, [0.0; 3])];
        self.post.process(&Frame { repaired, ..input }, &mut shown)?;
        let [shown] = shown;
        self.shown = encode(&shown, 0.0);
        let points = lattices.map_or(0, |l| l.as_slice().iter().map(|l| l.points[0] * l.points[1]).sum::<u32>());
        let chosen = mask.as_ref().map_or(0, |mask| mask.pixels().iter().filter(|&&chosen| chosen).count());
        self.mask = mask;
        Ok((f64::from(points) + chosen as f64) / f64::from(size[0] * size[1]))
    }
}

fn main() -> Result<(), Failure> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let option = |name: &str, default: &str| {
        args.iter().position(|a| a == name).map_or(default.to_owned(), |i| args[i + 1].clone())
    };
    let input = args.first().ok_or("which scene?")?.clone();
    let frames: u64 = option("--frames", "48").parse()?;
    let warm: u64 = option("--warm", "24").parse()?;
    let offset: u64 = option("--offset", "0").parse()?;
    let size: Vec<u32> = option("--size", "320x180").split('x').map(str::parse).collect::<Result<_, _>>()?;
    let (camera, out) = (option("--camera", ""), option("--out", ""));
    let is_folder = Path::new(&input).is_dir();
    let options = SceneOptions { size: (!is_folder).then(|| [size[0], size[1]]), hfov_deg: None, fps: None };
    let limits = ReadLimits::from_megapixels(64);
    let mut source: Box<dyn FrameSource> = if is_scene(&input) {
        let camera = (!camera.is_empty()).then_some(camera.as_str());
        let choice = SceneChoice { camera, options, limits, ..SceneChoice::new(&input) };
        Box::new(ViewedScene::open(&choice)?.on(Headless::find_roomy(true).ok_or("no device")?)?)
    } else {
        open(&input, &limits, &options)?
    };
    let info = source.info().clone();
    let size = info.size;
    let is_jittered = option("--jitter", "halton") == "halton" && !is_folder;
    let moves = option("--gaze", "moving") == "moving";
    let geometry = ViewGeometry::flat(size, info.hfov_deg.unwrap_or(70.0))?;
    let mut rows = rows(&option("--set", "first"), size, is_jittered)?;
    let viewing = Viewing { geometry, display: Display::default(), fps: info.fps.unwrap_or(60.0) };
    let mut references = References::with_flip(Flip::for_view(&geometry)).with_jod(viewing);
    let mut tracker = Tracker::default();
    let coarse = Image::filled(size, 3.0);
    for index in 0..frames {
        let at = if moves { GAZES[(index / FRAMES_PER_GAZE % 4) as usize] } else { [0.375, 0.55] };
        let gaze_px = [at[0] * size[0] as f32, at[1] * size[1] as f32];
        let jitter_px = is_jittered.then(|| Foveation::jitter_px(index + offset + 1));
        let request = FrameRequest {
            gaze_px,
            jitter_px,
            reference_samples: is_jittered.then_some(16),
            ..FrameRequest::full_rate(index)
        };
        let frame = source.render(&request)?;
        let ecc_deg = geometry.eccentricity_map(gaze_px);
        let tracked = tracker.advance(&frame.reference, &geometry, &ecc_deg, &coarse);
        let full = encode(&frame.reference.color, 0.0);
        let reference = references.next(&full, &tracked, &ecc_deg);
        let view = ViewFrame {
            jitter_px: jitter_px.unwrap_or_default(),
            previous_from_current: frame.given().previous_from_current,
            ..ViewFrame::new(geometry, Gaze::At { px: gaze_px })
        };
        for row in &mut rows {
            let shaded = row.show(frame.given(), &view, index + offset)?;
            row.shaded += if index >= warm { shaded / (frames - warm) as f64 } else { 0.0 };
        }
        rows.par_iter_mut().for_each(|row| {
            if index == warm {
                row.scorer.restart();
            }
            row.scorer.push(&reference, &row.shown, &tracked, &ecc_deg);
        });
        if !out.is_empty() && [warm, frames - 13, frames - 1].contains(&index) {
            std::fs::create_dir_all(&out)?;
            to_rgb8(&full).save(format!("{out}/reference_{index:03}.png"))?;
            for row in &rows {
                let name = row.name.replace([' ', '/', '%', '.', ','], "_");
                to_rgb8(&row.shown).save(format!("{out}/{name}_{index:03}.png"))?;
                if let Some(mask) = &row.mask {
                    let picture = mask.map(|chosen| [f32::from(u8::from(chosen)); 3]);
                    to_rgb8(&picture).save(format!("{out}/{name}_mask_{index:03}.png"))?;
                }
            }
        }
    }
    println!("{input} {}x{}, frames {warm} to {frames}, jitter {is_jittered}", size[0], size[1]);
    for row in &rows {
        let scores = row.scorer.scores();
        let number = |v: Option<f64>| v.unwrap_or(f64::NAN);
        println!(
            "{:24} {:5.2} %  {:6.3} JOD  {:5.2} dB  flicker {:5.2}  FLIP {:.4}",
            row.name,
            100.0 * row.shaded,
            number(scores.whole.jod),
            number(scores.whole.psnr_db),
            number(scores.flicker),
            number(scores.whole.flip),
        );
    }
    Ok(())
}
