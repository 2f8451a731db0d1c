//! Functions of stored surfaces: surface, resample.

use super::matching::{channels, like, push, stored_color};
use super::*;
use afterimage::kernel::lod;
use afterimage::kernel::lod::MAX_LOD;
use afterimage::kernel::resample::{Resampled, Tap, TapsAround};
use afterimage::kernel::resize;
use afterimage::kernel::surface;
use afterimage::kernel::surface::Surface;
use afterimage::kernel::{pack, resample};

shape!(Surface { color: Vec3, lod: f32, disparity: f32 });
shape!(Tap { color: Vec3, lod: f32, same: bool });
shape!(Resampled { sharp: Vec3, smooth as "smooth_color": Vec3, lod: f32 });
shape!(TapsAround { texel: [i32; 2], last: [i32; 2], fraction: [f32; 2], sharp_x: [f32; 4], sharp_y: [f32; 4] });

fn push_tap(d: &mut Draws, row: &mut Vec<u32>, color: [f32; 3], same: bool) {
    push(row, &color);
    push(row, &[(d.bits() % 63) as f32 / 7.0]);
    row.push(same.into());
}

/// Two words of arbitrary bits; with every code of a level of detail, also that of an empty texel.
fn packed_rows(rows: Rows) -> Rows {
    let edges = [words(), vec![0x3dff, 0x3e00, 0x3fff, 0xc000, 0xf7ff_fdff, 0xffff_0000]].concat();
    let empty = |d: &mut Draws, row: &mut Vec<u32>| row.extend([d.bits() & 0x0fff_ffff, d.bits() & !0xc000]);
    rows.cross(&[&edges, &edges]).each(&[Bits, Bits]).random_of("empty", empty)
}

/// Fractions between texels: 0, every quarter, random.
pub fn fraction(d: &mut Draws) -> f32 {
    match d.bits() % 4 {
        0 => (d.bits() % 4) as f32 / 4.0,
        1 => (d.bits() % 65536) as f32 / 65536.0,
        _ => d.uniform(),
    }
}

/// Positions around small images, and their sizes.
fn around_rows(rows: Rows) -> Rows {
    rows.random(|d, row| {
        let size = [1 + d.bits() % 9, 1 + d.bits() % 9];
        row.extend(size.map(|s| (d.bits() % (s + 2)).wrapping_sub(1)));
        push(row, &[fraction(d), fraction(d)]);
        row.extend(size);
    })
}

