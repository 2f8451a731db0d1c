//! Printed textures: the notice board, the scrolling page and the framed prints on the wall.

use super::glyph;
use super::noise::{fbm, floor2, inside, pulse, split, surviving, unit};
use glam::Vec2;
use glam::Vec3;

const PAPER: Vec3 = Vec3::new(0.80, 0.77, 0.68);
const INK: Vec3 = Vec3::new(0.035, 0.035, 0.045);

/// Distance from `p` to the border of a rectangle of `half` size around the origin; negative outside.
fn depth_in(p: Vec2, half: Vec2) -> f32 {
    (half - p.abs()).min_element()
}

/// Notice board with a wooden rim, a headline and running text; `half` is half its size in metres.
pub(super) fn notice(uv: Vec2, w: Vec2, half: Vec2) -> Vec3 {
    const RIM: f32 = 0.035;
    /// Size of a headline dot and of a text dot in metres.
    const BIG: f32 = 0.0175;
    const SMALL: f32 = 0.0042;
    let wide = w.max_element();
    let depth = depth_in(uv, half);
    let rim = inside(depth - RIM, wide);
    let wood = Vec3::new(0.20, 0.11, 0.05) * (0.6 + 0.8 * fbm(uv * 40.0, 40.0 * wide, 3, 201));
    let corner = uv + half - Vec2::splat(RIM);
    let width = 2.0 * (half.x - RIM);
    let title = (corner - Vec2::new(0.5 * (width - 59.0 * BIG), 0.05)) / BIG;
    let text_top = 0.05 + 7.0 * BIG + 0.05;
    let columns = ((width - 0.06) / (6.0 * SMALL)) as i32;
    let body = (corner - Vec2::new(0.03, text_top)) / SMALL;
    let mut ink = glyph::headline(title);
    ink += inside((corner.y - text_top + 0.022).abs() - 0.004, w.y);
    if body.y > 0.0 && half.y - uv.y > RIM + 0.02 {
        ink += glyph::running_text(body, w / SMALL, columns, 0);
    }
    let fibres = 0.92 + 0.16 * fbm(uv * 25.0, 25.0 * wide, 3, 203);
    PAPER.lerp(INK, ink.min(1.0)).lerp(wood, rim) * fibres
}

/// Page of running text behind a rim, scrolled up by `shift` metres.
pub(super) fn scroll(uv: Vec2, w: Vec2, half: Vec2, shift: f32) -> Vec3 {
    const RIM: f32 = 0.03;
    const DOT: f32 = 0.0085;
    /// Height in metres of a stripe; each stripe has a random tint.
    const STRIPE: f32 = 0.34;
    let wide = w.max_element();
    let page = uv + half - Vec2::splat(RIM) + Vec2::new(0.0, shift);
    let columns = ((2.0 * (half.x - RIM) - 0.04) / (6.0 * DOT)) as i32;
    let ink = glyph::running_text((page - Vec2::new(0.02, 0.0)) / DOT, w / DOT, columns, 0);
    let stripe = split(page.y / STRIPE).0;
    let tint = Vec3::new(
        0.62 + 0.3 * unit(stripe, 0, 211),
        0.62 + 0.3 * unit(stripe, 1, 211),
        0.62 + 0.3 * unit(stripe, 2, 211),
    );
    let rim = inside(depth_in(uv, half) - RIM, wide);
    tint.lerp(INK, ink).lerp(Vec3::splat(0.03), rim)
}

/// Framed prints on a plaster wall, one in each cell of 0.9 m x 1.05 m.
pub(super) fn gallery(uv: Vec2, w: Vec2) -> Vec3 {
    const CELL: Vec2 = Vec2::new(0.90, 1.05);
    const HALF: Vec2 = Vec2::new(0.40, 0.46);
    const RIM: f32 = 0.035;
    const MOUNT: f32 = 0.06;
    let wide = w.max_element();
    // An odd number of columns around the middle, an even number of rows.
    let p = uv / CELL + Vec2::new(0.5, 0.0);
    let cell = floor2(p);
    let (x, y) = (cell.x as i32, cell.y as i32);
    let q = (p - cell - 0.5) * CELL;
    let cloth = Vec3::new(0.16, 0.20, 0.17) * (0.7 + 0.6 * fbm(uv * 20.0, 20.0 * wide, 3, 221));
    let weave = 0.9 + 0.2 * pulse(uv.y * 50.0, 0.5, w.y * 50.0);
    let depth = depth_in(q, HALF);
    if depth < -wide {
        return cloth * weave;
    }
    let gilt = Vec3::new(0.52, 0.36, 0.12) * (0.55 + 0.9 * pulse((q.x + q.y) * 22.0, 0.5, 2.0 * wide * 22.0));
    let picture = print(q, w, HALF - Vec2::splat(RIM + MOUNT), (x, y));
    let mount = PAPER * 1.02;
    let on_mount = mount.lerp(picture, inside(RIM + MOUNT - depth, wide));
    let framed = gilt.lerp(on_mount, inside(RIM - depth, wide));
    let line = inside((depth - RIM - 0.7 * MOUNT).abs() - 0.004, wide);
    (cloth * weave).lerp(framed.lerp(INK, 0.8 * line), inside(-depth, wide))
}

