//! Antialiasing of jittered frames, full-rate and sparse, against a supersampled reference (antialias.md). Put it into
//! crates/lab/examples and run `cargo run --release -p afterimage-lab --example antialias`.

use afterimage::cpu::{CpuAfterimage, Frame, PixelTrace};
use afterimage::kernel::color::srgb_encode;
use afterimage::{ContextDesc, Filter, Foveation, Gaze, Image, Method, Settings, ViewFrame};
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::source::FrameSource;
use afterimage_lab::source::analytic::AnalyticSource;
const SIZE: [u32; 2] = [320, 180];
const FRAMES: u64 = 48;
const WARM: u64 = 24;
type Color = Image<[f32; 3]>;
fn halton(mut index: u64, base: u64) -> f32 {
    let (mut value, mut digit) = (0.0, 1.0);
    while index > 0 {
        digit /= base as f32;
        value += (index % base) as f32 * digit;
        index /= base;
    }
    value - 0.5
}
fn dump(path: &str, shown: &Color, reference: &Color) {
    let [w, h] = SIZE;
    let mut out = image::RgbImage::new(w * 2, h * 2);
    for y in 0..h {
        for x in 0..w {
            let i = (y * w + x) as usize;
            let e = |c: f32| (srgb_encode(c).clamp(0.0, 1.0) * 255.0) as u8;
            let (s, r) = (shown.pixels()[i].map(e), reference.pixels()[i].map(e));
            out.put_pixel(x, y, image::Rgb(s));
            out.put_pixel(x + w, y, image::Rgb(r));
            let d = [0, 1, 2].map(|c| (128.0 + 4.0 * (f32::from(s[c]) - f32::from(r[c]))).clamp(0.0, 255.0) as u8);
            out.put_pixel(x, y + h, image::Rgb(d));
        }
    }
    out.save(path).unwrap();
}
struct Pass(CpuAfterimage, Option<Image<PixelTrace>>);
impl Pass {
    fn new(method: Method, fov: Foveation, noisy: bool, aa: bool) -> Self {
        let mut desc = ContextDesc::new(SIZE);
        let method = match method {
            Method::Smr(smr) => Method::Smr(afterimage::Smr {
                antialias: aa,
                accumulate: if noisy { 0.95 } else { smr.accumulate },
                ..smr
            }),
            other => other,
        };
        desc.settings = Settings { method, ..Settings::default() };
        desc.settings.foveation = fov;
        desc.settings.noisy = noisy;
        if std::env::var("NODEPTH").is_ok() {
            desc.settings.depth_test = None;
        }
        Self(CpuAfterimage::new(&desc).unwrap(), None)
    }
    fn process(
        &mut self,
        color: &Color,
        from: &SourceFrame,
        view: ViewFrame,
        index: u64,
        noise: Option<&Image<[f32; 2]>>,
    ) -> Color {
        let (depth, motion) = (from.depth.as_ref().unwrap(), from.motion.as_ref().unwrap());
        let (colors, depths, motions, views) = ([color], [depth], [motion], [view]);
        let noises: Vec<&Image<[f32; 2]>> = noise.into_iter().collect();
        let frame = Frame {
            depth: Some(&depths),
            motion: Some(&motions),
            noise: noise.map(|_| noises.as_slice()),
            ..Frame::new(&colors, &views, index)
        };
        let mut shown = [Image::filled(SIZE, [0.0; 3])];
        let mut traces = [Image::filled(SIZE, PixelTrace::default())];
        self.0.process_traced(&frame, &mut shown, &mut traces).unwrap();
        self.1 = Some(traces[0].clone());
        let [shown] = shown;
        shown
    }
}
struct Row {
    name: &'static str,
    fov: Foveation,
    sparse: bool,
    jitter: bool,
    passes: Vec<Pass>,
    post_taa: bool,
    noisy: bool,
    sums: [f64; 6],
    bins: [(f64, f64); 7],
    before: Option<(Color, Color)>,
}
fn se(a: &Color, b: &Color, keep: impl Fn(usize) -> bool) -> (f64, f64) {
    let mut s = 0.0;
    let mut n = 0.0;
    for i in 0..a.pixels().len() {
        if keep(i) {
            for c in 0..3 {
                s += f64::from(srgb_encode(a.pixels()[i][c]) - srgb_encode(b.pixels()[i][c])).powi(2);
                n += 1.0;
            }
        }
    }
    (s, n)
}
fn main() {
    let scenes = std::env::var("SCENES").unwrap_or("still,lateral,turn".into());
    let frames_n: u64 = std::env::var("FRAMES").map_or(FRAMES, |v| v.parse().unwrap());
    let warm: u64 = std::env::var("WARM").map_or(WARM, |v| v.parse().unwrap());
    let filter = std::env::var("ROWS").unwrap_or_default();
    for scene in scenes.split(',') {
        let mut source = AnalyticSource::new(scene, SIZE, 40.0, 60.0).unwrap();
        let geometry = *source.view();
        let sp = Foveation {
            filter: Filter::Sparse,
            rate_mid: 2,
            rate_far: 4,
            fovea_deg: 8.0,
            mid_deg: 20.0,
            ..Foveation::default()
        };
        let up4 = Foveation {
            filter: Filter::Sparse,
            rate_mid: 2,
            rate_far: 2,
            fovea_deg: 0.0,
            mid_deg: 0.0,
            blend_deg: 0.0,
            ..Foveation::default()
        };
        let full1 = Foveation {
            filter: Filter::Sparse,
            rate_mid: 1,
            rate_far: 1,
            fovea_deg: 0.0,
            mid_deg: 0.0,
            blend_deg: 0.0,
            ..Foveation::default()
        };
        let full = Foveation { rate_mid: 1, rate_far: 1, ..Foveation::default() };
        let mk = |name: &'static str, fov: Foveation, sparse, jitter, methods: &[Method], post_taa: bool| {
            let noisy = name.contains("noisy");
            let mut passes: Vec<Pass> = methods.iter().map(|&m| Pass::new(m, fov, noisy, jitter)).collect();
            if post_taa {
                passes.push(Pass::new(Method::Taa, full, false, false));
            }
            Row {
                name,
                fov,
                sparse,
                jitter,
                passes,
                post_taa,
                noisy,
                sums: [0.0; 6],
                bins: [(0.0, 0.0); 7],
                before: None,
            }
        };
        let mut rows = vec![
            mk("full rate, one sample", full, false, false, &[], false),
            mk("full rate, jitter, taa", full, false, true, &[Method::Taa], false),
            mk("full rate, jitter, taau", full, false, true, &[Method::Taau], false),
            mk("one in 4, jitter, taau", up4, true, true, &[Method::Taau], false),
            mk("sparse, none", sp, true, false, &[Method::None], false),
            mk("sparse, taau", sp, true, false, &[Method::Taau], false),
            mk("sparse, jitter, taau", sp, true, true, &[Method::Taau], false),
            mk("sparse, smr", sp, true, false, &[Method::Smr(Default::default())], false),
            mk("sparse, jitter, smr", sp, true, true, &[Method::Smr(Default::default())], false),
            mk("full rate, jitter, smr", full1, true, true, &[Method::Smr(Default::default())], false),
            mk("one in 4, jitter, smr", up4, true, true, &[Method::Smr(Default::default())], false),
            mk("sparse, smr, then taa", sp, true, false, &[Method::Smr(Default::default())], true),
            mk("full rate, jitter, noisy smr", full, false, true, &[Method::Smr(Default::default())], false),
            mk("sparse, jitter, noisy smr", sp, true, true, &[Method::Smr(Default::default())], false),
        ];
        rows.retain(|r| filter.is_empty() || filter.split(";").any(|f| r.name == f));
        let mut mean: Vec<[f64; 3]> = vec![[0.0; 3]; (SIZE[0] * SIZE[1]) as usize];
        let mut last_ref = None;
        for index in 0..frames_n {
            let gaze_px = [[80.0, 60.0], [240.0, 60.0], [240.0, 130.0], [80.0, 130.0]][(index / 16 % 4) as usize];
            let mut acc: Vec<[f32; 3]> = vec![[0.0; 3]; (SIZE[0] * SIZE[1]) as usize];
            let cache = format!("/work/tmp/ref_{scene}_{index}.bin");
            let cached = std::fs::read(&cache).ok();
            if let Some(bytes) = &cached {
                for (p, b) in acc.iter_mut().zip(bytes.chunks_exact(12)) {
                    for c in 0..3 {
                        p[c] = f32::from_le_bytes(b[c * 4..c * 4 + 4].try_into().unwrap());
                    }
                }
            }
            for k in 0..(if cached.is_some() { 0 } else { 32u64 }) {
                let f = source.jittered_frame(index, [halton(k + 2000, 2), halton(k + 2000, 3)]);
                for (m, p) in acc.iter_mut().zip(f.color.pixels()) {
                    for c in 0..3 {
                        m[c] += p[c] / 32.0;
                    }
                }
            }
            if cached.is_none() {
                std::fs::write(&cache, acc.iter().flatten().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>())
                    .unwrap();
            }
            let reference = Image::from_pixels(SIZE, acc).unwrap();
            let jitter = Foveation::jitter_px(index + 1);
            let frames = [source.jittered_frame(index, [0.0; 2]), source.jittered_frame(index, jitter)];
            for (m, p) in mean.iter_mut().zip(frames[1].color.pixels()) {
                for c in 0..3 {
                    m[c] += f64::from(p[c]);
                }
            }
            last_ref = Some(reference.clone());
            let k = 0.3f32; // Local contrast told as noise.
            let luma = frames[1].color.map(|c| 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]);
            let noise = Image::from_fn(SIZE, |[x, y]| {
                let (mut s, mut q) = (0.0f32, 0.0f32);
                for j in -1i32..2 {
                    for i in -1i32..2 {
                        let (u, v) =
                            ((x as i32 + i).clamp(0, SIZE[0] as i32 - 1), (y as i32 + j).clamp(0, SIZE[1] as i32 - 1));
                        let l = luma.pixels()[(v * SIZE[0] as i32 + u) as usize];
                        s += l;
                        q += l * l;
                    }
                }
                [k * (q / 9.0 - s * s / 81.0).max(0.0).sqrt(), 1.0]
            });
            let ecc = geometry.eccentricity_map(gaze_px);
            for row in rows.iter_mut() {
                let frame = &frames[usize::from(row.jitter)];
                let mut view = ViewFrame {
                    jitter_px: if row.jitter { jitter } else { [0.0; 2] },
                    previous_from_current: frame.previous_from_current,
                    ..ViewFrame::new(geometry, Gaze::At { px: gaze_px })
                };
                let mut shown = frame.color.clone();
                let n = row.passes.len();
                for (k, pass) in row.passes.iter_mut().enumerate() {
                    let last_taa = row.post_taa && k + 1 == n;
                    view.lattices = (row.sparse && !last_taa).then(|| row.fov.lattices(&geometry, gaze_px, index));
                    shown = pass.process(&shown, frame, view, index, (row.noisy && !last_taa).then_some(&noise));
                }
                if index >= warm {
                    if let Some(t) = row.passes.first().and_then(|p| p.1.as_ref()) {
                        let depth = frame.depth.as_ref().unwrap();
                        let [w, h] = SIZE.map(|s| s as i32);
                        for i in 0..shown.pixels().len() {
                            let (x, y) = (i as i32 % w, i as i32 / w);
                            let mut lo = f32::MAX;
                            let mut hi = 0.0f32;
                            for j in -1..2 {
                                for k in -1..2 {
                                    let d =
                                        depth.at((x + k).clamp(0, w - 1) as usize, (y + j).clamp(0, h - 1) as usize);
                                    lo = lo.min(d);
                                    hi = hi.max(d);
                                }
                            }
                            let t = t.pixels()[i];
                            let edge = hi > lo * 1.1;
                            let bin = if edge {
                                0
                            } else if t.verdict as u32 != 0 {
                                1
                            } else if t.quality < 0.5 {
                                2
                            } else if t.quality < 0.99 {
                                3
                            } else if t.gate < 0.9 {
                                4
                            } else if t.weight < 0.99 {
                                5
                            } else {
                                6
                            };
                            let (a, _) = se(
                                &Image::filled([1, 1], shown.pixels()[i]),
                                &Image::filled([1, 1], reference.pixels()[i]),
                                |_| true,
                            );
                            row.bins[bin].0 += 1.0;
                            row.bins[bin].1 += a;
                        }
                    }
                    let (a, b) = se(&shown, &reference, |_| true);
                    row.sums[0] += a;
                    row.sums[1] += b;
                    let (a, b) = se(&shown, &reference, |i| ecc.pixels()[i] < 3.5);
                    row.sums[2] += a;
                    row.sums[3] += b;
                    if let Some((s0, r0)) = &row.before {
                        let l = |c: [f32; 3]| {
                            f64::from(
                                0.2126 * srgb_encode(c[0]) + 0.7152 * srgb_encode(c[1]) + 0.0722 * srgb_encode(c[2]),
                            )
                        };
                        for i in 0..shown.pixels().len() {
                            row.sums[4] += ((l(shown.pixels()[i]) - l(reference.pixels()[i]))
                                - (l(s0.pixels()[i]) - l(r0.pixels()[i])))
                            .abs();
                            row.sums[5] += 1.0;
                        }
                    }
                }
                if index + 1 == frames_n {
                    if let Ok(d) = std::env::var("DUMP") {
                        dump(&format!("{d}/{scene}_{}.png", row.name.replace([' ', ','], "_")), &shown, &reference);
                    }
                }
                row.before = Some((shown, reference.clone()));
            }
        }
        let m = Image::from_fn(SIZE, |[x, y]| mean[(y * SIZE[0] + x) as usize].map(|v| (v / FRAMES as f64) as f32));
        let (a, b) = se(&m, &last_ref.unwrap(), |_| true);
        println!("mean of jittered frames {:.2}", -10.0 * (a / b).log10());
        println!("{scene}");
        for r in &rows {
            if std::env::var("BINS").is_ok() {
                let n: f64 = r.bins.iter().map(|b| b.0).sum();
                let e: f64 = r.bins.iter().map(|b| b.1).sum();
                for (name, b) in ["edge", "reject", "coarse", "mid", "gated", "between", "own"].iter().zip(&r.bins) {
                    println!(
                        "     {name:8} pixels {:5.1} %  error {:5.1} %  PSNR {:.1}",
                        100.0 * b.0 / n,
                        100.0 * b.1 / e,
                        -10.0 * (b.1 / (3.0 * b.0)).log10()
                    );
                }
            }
            let db = |i: usize| -10.0 * (r.sums[i] / r.sums[i + 1]).log10();
            println!(
                "  {:<26} PSNR {:6.2}  fovea {:6.2}  flicker {:6.2}",
                r.name,
                db(0),
                db(2),
                1000.0 * r.sums[4] / r.sums[5]
            );
        }
    }
}
