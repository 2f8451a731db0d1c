//! Hard cases for the methods that store surfaces, H50 to H53, H58, H59, H66 and H72 to H75: laws that hold on
//! either executor.

use crate::depth_hard::{Color, Make};
use crate::images::{View, noise, off, peak, pixel, pixels, times};
use crate::low_pass::LowPass;
use afterimage::internal::{ContextDesc, Foveation, Method, MethodKind, Reset, Settings, Smr};
use afterimage::{Exposure, Gaze, Image, Verdict};
use afterimage_testing::Draws;

/// The laws as tests of an executor. `$run_law` runs one, and returns what it measured.
macro_rules! surfaces_laws {
    ($side:ident, $run_law:ident) => {
        crate::laws::laws! { $side, $run_law,
            h50_z_fighting_stays_next_to_the_colors_presented: "H50", z_fighting;
            h51_a_still_picture_stays_bit_for_bit_whatever_the_candidates_level: "H51", still_picture;
            h52_a_whole_shift_moves_history_exactly_and_the_border_is_new: "H52", whole_shift;
            h53_200_steps_of_half_a_pixel_blur_no_more_than_stated: "H53", half_pixels;
            h58_nothing_is_read_over_a_depth_edge: "H58", depth_edge;
            h59_a_zoom_leaves_no_hole: "H59", zoom;
            h66_the_old_fovea_stays_sharp_after_a_saccade: "H66", saccade;
            h72_an_exposure_of_256_in_one_frame_loses_nothing_if_it_is_declared: "H72", exposure;
            h73_a_firefly_is_gone_with_the_frame_after: "H73", firefly;
            h74_a_strobe_leaves_nothing_behind: "H74", strobe;
            h75_black_and_white_in_turn_show_what_came: "H75", black_and_white;
        }
    };
}
pub(crate) use surfaces_laws;

pub const SIZE: [u32; 2] = [52, 41];
pub const METHODS: [MethodKind; 3] = [MethodKind::Smr, MethodKind::Taa, MethodKind::Taau];

/// Four pixels a block at the most: levels 0 to 4 of the mip chain, so that positions 16 pixels apart are alike.
pub fn settings(method: MethodKind) -> Settings {
    let foveation = Foveation { rate_mid: 4, rate_far: 4, ..Foveation::default() };
    Settings { method: method.into(), foveation, ..Settings::default() }
}

fn of(method: MethodKind) -> ContextDesc {
    sized(SIZE, settings(method))
}

fn sized(size: [u32; 2], settings: Settings) -> ContextDesc {
    ContextDesc { settings, ..ContextDesc::new(size) }
}

/// smr whose samples are not relit.
fn unlit() -> ContextDesc {
    let method = Method::Smr(Smr { relight: false, ..Smr::default() });
    sized(SIZE, Settings { method, ..settings(MethodKind::Smr) })
}

/// A view whose level of detail is given.
fn at_lods(color: Color, lods: Image<f32>) -> View {
    View { lod: Some(lods), ..View::still(color, [20.0, 20.0]) }
}

pub fn at_lod(color: Color, lod: f32) -> View {
    let lods = Image::filled(color.size(), lod);
    at_lods(color, lods)
}

pub fn sharp(color: Color) -> View {
    at_lod(color, 0.0)
}

/// Two surfaces that z-fight pixel by pixel, as a renderer of quarter resolution delivers them.
pub fn z_fighting(make: Make<'_>) -> Option<String> {
    let (a, b) = ([0.25, 0.5, 0.75], [0.75, 0.25, 0.5]);
    let (mut post, mut plain) = (make(of(MethodKind::Smr))?, make(of(MethodKind::Smr))?);
    let lods = Image::filled(SIZE, 2.0);
    let mut draws = Draws::new("z-fighting of surfaces");
    let mut beyond = 0.0_f32;
    for index in 0..40 {
        let picks = Image::from_fn(SIZE, |_| draws.uniform() < 0.5);
        let color = LowPass::new(&picks.map(|p| if p { a } else { b }), 4).render(&lods);
        let view = View { depth: Some(picks.map(|p| if p { 3.0 } else { 3.0001 })), ..at_lod(color, 2.0) };
        let made = post.step(index, &view);
        let expected = plain.step(index, &View { depth: None, ..view });
        assert_eq!((&made.shown, &made.trace), (&expected.shown, &expected.trace), "frame {index}");
        assert_eq!(made.stats.rejected(), 0);
        for c in made.shown.pixels() {
            beyond = (0..3).fold(beyond, |w, i| w.max(c[i] - a[i].max(b[i])).max(a[i].min(b[i]) - c[i]));
        }
    }
    assert!(beyond < 0.01, "{beyond}");
    Some(format!("smr, 40 frames: all as without depth, bit for bit; at the most {beyond:.4} beyond 0.25 to 0.75"))
}

