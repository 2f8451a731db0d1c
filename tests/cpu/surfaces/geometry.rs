//! Surfaces that appear, disappear, move and z-fight, and gaze that moves: hard cases H50, H59, H60, H66, H67 for smr.

use super::rig::*;
use afterimage::{Method, Smr, Verdict};
use afterimage_testing::holds;

fn context_of(size: [u32; 2], settings: Settings) -> CpuAfterimage {
    CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(size) }).unwrap()
}

#[test]
fn h50_z_fighting_stays_next_to_the_colors_presented() {
    // Two surfaces that z-fight pixel by pixel, as a renderer of quarter resolution delivers them.
    let (a, b) = ([0.25, 0.5, 0.75], [0.75, 0.25, 0.5]);
    let (mut post, mut plain) = (context(MethodKind::Smr), context(MethodKind::Smr));
    let lods = Image::filled(SIZE, 2.0);
    let mut draws = Draws::new("z-fighting of surfaces");
    let mut beyond = 0.0_f32;
    for index in 0..100 {
        let picks = Image::from_fn(SIZE, |_| draws.uniform() < 0.5);
        let color = LowPass::new(&picks.map(|p| if p { a } else { b }), 4).render(&lods);
        let input = Input { depth: Some(picks.map(|p| if p { 3.0 } else { 3.0001 })), ..Input::at_lod(color, 2.0) };
        let made = step(&mut post, index, &input);
        let expected = step(&mut plain, index, &Input { depth: None, ..input });
        assert_eq!((&made.shown, &made.trace), (&expected.shown, &expected.trace), "frame {index}");
        for c in made.shown.pixels() {
            beyond = (0..3).fold(beyond, |w, i| w.max(c[i] - a[i].max(b[i])).max(a[i].min(b[i]) - c[i]));
        }
    }
    println!("{beyond} beyond the colors presented");
    assert!(beyond < 0.05, "{beyond}");
    holds!(
        "H50",
        Cpu,
        "smr, 100 frames: all as without depth, bit for bit; at the most {beyond:.4} beyond 0.25 to 0.75"
    );
}

#[test]
fn h59_h60_zoom_and_turn_leave_no_hole() {
    let before = noise(SIZE, "zoom of surfaces").map(|c| c.map(|v| 0.5 + 0.125 * (8.0 * v).floor() / 8.0));
    let low_pass = LowPass::new(&before, 4);
    let zoomed = |factor: f32| {
        // Samples without relighting.
        let plain = Method::Smr(Smr { relight: false, ..Smr::default() });
        let mut post = context_of(SIZE, Settings { method: plain, ..settings(MethodKind::Smr) });
        step(&mut post, 0, &Input::sharp(before.clone()));
        let shift = |v: u32, middle: f32| (v as f32 - middle) * (factor - 1.0);
        let motion = Image::from_fn(SIZE, |[x, y]| [shift(x, 26.0), shift(y, 20.0)]);
        // The frame as a renderer of quarter resolution delivers it.
        let color = Image::from_fn(SIZE, |[x, y]| {
            low_pass.at([f64::from(x) + f64::from(shift(x, 26.0)), f64::from(y) + f64::from(shift(y, 20.0))], 2.0)
        });
        let later = Input { motion: Some(motion), ..Input::at_lod(color, 2.0) };
        let made = step(&mut post, 1, &later);
        let mut kept = 0;
        for y in 0..41_usize {
            for x in 0..52_usize {
                let t = made.trace.at(x, y);
                let source = |at: usize, middle: f32| middle + (at as f32 - middle) * factor;
                let [qx, qy] = [source(x, 26.0), source(y, 20.0)];
                let shown = made.shown.at(x, y);
                if t.verdict != Verdict::Valid {
                    // Near the middle, where neighbours' vectors differ by much of themselves, they are taken for a
                    // silhouette's.
                    let inside = (-0.5..51.5).contains(&qx) && (-0.5..40.5).contains(&qy);
                    assert_eq!(t.verdict, if inside { Verdict::Disoccluded } else { Verdict::OffScreen });
                    assert_eq!(shown, later.color.at(x, y));
                    continue;
                }
                // On texels the sample itself, with its quality; between texels within the overshoot of the resampling.
                if qx.fract() == 0.0 && qy.fract() == 0.0 && t.survival == 1.0 {
                    assert_eq!(shown, before.at(qx as usize, qy as usize));
                    assert_eq!(made.surfaces()[y * 52 + x].lod, 0.0);
                    kept += 1;
                }
                assert!(shown.iter().all(|v| (0.45..0.7).contains(v)), "{shown:?}");
            }
        }
        [kept, made.stats.rejected()]
    };
    let ([near, none], [far, border]) = (zoomed(0.5), zoomed(2.0));
    assert!(near > 300 && none == 0 && far > 300 && border > 1000, "{near} {none} {far} {border}");
    holds!(
        "H59",
        Cpu,
        "smr, in x2: no hole, {near} samples on texels bit for bit and as sharp; out x2: {border} are the candidate"
    );

    let mut post = context(MethodKind::Smr);
    step(&mut post, 0, &Input::sharp(before));
    let later = Input::at_lod(Image::filled(SIZE, [0.5; 3]), 2.0);
    let made = step(&mut post, 1, &Input { motion: Some(Image::filled(SIZE, [5000.0, 0.0])), ..later.clone() });
    assert!(made.shown == later.color && made.stats.rejected() == 52 * 41);
    holds!("H60", Cpu, "smr: all 2132 pixels are the candidate, bit for bit");
}

