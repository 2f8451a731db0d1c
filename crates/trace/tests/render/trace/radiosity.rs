//! The Cornell box against an independent solution: radiosity in f64 on patches, by quadrature, with brute-force
//! visibility. It shares only the scene's triangles with the tracer.

use super::rig::Rig;
use super::statistics::mean_of;
use crate::given::builtin;
use afterimage_lab::scene::Scene;
use afterimage_trace::film::Film;
use afterimage_trace::settings::TraceSettings;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Approximate edge of a patch in metres.
const PATCH_M: f64 = 0.12;
/// Quadrature points along each side of the lamp.
const LAMP: usize = 8;
/// Directions of final gathering: rings of equal weight, and spokes per ring.
const GATHER: [usize; 2] = [12, 24];

/// A parallelogram made of two of the scene's triangles.
struct Quad {
    origin: DVec3,
    u: DVec3,
    v: DVec3,
    /// Towards the front.
    normal: DVec3,
    reflectance: DVec3,
    emitted: f64,
    patches: [usize; 2],
    /// Radiance reflected by each patch after one, two and more bounces.
    bounces: [Vec<DVec3>; BOUNCES],
}

impl Quad {
    fn at(&self, s: f64, t: f64) -> DVec3 {
        self.origin + self.u * s + self.v * t
    }

    fn center(&self, i: usize) -> DVec3 {
        let [w, h] = self.patches;
        self.at(((i % w) as f64 + 0.5) / w as f64, ((i / w) as f64 + 0.5) / h as f64)
    }

    fn patch_at(&self, p: DVec3) -> usize {
        let d = p - self.origin;
        let [w, h] = self.patches;
        let place =
            |along: DVec3, n: usize| ((d.dot(along) / along.length_squared() * n as f64).max(0.0) as usize).min(n - 1);
        place(self.v, h) * w + place(self.u, w)
    }
}

struct Room(Vec<Quad>);

impl Room {
    fn new(scene: &Scene) -> Self {
        let quads = scene.still().positions.chunks(2).zip(scene.still().materials.chunks(2));
        let quads = quads.map(|(pair, material)| {
            let [a, b, c] = pair[0].map(|p| p.as_dvec3());
            let d = pair[1][2].as_dvec3();
            let (u, v) = (b - a, d - a);
            assert!((a + u + v - c).length() < 1e-5 && u.dot(v).abs() < 1e-5);
            let m = &scene.materials[material[0] as usize];
            let patches = [u, v].map(|e| (e.length() / PATCH_M).ceil() as usize);
            let dark = vec![DVec3::ZERO; patches[0] * patches[1]];
            Quad {
                origin: a,
                u,
                v,
                normal: u.cross(v).normalize(),
                reflectance: DVec3::from_array(m.base_color.map(f64::from)),
                emitted: f64::from(m.emissive[0]),
                patches,
                bounces: std::array::from_fn(|_| dark.clone()),
            }
        });
        Self(quads.collect())
    }