pub fn still_picture(make: Make<'_>) -> Option<String> {
    // Rough, smooth, and dark pictures: the tolerance grows with contrast, and smooth ones have none. The roughest for
    // a thousand frames.
    for (name, floor, contrast, frames) in
        [("rough", 0.0, 1.0, 1000), ("smooth", 0.5, 0.02, 30), ("dark", 0.0, 0.004, 30)]
    {
        let mut post = make(of(MethodKind::Smr))?;
        let picture = noise(SIZE, "s3").map(|c| c.map(|v| floor + contrast * v));
        let first = post.step(0, &sharp(picture));
        let stored = first.stored();
        let low_pass = LowPass::new(&stored, 4);
        for index in 1..=frames {
            // Levels at which sharp history replaces the candidate fully: a tenth and more.
            let mut draws = Draws::new(&format!("s3 {index}"));
            let lods = Image::from_fn(SIZE, |_| draws.range(0.11, 2.0));
            let made = post.step(index, &at_lods(low_pass.render(&lods), lods));
            assert_eq!(made.words, first.words, "{name}, frame {index}");
            assert_eq!(made.shown, stored, "{name}, frame {index}");
            assert!(made.trace.pixels().iter().all(|t| t.history_share == 1.0 && t.agreement == 1.0));
            assert_eq!(made.stats.rejected(), 0);
        }
    }
    let pixels = SIZE[0] * SIZE[1];
    Some(format!("smr: 1000 coarse frames of noise show frame 0 bit for bit in all {pixels} pixels (smooth, dark: 30)"))
}

pub fn whole_shift(make: Make<'_>) -> Option<String> {
    let before = noise(SIZE, "h52");
    let low_pass = LowPass::new(&before, 4);
    for (shift, right) in [([3.0, -2.0], true), ([-3.0, 2.0], false)] {
        let mut post = make(of(MethodKind::Smr))?;
        post.step(0, &sharp(before.clone()));
        let color = Image::from_fn(SIZE, |[x, y]| low_pass.at([f64::from(x) + 3.0, f64::from(y) - 2.0], 1.0));
        let view = View { motion: Some(Image::filled(SIZE, shift)), ..at_lod(color.clone(), 1.0) };
        let made = post.step(1, &view);
        let as_expected = pixels(SIZE).all(|px| {
            let (shown, t) = (pixel(&made.shown, px), pixel(&made.trace, px));
            if px[0] + 3 < 52 && px[1] >= 2 {
                shown == pixel(&before, [px[0] + 3, px[1] - 2]) && t.history_share == 1.0
            } else {
                shown == pixel(&color, px) && t.verdict == Verdict::OffScreen
            }
        });
        assert_eq!(as_expected, right, "the planted error: the other sign");
    }
    Some(format!("smr: {} samples moved bit for bit, {} of the border new", 49 * 39, 52 * 41 - 49 * 39))
}

