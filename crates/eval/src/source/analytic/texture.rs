//! Procedural textures: albedo of each material as a function of position on the surface.

use super::noise::{fbm, fbm3, floor2, inside, pulse, smoothstep, split, surviving, unit};
use super::print;
use glam::{Vec2, Vec2Swizzles, Vec3};

/// Procedural texture of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Material {
    /// Octagonal stone tiles with small dark squares at their corners.
    Floor,
    /// Bricks in running bond.
    Bricks,
    /// Plaster above the texture's height 0, painted tiles below.
    Azulejo,
    /// Rough plaster of one color.
    Plaster([f32; 3]),
    /// A woven hanging.
    Rug,
    /// Planks along the first texture axis.
    Planks([f32; 3]),
    /// Planed wood with its grain along the second texture axis.
    Timber([f32; 3]),
    /// A notice board with a headline and running text, by half its size in metres.
    Notice([f32; 2]),
    /// Rows of framed prints.
    Gallery,
    /// A page scrolled up by `shift` metres.
    Scroll { half: [f32; 2], shift: f32 },
    /// Painted pickets in three colors.
    Picket,
    /// A post with a painted spiral.
    Spiral,
    /// A terrestrial globe.
    Globe,
    /// Colored segments with seams and dots.
    BeachBall,
    /// A fine chequer of meridians and parallels.
    Chequer,
    /// Veined stone.
    Marble,
    /// Leaves.
    Foliage,
}

/// Texture coordinates and footprint of a sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// Texture coordinates in metres; v points down on upright surfaces.
    pub uv: Vec2,
    /// Footprint width along u and v, in metres.
    pub w: Vec2,
    /// Spheres: unit direction from the centre in the sphere's local space, and radius in metres.
    pub ball: (Vec3, f32),
}

impl Material {
    /// Linear albedo, each channel in [0, 1].
    pub fn albedo(self, spot: &Spot) -> Vec3 {
        let Spot { uv, w, .. } = *spot;
        match self {
            Self::Floor => floor(uv, w),
            Self::Bricks => bricks(uv, w),
            Self::Azulejo => azulejo_wall(uv, w),
            Self::Plaster(tint) => plaster(uv, w, Vec3::from(tint)),
            Self::Rug => rug(uv, w),
            Self::Planks(tint) => planks(uv, w, Vec3::from(tint)),
            Self::Timber(tint) => grain(uv.yx(), w.yx(), Vec3::from(tint), 7),
            Self::Notice(half) => print::notice(uv, w, Vec2::from(half)),
            Self::Gallery => print::gallery(uv, w),
            Self::Scroll { half, shift } => print::scroll(uv, w, Vec2::from(half), shift),
            Self::Picket => picket(uv, w),
            Self::Spiral => spiral(uv, w),
            Self::Globe => globe(spot),
            Self::BeachBall => beach_ball(spot),
            Self::Chequer => chequer(spot),
            Self::Marble => marble(spot),
            Self::Foliage => foliage(spot),
        }
    }
}

fn floor(uv: Vec2, w: Vec2) -> Vec3 {
    const TILE: f32 = 0.5;
    let (p, w) = (uv / TILE, w / TILE);
    let cell = floor2(p);
    let (x, y) = (cell.x as i32, cell.y as i32);
    let q = p - cell - 0.5;
    let wide = w.max_element();
    let kept = surviving(0.6 * wide);
    let dark_cell = (x + y) & 1 == 0;
    let tone = 0.86 + 0.28 * unit(x, y, 11) * kept;
    let cream = Vec3::new(0.62, 0.53, 0.41);
    let clay = Vec3::new(0.47, 0.27, 0.17);
    let mean = 0.5 * (cream + clay);
    let stone = mean.lerp(if dark_cell { clay } else { cream }, kept) * tone;
    let wear = 0.55 + 0.9 * fbm(uv * 5.0, 5.0 * wide * TILE, 3, 20);
    let speckle = 1.0 + 0.35 * (fbm(uv * 60.0, 60.0 * wide * TILE, 2, 31) - 0.5);
    // Octagons: the corner squares cut 0.2 of a tile, and a joint surrounds each piece.
    let to_corner = 0.5 * 2.0 - q.x.abs() - q.y.abs();
    let square = inside(to_corner - 0.2, 1.4 * wide) * kept + 0.08 * (1.0 - kept);
    let seam = inside((to_corner - 0.2).abs() - 0.02, 1.4 * wide) * kept;
    let straight = pulse(p.x + 0.015, 0.03, w.x) + pulse(p.y + 0.015, 0.03, w.y);
    let joint = (straight * (1.0 - square) + seam).clamp(0.0, 1.0);
    let slate = Vec3::new(0.10, 0.12, 0.15) * (0.7 + 0.6 * unit(x, y, 12));
    let tile = (stone * wear).lerp(slate, square) * speckle;
    tile.lerp(Vec3::new(0.16, 0.14, 0.12), joint)
}

