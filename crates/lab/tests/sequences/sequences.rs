//! Analytic scenes, 40 frames each, with resets, broken pixels and garbage vectors, through every variant of the pass.

use super::rig::{Rig, View};
use afterimage::simulator::Pyramid;
use afterimage::{
    Bias, ContextDesc, Exposure, Foveation, Gate, GateMetric, Gaze, Image, Method, MethodKind, Reset, Sampler,
    Settings, ViewFrame, Wrs,
};
use afterimage_lab::source::{AnalyticSource, FrameSource};
use afterimage_testing::Draws;

pub const SIZE: [u32; 2] = [150, 84];
const FRAMES: u64 = 40;

/// Frame `index` of a scene as a foveating renderer would deliver it, damaged here and there.
pub fn view(source: &mut AnalyticSource, index: u64) -> View {
    foveated(source, index, &Foveation { rate_mid: 4, rate_far: 8, ..Foveation::default() })
}

/// The same by another renderer.
pub fn foveated(source: &mut AnalyticSource, index: u64, foveation: &Foveation) -> View {
    let mut draws = Draws::new(&format!("damage {index}"));
    let frame = source.frame(index).unwrap();
    let geometry = *source.view();
    // The eye drifts, and jumps every ten frames; it is lost for a while.
    let jump = (index / 10) as f32;
    let px = [30.0 + 25.0 * jump + 0.3 * index as f32, 60.0 - 12.0 * jump];
    let lods = foveation.lod_map(&geometry, px, &geometry.eccentricity_map(px));
    let mut color = foveation.render(&Pyramid::new(frame.color, foveation.max_level()), &lods);
    let mut motion = frame.motion.unwrap();
    let mut depth = frame.depth.unwrap();
    for _ in 0..20 {
        let i = (draws.uniform() * color.pixels().len() as f32) as usize;
        let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -3.0][draws.bits() as usize % 5];
        match draws.bits() % 3 {
            0 => color.pixels_mut()[i][1] = bad,
            1 => motion.pixels_mut()[i][0] = bad,
            _ => depth.pixels_mut()[i] = bad,
        }
    }
    let gaze = if (13..17).contains(&index) { Gaze::Lost } else { Gaze::At { px } };
    let facts = ViewFrame { previous_from_current: frame.previous_from_current, ..ViewFrame::new(geometry, gaze) };
    View { facts, color, depth: Some(depth), motion: Some(motion), trust: None, lod: None, noise: None, repaired: None }
}

/// A mask that moves over the frame: full trust, none, some, and numbers that are none.
pub fn trust(index: u64) -> Image<f32> {
    let values = [1.0, 1.0, 0.7, 1.0, 0.25, 0.0, 1.5, f32::NAN, -0.5, 1.0, f32::INFINITY, 1e-30];
    Image::from_fn(SIZE, |[x, y]| values[(x / 7 + y / 5 + index as u32 / 4) as usize % values.len()])
}

pub fn reset(index: u64) -> Reset {
    if index == 24 { Reset::All } else { Reset::None }
}

/// Runs a scene through both and compares every word.
fn agree(scene: &str, settings: Settings, change: impl Fn(View) -> View) {
    agree_exposed(scene, settings, |_| Exposure::Same, |_, view| change(view));
}

/// The same with exposures, and changes by frame.
fn agree_exposed(
    scene: &str,
    settings: Settings,
    exposure: impl Fn(u64) -> Exposure,
    change: impl Fn(u64, View) -> View,
) {
    let mut source = AnalyticSource::new(scene, SIZE, 70.0, 60.0).unwrap();
    let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), settings) else { return };
    let (mut flushed, mut kept) = (0, 0);
    for index in 0..FRAMES {
        rig.exposure = exposure(index);
        let views = [change(index, view(&mut source, index))];
        let (cpu, trace) = rig.on_cpu(index, reset(index), &views);
        let gpu = rig.on_gpu(index, reset(index), &views);
        assert_eq!(gpu.stats, cpu.stats, "{scene}, frame {index}: counted");
        for (i, t) in trace[0].pixels().iter().enumerate() {
            let [x, y] = [i as u32 % SIZE[0], i as u32 / SIZE[0]];
            let decision = |words: [u32; 3]| words[2] & 0xff;
            assert_eq!(
                decision(gpu.words[i]),
                decision(cpu.words[i]),
                "{scene}, frame {index}, pixel ({x}, {y}): kept or replaced; the CPU decided {t:?}"
            );
            assert_eq!(gpu.words[i], cpu.words[i], "{scene}, frame {index}, pixel ({x}, {y}): stored; {t:?}");
            assert_eq!(gpu.shown[i], cpu.shown[i], "{scene}, frame {index}, pixel ({x}, {y}): shown; {t:?}");
            kept += usize::from(!t.take);
            flushed += usize::from(t.verdict as u32 > 1);
        }
    }
    println!("{scene}: {kept} kept and {flushed} flushed pixels agree");
    assert!(kept > 1000);
}