pub fn half_pixels(make: Make<'_>) -> Option<String> {
    // Waves of 16 pixels in a wide picture that moves 100 pixels to the right. Read half-way between texels, a wave
    // keeps 9/8 cos(pi f) - 1/8 cos(3 pi f) of itself, f being a wave a 16th of a pixel: 0.896 of it after 200
    // readings.
    const WIDE: [u32; 2] = [224, 24];
    let f = std::f64::consts::PI / 16.0;
    let mtf = 1.125 * f.cos() - 0.125 * (3.0 * f).cos();
    let wave = |x: f64| 0.5 + 0.3 * (2.0 * f * x).sin();
    let picture = |shift: f64| Image::from_fn(WIDE, |[x, _]| [wave(f64::from(x) - shift) as f32; 3]);
    let mut post = make(sized(WIDE, settings(MethodKind::Smr)))?;
    post.step(0, &sharp(picture(0.0)));
    let (mut kept, mut coarse) = (0.0, 0.0);
    for index in 1..=200 {
        let shift = 0.5 * index as f64;
        let color = LowPass::new(&picture(shift), 3).render(&Image::filled(WIDE, 2.0));
        let motion = Some(Image::filled(WIDE, [-0.5, 0.0]));
        let made = post.step(index, &View { motion, ..at_lod(color.clone(), 2.0) });
        // Amplitudes, over four whole waves that were in view all the time.
        let amplitude = |image: &Color| {
            let at = |x: usize| f64::from(image.at(x, 12)[0]) * (2.0 * f * (x as f64 - shift)).sin();
            (130..194).map(at).sum::<f64>() / 32.0 / 0.3
        };
        (kept, coarse) = (amplitude(&made.shown), amplitude(&color));
    }
    let stated = mtf.powi(200);
    // The amplitude differs from the MTF by 0.023: differences of phase count as changes of light, and a gain costs
    // detail.
    assert!(kept > stated - 0.03 && kept < 1.01 && coarse < stated - 0.05);
    Some(format!(
        "smr, 0.5 px x 200: {kept:.3} of a wave of 16 px left, {stated:.3} by its MTF; the candidate has {coarse:.3}"
    ))
}

pub fn depth_edge(make: Make<'_>) -> Option<String> {
    // A quarter of a pixel to the left of the edge and to the right of it, taps reach over; plain colors show any such
    // tap. smr accumulates coarse history.
    let mut widest = vec![];
    let near = |[x, _]: [u32; 2]| x < 26;
    let colors = |near: bool| if near { [0.9, 0.6, 0.3] } else { [0.1, 0.2, 0.4] };
    let depths = Image::from_fn(SIZE, |at| if near(at) { 1.0 } else { 3.0 });
    for (method, depth, bleeds) in [
        (MethodKind::Taa, Some(depths.clone()), false),
        (MethodKind::Taa, None, true),
        (MethodKind::Smr, Some(depths), false),
        (MethodKind::Smr, None, true),
    ] {
        let lod = if method == MethodKind::Smr { 1.0 } else { 0.0 };
        let motion = Some(Image::filled(SIZE, [-0.25, 0.0]));
        let view = View { depth, motion, ..at_lod(Image::from_fn(SIZE, |at| colors(near(at))), lod) };
        let mut post = make(of(method))?;
        let worst = (0..20).map(|i| off(&post.step(i, &view).shown, &view.color)).fold(0.0, f32::max);
        // Storage alone is off by 2^-10, and by up to three times that before a share of 0.3 tells.
        assert_eq!(worst > 0.006, bleeds, "{method:?}: {worst}");
        widest.push(worst);
    }
    let (least, bled) = (widest[0].max(widest[2]), widest[3]);
    assert!(bled > 0.1, "{bled}");
    Some(format!("smr and taa, 1/4 px over an edge: off by {least:.4}, rounding; without depth {bled:.2}"))
}