fn bricks(uv: Vec2, w: Vec2) -> Vec3 {
    const SIZE: Vec2 = Vec2::new(0.3, 0.1);
    let mut p = uv / SIZE;
    let w_cell = w / SIZE;
    let row = split(p.y).0;
    p.x += 0.5 * (row & 1) as f32;
    let column = split(p.x).0;
    let kept = surviving(0.7 * w_cell.max_element());
    let pick = unit(column, row, 41) - 0.5;
    let hue = unit(column, row, 42) - 0.5;
    let mut clay = Vec3::new(0.46, 0.20, 0.125) * (1.0 + 1.0 * pick * kept);
    clay += Vec3::new(0.06, 0.05, 0.05) * hue * kept;
    let wide = w.max_element();
    let rough = 0.6 + 0.8 * fbm(uv * Vec2::new(14.0, 22.0), 18.0 * wide, 2, 43);
    let stain = 0.75 + 0.5 * fbm(uv * 0.9, 0.9 * wide, 2, 47);
    let face = pulse(p.x, 0.95, w_cell.x) * pulse(p.y, 0.86, w_cell.y);
    let mortar = Vec3::new(0.50, 0.46, 0.40);
    mortar.lerp(clay * rough, face) * stain
}

fn azulejo_wall(uv: Vec2, w: Vec2) -> Vec3 {
    const TILE: f32 = 0.24;
    let wall = ashlar(uv, w);
    let frieze = inside(-uv.y, w.y);
    if frieze <= 0.0 {
        return wall;
    }
    let (p, wt) = (uv / TILE, w / TILE);
    let cell = floor2(p);
    let (x, y) = (cell.x as i32, cell.y as i32);
    let q = (p - cell) * 2.0 - 1.0;
    let wide = 2.0 * wt.max_element();
    let kept = surviving(0.35 * wide);
    let r2 = q.length_squared();
    let r = r2.sqrt();
    // Cosine of four times the polar angle, without a trigonometric function.
    let (a, b) = (q.x * q.x, q.y * q.y);
    let cos4 = if r2 > 1e-6 { (a * a - 6.0 * a * b + b * b) / (r2 * r2) } else { 1.0 };
    let turn = if (x ^ y) & 1 == 0 { 1.0 } else { -1.0 };
    let petals = inside(r - 0.50 - 0.22 * cos4 * turn, wide);
    let vein = inside((r - 0.33 - 0.16 * cos4 * turn).abs() - 0.045, wide);
    let eye = inside(r - 0.13, wide);
    let corner = (Vec2::ONE - q.abs()).length();
    let ring = inside((corner - 0.46).abs() - 0.07, wide);
    let bud = inside(corner - 0.22, wide);
    let ink = ((petals - vein).max(0.0) + ring + eye).clamp(0.0, 1.0);
    let white = Vec3::new(0.80, 0.82, 0.80);
    let blue = Vec3::new(0.045, 0.12, 0.42) * (0.8 + 0.6 * unit(x, y, 51));
    let amber = Vec3::new(0.78, 0.45, 0.08);
    let painted = white.lerp(blue, ink).lerp(amber, bud);
    let mean = white.lerp(blue, 0.42).lerp(amber, 0.04);
    let glaze = 0.92 + 0.16 * fbm(uv * 30.0, 30.0 * w.max_element(), 2, 53);
    let face = pulse(p.x + 0.015, 0.97, wt.x) * pulse(p.y + 0.015, 0.97, wt.y);
    let tiles = mean.lerp(painted, kept) * glaze * (0.35 + 0.65 * face);
    let ledge = inside(uv.y.abs() - 0.05, w.y);
    wall.lerp(tiles, frieze).lerp(Vec3::new(0.08, 0.11, 0.25), ledge)
}

/// Plaster with joints like courses of cut stone.
fn ashlar(uv: Vec2, w: Vec2) -> Vec3 {
    const SIZE: Vec2 = Vec2::new(0.62, 0.31);
    let (mut p, w_cell) = (uv / SIZE, w / SIZE);
    let row = split(p.y).0;
    p.x += 0.5 * (row & 1) as f32;
    let kept = surviving(w_cell.max_element());
    let tone = 1.0 + 0.35 * (unit(split(p.x).0, row, 63) - 0.5) * kept;
    let face = pulse(p.x, 0.975, w_cell.x) * pulse(p.y, 0.95, w_cell.y);
    plaster(uv, w, Vec3::new(0.74, 0.58, 0.36)) * tone * (0.45 + 0.55 * face)
}

