//! Traversal finds exactly what a loop over all triangles finds, bit for bit.

use super::scenes::{SOUPS, all, differing, nearest, no_rays, rays, soup};
use afterimage_lab::rays::{Bvh, Geometry, Hit, Ray};
use afterimage_testing::Draws;
use glam::Vec3;

/// Rays that are none hit nothing.
#[test]
fn closest_hits_of_random_soups() {
    for (count, center, half) in SOUPS {
        let name = format!("soup of {count} around {center}, {half} m");
        let bvh = Bvh::build(&soup(&name, count, center, half), None, &[]);
        let rays = [rays(&name, 4000, center, half), no_rays()].concat();
        let hit = rays.iter().filter(|r| bvh.closest(r, all).is_some()).count();
        println!("{name}: {hit} of {} rays hit, {} nodes", rays.len(), bvh.node_count());
        assert_eq!(differing(&bvh, &rays), 0, "{name}");
        assert!(count < 100 || hit > 100, "{name}: {hit} rays hit");
    }
}

#[test]
fn whether_anything_is_hit_within_a_limit() {
    let bvh = Bvh::build(&soup("occluded", 1000, Vec3::ZERO, 1.0), None, &[]);
    for (i, ray) in rays("occluded", 4000, Vec3::ZERO, 1.0).into_iter().enumerate() {
        let Some(hit) = nearest(&bvh, &ray) else {
            assert!(!bvh.occluded(&ray, all), "ray {i}");
            continue;
        };
        // A hit at the limit does not count; just inside the limit it does.
        assert!(!bvh.occluded(&Ray { t_max: hit.t, ..ray }, all), "ray {i}");
        assert!(bvh.occluded(&Ray { t_max: hit.t.next_up(), ..ray }, all), "ray {i}");
        assert!(bvh.occluded(&ray, all), "ray {i}");
    }
}

#[test]
fn of_equally_near_triangles_the_first_is_hit() {
    let once = soup("copies", 200, Vec3::ZERO, 1.0);
    let mut thrice = once.clone();
    (0..2).for_each(|_| thrice.extend(&once));
    assert_eq!(differing(&Bvh::build(&thrice, None, &[]), &rays("copies", 2000, Vec3::ZERO, 1.0)), 0);
}

/// Where a ray hits, whatever the triangle's number.
fn place(hit: Option<Hit>) -> Option<[f32; 3]> {
    hit.map(|h| [h.t, h.u, h.v])
}

#[test]
fn moving_and_resting_triangles_are_one_scene() {
    let (a, b) = (soup("resting", 500, Vec3::ZERO, 1.0), soup("moving", 100, Vec3::ZERO, 1.0));
    let build = |t| Bvh::build(t, None, &[]);
    let geometry = Geometry { still: build(&a), moving: build(&b) };
    let mut both = a.clone();
    both.extend(&b);
    let joined = build(&both);
    let mut moving = 0;
    for ray in rays("both", 4000, Vec3::ZERO, 1.0) {
        let (hit, expected) = (geometry.closest(&ray, all), joined.closest(&ray, all));
        assert_eq!(place(hit), place(expected));
        let (Some(hit), Some(expected)) = (hit, expected) else { continue };
        let corners = joined.triangles()[expected.triangle as usize].positions();
        assert_eq!(geometry.triangle(hit.triangle).positions(), corners);
        moving += usize::from(hit.triangle >= geometry.first_moving());
        assert!(geometry.occluded(&ray, all));
    }
    println!("{moving} rays hit what moves");
    assert!(moving > 100);
}

#[test]
fn what_is_not_accepted_is_not_there() {
    use afterimage_lab::scene::{Alpha, Material};
    let materials = [Material { alpha: Alpha::Blend, ..Material::default() }, Material::default()];
    let mut triangles = soup("alpha", 400, Vec3::ZERO, 1.0);
    let mut d = Draws::new("alpha, materials");
    triangles.materials = (0..400).map(|_| u32::from(d.range(0.0, 1.0) < 0.5)).collect();
    let bvh = Bvh::build(&triangles, None, &materials);
    let mut opaque = triangles.clone();
    let blended = opaque.positions.iter_mut().zip(&triangles.materials).filter(|(_, material)| **material == 0);
    blended.for_each(|(corners, _)| *corners = [Vec3::ZERO; 3]);
    let opaque = Bvh::build(&opaque, None, &materials);
    for ray in rays("alpha", 4000, Vec3::ZERO, 1.0) {
        let none = |_, _, _| false;
        assert_eq!(place(bvh.closest(&ray, none)), place(opaque.closest(&ray, all)));
        assert_eq!(bvh.occluded(&ray, none), opaque.occluded(&ray, all));
    }
}