pub fn zoom(make: Make<'_>) -> Option<String> {
    let before = noise(SIZE, "zoom of surfaces").map(|c| c.map(|v| 0.5 + 0.125 * (8.0 * v).floor() / 8.0));
    let low_pass = LowPass::new(&before, 4);
    let zoomed = |factor: f32| -> Option<[u64; 2]> {
        let mut post = make(unlit())?;
        post.step(0, &sharp(before.clone()));
        let middle = [26.0, 20.0];
        let shift = |px: [u32; 2]| [0, 1].map(|i| (px[i] as f32 - middle[i]) * (factor - 1.0));
        let motion = Image::from_fn(SIZE, shift);
        // The frame as a renderer of quarter resolution delivers it.
        let source64 = |px: [u32; 2]| [0, 1].map(|i| f64::from(px[i]) + f64::from(shift(px)[i]));
        let color = Image::from_fn(SIZE, |px| low_pass.at(source64(px), 2.0));
        let later = View { motion: Some(motion), ..at_lod(color, 2.0) };
        let made = post.step(1, &later);
        let surfaces = made.surfaces();
        let mut kept = 0;
        for (surface, px) in surfaces.iter().zip(pixels(SIZE)) {
            let (shown, t) = (pixel(&made.shown, px), pixel(&made.trace, px));
            let [qx, qy] = [0, 1].map(|i| middle[i] + (px[i] as f32 - middle[i]) * factor);
            if t.verdict != Verdict::Valid {
                // Near the middle, the vectors of neighbours differ by a large part of their length, and count as
                // vectors on a silhouette.
                let inside = (-0.5..51.5).contains(&qx) && (-0.5..40.5).contains(&qy);
                assert_eq!(t.verdict, if inside { Verdict::Disoccluded } else { Verdict::OffScreen });
                assert_eq!(shown, pixel(&later.color, px));
                continue;
            }
            // On texels the sample itself, with its quality; between texels within the overshoot of the resampling.
            if qx.fract() == 0.0 && qy.fract() == 0.0 && t.history_share == 1.0 {
                assert_eq!((shown, surface.lod), (pixel(&before, [qx as u32, qy as u32]), 0.0));
                kept += 1;
            }
            assert!(shown.iter().all(|v| (0.45..0.7).contains(v)), "{shown:?}");
        }
        Some([kept, made.stats.rejected()])
    };
    let ([near, none], [far, border]) = (zoomed(0.5)?, zoomed(2.0)?);
    assert!(near > 300 && none == 0 && far > 300 && border > 1000, "{near} {none} {far} {border}");
    Some(format!(
        "smr, in x2: no hole, {near} samples on texels bit for bit and as sharp; out x2: {border} are the candidate"
    ))
}

/// A gaze that moves by 20 degrees.
pub fn saccade(make: Make<'_>) -> Option<String> {
    const WIDE: [u32; 2] = [320, 40];
    let settings = settings(MethodKind::Smr);
    let picture = LowPass::new(&noise(WIDE, "h66"), 3);
    // The picture as a renderer that follows the eye delivers it, and the eccentricities.
    let frame = |e_deg: f32| {
        let mut view = View::still(noise(WIDE, "h66"), [0.0; 2]);
        let geometry = view.facts.geometry;
        let px = geometry.project([e_deg.to_radians().tan(), 0.0, 1.0]).unwrap();
        let ecc = geometry.eccentricity_map(px);
        view.facts.gaze = Gaze::At { px };
        view.color = picture.render(&settings.foveation.lod_map(&geometry, px));
        (view, ecc)
    };
    let ((left, ecc), (right, _)) = (frame(-10.0), frame(10.0));
    let mut post = make(sized(WIDE, settings))?;
    let before: Vec<_> = (0..4).map(|index| post.step(index, &left)).collect();
    let stored = before[3].stored();
    let old: Vec<usize> = (0..320 * 40).filter(|&i| ecc.pixels()[i] < 2.4).collect();
    // For two seconds, no frame loses a sharp pixel.
    for index in 4..124 {
        let made = post.step(index, &right);
        let kept = old.iter().filter(|&&i| made.shown.pixels()[i] == stored.pixels()[i]).count();
        assert_eq!(kept, old.len(), "frame {index}");
        let surfaces = made.surfaces();
        assert!(old.iter().all(|&i| surfaces[i].lod == 0.0));
    }
    // The planted error: no history.
    let fresh = make(sized(WIDE, settings))?.step(0, &right);
    assert!(old.iter().all(|&i| fresh.shown.pixels()[i] != stored.pixels()[i]));
    let count = old.len();
    Some(format!("smr: all {count} px of the old fovea bit for bit as sharp, 120 frames after 20 degrees; no decay"))
}

