//! Analytic scenes with resets, broken pixels and garbage vectors, 14 frames each, through every variant.

use super::rig::{Rig, View};
use afterimage::simulator::Pyramid;
use afterimage::{
    Bias, ContextDesc, Exposure, Foveation, Gate, GateMetric, Gaze, Image, Method, MethodKind, Reset, Sampler,
    Settings, ViewFrame, Wrs,
};
use afterimage_lab::source::{AnalyticSource, FrameSource};
use afterimage_testing::Draws;

pub const SIZE: [u32; 2] = [150, 84];

/// Frame `index` of a scene as a foveating renderer would deliver it, damaged here and there.
pub fn view(source: &mut AnalyticSource, index: u64) -> View {
    foveated(source, index, &Foveation { rate_mid: 4, rate_far: 8, ..Foveation::default() })
}

/// The same by another renderer.
pub fn foveated(source: &mut AnalyticSource, index: u64, foveation: &Foveation) -> View {
    let mut draws = Draws::new(&format!("damage {index}"));
    let frame = source.frame(index).unwrap();
    let geometry = *source.view();
    // The eye drifts, and jumps every five frames; it is lost for a while.
    let jump = (index / 5) as f32;
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
    let gaze = if (7..9).contains(&index) { Gaze::Lost } else { Gaze::At { px } };
    let facts = ViewFrame { previous_from_current: frame.previous_from_current, ..ViewFrame::new(geometry, gaze) };
    View { facts, depth: Some(depth), motion: Some(motion), ..View::still(color, [0.0; 2]) }
}

/// A mask that moves over the frame: full trust, none, some, and numbers that are none.
pub fn trust(index: u64) -> Image<f32> {
    let values = [1.0, 1.0, 0.7, 1.0, 0.25, 0.0, 1.5, f32::NAN, -0.5, 1.0, f32::INFINITY, 1e-30];
    Image::from_fn(SIZE, |[x, y]| values[(x / 7 + y / 5 + index as u32 / 4) as usize % values.len()])
}

pub fn reset(index: u64) -> Reset {
    if index == 12 { Reset::All } else { Reset::None }
}

pub fn settings(method: MethodKind) -> Settings {
    let foveation = Foveation { rate_mid: 4, rate_far: 8, ..Foveation::default() };
    Settings { method: method.into(), foveation, ..Settings::paper() }
}

/// The methods that store surfaces.
pub fn surfaces() -> [Settings; 3] {
    [MethodKind::Taa, MethodKind::Smr, MethodKind::Taau].map(settings)
}

/// Runs 14 frames of a damaged scene through both, which must agree in every bit of what they show, keep and count.
#[track_caller]
pub fn agree(scene: &str, settings: Settings, change: impl Fn(u64, View, &mut Rig) -> View) {
    let desc = ContextDesc::new(SIZE);
    let Some(mut rig) = Rig::new(desc, settings) else { return };
    let mut source = AnalyticSource::new(scene, desc.size_px, 70.0, 60.0).unwrap();
    let (mut kept, mut flushed) = (0, 0);
    for index in 0..14 {
        // What wrs is given does not depend on its foveation.
        let view = match settings.method {
            Method::Wrs(_) => view(&mut source, index),
            _ => foveated(&mut source, index, &settings.foveation),
        };
        let view = change(index, view, &mut rig);
        let (_, trace) = rig.both(index, reset(index), &[view]);
        kept += trace[0].pixels().iter().filter(|t| !t.is_replaced).count();
        flushed += trace[0].pixels().iter().filter(|t| t.verdict as u32 > 1).count();
    }
    println!("{settings:?}, {scene}: {kept} kept and {flushed} flushed pixels agree");
    assert!(kept > 1000 || settings.method == Method::None, "history must play a part");
}

fn agree_as_is(scene: &str, settings: Settings) {
    agree(scene, settings, |_, v, _| v);
}

/// Some stops up and down, thirds of stops, a fade to nothing, and no change.
pub fn exposure(index: u64) -> Exposure {
    let ratios = [1.0, 2.0, 0.5, 1.26, 0.794, 256.0, 1.0 / 256.0, 1e-30, 1e30];
    match index % 4 {
        0 => Exposure::Same,
        _ => Exposure::Changed { ratio: ratios[index as usize % ratios.len()] },
    }
}

#[test]
fn the_defaults_agree_bit_for_bit() {
    for (settings, scenes) in [(Settings::paper(), &["lateral", "occluder", "scroll"][..])]
        .into_iter()
        .chain(surfaces().map(|settings| (settings, &["occluder", "light-step"][..])))
    {
        scenes.iter().for_each(|scene| agree_as_is(scene, settings));
    }
    // The frame with what is broken replaced.
    agree_as_is("lateral", Settings { method: Method::None, ..Settings::paper() });
}

#[test]
fn every_variant_agrees_bit_for_bit() {
    let base = Settings::paper();
    let paper = Wrs::default();
    let wrs = |wrs| Settings { method: Method::Wrs(wrs), ..base };
    let fovea = |fovea_deg| Foveation { fovea_deg, mid_deg: 40.0, ..Foveation::default() };
    let lightness = Gate { metric: GateMetric::Lightness, divisor: 30.0, offset: 2.0, ..Gate::default() };
    for settings in [
        Settings { seed: 9, foveation: fovea(0.0), ..wrs(Wrs { bias: Bias::None, gate: None, ..paper }) },
        Settings { foveation: fovea(20.0), ..wrs(Wrs { gate: Some(lightness), ..paper }) },
        wrs(Wrs { bias: Bias::Exponential { lambda: 0.05 }, ..paper }),
        wrs(Wrs { sampler: Sampler::AEs, bias: Bias::Exponential { lambda: 0.02 }, gate: None, ..paper }),
        Settings::weighted(),
        wrs(Wrs { sampler: Sampler::AChao, ..Wrs::weighted() }),
    ] {
        agree_as_is("occluder", settings);
    }
}

#[test]
fn absent_inputs_are_switched_off() {
    for base in [Settings::paper()].into_iter().chain(surfaces()) {
        agree("lateral", base, |_, v, _| View { depth: None, ..v });
        agree("still", base, |_, v, _| View { motion: None, ..v });
        agree_as_is("occluder", Settings { depth_test: None, ..base });
    }
}

#[test]
fn trust_and_exposure_agree_bit_for_bit() {
    let wrs = [Wrs::default(), Wrs { sampler: Sampler::AEs, gate: None, ..Wrs::default() }];
    let wrs = wrs.map(|wrs| Settings { method: Method::Wrs(wrs), ..Settings::default() });
    for settings in wrs.into_iter().chain(surfaces()) {
        agree("occluder", settings, |index, v, rig| {
            rig.exposure = exposure(index);
            // The mask has NaN, infinity, numbers below 0 and above 1.
            View { trust: Some(trust(index)), ..v }
        });
    }
}
