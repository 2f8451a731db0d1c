//! Small frames of arbitrary bit patterns, for properties of whole passes on either executor.

use crate::images::View;
use afterimage::internal::{Bias, Foveation, FoveationKind, Method, MethodKind, Sampler, Settings, ViewFrame, Wrs};
use afterimage::{Gaze, Image, ViewGeometry};
use afterimage_testing::Draws;

pub const SIZE: [u32; 2] = [8, 6];

/// Every method, sampler, bias and filter that has a path of its own; the last one is noisy.
pub fn all_settings() -> Vec<Settings> {
    let of = |method: MethodKind| Settings { method: method.into(), ..Settings::default() };
    let keyed = Wrs { sampler: Sampler::AEs, bias: Bias::Exponential { lambda: 0.1 }, gate: None, ..Wrs::default() };
    let blocks = Foveation { kind: FoveationKind::Block, ..Foveation::default() };
    vec![
        of(MethodKind::None),
        of(MethodKind::Wrs),
        Settings::weighted(),
        Settings { method: Method::Wrs(keyed), ..Settings::default() },
        of(MethodKind::Taa),
        of(MethodKind::Taau),
        of(MethodKind::Smr),
        Settings { foveation: blocks, ..of(MethodKind::Smr) },
        Settings { noisy: true, ..of(MethodKind::Smr) },
    ]
}

/// Arbitrary bits with probability `wild`, else a number in [low, high).
pub fn number(draws: &mut Draws, wild: f32, low: f32, high: f32) -> f32 {
    if draws.uniform() < wild { f32::from_bits(draws.bits()) } else { draws.range(low, high) }
}

/// Plausible inputs of an engine, a share `wild` of them arbitrary bits. Motion vectors are whole pixels, or such bits.
pub fn any_frame(draws: &mut Draws, wild: f32) -> View {
    let d = draws;
    let gaze = Gaze::At { px: [number(d, wild, 0.0, 8.0), number(d, wild, 0.0, 6.0)] };
    let shift = [0; 2].map(|_| (d.bits() % 5) as f32 - 2.0);
    let vector = |d: &mut Draws, v: f32| if d.uniform() < wild { f32::from_bits(d.bits()) } else { v };
    View {
        facts: ViewFrame::new(ViewGeometry::flat(SIZE, 70.0).unwrap(), gaze),
        color: Image::from_fn(SIZE, |_| [0; 3].map(|_| number(d, wild, 0.0, 1.0))),
        depth: Some(Image::from_fn(SIZE, |_| number(d, wild, 3.0, 3.05))),
        motion: Some(Image::from_fn(SIZE, |_| shift.map(|v| vector(d, v)))),
        trust: Some(Image::from_fn(SIZE, |_| number(d, wild, 0.5, 1.0))),
        reactive: None,
        albedo: None,
        mask: None,
        half: None,
        lod: Some(Image::from_fn(SIZE, |_| number(d, wild, 0.0, 4.0))),
        noise: Some(Image::from_fn(SIZE, |_| [number(d, wild, 0.0, 0.3), number(d, wild, 1.0, 16.0)])),
    }
}