/// One of five pictures, chosen by its cell.
fn print(q: Vec2, w: Vec2, half: Vec2, (x, y): (i32, i32)) -> Vec3 {
    let wide = w.max_element();
    let seed = 300 + 17 * x.rem_euclid(64) as u32 + y.rem_euclid(64) as u32;
    match (x + 2 * y).rem_euclid(5) {
        0 => text_sheet(q, w, half, x * 31 + y * 67),
        1 => star(q, wide),
        2 => map(q, wide, seed),
        3 => engraving(q, wide, seed),
        _ => hills(q, wide, half, seed),
    }
}

fn text_sheet(q: Vec2, w: Vec2, half: Vec2, first: i32) -> Vec3 {
    const DOT: f32 = 0.0062;
    let columns = (2.0 * half.x / (6.0 * DOT)) as i32;
    PAPER.lerp(INK, glyph::running_text((q + half) / DOT, w / DOT, columns, first))
}

/// Siemens star: spokes that become finer than the pixels towards the middle.
fn star(q: Vec2, wide: f32) -> Vec3 {
    const SPOKES: f32 = 24.0;
    let r = q.length().max(1e-4);
    let turns = q.y.atan2(q.x) / std::f32::consts::TAU;
    let spokes = pulse(turns * SPOKES, 0.5, SPOKES * wide / (std::f32::consts::TAU * r));
    let rings = inside((r - 0.285).abs() - 0.008, wide);
    let disc = inside(r - 0.265, wide);
    PAPER.lerp(INK, (spokes * disc + rings).min(1.0))
}

/// Contour lines over tinted heights.
fn map(q: Vec2, wide: f32, seed: u32) -> Vec3 {
    let height = fbm(q * 5.0, 5.0 * wide, 3, seed);
    let blur = 5.0 * 1.2 * wide * 12.0;
    let lines = pulse(height * 12.0, 0.16, blur) * surviving(blur);
    let sea = inside((0.45 - height).min(1.0) * 0.3, wide);
    let ground =
        Vec3::new(0.20, 0.42, 0.50).lerp(Vec3::new(0.72, 0.62, 0.36).lerp(Vec3::new(0.42, 0.30, 0.16), height), sea);
    let grid = pulse(q.x * 8.0, 0.03, wide * 8.0) + pulse(q.y * 8.0, 0.03, wide * 8.0);
    ground.lerp(INK, 0.8 * lines).lerp(Vec3::new(0.5, 0.1, 0.1), 0.6 * grid.min(1.0))
}

/// Engraving of a head: concentric lines whose thickness encodes the shade.
fn engraving(q: Vec2, wide: f32, seed: u32) -> Vec3 {
    const PITCH: f32 = 0.016;
    let face = Vec2::new(q.x / 0.16, (q.y + 0.05) / 0.21).length();
    let light = (0.5 - 1.3 * q.x - 0.5 * q.y).clamp(0.0, 1.0);
    let relief = fbm(q * 9.0, 9.0 * wide, 3, seed);
    let shoulders = inside(0.2 + 1.6 * q.x * q.x - q.y, wide);
    let head = inside((face - 1.0) * 0.18, wide);
    let shade = 0.25 + 0.25 * relief + 0.45 * (1.0 - light) * head + 0.45 * shoulders * (1.0 - head);
    let rings = (q - Vec2::new(0.02, -0.08)).length() / PITCH;
    let ink = pulse(rings, shade.clamp(0.1, 0.9), wide / PITCH);
    PAPER.lerp(INK, ink)
}

/// Landscape of hill ridges under a low sun.
fn hills(q: Vec2, wide: f32, half: Vec2, seed: u32) -> Vec3 {
    let mut color =
        Vec3::new(0.80, 0.42, 0.20).lerp(Vec3::new(0.85, 0.74, 0.45), (0.5 + 0.5 * q.y / half.y).clamp(0.0, 1.0));
    let sun = inside((q - Vec2::new(0.07, -0.1)).length() - 0.07, wide);
    color = color.lerp(Vec3::new(0.98, 0.86, 0.60), sun);
    for ridge in 0..4 {
        let k = ridge as f32;
        let line = fbm(Vec2::new(q.x * (5.0 + 2.0 * k) + 3.0 * k, k), 5.0 * wide, 4, seed + ridge);
        let top = -0.10 + 0.10 * k - 0.22 * (line - 0.4);
        let tone = Vec3::new(0.42, 0.30, 0.34).lerp(Vec3::new(0.03, 0.07, 0.06), k / 3.0);
        let trees = 0.75 + 0.5 * fbm(q * 60.0, 60.0 * wide, 2, seed + 7);
        color = color.lerp(tone * trees, inside(top - q.y, wide));
    }
    color
}
