//! Functions that match the scales of history and candidate: matched.

use super::*;
use afterimage::kernel::smr::{Evidence, Matched, SmrParams};
use afterimage::kernel::{color, reproject, smr};

/// Channels of sanitized colors: 0, dark, negative, the largest half.
pub fn channels() -> Vec<u32> {
    floats(&[0.0, -0.0, 6e-8, 0.002, -0.002, 0.18, 1.0, -0.01, -65504.0, 65504.0])
}

/// A stored color: at least 0, of any magnitude of a half.
pub fn stored_color(d: &mut Draws) -> [f32; 3] {
    let scale = [1.0, 1.0, 1.0, 0.01, 100.0, 65504.0][d.bits() as usize % 6];
    [0; 3].map(|_| if d.bits().is_multiple_of(16) { 0.0 } else { scale * d.uniform() })
}

/// A color like `c`: equal, nearly, or another; now and then a little below 0.
pub fn like(d: &mut Draws, c: [f32; 3]) -> [f32; 3] {
    let spread = [0.0, 1e-3, 0.01, 0.1, 0.5, 1.1][d.bits() as usize % 6];
    c.map(|x| x * (1.0 + spread * d.range(-1.0, 1.0)))
}

pub fn push(row: &mut Vec<u32>, values: &[f32]) {
    row.extend(values.iter().map(|x| x.to_bits()));
}

/// Levels of detail as they are stored, and as frames have them.
fn lod(d: &mut Draws) -> f32 {
    match d.bits() % 4 {
        0 => (d.bits() % 63) as f32 / 7.0,
        1 => (d.bits() % 9) as f32,
        _ => d.range(0.0, 8.9),
    }
}

fn pair_rows(rows: Rows) -> Rows {
    let c = channels();
    rows.mixed(&[&c, &c, &c, &c, &c, &c]).random(|d, row| {
        let a = stored_color(d);
        let b = like(d, a);
        push(row, &[a, b].concat());
    })
}

/// Texels of the mip chain: color times coverage, and coverage.
fn chain_rows(rows: Rows, fractions: usize) -> Rows {
    let (c, cover) = (floats(&[0.0, 0.18, 1.0, 65504.0, 6e-5]), floats(&[0.0, 0.25, 0.5, 1.0]));
    let (at, texel) = (floats(&[0.0, 0.25, 0.5, 0.75, 0.9]), [&c[..], &c, &c, &cover]);
    let lists = [texel.repeat(4), vec![&at; fractions]].concat();
    rows.mixed(&lists).random(|d, row| {
        for _ in 0..4 {
            let covered = [0.0, 0.25, 0.5, 0.75, 1.0, 1.0, 1.0, 1.0][d.bits() as usize % 8];
            push(row, &stored_color(d).map(|x| x * covered));
            push(row, &[covered]);
        }
        (0..fractions).for_each(|_| row.push(range(d, 0.0, 1.0)));
    })
}

shape!(Evidence {
    candidate: Vec3,
    unit: f32,
    compared: Vec3,
    compared_coarser: Vec3,
    observed: Vec3,
    lod: f32,
    history: Vec3,
    history_lod: f32,
    resampled: bool,
    matched: Vec3,
    level: Vec3,
    next_level: Vec3,
    matched_coarser: Vec3,
    predicted: Vec3,
    trust: f32,
    noise: f32,
    confidence: [f32; 2]
});
shape!(Matched { color: Vec3, lod: f32, share: f32, fit: f32 });

fn decide(e: Evidence, accumulate: f32, tolerances: (f32, f32), [blocks, relight, noisy]: [bool; 3]) -> Matched {
    let (accumulate_tolerance, tolerance) = tolerances;
    smr::decide(&e, &SmrParams { accumulate, accumulate_tolerance, tolerance, blocks, relight, noisy })
}

