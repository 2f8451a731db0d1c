//! `courtyard`: about 260,000 triangles with displaced surfaces everywhere, for timing of rays.

use super::patch::{direction, patch};
use super::still::{look_at, still};
use crate::scene::{Material, Scene, Triangles};
use afterimage::kernel::rng::{pcg4d, unit_draw};
use glam::Vec3;
use std::f32::consts::TAU;

/// The courtyard with about 262,144 triangles; degenerate ones at the poles of bushes are left out.
pub fn courtyard() -> Scene {
    courtyard_of(262_144)
}

/// The courtyard with about `triangles` triangles: paving, walls of rough stone, 32 columns under an architrave, 16
/// bushes. Light comes from a uniform sky and a lantern on each side.
pub fn courtyard_of(triangles: u32) -> Scene {
    let [paving, stone, marble, leaves, lantern] = [0, 1, 2, 3, 4];
    let lambert =
        |name: &str, base_color| Material { name: name.into(), base_color, specular: 0.0, ..Material::default() };
    let materials = vec![
        lambert("paving", [0.42, 0.38, 0.33]),
        lambert("stone", [0.62, 0.52, 0.40]),
        lambert("marble", [0.80, 0.78, 0.74]),
        lambert("leaves", [0.12, 0.30, 0.08]),
        Material { emissive: [30.0, 20.0, 10.0], ..lambert("lantern", [0.0; 3]) },
    ];
    // Shares of the triangles: paving 1/8, walls 1/4, columns 3/8, bushes 1/4.
    let unit = triangles as f32;
    let square = |share: f32| ((unit * share / 2.0).sqrt().round() as u32).max(2);
    let mut t = Triangles::default();
    let half = 10.0;

    let cells = square(0.125);
    patch(&mut t, [cells, cells], paving, |u, v| {
        let (x, z) = ((2.0 * u - 1.0) * half, (1.0 - 2.0 * v) * half);
        let tile = noise((x * 1.5).floor() as i32, (z * 1.5).floor() as i32, 1);
        Vec3::new(x, 0.03 * tile + 0.01 * smooth_noise(x * 4.0, z * 4.0, 2), z)
    });
    let cells = square(0.0625);
    for side in 0..4 {
        patch(&mut t, [cells, cells], stone, |u, v| {
            let (along, height) = ((2.0 * u - 1.0) * half, v * 7.0);
            let brick = noise((along * 1.2).floor() as i32, (height * 2.5).floor() as i32, 3 + side);
            let depth = half - 0.06 * brick - 0.05 * smooth_noise(along * 3.0, height * 3.0, 7 + side);
            turned(side, Vec3::new(along, height, -depth))
        });
    }
    let cells = square(0.375 / 36.0);
    for column in 0..32 {
        let (side, place) = (column / 8, column % 8);
        let center = turned(side, Vec3::new((place as f32 - 3.5) * 1.8 + 0.9, 0.0, -7.2));
        patch(&mut t, [cells, cells], marble, |u, v| {
            let flutes = 1.0 + 0.06 * (u * 16.0 * TAU).cos();
            let swell = 0.28 - 0.05 * v + 0.08 * ((v - 0.5).abs() * 2.0).powi(12);
            center + Vec3::new((u * TAU).sin() * swell * flutes, v * 4.5, (u * TAU).cos() * swell * flutes)
        });
    }
    for side in 0..4 {
        // The architrave: a beam of square section.
        patch(&mut t, [cells * 2, cells / 2], marble, |u, v| {
            let (sin, cos) = ((v * TAU).sin(), (v * TAU).cos());
            let rim = 0.35 / sin.abs().max(cos.abs());
            turned(side, Vec3::new((2.0 * u - 1.0) * 7.6, 4.85 + rim * sin, -7.2 + rim * cos))
        });
    }
    let cells = square(0.25 / 16.0);
    for bush in 0..16 {
        let (side, place) = (bush / 4, bush % 4);
        let center = turned(side, Vec3::new((place as f32 - 1.5) * 2.6, 0.7, -4.6));
        patch(&mut t, [cells, cells], leaves, |u, v| {
            let d = direction(u, v);
            // Noise of the direction, not of u: it is seamless.
            let rough = smooth_noise(d.x * 9.0 + d.z * 5.0, d.y * 9.0 + d.z * 7.0, 20 + bush);
            center + d * (0.55 + 0.25 * rough)
        });
    }
    for side in 0..4 {
        let center = turned(side, Vec3::new(0.0, 3.4, -7.2));
        patch(&mut t, [12, 8], lantern, |u, v| center + 0.15 * direction(u, v));
    }
    let camera = look_at([5.5, 2.2, 6.2], [-2.0, 2.0, -4.0], 50.0);
    still("courtyard", materials, t, camera, vec![], [0.5, 0.65, 0.9])
}

/// Rotation by `side` quarter turns about y.
fn turned(side: u32, p: Vec3) -> Vec3 {
    match side % 4 {
        0 => p,
        1 => Vec3::new(-p.z, p.y, p.x),
        2 => Vec3::new(-p.x, p.y, -p.z),
        _ => Vec3::new(p.z, p.y, -p.x),
    }
}

/// Random number in \[0, 1) of a lattice cell.
fn noise(x: i32, y: i32, salt: u32) -> f32 {
    unit_draw(pcg4d([x as u32, y as u32, salt, 0])[0])
}

/// Value noise: [`noise`] interpolated smoothly between cells.
fn smooth_noise(x: f32, y: f32, salt: u32) -> f32 {
    let (i, j) = (x.floor(), y.floor());
    let fade = |t: f32| t * t * (3.0 - 2.0 * t);
    let (s, t) = (fade(x - i), fade(y - j));
    let at = |di, dj| noise(i as i32 + di, j as i32 + dj, salt);
    let along = |dj| at(0, dj) * (1.0 - s) + at(1, dj) * s;
    along(0) * (1.0 - t) + along(1) * t
}
