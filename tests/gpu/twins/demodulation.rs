//! Demodulation of planned frames.

use super::sparse::color;
use super::*;
use afterimage::kernel::demodulation;

shape!(demodulation::LumaRanges { own: f32, color: Vec2, lit: Vec2 });
shape!(demodulation::AlbedoSums { sum: Vec4, lumas: demodulation::LumaRanges });
shape!(demodulation::AlbedoChange { albedo: Vec3, factor: Vec3 });
shape!(demodulation::OwnAlbedo { albedo: Vec3, around: [Vec3; 2] });
shape!(demodulation::PastAlbedo { shown: Vec3, kept: Vec3, explained: f32 });
shape!(demodulation::Texture { albedo: Vec3, stored: Vec3, explained: f32, kept: f32 });
shape!(demodulation::Retextured { factor: Vec3, place_share: f32, word: u32 });

/// Albedos.
fn push_albedo(d: &mut Draws, row: &mut Vec<u32>) {
    let black = d.bits().is_multiple_of(8);
    row.extend([0; 3].map(|_| range(d, 0.0, if black { 0.0 } else { 0.998 })));
}

/// Albedos, a sixth of them unknown.
fn push_given(d: &mut Draws, row: &mut Vec<u32>) {
    push_albedo(d, row);
    row.push((if d.bits().is_multiple_of(6) { 0.0_f32 } else { 1.0 }).to_bits());
}

/// Luma of an albedo, and a smallest and a largest one of colors, and of lit ones.
fn push_lumas(d: &mut Draws, row: &mut Vec<u32>) {
    row.push(range(d, 0.04, 1.0));
    for _ in 0..2 {
        let low = d.range(0.0, 2.0);
        row.extend([low, low + d.range(0.0, 2.0)].map(f32::to_bits));
    }
}

/// A smallest and a largest albedo, in every fourth row the same.
fn push_box(d: &mut Draws, row: &mut Vec<u32>) {
    let width = if d.bits().is_multiple_of(4) { 0.0 } else { 0.3 };
    let low = [0; 3].map(|_| d.range(0.0, 0.7));
    row.extend(low.map(f32::to_bits));
    row.extend(low.map(|v| (v + d.range(0.0, width)).to_bits()));
}

/// One albedo, and history's within two stored steps of it.
fn push_flat(d: &mut Draws, row: &mut Vec<u32>) {
    let grey = (d.bits() % 500) as f32 / 512.0;
    let albedo = |steps: u32| [grey + steps as f32 / 512.0; 3].map(f32::to_bits);
    row.extend([albedo(0), albedo(0), albedo(0), albedo(d.bits() % 3), albedo(d.bits() % 3)].concat());
    row.push(1.0_f32.to_bits());
}

fn push_own(d: &mut Draws, row: &mut Vec<u32>) {
    push_albedo(d, row);
    push_box(d, row);
}

fn push_sums(d: &mut Draws, row: &mut Vec<u32>) {
    let weight = d.range(0.01, 4.0);
    row.extend([0; 3].map(|_| (d.range(0.0, 1.0) * weight).to_bits()));
    row.push(weight.to_bits());
    push_lumas(d, row);
}

/// Sums over two samples around a pixel with the albedo `own`.
fn added(own: Vec4, albedos: [Vec4; 2], colors: [Vec3; 2], weight: f32) -> demodulation::AlbedoSums {
    let first = demodulation::add_albedo(demodulation::no_albedos(own.truncate()), own, albedos[0], colors[0], 0.5);
    demodulation::add_albedo(first, own, albedos[1], colors[1], weight)
}

const ADDED: &str = "let first = add_albedo(no_albedos($0.xyz), $0, vec4f(in_f(4u), in_f(5u), in_f(6u), in_f(7u)), \
     in_v(12u), 0.5); let s = add_albedo(first, $0, vec4f(in_f(8u), in_f(9u), in_f(10u), in_f(11u)), in_v(15u), \
     $3); out_v(s.sum.xyz); out_f(s.sum.w); out_f(s.lumas.own); out_f(s.lumas.color.x); \
     out_f(s.lumas.color.y); out_f(s.lumas.lit.x); out_f(s.lumas.lit.y);";

const ALBEDO: Word = Of(push_albedo);
const GIVEN: Word = Of(push_given);
const LUMAS: Word = Of(push_lumas);
const TEXTURE: Word = Of(|d, row| {
    push_albedo(d, row);
    push_albedo(d, row);
    row.extend([range(d, 0.0, 1.0), range(d, 0.0, 29.0)]);
});
const COLOR: Word = Of(|d, row| row.extend(color(d)));

pub const PROBES: &[Probe] = &[
    probe!(demodulation::limited_albedo, |rows| rows.mixed(&[&any(), &any(), &any()]).each(&[
        F(-0.5, 1.5),
        F(0.0, 1.0),
        F(0.0, 2.0)
    ])),
    probe!(demodulation::given_albedo, |rows| rows.mixed(&[&any(), &any(), &any()]).each(&[
        F(-0.5, 1.5),
        F(0.0, 1.0),
        F(0.0, 2.0)
    ])),
    probe!(demodulation::quotient, |rows| rows.each(&[ALBEDO, ALBEDO])),
    probe!(demodulation::raised_luma, |rows| rows.each(&[ALBEDO])),
    probe!(demodulation::no_lumas, |rows| rows.each(&[ALBEDO])),
    probe!(demodulation::no_albedos, |rows| rows.each(&[ALBEDO])),
    probe!(demodulation::with_luma, |rows| rows.each(&[LUMAS, COLOR, ALBEDO])),
    probe!(demodulation::explained, |rows| rows.each(&[LUMAS])),
    probe!(demodulation::exposed_lumas, |rows| rows.each(&[LUMAS, F(0.25, 4.0)])),
    probe!(demodulation::part, |rows| rows.each(&[F(0.25, 4.0), F(0.25, 4.0), F(0.25, 4.0), F(0.0, 1.0)])),
    probe!(demodulation::between, |rows| rows.each(&[ALBEDO, ALBEDO, F(0.0, 1.0)])),
    probe!(demodulation::add_albedo, added, ADDED, |rows| {
        rows.each(&[GIVEN, GIVEN, GIVEN, COLOR, COLOR, F(0.001, 1.0)])
    }),
    probe!(demodulation::candidate_change, |rows| rows.each(&[Of(push_sums), GIVEN, N(2)])),
    probe!(demodulation::past_albedo, |rows| {
        let rows = rows.each(&[Of(push_own), ALBEDO, ALBEDO, F(0.0, 1.0)]);
        rows.random_of("flat", push_flat)
    }),
    probe!(demodulation::kept_albedos, |rows| rows.each(&[F(0.0, 31.0), F(-1.2, 1.2), F(-1.2, 1.2)])),
    probe!(demodulation::mean_albedo, |rows| rows.each(&[ALBEDO, Of(push_own), F(0.0, 29.0)])),
    probe!(demodulation::texture_of, |rows| { rows.each(&[Of(push_own), ALBEDO, ALBEDO, F(0.0, 1.0), F(0.0, 29.0)]) }),
    probe!(demodulation::textured, |rows| rows.each(&[TEXTURE, ALBEDO])),
    probe!(demodulation::retextured, |rows| rows.each(&[TEXTURE, ALBEDO, F(0.0, 30.0), F(0.0, 0.9999)])),
    probe!(demodulation::pack_albedo, |rows| rows.each(&[ALBEDO, F(-1.0, 31.0), F(0.0, 0.9999)])),
    probe!(demodulation::unpack_albedo, |rows| rows.cross(&[&words()]).each(&[Bits])),
];