/// Exposure that changes by x256 in one frame, declared and undeclared.
pub fn exposure(make: Make<'_>) -> Option<String> {
    let mut worst = 0.0_f32;
    for ratio in [256.0, 1.0 / 256.0] {
        let [mut post, mut undeclared] = [make(of(MethodKind::Smr))?, make(of(MethodKind::Smr))?];
        let picture = sharp(noise(SIZE, "h72").map(|c| c.map(|v| 0.25 + 0.5 * v)));
        let made = post.step(0, &picture);
        let coarse = LowPass::new(&made.stored(), 4).render(&Image::filled(SIZE, 2.0));
        let exposed = at_lod(times(&coarse, ratio), 2.0);
        let declared = post.make(1, &exposed, Exposure::Changed { ratio }, Reset::None);
        assert_eq!(declared.shown, times(&made.stored(), ratio), "x{ratio}");
        assert_eq!(declared.stats.rejected(), 0);
        // Undeclared, it is another picture, and is shown at once. The same holds for the change back.
        undeclared.step(0, &picture);
        for index in 1..20 {
            worst = worst.max(off(&undeclared.step(index, &exposed).shown, &exposed.color));
        }
        let back = at_lod(coarse, 2.0);
        for index in 2..12 {
            worst = worst.max(off(&post.step(index, &back).shown, &back.color));
        }
    }
    assert!(worst < 0.05, "{worst}");
    Some(format!("smr, x256 and /256 declared: detail kept bit for bit; undeclared: within {worst:.3} at once"))
}

/// A pixel of the brightest half in a dark frame.
pub fn firefly(make: Make<'_>) -> Option<String> {
    let mut worst = vec![];
    for method in METHODS {
        let mut post = make(of(method))?;
        let dark = at_lod(Image::filled(SIZE, [0.01; 3]), 2.0);
        let mut firefly = dark.clone();
        firefly.color.pixels_mut()[20 * 52 + 26] = [65504.0; 3];
        post.step(0, &firefly);
        let made = post.step(1, &dark);
        let brightest = peak(&made.shown);
        assert!(
            brightest < 0.011 && off(&made.shown, &dark.color) < 0.1,
            "{method:?}: at the most {brightest} a frame after 65504"
        );
        // Remaining light of the firefly, over all pixels and the following frames.
        let mut extra = 0.0_f64;
        for index in 2..30 {
            let made = post.step(index, &dark);
            extra += made.shown.pixels().iter().flatten().map(|&v| f64::from(v - 0.01).abs()).sum::<f64>();
        }
        worst.push((brightest, extra / (3.0 * 65504.0)));
    }
    assert!(worst.iter().all(|w| w.1 < 1e-3), "{worst:?}");
    let (brightest, left) = worst[0];
    Some(format!(
        "smr: at the most {brightest:.4} for 0.01 a frame after 65504; of its light {left:.1e} is left in 28 frames"
    ))
}

pub fn strobe(make: Make<'_>) -> Option<String> {
    let dark = 0.031_25;
    let mut worst = vec![];
    for method in METHODS {
        for on in [1.0, 0.0625] {
            let mut post = make(of(method))?;
            let [lit, unlit] = [on, dark].map(|light| at_lod(Image::filled(SIZE, [light; 3]), 2.0));
            let mut offs = vec![];
            for index in 0..120_u64 {
                let made = post.step(index, if index < 20 && index % 2 == 1 { &lit } else { &unlit });
                if index >= 20 {
                    offs.push(off(&made.shown, &unlit.color));
                }
            }
            // Accumulation stalls where a tenth of the difference is less than half a step of storage.
            let stall = 1.5 / 1024.0 / (1.0 - Smr::default().accumulate);
            let frames = offs.iter().rposition(|&v| v > stall).map_or(0, |last| last + 1);
            let last = offs[99];
            assert!(frames <= 40, "{method:?}: {frames}");
            worst.push((frames, last));
        }
    }
    let [(full, nothing), (stop, stalled)] = [worst[0], worst[1]];
    assert_eq!(nothing, 0.0);
    Some(format!("smr: nothing left after {full} frames; by 1 stop within 0.0146 after {stop}, {stalled:.4} for ever"))
}

/// Black and white by turns.
pub fn black_and_white(make: Make<'_>) -> Option<String> {
    let mut post = make(of(MethodKind::Smr))?;
    let mut mean = 0.0;
    for index in 0..40 {
        let color = Image::filled(SIZE, [(index % 2) as f32; 3]);
        let shown = post.step(index, &at_lod(color.clone(), 2.0)).shown;
        assert_eq!(shown, color, "frame {index}");
        mean += f64::from(shown.pixels()[0][0]) / 40.0;
    }
    Some(format!("smr: 40 frames shown as they came, bit for bit; mean over time {mean:.3}"))
}