/// Woven hanging: bands of diamonds between stripes.
fn rug(uv: Vec2, w: Vec2) -> Vec3 {
    const BAND: f32 = 0.30;
    let palette = [
        Vec3::new(0.50, 0.06, 0.05),
        Vec3::new(0.06, 0.10, 0.24),
        Vec3::new(0.62, 0.36, 0.07),
        Vec3::new(0.07, 0.22, 0.18),
    ];
    let wool = Vec3::new(0.72, 0.66, 0.52);
    let wide = w.max_element();
    let p = uv.y / BAND;
    let (band, y) = split(p);
    let ground = palette[band.rem_euclid(4) as usize];
    let motif = palette[(band + 2).rem_euclid(4) as usize];
    let y = (y - 0.5).abs();
    let x = (split(uv.x / 0.24).1 - 0.5).abs();
    let rhomb = x + y;
    let blur = wide * (1.0 / BAND + 1.0 / 0.24);
    let outline = inside((rhomb - 0.40).abs() - 0.05, blur);
    let filled = inside(rhomb - 0.26, blur);
    let eye = inside(rhomb - 0.10, blur);
    let stripes = pulse(y * 12.0, 0.5, 12.0 * w.y / BAND) * inside(0.42 - y, w.y / BAND);
    let weave = 0.75 + 0.5 * pulse(uv.x * 55.0, 0.5, 55.0 * w.x) * pulse(uv.y * 40.0, 0.6, 40.0 * w.y);
    ground.lerp(wool, outline.max(stripes)).lerp(motif, filled).lerp(wool, eye) * weave
}

fn plaster(uv: Vec2, w: Vec2, tint: Vec3) -> Vec3 {
    let wide = w.max_element();
    let coarse = fbm(uv * 1.3, 1.3 * wide, 2, 61);
    let fine = fbm(uv * 28.0, 28.0 * wide, 2, 67);
    tint * (0.6 + 0.45 * coarse + 0.5 * fine)
}

/// Wood with its grain along x.
fn grain(uv: Vec2, w: Vec2, tint: Vec3, seed: u32) -> Vec3 {
    let across = w.y.max(w.x * 0.05);
    let figure = fbm(uv * Vec2::new(1.5, 25.0), 25.0 * across, 3, seed);
    let pores = fbm(uv * Vec2::new(8.0, 160.0), 160.0 * across, 2, seed + 9);
    tint * (0.45 + 0.75 * figure + 0.35 * pores)
}

fn planks(uv: Vec2, w: Vec2, tint: Vec3) -> Vec3 {
    const WIDTH: f32 = 0.14;
    let p = uv.y / WIDTH;
    let plank = split(p).0;
    let kept = surviving(w.y / WIDTH);
    let shade = 1.0 + 0.5 * (unit(plank, 3, 71) - 0.5) * kept;
    let along = Vec2::new(uv.x + 5.0 * unit(plank, 5, 72), uv.y);
    grain(along, w, tint, 73) * shade * (0.2 + 0.8 * pulse(p, 0.93, w.y / WIDTH))
}

fn picket(uv: Vec2, w: Vec2) -> Vec3 {
    let board = split(uv.x / super::shape::PICKET_PERIOD).0;
    let tones = [Vec3::new(0.78, 0.78, 0.74), Vec3::new(0.35, 0.55, 0.62), Vec3::new(0.80, 0.62, 0.26)];
    let tone = tones[board.rem_euclid(3) as usize];
    grain(uv.yx() + Vec2::new(board as f32, 0.0), w.yx(), tone, 81) * 0.95
}

fn spiral(uv: Vec2, w: Vec2) -> Vec3 {
    const PITCH: f32 = 0.26;
    // Arc length around a post of 5 cm is 0.31 m: one turn of the band.
    let turns = uv.y / PITCH + uv.x / 0.314_159_27;
    let blur = w.y / PITCH + w.x / 0.314_159_27;
    let band = pulse(turns, 0.5, blur);
    let thin = pulse(turns + 0.2, 0.1, blur);
    let paint = Vec3::new(0.74, 0.70, 0.60)
        .lerp(Vec3::new(0.50, 0.07, 0.05), band)
        .lerp(Vec3::new(0.06, 0.10, 0.22), thin * (1.0 - band));
    let chips = fbm(uv * 40.0, 40.0 * w.max_element(), 3, 83);
    paint * (0.65 + 0.7 * chips)
}

