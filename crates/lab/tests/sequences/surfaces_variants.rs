//! Variants of taa and smr: what a frame may lack or bring, conventions, filters, sizes. Bit equality throughout.

use super::rig::{Rig, View, noise_view};
use super::sequences::{SIZE, agree, exposure, foveated, settings, trust};
use afterimage::{ContextDesc, Filter, Foveation, Image, Method, MethodKind, Reset, Settings, Smr};
use afterimage_lab::source::AnalyticSource;
use afterimage_testing::Draws;

#[test]
fn every_filter_and_tunable_of_smr_agrees_bit_for_bit() {
    let base = settings(MethodKind::Smr);
    let with = |filter| Settings { foveation: Foveation { filter, ..base.foveation }, ..base };
    let smr = |smr| Settings { method: Method::Smr(smr), ..base };
    let fovea = |fovea_deg| Foveation { fovea_deg, mid_deg: 40.0, blend_deg: 7.0, ..base.foveation };
    let all = [
        with(Filter::Gauss),
        with(Filter::Block),
        Settings { foveation: with(Filter::Block).foveation, ..smr(Smr { relight: false, ..Smr::default() }) },
        smr(Smr { accumulate: 0.0, relight: false, ..Smr::default() }),
        Settings { foveation: fovea(0.0), ..smr(Smr { accumulate: 0.98, tolerance: 10.0, ..Smr::default() }) },
        Settings { foveation: fovea(20.0), ..smr(Smr { tolerance: 0.1, ..Smr::default() }) },
        Settings { foveation: Foveation { rate_mid: 1, rate_far: 256, ..base.foveation }, ..base },
    ];
    for (settings, scene) in all.into_iter().zip(["occluder", "light-step"].into_iter().cycle()) {
        println!("{settings:?}");
        agree(scene, settings, |_, v, _| v);
    }
    // Full rate everywhere: history shows where a candidate is broken, and nowhere else.
    let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), with(Filter::Off)) else { return };
    let mut source = AnalyticSource::new("lateral", SIZE, 70.0, 60.0).unwrap();
    for index in 0..4 {
        rig.both(index, Reset::None, &[foveated(&mut source, index, &with(Filter::Off).foveation)]);
    }
}

/// Levels of detail as an input: integers, fractions, levels beyond the mip chain, and non-finite values.
fn lod_of(index: u64, size: [u32; 2]) -> Image<f32> {
    let values = [0.0, 1.0, 2.0, 3.0, 1.5, 2.71, 0.1, 8.0, 8.9, 100.0, -1.0, -0.0, 1e-20];
    let broken = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX];
    Image::from_fn(size, |[x, y]| {
        let i = (x / 9 + y / 6 + index as u32 / 4) as usize;
        if (x + 3 * y).is_multiple_of(97) { broken[i % broken.len()] } else { values[i % values.len()] }
    })
}

#[test]
fn told_levels_of_detail_agree_bit_for_bit() {
    let base = settings(MethodKind::Smr);
    let with = |filter| Settings { foveation: Foveation { filter, ..base.foveation }, ..base };
    // taa ignores them.
    for settings in [with(Filter::Mip), with(Filter::Block), with(Filter::Off), settings(MethodKind::Taa)] {
        agree("occluder", settings, |index, v, _| View { lod: Some(lod_of(index, SIZE)), ..v });
    }
}

/// What a path tracer might tell of its noise, and what it must not.
fn noise(index: u64, size: [u32; 2]) -> Image<[f32; 2]> {
    let mut draws = Draws::new(&format!("noise {index}"));
    let broken = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 1e30, 0.0];
    Image::from_fn(size, |[x, y]| {
        let valid = [draws.range(0.0, 0.3), [1.0, 2.0, 8.0, 32.0][(x / 31 + y / 17) as usize % 4]];
        match (x + 3 * y) % 89 {
            0 => [broken[draws.bits() as usize % broken.len()], valid[1]],
            1 => [valid[0], broken[draws.bits() as usize % broken.len()]],
            _ => valid,
        }
    })
}

/// A view whose colors scatter by what it tells.
pub fn noisy(index: u64, view: View) -> View {
    let size = view.color.size();
    let noise = noise(index, size);
    let mut draws = Draws::new(&format!("scatter {index}"));
    let color = Image::from_fn(size, |[x, y]| {
        let [error, _] = noise.at(x as usize, y as usize);
        let by = if error.is_finite() { error.clamp(0.0, 1.0) * draws.range(-1.7, 1.7) } else { 0.0 };
        view.color.at(x as usize, y as usize).map(|c| c + by)
    });
    View { color, noise: Some(noise), ..view }
}

#[test]
fn noisy_frames_agree_bit_for_bit() {
    for method in [MethodKind::Wrs, MethodKind::Taa, MethodKind::None] {
        agree("still", Settings { noisy: true, ..settings(method) }, |index, v, _| noisy(index, v));
    }
    let base = Settings { noisy: true, ..settings(MethodKind::Smr) };
    let with = |filter| Settings { foveation: Foveation { filter, ..base.foveation }, ..base };
    for scene in ["lateral", "occluder"] {
        agree(scene, base, |index, v, _| noisy(index, v));
    }
    agree("lateral", with(Filter::Off), |index, v, _| noisy(index, v));
    agree("still", with(Filter::Block), |index, v, rig| {
        rig.exposure = exposure(index);
        View { depth: None, lod: Some(lod_of(index, SIZE)), trust: Some(trust(index)), ..noisy(index, v) }
    });
    let method = Method::Smr(Smr { relight: false, accumulate: 0.98, tolerance: 0.3, ..Smr::default() });
    agree("light-step", Settings { method, ..base }, |index, v, _| noisy(index, v));
    // Two views of odd sizes, and a history that is poisoned and reset.
    for size in [[65, 33], [1, 7]] {
        let desc = ContextDesc { view_count: 2, ..ContextDesc::new(size) };
        let Some(mut rig) = Rig::new(desc, base) else { return };
        for index in 0..6 {
            let still = noise_view(&format!("odd {}", index / 3), &desc);
            let eyes = [0, 1].map(|eye: u64| noisy(2 * index + eye, still.clone()));
            if index == 4 {
                rig.poison();
            }
            rig.both(index, if index == 4 { Reset::All } else { Reset::None }, &eyes);
        }
    }
}

#[test]
fn noise_is_asked_for_and_refused_by_the_setting() {
    let desc = ContextDesc::new(SIZE);
    for noisy_setting in [false, true] {
        let settings = Settings { noisy: noisy_setting, ..settings(MethodKind::Smr) };
        let Some(mut rig) = Rig::new(desc, settings) else { return };
        let view = noise_view("refused", &desc);
        let wrong = if noisy_setting { view.clone() } else { noisy(0, view.clone()) };
        let message = rig.refusal(&wrong);
        println!("{message}");
        assert!(message.contains("noise") && message.contains("Settings::noisy"), "{message}");
        let right = if noisy_setting { noisy(0, view) } else { view };
        rig.both(0, Reset::None, &[right]);
    }
}
