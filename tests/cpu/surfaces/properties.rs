//! S1, S2, S6 and S8 over random frames.

use super::rig::*;
use afterimage::Verdict;
use afterimage::kernel::lod::MAX_LOD;

/// Coarse, moving, partly distrusted frames, as engines may deliver. Motion in quarters of a pixel, constant over large
/// areas.
fn busy(name: &str) -> View {
    let mut draws = Draws::new(name);
    let size = SIZE;
    let shift = [0; 2].map(|_| (draws.bits() % 17) as f32 * 0.25 - 2.0);
    let split = draws.range(8.0, 40.0);
    let lods = Image::from_fn(size, |_| if draws.uniform() < 0.3 { 0.0 } else { draws.range(0.0, 2.0) });
    let trust = Image::from_fn(size, |_| if draws.uniform() < 0.8 { 1.0 } else { draws.uniform() });
    let near = |x: u32| (x as f32) < split;
    View {
        lod: Some(lods),
        depth: Some(Image::from_fn(size, |[x, _]| if near(x) { 2.0 } else { 5.0 })),
        motion: Some(Image::from_fn(size, |[x, _]| if near(x) { shift } else { [0.0; 2] })),
        trust: Some(trust),
        ..sharp(LowPass::new(&noise(size, name), 3).render(&Image::filled(size, 0.5)))
    }
}

#[test]
fn s1_inside_the_fovea_the_candidate_is_shown_bit_for_bit() {
    let mut post = context(MethodKind::Smr);
    let mut foveal = 0;
    for index in 0..40 {
        let input = busy(&format!("s1 {index}"));
        let made = post.step(index, &input);
        let surfaces = made.surfaces();
        for (i, lod) in input.lod.as_ref().unwrap().pixels().iter().enumerate().filter(|(_, l)| **l == 0.0) {
            assert_eq!(bits(made.shown.pixels()[i]), bits(input.color.pixels()[i]), "frame {index}, pixel {i}");
            foveal += 1;
            // Stored as sharp, except where the motion vector is on a silhouette.
            assert!(surfaces[i].lod == 0.0 || surfaces[i].lod == MAX_LOD && lod == &0.0);
        }
        assert!(index == 0 || made.trace.pixels().iter().any(|t| t.history_share > 0.0), "history is used elsewhere");
    }
    assert!(foveal > 10_000);
}

#[test]
fn s2_without_a_valid_history_the_candidate_and_its_level_are_shown_and_stored() {
    let before = View { depth: Some(Image::filled(SIZE, 4.0)), ..sharp(noise(SIZE, "s2 before")) };
    let lods = Image::from_fn(SIZE, |[x, y]| ((x + 3 * y) % 40) as f32 * 0.05);
    let plain = View {
        lod: Some(lods.clone()),
        depth: before.depth.clone(),
        ..sharp(LowPass::new(&before.color, 3).render(&lods))
    };
    let motion = |m: [f32; 2]| Some(Image::filled(SIZE, m));
    let cases = [
        (Verdict::Reset, plain.clone()),
        (Verdict::Distrusted, View { trust: Some(Image::filled(SIZE, 0.0)), ..plain.clone() }),
        (Verdict::OffScreen, View { motion: motion([100.0, 0.0]), ..plain.clone() }),
        (Verdict::Disoccluded, View { depth: Some(Image::filled(SIZE, 9.0)), ..plain.clone() }),
        (Verdict::Disoccluded, View { depth: Some(Image::filled(SIZE, f32::NAN)), ..plain.clone() }),
        (Verdict::BadMotion, View { motion: motion([1e9, 0.0]), ..plain.clone() }),
        (Verdict::BadMotion, View { motion: motion([f32::NAN, 0.0]), ..plain.clone() }),
    ];
    for method in METHODS {
        let mut seen = context(method);
        seen.step(0, &before);
        let kept = seen.clone().step(1, &plain);
        assert_ne!(kept.shown, plain.color, "the planted error: a history");
        for (verdict, input) in &cases {
            let reset = if *verdict == Verdict::Reset { Reset::All } else { Reset::None };
            let made = seen.clone().make(1, input, Exposure::Same, reset);
            assert!(made.trace.pixels().iter().all(|t| t.verdict == *verdict), "{verdict:?}");
            assert_eq!(made.shown, input.color, "{method:?} {verdict:?}");
            for (s, &lod) in made.surfaces().iter().zip(lods.pixels()) {
                // A NaN vector is unlike its neighbours'.
                let nowhere = input.motion.as_ref().is_some_and(|m| m.pixels()[0][0].is_nan());
                let expected = match method {
                    // It has the confidence of one sample.
                    MethodKind::Taa | MethodKind::Taau => 6.0,
                    _ if nowhere => MAX_LOD,
                    // In sevenths, up to 62 of them.
                    _ => (lod * 7.0).round().min(62.0) / 7.0,
                };
                assert!((s.lod - expected).abs() < 1e-6, "{method:?} {verdict:?}: {} for {expected}", s.lod);
            }
        }
    }
}