    /// Index of the nearest parallelogram between 1e-6 and `far`, and its distance.
    fn hit(&self, from: DVec3, to: DVec3, far: f64) -> Option<(usize, f64)> {
        let hits = self.0.iter().enumerate().filter_map(|(i, q)| {
            let t = q.normal.dot(q.origin - from) / q.normal.dot(to);
            let d = from + to * t - q.origin;
            let is_on = [q.u, q.v].iter().all(|side| (0.0..=1.0).contains(&(d.dot(*side) / side.length_squared())));
            (t > 1e-6 && t < far && is_on).then_some((i, t))
        });
        hits.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Irradiance from the lamp at a point, by the midpoint rule over the lamp.
    fn irradiance(&self, p: DVec3, normal: DVec3) -> f64 {
        let lamp = self.0.iter().find(|q| q.emitted > 0.0).unwrap();
        let mut sum = 0.0;
        for i in 0..LAMP * LAMP {
            let on = lamp.at(((i % LAMP) as f64 + 0.5) / LAMP as f64, ((i / LAMP) as f64 + 0.5) / LAMP as f64);
            let to = on - p;
            let r = to.length();
            let w = to / r;
            let geometry = w.dot(normal).max(0.0) * (-w).dot(lamp.normal).max(0.0) / (r * r);
            if geometry > 0.0 && self.hit(p, w, r - 1e-6).is_none() {
                sum += geometry;
            }
        }
        lamp.emitted * sum * lamp.u.cross(lamp.v).length() / (LAMP * LAMP) as f64
    }

    /// Mean radiance of bounce `bounce` over cosine-weighted directions above a point.
    fn gather(&self, p: DVec3, normal: DVec3, bounce: usize, turn: f64) -> DVec3 {
        let x = normal.any_orthonormal_vector();
        let y = normal.cross(x);
        let [rings, spokes] = GATHER;
        let mut sum = DVec3::ZERO;
        for (ring, spoke) in (0..rings).flat_map(|ring| (0..spokes).map(move |spoke| (ring, spoke))) {
            let r = ((ring as f64 + 0.5) / rings as f64).sqrt();
            let a = TAU * (spoke as f64 + turn) / spokes as f64;
            let w = x * (r * a.cos()) + y * (r * a.sin()) + normal * (1.0 - r * r).sqrt();
            if let Some((i, t)) = self.hit(p, w, f64::INFINITY) {
                let q = &self.0[i];
                // Both sides reflect, but only fronts are visible in this room.
                sum += q.bounces[bounce][q.patch_at(p + w * t)];
            }
        }
        sum / (rings * spokes) as f64
    }

    /// Computes all bounces.
    fn solve(&mut self) {
        for bounce in 0..BOUNCES {
            let mut lit = vec![];
            for q in &self.0 {
                let patch = |i: usize| {
                    let p = q.center(i);
                    if bounce == 0 {
                        return q.reflectance / PI * self.irradiance(p, q.normal);
                    }
                    // Spokes are rotated from patch to patch, so that their pattern averages out.
                    let turn = (i as f64 * 0.618).fract();
                    q.reflectance * self.gather(p, q.normal, bounce - 1, turn)
                };
                lit.push((0..q.patches[0] * q.patches[1]).map(patch).collect::<Vec<_>>());
            }
            for (q, lit) in self.0.iter_mut().zip(lit) {
                q.bounces[bounce] = lit;
            }
        }
    }
}

/// Depth of the deepest comparison.
const BOUNCES: usize = 8;

const SIZE: u32 = 56;

/// Walls, by index of their parallelogram.
const WALLS: [&str; 5] = ["floor", "ceiling", "back wall", "left, red wall", "right, green wall"];

struct Expected {
    /// The parallelogram that covers each pixel, if a single one does.
    seen: Vec<Option<usize>>,
    /// Mean radiance of each pixel after each bounce.
    radiance: Vec<[DVec3; BOUNCES]>,
}

/// Expected image of a camera at (2.78, 2.78, -8) that looks along +z with a vertical field of view of 40 degrees, from
/// 3x3 points per pixel.
fn expected(room: &Room) -> Expected {
    let eye = DVec3::new(2.78, 2.78, -8.0);
    let tan = 20.0_f64.to_radians().tan();
    let mut e = Expected { seen: vec![], radiance: vec![] };
    for i in 0..SIZE * SIZE {
        let mut quads = vec![];
        let mut sum = [DVec3::ZERO; BOUNCES];
        for k in 0..9 {
            let at = |pixel: u32, k: u32| (f64::from(pixel) + (f64::from(k) + 0.5) / 3.0) / f64::from(SIZE) * 2.0 - 1.0;
            // Looking along +z, right is -x.
            let w = DVec3::new(-at(i % SIZE, k % 3) * tan, -at(i / SIZE, k / 3) * tan, 1.0).normalize();
            let hit = room.hit(eye, w, f64::INFINITY);
            quads.push(hit.map(|h| h.0));
            if let Some((q, t)) = hit {
                let (p, quad) = (eye + w * t, &room.0[q]);
                // Shadow edges are finer than patches, so the lamp's light is computed at the exact point.
                sum[0] += quad.reflectance / PI * room.irradiance(p, quad.normal) / 9.0;
                (1..BOUNCES).for_each(|b| sum[b] += quad.bounces[b][quad.patch_at(p)] / 9.0);
            }
        }
        e.seen.push(quads[0].filter(|_| quads.iter().all(|q| *q == quads[0])));
        e.radiance.push(sum);
    }
    e
}

#[test]
fn walls_of_the_cornell_box_are_as_bright_as_radiosity_says() {
    let scene = builtin("cornell");
    let mut room = Room::new(&scene);
    room.solve();
    let e = expected(&room);
    // Mean of a wall and its standard error, and by how much of it the mean differs from the solution. In the wall's
    // brightest channel; colored walls reflect almost nothing in the others.
    let off = |film: &Film, wall: usize, max_depth: usize| {
        let is_in = |i: usize| e.seen[i] == Some(wall);
        let pixels: Vec<usize> = (0..e.seen.len()).filter(|&i| is_in(i)).collect();
        assert!(pixels.len() > 100, "wall {wall}: {} pixels", pixels.len());
        let channel = usize::from(WALLS[wall].contains("green"));
        let sum = |i: &usize| (0..max_depth).map(|b| e.radiance[*i][b][channel]).sum::<f64>();
        let exact = pixels.iter().map(sum).sum::<f64>() / pixels.len() as f64;
        let (mean, se) = mean_of(film, channel, is_in);
        ([mean, se, exact], mean / exact - 1.0)
    };
    let rig = Rig::new(scene, [SIZE, SIZE]);
    let mut failures = vec![];
    for max_depth in [1, 2, 3, 8] {
        let film = rig.cpu(TraceSettings { max_depth, seed: 5, ..TraceSettings::default() }, 224);
        for (wall, name) in WALLS.into_iter().enumerate() {
            let ([mean, se, exact], off) = off(&film, wall, max_depth as usize);
            println!("depth {max_depth}, {name}: {mean:.5} +- {se:.5}, radiosity {exact:.5}, {off:+.4} of it off");
            if max_depth == 1 && name == "ceiling" {
                // The lamp hangs below the ceiling and emits downwards.
                assert!(mean == 0.0 && exact == 0.0);
            } else if !(off.abs() < 0.01 && se < 0.006 * mean) {
                failures.push(format!("depth {max_depth}, {name}: {off:+.4}"));
            }
        }
    }
    assert!(failures.is_empty(), "{failures:?}");

    // Planted error: a floor that is two percent darker.
    let mut darker = builtin("cornell");
    darker.materials[0].base_color = [0.73 * 0.98; 3];
    let film = Rig::new(darker, [SIZE, SIZE]).cpu(TraceSettings { max_depth: 1, ..TraceSettings::default() }, 96);
    let off = off(&film, 0, 1).1;
    println!("a darker floor: {off:+.4} of it off");
    assert!(off.abs() > 0.01);
}
