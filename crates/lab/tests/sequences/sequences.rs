//! Analytic scenes with resets, broken pixels and garbage vectors, 14 frames each, through every variant. Bit equality
//! throughout.

use super::rig::{Rig, View, noise_view};
use afterimage::internal::{
    Bias, ContextDesc, Foveation, FoveationKind, Gate, GateMetric, Method, MethodKind, Pyramid, Reset, Sampler,
    Settings, Smr, ViewFrame, Wrs,
};
use afterimage::{Exposure, Gaze, Image};
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
    let lods = foveation.lod_map(&geometry, px);
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
fn agree(scene: &str, settings: Settings, change: impl Fn(u64, View, &mut Rig) -> View) {
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
    // Where all is at full rate, history shows at broken pixels alone.
    let is_shown = settings.method != Method::None && settings.foveation.kind != FoveationKind::Off;
    assert!(kept > 1000 || !is_shown, "history must play a part");
}

/// Some stops up and down, thirds of stops, a fade to nothing, and no change.
fn exposure(index: u64) -> Exposure {
    let ratios = [1.0, 2.0, 0.5, 1.26, 0.794, 256.0, 1.0 / 256.0, 1e-30, 1e30];
    match index % 4 {
        0 => Exposure::Same,
        _ => Exposure::Changed { ratio: ratios[index as usize % ratios.len()] },
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

/// Every method, sampler, bias, gate, filter and tunable that has a path of its own: with what a frame has to have, and
/// with all that it may bring.
#[test]
fn every_variant_agrees_bit_for_bit() {
    let base = Settings::paper();
    let wrs = |wrs| Settings { method: Method::Wrs(wrs), ..base };
    let lightness = Gate { metric: GateMetric::Lightness, divisor: 30.0, offset: 2.0, ..Gate::default() };
    let keyed = Wrs { sampler: Sampler::AEs, bias: Bias::Exponential { lambda: 0.02 }, gate: None, ..Wrs::default() };
    let unbiased = Wrs { bias: Bias::None, ..Wrs::default() };
    let smr = settings(MethodKind::Smr);
    let with = |filter| Settings { foveation: Foveation { kind: filter, ..smr.foveation }, ..smr };
    let tuned = Smr { accumulate: 0.98, tolerance: 0.3, relight: false, ..Smr::default() };
    let all = [
        base,
        Settings { method: Method::None, ..base },
        wrs(Wrs { gate: Some(lightness), ..Wrs::default() }),
        Settings { seed: 9, depth_test: None, ..wrs(unbiased) },
        wrs(keyed),
        Settings::weighted(),
        settings(MethodKind::Taa),
        settings(MethodKind::Taau),
        smr,
        with(FoveationKind::Gauss),
        with(FoveationKind::Off),
        Settings { method: Method::Smr(tuned), ..with(FoveationKind::Block) },
    ];
    for (settings, scene) in all.into_iter().zip(["occluder", "lateral", "light-step"].into_iter().cycle()) {
        agree(scene, settings, |_, v, _| v);
        agree("occluder", Settings { noisy: true, ..settings }, |index, v, rig| {
            rig.exposure = exposure(index);
            View { trust: Some(trust(index)), lod: Some(lod_of(index, SIZE)), ..noisy(index, v) }
        });
    }
}

#[test]
fn noise_is_asked_for_and_refused_by_the_setting() {
    let desc = ContextDesc::new(SIZE);
    let calm = noise_view("refused", &desc);
    let told = noisy(0, calm.clone());
    for (is_noisy, right, wrong) in [(false, &calm, &told), (true, &told, &calm)] {
        let settings = Settings { noisy: is_noisy, ..settings(MethodKind::Smr) };
        let Some(mut rig) = Rig::new(desc, settings) else { return };
        let message = rig.refusal(wrong);
        println!("{message}");
        assert!(message.contains("noise") && message.contains("Settings::noisy"), "{message}");
        rig.both(0, Reset::None, std::slice::from_ref(right));
    }
}