/// Longitude and latitude in turns (latitude -1/4 to 1/4), and their footprints.
fn lon_lat(spot: &Spot) -> (Vec2, Vec2) {
    let (d, radius) = spot.ball;
    let tau = std::f32::consts::TAU;
    let lon = d.x.atan2(d.z) / tau;
    let lat = (-d.y).clamp(-1.0, 1.0).asin() / tau;
    let wide = spot.w.max_element() / (radius * tau);
    let cos = (1.0 - d.y * d.y).max(0.0).sqrt();
    (Vec2::new(lon, lat), Vec2::new((wide / cos.max(1e-3)).min(1.0), wide))
}

fn globe(spot: &Spot) -> Vec3 {
    let (p, w) = lon_lat(spot);
    let (d, radius) = spot.ball;
    let wide = spot.w.max_element() / radius;
    let height = fbm3(d * 2.1 + 7.0, 2.1 * wide, 5, 91);
    let slope = (8.0 * wide).max(0.012);
    let land = smoothstep(0.52 - slope, 0.52 + slope, height);
    let coast = 1.0 - smoothstep(0.0, 0.012 + slope, (height - 0.52).abs());
    let relief = fbm3(d * 17.0, 17.0 * wide, 3, 97);
    let soil = Vec3::new(0.62, 0.47, 0.22).lerp(Vec3::new(0.20, 0.36, 0.12), relief);
    let sea = Vec3::new(0.07, 0.22, 0.36) * (0.75 + 0.5 * relief);
    let lines = pulse(p.x * 24.0, 0.05, w.x * 24.0) + pulse(p.y * 24.0, 0.05, w.y * 24.0);
    sea.lerp(soil * (0.6 + 0.8 * relief), land)
        .lerp(Vec3::new(0.10, 0.08, 0.05), 0.7 * coast)
        .lerp(Vec3::new(0.75, 0.72, 0.60), 0.6 * lines.min(1.0))
}

fn beach_ball(spot: &Spot) -> Vec3 {
    let (p, w) = lon_lat(spot);
    let palette = [
        Vec3::new(0.72, 0.08, 0.06),
        Vec3::new(0.82, 0.80, 0.74),
        Vec3::new(0.05, 0.22, 0.48),
        Vec3::new(0.85, 0.58, 0.08),
    ];
    let segment = split(p.x * 12.0).0;
    let color = palette[segment.rem_euclid(4) as usize];
    let seam = pulse(p.x * 12.0 + 0.03, 0.06, w.x * 12.0).max(pulse(p.y * 12.0 + 0.06, 0.12, w.y * 12.0));
    // Rows of dots of about the same size at low latitudes.
    let dots = Vec2::new(p.x * 36.0, p.y * 36.0);
    let q = dots - floor2(dots) - 0.5;
    let dot = inside(q.length() - 0.22, 36.0 * w.max_element()) * surviving(24.0 * w.max_element());
    let base = color.lerp(Vec3::ONE - color, 0.75 * dot);
    base.lerp(Vec3::splat(0.04), seam)
}

fn chequer(spot: &Spot) -> Vec3 {
    let (p, w) = lon_lat(spot);
    let (p, w) = (p * 24.0, w * 24.0);
    let square = |x: f32, w: f32| 2.0 * pulse(x * 0.5, 0.5, w * 0.5) - 1.0;
    let white = 0.5 + 0.5 * square(p.x, w.x) * square(p.y, w.y);
    let pitted = fbm3(spot.ball.0 * 30.0, 30.0 * spot.w.x / spot.ball.1, 2, 101);
    Vec3::new(0.05, 0.05, 0.06).lerp(Vec3::new(0.84, 0.78, 0.62), white) * (0.8 + 0.4 * pitted)
}

fn marble(spot: &Spot) -> Vec3 {
    let (d, radius) = spot.ball;
    let wide = spot.w.max_element() / radius;
    let warp = fbm3(d * 3.0, 3.0 * wide, 4, 103);
    let phase = d.dot(Vec3::new(3.0, 5.0, 2.0)) + 6.0 * warp;
    let vein = (1.0 - (phase * 2.2).sin().abs()).powi(4);
    Vec3::new(0.78, 0.76, 0.72).lerp(Vec3::new(0.10, 0.22, 0.16), vein) * (0.7 + 0.6 * warp)
}

fn foliage(spot: &Spot) -> Vec3 {
    let (d, radius) = spot.ball;
    let p = d * radius;
    let wide = spot.w.max_element();
    let boughs = fbm3(p * 2.2, 2.2 * wide, 2, 107);
    let leaves = fbm3(p * 11.0, 11.0 * wide, 2, 109);
    let light = smoothstep(0.34, 0.74, 0.45 * boughs + 0.6 * leaves);
    Vec3::new(0.012, 0.03, 0.010).lerp(Vec3::new(0.30, 0.46, 0.10), light)
}
