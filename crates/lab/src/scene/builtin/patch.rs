//! Tessellation of parametric surfaces.

use crate::scene::Triangles;
use glam::{Vec2, Vec3};

/// Tessellates the surface `at(u, v)` over the unit square into `cells` quadrilaterals along u and v, two triangles
/// each, with smooth normals. Seen from the front, u increases to the right and v upwards. Degenerate triangles (poles)
/// are left out.
pub(super) fn patch(to: &mut Triangles, cells: [u32; 2], material: u32, at: impl Fn(f32, f32) -> Vec3) {
    let [columns, rows] = cells;
    let point = |i: u32, j: u32| at(i as f32 / columns as f32, j as f32 / rows as f32);
    let normal = |i: u32, j: u32, flat: Vec3| {
        let (u, v) = (i as f32 / columns as f32, j as f32 / rows as f32);
        let (du, dv) = (0.25 / columns as f32, 0.25 / rows as f32);
        let along_u = at(u + du, v) - at(u - du, v);
        let along_v = at(u, v + dv) - at(u, v - dv);
        let smooth = along_u.cross(along_v).normalize_or(flat);
        // Where the parametrisation is singular (poles), use the face normal.
        if smooth.dot(flat) > 0.0 { smooth } else { flat }
    };
    for j in 0..rows {
        for i in 0..columns {
            let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
            for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
                let ids = [corners[a], corners[b], corners[c]];
                let positions = ids.map(|[i, j]| point(i, j));
                let [p, q, r] = positions;
                let flat = (q - p).cross(r - p);
                if flat.length_squared() < 1e-18 {
                    continue;
                }
                to.push_flat(positions, material);
                let last = to.len() - 1;
                to.normals[last] = ids.map(|[i, j]| normal(i, j, flat.normalize()));
                to.uvs[last] = ids.map(|[i, j]| Vec2::new(i as f32 / columns as f32, 1.0 - j as f32 / rows as f32));
            }
        }
    }
}

/// Direction of longitude `u` and latitude `v`, both in \[0, 1\]; v = 0 is down.
pub(super) fn direction(u: f32, v: f32) -> Vec3 {
    let (sin_u, cos_u) = (u * std::f32::consts::TAU).sin_cos();
    let (sin_v, cos_v) = (v * std::f32::consts::PI).sin_cos();
    Vec3::new(sin_v * sin_u, -cos_v, sin_v * cos_u)
}