#[test]
fn the_default_agrees_bit_for_bit() {
    for scene in ["still", "lateral", "occluder", "light-step", "scroll"] {
        agree(scene, Settings::paper(), |v| v);
    }
}

#[test]
fn taa_and_smr_agree_bit_for_bit() {
    let base =
        Settings { foveation: Foveation { rate_mid: 4, rate_far: 8, ..Foveation::default() }, ..Settings::paper() };
    for scene in ["still", "lateral", "occluder", "light-step"] {
        for method in [MethodKind::Taa, MethodKind::Smr, MethodKind::Taau] {
            println!("{method:?}");
            agree(scene, Settings { method: method.into(), ..base }, |v| v);
        }
    }
}

#[test]
fn every_variant_agrees_bit_for_bit() {
    let base = Settings::paper();
    let paper = Wrs::default();
    let wrs = |wrs| Settings { method: Method::Wrs(wrs), ..base };
    let fovea = |fovea_deg| Foveation { fovea_deg, mid_deg: 40.0, ..Foveation::default() };
    let lightness = Gate { metric: GateMetric::Lightness, divisor: 30.0, offset: 2.0, ..Gate::default() };
    for settings in [
        Settings { seed: 9, ..wrs(Wrs { gate: None, ..paper }) },
        wrs(Wrs { gate: Some(lightness), ..paper }),
        wrs(Wrs { bias: Bias::Exponential { lambda: 0.05 }, ..paper }),
        wrs(Wrs { bias: Bias::None, gate: None, ..paper }),
        wrs(Wrs { sampler: Sampler::AEs, ..paper }),
        Settings::weighted(),
        wrs(Wrs { sampler: Sampler::AChao, ..Wrs::weighted() }),
        wrs(Wrs { sampler: Sampler::AEs, bias: Bias::Exponential { lambda: 0.02 }, gate: None, ..paper }),
        Settings { depth_test: None, ..base },
        Settings { foveation: fovea(0.0), ..base },
        Settings { foveation: fovea(20.0), ..base },
    ] {
        println!("{settings:?}");
        agree("occluder", settings, |v| v);
    }
}

#[test]
fn absent_inputs_are_switched_off() {
    let base = Settings::paper();
    agree("lateral", base, |v| View { depth: None, ..v });
    agree("still", base, |v| View { motion: None, ..v });
    agree("still", base, |v| View { motion: None, depth: None, ..v });
}

#[test]
fn trust_and_exposure_agree_bit_for_bit() {
    // Some stops up and down, thirds of stops, a fade to nothing, and no change.
    let ratios = [1.0, 2.0, 0.5, 1.26, 0.794, 256.0, 1.0 / 256.0, 1e-30, 1e30];
    let exposure = |index: u64| match index % 4 {
        0 => Exposure::Same,
        _ => Exposure::Changed { ratio: ratios[index as usize % ratios.len()] },
    };
    let ungated = Wrs { gate: None, ..Wrs::default() };
    for wrs in [Wrs::default(), ungated, Wrs { sampler: Sampler::AEs, ..ungated }] {
        let settings = Settings { method: Method::Wrs(wrs), ..Settings::default() };
        println!("{settings:?}");
        agree_exposed("occluder", settings, exposure, |_, v| v);
        let masked = |index, v| View { trust: Some(trust(index)), ..v };
        agree_exposed("occluder", settings, |_| Exposure::Same, masked);
        agree_exposed("lateral", settings, exposure, |index, v| View { depth: None, ..masked(index, v) });
    }
}

#[test]
fn method_none_shows_the_sanitized_frame() {
    let mut source = AnalyticSource::new("lateral", SIZE, 70.0, 60.0).unwrap();
    let settings = Settings { method: Method::None, ..Settings::paper() };
    let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), settings) else { return };
    for index in 0..3 {
        let views = [view(&mut source, index)];
        let (gpu, cpu) = (rig.on_gpu(index, Reset::None, &views), rig.on_cpu(index, Reset::None, &views).0);
        assert_eq!((gpu.shown, gpu.stats), (cpu.shown, cpu.stats));
    }
}