/// Frames of a still picture as a renderer that follows the eye delivers them.
fn foveated(picture: &LowPass, gaze: [f32; 2], settings: &Settings) -> Input {
    let size = picture.0[0].size();
    let view = ViewGeometry::flat(size, 70.0).unwrap();
    let lods = settings.foveation.lod_map(&view, gaze, &view.eccentricity_map(gaze));
    Input { lod: None, gaze: Gaze::At { px: gaze }, ..Input::sharp(picture.render(&lods)) }
}

#[test]
fn h66_the_old_fovea_stays_sharp_after_a_saccade() {
    const WIDE: [u32; 2] = [320, 40];
    let settings = settings(MethodKind::Smr);
    let view = ViewGeometry::flat(WIDE, 70.0).unwrap();
    let at = |e: f32| view.project([e.to_radians().tan(), 0.0, 1.0]).unwrap();
    let sharp = noise(WIDE, "h66");
    let picture = LowPass::new(&sharp, 3);
    let mut post = context_of(WIDE, settings);
    for index in 0..3 {
        step(&mut post, index, &foveated(&picture, at(-10.0), &settings));
    }
    let stored = step(&mut post.clone(), 3, &foveated(&picture, at(-10.0), &settings)).stored();
    let old: Vec<usize> = (0..320 * 40)
        .filter(|i| view.eccentricity_deg([(i % 320) as f32, (i / 320) as f32], at(-10.0)) < 2.4)
        .collect();
    // 20 degrees to the right, for two seconds: no frame loses a pixel of it.
    for index in 3..123 {
        let made = step(&mut post, index, &foveated(&picture, at(10.0), &settings));
        let kept = old.iter().filter(|&&i| made.shown.pixels()[i] == stored.pixels()[i]).count();
        assert_eq!(kept, old.len(), "frame {index}");
        assert!(old.iter().all(|&i| made.surfaces()[i].lod == 0.0));
    }
    // The planted error: no history.
    let fresh = step(&mut context_of(WIDE, settings), 0, &foveated(&picture, at(10.0), &settings));
    assert!(old.iter().all(|&i| fresh.shown.pixels()[i] != stored.pixels()[i]));
    holds!(
        "H66",
        Cpu,
        "smr: all {} px of the old fovea bit for bit as sharp, 120 frames after 20 degrees; no decay",
        old.len()
    );
}

#[test]
fn h67_microsaccades_enlarge_what_is_shown_sharp() {
    const WIDE: [u32; 2] = [240, 120];
    // Levels are stored in sevenths: those finer than one and a half sevenths are stored as 0 or 1.
    const SHARP: f32 = 1.5 / 7.0;
    let settings = settings(MethodKind::Smr);
    let view = ViewGeometry::flat(WIDE, 40.0).unwrap();
    let px_per_deg = 240.0 / (2.0 * 20.0_f32.to_radians().tan()) * 1.0_f32.to_radians();
    let picture = LowPass::new(&noise(WIDE, "h67"), 3);
    let mut draws = Draws::new("microsaccades");
    // 1000 gazes a second within half a degree, of which a frame at 90 Hz sees the last.
    let stream: Vec<f32> = (0..500).map(|_| 119.5 + draws.range(-0.5, 0.5) * px_per_deg).collect();
    let gazes: Vec<[f32; 2]> = (0..45).map(|frame| [stream[(frame as f64 * 1000.0 / 90.0) as usize], 59.5]).collect();
    let sharp_after = |gazes: &[[f32; 2]]| {
        let mut post = context_of(WIDE, settings);
        let mut last = None;
        for (index, &gaze) in gazes.iter().enumerate() {
            let lods = settings.foveation.lod_map(&view, gaze, &view.eccentricity_map(gaze));
            let input = Input { lod: Some(lods.clone()), ..Input::sharp(picture.render(&lods)) };
            last = Some(step(&mut post, index as u64, &input));
        }
        last.unwrap().surfaces().iter().filter(|s| s.lod < SHARP).count()
    };
    let (moving, still) = (sharp_after(&gazes), sharp_after(&[[119.5, 59.5]; 3]));
    // Predicted: pixels within the radius of that level of any frame's gaze, by angles in f64.
    let ray = |x: f64, y: f64| {
        let scale = 20_f64.to_radians().tan() / 120.0;
        glam::DVec3::new((x - 119.5) * scale, (y - 59.5) * scale, 1.0)
    };
    let radius_deg = 2.5
        + f64::from(SHARP) / f64::from(settings.foveation.rate_mid).log2() * f64::from(settings.foveation.blend_deg);
    let seen = |x: u32, y: u32, gaze: &[f32; 2]| {
        let (r, g) = (ray(x.into(), y.into()), ray(gaze[0].into(), gaze[1].into()));
        r.cross(g).length().atan2(r.dot(g)).to_degrees() < radius_deg
    };
    let union =
        |gazes: &[[f32; 2]]| (0..240 * 120_u32).filter(|i| gazes.iter().any(|g| seen(i % 240, i / 240, g))).count();
    let (predicted, predicted_still) = (union(&gazes), union(&[[119.5, 59.5]]));
    println!("{moving} px sharp, {predicted} predicted; still {still}, {predicted_still}");
    assert!(moving >= predicted && still >= predicted_still && moving as f64 > 1.1 * still as f64);
    holds!(
        "H67",
        Cpu,
        "smr, 45 frames at 90 Hz: {moving} px sharp, union of the foveas {predicted}; without movement {still}"
    );
}