#[test]
fn a_vector_unlike_its_neighbours_leads_nowhere_and_is_not_kept() {
    let mut post = context(MethodKind::Smr);
    let picture = noise(SIZE, "coherent");
    post.step(0, &sharp(picture.clone()));
    // A single pixel; and a row of three, of which the first two share a 2x2 block and the last has no neighbour in its
    // own.
    let odd = [[10, 10], [20, 10], [21, 10], [22, 10]];
    let motion = Image::from_fn(SIZE, |at| if odd.contains(&at) { [2.0, 0.0] } else { [0.0; 2] });
    let input =
        View { motion: Some(motion), ..at_lod(LowPass::new(&picture, 3).render(&Image::filled(SIZE, 1.0)), 1.0) };
    let made = post.step(1, &input);
    for (px, surface) in pixels(SIZE).zip(made.surfaces()) {
        let nowhere = [[10, 10], [22, 10]].contains(&px);
        let verdict = if nowhere { Verdict::Disoccluded } else { Verdict::Valid };
        assert_eq!(pixel(&made.trace, px).verdict, verdict, "{px:?}");
        if nowhere {
            assert_eq!(bits(pixel(&made.shown, px)), bits(pixel(&input.color, px)));
            assert_eq!(surface.lod, MAX_LOD);
        } else if ![[20, 10], [21, 10]].contains(&px) {
            assert_eq!(surface.lod, 0.0, "{px:?}");
        }
    }
}

/// A few frames with all colors times `ratio` from frame `from` on; `is_declared`: whether the frame's exposure states
/// this ratio.
fn exposed(method: MethodKind, ratio: f32, from: u64, is_declared: bool) -> Vec<Made> {
    let mut post = context(method);
    let mut frame = |index: u64| {
        let busy = busy(&format!("exposure {index}"));
        let input = View { color: times(&busy.color, if index >= from { ratio } else { 1.0 }), ..busy };
        let is_change = is_declared && index == from;
        post.exposed(index, &input, if is_change { Exposure::Changed { ratio } } else { Exposure::Same })
    };
    (0..6).map(&mut frame).collect()
}

#[test]
fn s6_a_declared_exposure_is_as_if_it_had_always_been() {
    for method in METHODS {
        // Powers of two shift exponents alone, and before the change there was a first frame only, in which nothing is
        // compared: the gate's differences grow with the square root of light, so that later frames decide by their own
        // exposure.
        for ratio in [0.25, 0.5, 2.0, 16.0] {
            let always = exposed(method, ratio, 0, false);
            let declared = exposed(method, ratio, 1, true);
            let undeclared = exposed(method, ratio, 1, false);
            for index in 1..6 {
                assert_eq!(declared[index].shown, always[index].shown, "{method:?}, {ratio}, frame {index}");
                assert_eq!(declared[index].words, always[index].words);
            }
            assert_ne!(undeclared[1].shown, always[1].shown, "the planted error: undeclared");
        }
    }
}

#[test]
fn s8_the_index_of_a_frame_and_the_number_of_threads_do_not_matter() {
    for method in METHODS {
        let run = |from: u64, seed: u64, threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut post = context_of(SIZE, Settings { seed, ..settings(method) });
                (0..6).map(|i| post.step(from + 7 * i, &busy(&format!("s8 {i}")))).collect::<Vec<_>>()
            })
        };
        let first = run(0, 0, 1);
        assert!(first == run(1 << 40, 99, 3), "{method:?}");
        assert!(first.iter().skip(1).all(|m| m.trace.pixels().iter().any(|t| t.history_share > 0.0)));
    }
}

#[test]
fn s8_a_picture_16_pixels_further_becomes_the_same_16_pixels_further() {
    // Each frame borders reach two coarsest texels of 16 pixels further in.
    const WIDE: [u32; 2] = [208, 224];
    const MARGIN: u32 = 2 * 2 * 16 + 8;
    for method in METHODS {
        let run = |offset: [u32; 2]| {
            let mut post = context_of(WIDE, settings(method));
            let frame = |index: u32| {
                let world = noise([WIDE[0] + 64, WIDE[1] + 64], &format!("world {index}"));
                let window = |[x, y]: [u32; 2]| [x + offset[0], y + offset[1]];
                let near = |at: [u32; 2]| window(at)[0] / 24 % 2 == 0;
                let color = Image::from_fn(WIDE, |at| pixel(&world, window(at)).map(|v| 0.4 + 0.1 * v));
                let input = View {
                    lod: Some(Image::from_fn(WIDE, |at| (window(at)[1] % 24) as f32 / 12.0 * (index.min(1) as f32))),
                    depth: Some(Image::from_fn(WIDE, |at| if near(at) { 2.0 } else { 4.0 })),
                    motion: Some(Image::from_fn(WIDE, |at| if near(at) { [-0.25, 0.75] } else { [1.0, 0.0] })),
                    ..sharp(color)
                };
                post.step(index.into(), &input)
            };
            (0..3).map(frame).last().unwrap()
        };
        let (here, there) = (run([0, 0]), run([16, 32]));
        let mut used = 0;
        for [x, y] in pixels([208 - 2 * MARGIN - 16, 224 - 2 * MARGIN - 32]) {
            let t = ((y + MARGIN) * 208 + x + MARGIN) as usize;
            let h = t + 32 * 208 + 16;
            assert_eq!(here.shown.pixels()[h], there.shown.pixels()[t], "{method:?} ({x}, {y})");
            assert_eq!(here.words[h], there.words[t]);
            used += usize::from(there.trace.pixels()[t].history_share > 0.0);
        }
        assert!(used > 500, "{used} use history");
    }
}