/// With these flags, or any.
fn decide_rows(rows: Rows, flags: Option<[u32; 3]>) -> Rows {
    let (c, l) = (channels(), floats(&[0.0, 1.0 / 7.0, 1.0, 2.0, 3.0, 8.0, 62.0 / 7.0]));
    let h = floats(&[0.0, 6e-8, 0.002, 0.18, 0.5, 1.0, 65504.0]);
    let trust = floats(&[0.25, 1.0, 1e-30]);
    let (share, tolerance) = (floats(&[0.0, 0.5, 0.9, 0.99]), floats(&[0.25, 1.0, 2.0]));
    let flag = |i: usize| flags.map_or(vec![0, 1], |f| vec![f[i]]);
    let (blocks, relight, noisy) = (flag(0), flag(1), flag(2));
    let noise = floats(&[0.0, 1e-30, 0.5, 3.0, 100.0]);
    let confidence = floats(&[0.0, 0.25, 1.0]);
    let unit = floats(&[1.0 / 8192.0, 0.3, 1.0, 131008.0]);
    let mut lists: Vec<&[u32]> = vec![&c; 3];
    lists.push(&unit);
    lists.extend([&c[..]; 9]);
    lists.extend([&l[..], &h, &h, &h, &l, &[0, 1]]);
    lists.extend([&h[..]; 15]);
    lists.extend([&trust[..], &noise, &confidence, &confidence, &share, &tolerance, &tolerance]);
    lists.extend([&blocks[..], &relight, &noisy]);
    rows.mixed(&lists).random(|d, row| {
        let candidate = stored_color(d);
        let [compared, observed] = [0; 2].map(|_| if d.bits() & 1 == 0 { candidate } else { like(d, candidate) });
        let lit = [1.0, 1.0, 1.2, 0.4, 2.0][d.bits() as usize % 5];
        let [coarser, history, matched, whole, dimmer] = [0; 5].map(|_| like(d, candidate).map(|x| (x * lit).max(0.0)));
        let level = lod(d);
        let past = if d.bits() & 1 == 0 { level } else { lod(d) };
        push(row, &candidate);
        row.push(unit[d.bits() as usize % unit.len()]);
        push(row, &[compared, coarser, observed].concat());
        push(row, &[&[level][..], &history, &[past]].concat());
        row.push(d.bits() & 1);
        let [matched_coarser, other] = [0; 2].map(|_| like(d, matched).map(|x| x.max(0.0)));
        let predicted = if d.bits() & 1 == 0 { matched } else { other };
        push(row, &[matched, whole, dimmer, matched_coarser, predicted].concat());
        let trust = if d.bits() & 1 == 0 { 1.0 } else { d.range(0.01, 1.0) };
        let noise = if d.bits() & 1 == 0 { 0.0 } else { d.range(0.0, 20.0) };
        push(row, &[trust, noise]);
        let confidence = [0; 2].map(|_| if d.bits() & 1 == 0 { 1.0 } else { d.uniform() });
        push(row, &confidence);
        push(row, &[d.range(0.0, 0.99), d.range(0.1, 1.0), d.range(0.2, 3.0)]);
        row.extend([&blocks, &relight, &noisy].map(|flag| flag[d.bits() as usize % flag.len()]));
    })
}

pub const PROBES: &[Probe] = &[
    probe!(color::root_difference, pair_rows),
    probe!(color::roots, |rows| {
        // A root of a denormal is a normal number, unless a device flushes it.
        let c: Vec<u32> = finite().into_iter().filter(|&x| x & 0x7fff_ffff == 0 || x & 0x7f80_0000 != 0).collect();
        rows.mixed(&[&c, &c, &c]).each(&[Signed(-24, 17); 3])
    }),
    probe!(smr::brightness_unit, |rows| {
        let (c, exposure) = (channels(), floats(&[0.3, 1.0, 4.0]));
        rows.mixed(&[&c, &c, &c, &c, &c, &c, &exposure]).random(|d, row| {
            let a = stored_color(d);
            let b = like(d, a);
            push(row, &[a, b].concat());
            push(row, &[d.range(0.1, 10.0)]);
        })
    }),
    probe!(reproject::moves_alike, |rows| {
        let v = [finite(), around(&[0.5, -0.5, 16.0])].concat();
        rows.mixed(&[&v, &v, &v, &v]).random(|d, row| {
            let own = [d.range(-40.0, 40.0), d.range(-40.0, 40.0)];
            let within = 0.5 + 0.1 * (own[0].abs() + own[1].abs());
            let other = own.map(|x| x + within * d.range(-1.2, 1.2));
            push(row, &[own, other].concat());
        })
    }),
    probe!(smr::is_changed, |rows| {
        rows.random(|d, row| {
            let compared = stored_color(d);
            let [matched, level, next] = [0; 3].map(|_| like(d, compared).map(|x| x.max(0.0)));
            push(row, &[compared, matched, level, next].concat());
        })
    }),
    probe!(smr::decide, decide, "decide($0, SmrParams($1, $2, $3))", |rows| decide_rows(rows, None)),
    // As the passes have them: constants of a pipeline, which the compiler folds.
    probe!(smr::decide, decide, "decide($0, SmrParams($1, $2, false, true, false))", |rows| {
        decide_rows(rows, Some([0, 1, 0]))
    }),
    probe!(smr::mip_mean, |rows| chain_rows(rows, 0)),
    probe!(smr::mip_bilinear, |rows| chain_rows(rows, 2)),
];
