//! What a headset's lens hides.

use super::sparse::{SIZE, arrange, desc, gliding_view, settings};
use super::*;

const FRAMES: u64 = 12;

/// An octagon that cuts off corners and edges, another one in each view.
fn lens_of(v: u32) -> [[f32; 4]; 2] {
    let [width, height] = SIZE.map(|side| side as f32);
    let inset = 3.0 + 2.0 * v as f32;
    let lowest = [inset, 2.0, 16.0, 14.0 - height];
    [lowest, [width - 4.0, height - 1.0 - inset, width + height - 20.0, width - 12.0]]
}

fn hides(v: u32, [x, y]: [u32; 2]) -> bool {
    let ([lowest, highest], [x, y]) = (lens_of(v), [x as f32, y as f32]);
    let along = [x, y, x + y, x - y].into_iter();
    along.zip(lowest.into_iter().zip(highest)).any(|(at, (low, high))| at < low || at > high)
}

/// Two views that glide through the lenses.
fn views(index: u64, settings: &Settings) -> [View; 2] {
    [0, 1].map(|v| {
        let mut view = gliding_view(index, v);
        let jitters = matches!(settings.method, Method::Smr(Smr { antialias: true, .. }));
        view.facts.jitter_px = if jitters { Foveation::jitter_px(index) } else { [0.0; 2] };
        view.facts.visible_px = Some(lens_of(v));
        let noise = Image::from_fn(SIZE, |[x, y]| [0.02 * (x % 3) as f32, 1.0 + (y % 4) as f32]);
        view.noise = settings.noisy.then_some(noise);
        view
    })
}

#[test]
fn what_a_lens_hides_is_black_without_history_and_never_shaded() {
    let smr = |antialias, noisy, foveation| {
        let method = Method::Smr(Smr { antialias, ..Smr::default() });
        Settings { method, noisy, foveation, ..Settings::default() }
    };
    let quads = Foveation::quads();
    let single = Foveation { single_pixels: true, rate_mid: 2, rate_far: 4, ..quads };
    let all = [
        (false, false, quads),
        (true, false, quads),
        (false, false, single),
        (true, false, single),
        (false, true, single),
    ];
    for (antialias, noisy, foveation) in all {
        let settings = smr(antialias, noisy, foveation);
        let Some(mut rig) = Rig::new(desc(), settings) else { return };
        let (mut hidden, mut shaded) = (0, 0);
        for index in 0..FRAMES {
            arrange(index, &mut rig);
            let reset = if index == 7 { Reset::All } else { Reset::None };
            let (made, _) = rig.both(index, reset, &views(index, &settings));
            let pixels = (SIZE[0] * SIZE[1]) as usize;
            for (i, shown) in made.shown.iter().enumerate() {
                let (v, i) = ((i / pixels) as u32, i % pixels);
                let px = [i as u32 % SIZE[0], i as u32 / SIZE[0]];
                if hides(v, px) {
                    hidden += 1;
                    assert_eq!(*shown, [0; 3], "{px:?}");
                    assert_eq!(made.words[v as usize * pixels + i][1] & 63, 0, "{px:?} has history");
                }
            }
            let columns = SIZE[0].div_ceil(2);
            let quads_a_view = (columns * SIZE[1].div_ceil(2)) as usize;
            for (i, &mask) in made.quads.iter().enumerate().filter(|(_, mask)| **mask != 0) {
                let (v, i) = ((i / quads_a_view) as u32, (i % quads_a_view) as u32);
                // Some pixel of a whole quad is seen; so is one that is shaded alone.
                let of_quad = (0..4).filter(|k| mask >> k & 1 == 1);
                let px: Vec<_> = of_quad.map(|k| [2 * (i % columns) + k % 2, 2 * (i / columns) + k / 2]).collect();
                assert!(px.iter().any(|px| !hides(v, *px)), "{px:?} is shaded");
                shaded += 1;
            }
        }
        println!("antialias {antialias}, noisy {noisy}: {hidden} hidden pixels, {shaded} quads shaded");
        assert!(hidden > 1000 && shaded > 100);
    }
}

/// A first frame, which no history can have come to from beyond.
#[test]
fn what_a_lens_shows_is_as_without_it() {
    for [antialias, noisy] in [[false, false], [true, false], [false, true]] {
        let method = Method::Smr(Smr { antialias, ..Smr::default() });
        let settings = Settings { method, noisy, ..settings(MethodKind::Smr) };
        let Some(mut rig) = Rig::new(desc(), settings) else { return };
        // Of the same samples: a plan leaves out what the lens hides.
        let mask = Image::from_fn(SIZE, |[x, y]| if (x + y).is_multiple_of(3) { 1.0 } else { 0.0 });
        let mut seen = views(0, &settings).map(|view| View { mask: Some(mask.clone()), ..view });
        let made = rig.on_gpu(0, Reset::All, &seen);
        seen.iter_mut().for_each(|view| view.facts.visible_px = None);
        let all = rig.on_gpu(0, Reset::All, &seen);
        let differing = all.shown.iter().zip(&made.shown).enumerate().filter(|(_, (all, made))| all != made);
        for (i, _) in differing {
            let (v, i) = (i as u32 / (SIZE[0] * SIZE[1]), i as u32 % (SIZE[0] * SIZE[1]));
            assert!(hides(v, [i % SIZE[0], i / SIZE[0]]), "view {v}, pixel {i}");
        }
    }
}