pub const PROBES: &[Probe] = &[
    probe!(resize::old_position, |rows| {
        let ratios = [around(&[0.5, 1.0, 4.0 / 3.0]), floats(&[1.0 / 16384.0, 16384.0])].concat();
        rows.cross(&[&[0, 1, 2, 719, 16383], &ratios, &[1, 2, 1080, 16384]])
            .random(|d, row| row.extend([d.bits() % 16384, range(d, 0.1, 8.0), 1 + d.bits() % 16384]))
    }),
    probe!(resize::resized_lod, |rows| {
        let lods = [around(&[0.5, 4.0, MAX_LOD]), floats(&[0.0])].concat();
        rows.cross(&[&lods, &floats(&[-14.0, -1.0, -0.1, 0.0, 0.1, 1.0, 14.0])]).each(&[F(0.0, 9.0), F(-3.0, 3.0)])
    }),
    probe!(surface::float14_bits, |rows| {
        // Every value of a code, and the borders between.
        let codes = (0..=0x3fff_u32).map(surface::float14_value).flat_map(|x| [x, x.next_up(), -x]);
        let codes: Vec<u32> = codes.map(f32::to_bits).collect();
        rows.cross(&[&[finite(), codes].concat()])
            .random(|d, row| row.push(finite_bits(d)))
            .random_of("halves", |d, row| row.push(signed(d, -26, 17)))
    }),
    probe!(surface::float14_value, |rows| rows.cross(&[&(0..0x4000).collect::<Vec<u32>>()])),
    probe!(surface::pack_surface, |rows| {
        let halves: Vec<f32> = (0..=125).map(|i| i as f32 / 14.0).collect();
        let lods = [around(&halves[1..]), floats(&[0.0, -0.0, -1.0, 100.0, 1e30])].concat();
        let disparities = [positive(), floats(&[-1.0, -0.0])].concat();
        rows.mixed(&[&finite(), &channels(), &finite(), &lods, &disparities])
            .each(&[&[Signed(-26, 17); 3][..], &[F(-0.5, 9.5), Scaled(-20, 20)]].concat())
    }),
    probe!(surface::unpack_surface, packed_rows),
    probe!(surface::mip_texel, packed_rows),
    probe!(surface::round_mip, |rows| {
        let x = finite();
        rows.mixed(&[&x, &x, &x, &x]).each(&[Signed(-26, 17); 4])
    }),
    probe!(lod::lod_value, |rows| rows.cross(&[&(0..256).collect::<Vec<u32>>()])),
    probe!(resample::taps_around, around_rows),
    probe!(pack::tap_codes_between, |rows| {
        let disparities = [positive(), floats(&[-1.0, 0.0])].concat();
        let rows = rows.cross(&[&disparities, &disparities]);
        rows.each(&[Scaled(-34, 34), Scaled(-34, 34)])
    }),
    probe!(resample::surface_tap, |rows| {
        rows.random(|d, row| {
            let words = [d.bits() & [u32::MAX, 0x0fff_ffff][d.bits() as usize % 2], d.bits() & !0xc000];
            row.extend(words);
            row.extend([(words[1] >> 16).saturating_sub(d.bits() % 4), d.bits() % 4, d.bits() % 2]);
        })
    }),
    probe!(resample::second_corner, |rows| {
        let f = floats(&[0.0, 0.1, 0.25, 0.499_999_97, 0.5, 0.75, 0.9, 1e-30]);
        rows.cross(&[&f, &f]).each(&[F(0.0, 1.0), F(0.0, 1.0)])
    }),
    probe!(resample::corner_weight, |rows| {
        let f = floats(&[0.0, 0.1, 0.25, 0.5, 0.9, 1e-30]);
        rows.cross(&[&[0, 1, 2, 3], &f, &f]).each(&[N(4), F(0.0, 1.0), F(0.0, 1.0)])
    }),
    // Twelve taps, as the pass takes them.
    probe!(
        resample::nothing_gathered,
        |fraction: [f32; 2], color: Vec3, lod: f32, read: [Tap; 12]| {
            let (taps, mut read) = (resample::taps_around([8, 8], fraction, [16, 16]), read.into_iter());
            let gathered = resample::gather_around(&taps, |_| read.next().unwrap());
            resample::resolve(gathered, resample::sharp_sum(&taps), Surface { color, lod, disparity: 1.0 })
        },
        "let taps = taps_around(vec2i(8), vec2f(in_f(0u), in_f(1u)), vec2u(16u));
    var g = nothing_gathered();
    // A variable count, as in the passes: Mesa unrolls constant ones, and reorders their sums.
    let rounds = select(0u, ROUNDS, in_f(0u) >= 0.0);
    for (var round = 0u; round < rounds; round++) {
        let k = 6u + 20u * round; let four = taps_of(taps, round);
        let a = Tap(in_v(k), in_f(k + 3u), in_u(k + 4u) != 0u);
        let b = Tap(in_v(k + 5u), in_f(k + 8u), in_u(k + 9u) != 0u);
        let c = Tap(in_v(k + 10u), in_f(k + 13u), in_u(k + 14u) != 0u);
        let d = Tap(in_v(k + 15u), in_f(k + 18u), in_u(k + 19u) != 0u);
        g = gather(g, a, b, c, d, four);
    }
    let r = resolve(g, sharp_sum(taps), Surface(in_v(2u), in_f(5u), 1.0));
    out_v(r.sharp); out_v(r.smooth_color); out_f(r.lod);",
        |rows| {
            rows.random(|d, row| {
                let (center, share) = (stored_color(d), d.bits() % 4);
                push(row, &[fraction(d), fraction(d)]);
                push(row, &center);
                push(row, &[(d.bits() % 63) as f32 / 7.0]);
                for _ in 0..12 {
                    let same = share == 0 || d.bits() % 4 < share;
                    let near = like(d, center).map(|x| x.max(0.0));
                    push_tap(d, row, near, same);
                }
            })
        }
    ),
];
