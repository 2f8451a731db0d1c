//! Functions of levels of detail and of the foveation filters: foveate.

use super::*;
use afterimage::kernel::foveate;

/// Widths of a blur from 0 to the widest.
fn sigma(d: &mut Draws) -> u32 {
    if d.bits() & 1 == 0 { range(d, 0.0, 2.0) } else { range(d, 0.0, 127.5) }
}

/// A color: of all magnitudes, dark to the largest half.
const COLOR: Word = Of(|d, row| row.extend([0; 3].map(|_| signed(d, -24, 16))));

shape!(foveate::GaussTap { weight: f32, ratio: f32, ratio_step: f32 });

pub const PROBES: &[Probe] = &[
    probe!(foveate::region_lod, |rows| {
        let e = [around(&[2.5, 5.0, 7.5, 20.0, 22.5]), floats(&[0.0, 180.0])].concat();
        let lod = floats(&[0.0, 1.0, 2.0, 4.0]);
        rows.cross(&[&e, &floats(&[0.0, 2.5, 5.0]), &floats(&[5.0, 20.0]), &floats(&[0.0, 2.5]), &lod, &lod])
            .each(&[60.0, 10.0, 30.0, 5.0, 3.0, 6.0].map(|most| F(0.0, most)))
    }),
    probe!(foveate::blur_lod, |rows| {
        let e = [around(&[2.5, 7.5, 20.0]), floats(&[0.0, 180.0])].concat();
        let lod = floats(&[0.0, 1.0, 3.0, 4.0, 8.0]);
        rows.cross(&[&e, &floats(&[0.0, 2.5]), &floats(&[2.5, 7.5]), &lod, &lod])
            .each(&[180.0, 10.0, 30.0, 6.0, 8.0].map(|most| F(0.0, most)))
    }),
    probe!(foveate::blur_sigma_px, |rows| {
        let whole: Vec<f32> = (0..=16).map(|i| 0.5 * i as f32).collect();
        rows.cross(&[&around(&whole)])
            .each(&[F(0.0, 8.0)])
            .random_of("small", |d, row| row.push(scaled(d, -30, 0)))
            .within(|r| r.f(0) == 0.0 || r.f(0) >= f32::MIN_POSITIVE)
    }),
    // All taps out to the edge, one after the other, as the pass takes them.
    probe!(
        foveate::gauss_next,
        |sigma: f32| {
            let (mut t, mut side) = (foveate::gauss_center(sigma), 0.0);
            for _ in 0..foveate::gauss_radius(sigma) {
                t = foveate::gauss_next(t);
                side += t.weight;
            }
            [t.weight, t.ratio_step, 1.0 + 2.0 * side]
        },
        "var t = gauss_center($0); var side = 0.0;
    for (var d = 0u; d < gauss_radius($0); d++) { t = gauss_next(t); side += t.weight; }
    out_f(t.weight); out_f(t.ratio_step); out_f(1.0 + 2.0 * side);",
        |rows| rows
            .cross(&[&[around(&[0.125, 0.5, 1.0 / 3.0, 7.5, 127.5]), floats(&[0.0])].concat()])
            .random(|d, row| row.push(sigma(d)))
    ),
    probe!(foveate::level_len, |rows| rows.cross(&[&lengths(), &levels()])),
    probe!(foveate::level_coordinate, |rows| {
        let px: Vec<u32> = lengths().iter().map(|&n| (n as f32 - 1.0).to_bits()).collect();
        rows.cross(&[&px, &levels()]).each(&[F(0.0, 16384.0), N(9)])
    }),
    probe!(foveate::split, foveate::split, "let s = split($0, $1); out_u(s.whole); out_f(s.fraction);", |rows| {
        // Not -0, whose sign clamp may lose.
        let v = [around(&[1.0, 2.0, 0.5, 16.0, 8191.0]), floats(&[0.0, -0.5, 1e9, -1e9])].concat();
        rows.cross(&[&v, &lengths()]).random(|d, row| {
            row.extend([range(d, -1.0, 64.0), 1 + d.bits() % 64]);
        })
    }),
    probe!(foveate::bilinear, |rows| rows.each(&[&[COLOR; 4][..], &[F(0.0, 1.0); 2]].concat())),
    probe!(foveate::mean_of_four, |rows| rows.each(&[COLOR; 4])),
    probe!(foveate::block_sample, |rows| rows.cross(&[&[0, 1, 2, 7, 8, 63, 1000], &levels(), &lengths()])),
];

/// Sides of images, in pixels or texels.
fn lengths() -> Vec<u32> {
    vec![1, 2, 3, 17, 64, 97, 255, 256, 257, 1080, 4097, 8192, 16384]
}

/// Levels of a mip chain.
fn levels() -> Vec<u32> {
    (0..=8).collect()
}
