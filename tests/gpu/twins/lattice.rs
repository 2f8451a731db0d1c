//! Samples of sparse frames: lattice.

use super::*;
use afterimage::kernel::lattice;

shape!(lattice::Between { points: [u32; 2], fraction: f32 });
shape!(lattice::SampleMean { sum: Vec4, weight: f32 });
shape!(lattice::GeometryMean { disparity: f32, motion: Vec2, weight: f32 });

pub const PROBES: &[Probe] = &[
    probe!(lattice::between, |rows| {
        let ends = [0, 1, 2, 7, 255, 256, 257, 16383];
        rows.cross(&[&ends, &ends, &(0..=8).collect::<Vec<_>>(), &[1, 2, 3, 64, 16384]])
            .random(|d, row| row.extend([d.bits() % 16384, d.bits() % 16384, d.bits() % 9, 1 + d.bits() % 16384]))
    }),
    probe!(lattice::nearest_point, |rows| {
        let ends = [0, 1, 2, 3, 7, 255, 256, 257, 16383];
        rows.cross(&[&ends, &ends, &(0..=8).collect::<Vec<_>>()]).each(&[N(16384), N(16384), N(9)])
    }),
    probe!(lattice::point_offset_px, |rows| {
        let (ends, points) = ([0, 1, 7, 255, 16383], [0, 1, 2, 64, !0, !1, !200]);
        rows.cross(&[&ends, &ends, &(0..=8).collect::<Vec<_>>(), &points])
    }),
    probe!(lattice::place_weight, |rows| {
        let offsets: Vec<f32> = (-256..=256).map(|i| i as f32).collect();
        rows.cross(&[&floats(&offsets), &floats(&[-255.0, -3.0, 0.0, 1.0, 8.0])])
    }),
    probe!(lattice::point_weight, |rows| {
        let fractions: Vec<f32> = (0..256).map(|i| i as f32 / 256.0).collect();
        rows.cross(&[&floats(&fractions), &[0, 1]])
    }),
    probe!(lattice::add_sample, |rows| {
        let color = [Signed(-20, 16); 4];
        rows.each(&[&color[..], &[F(0.0, 1.0)], &color, &[N(4), Share(65536)]].concat())
    }),
    probe!(lattice::sample_mean, |rows| rows.each(&[&[Signed(-16, 16); 4][..], &[Share(65536)]].concat())),
    probe!(lattice::add_geometry, |rows| {
        rows.random(|d, row| {
            row.extend([range(d, 0.0, 4.0), signed(d, -8, 8), signed(d, -8, 8), range(d, 0.0, 1.0)]);
            row.extend([range(d, 0.1, 2.0), range(d, 0.1, 2.0), signed(d, -8, 8)]);
            row.push(if d.bits().is_multiple_of(8) { f32::NAN.to_bits() } else { signed(d, -8, 8) });
            row.push(((d.bits() % 5) as f32 / 4.0).to_bits());
        })
    }),
    probe!(lattice::filled_geometry, |rows| {
        let motion = [Signed(-8, 8); 2];
        rows.each(&[&[F(0.0, 4.0)][..], &motion, &[Share(4), F(-0.1, 2.0)], &motion].concat())
    }),
];
