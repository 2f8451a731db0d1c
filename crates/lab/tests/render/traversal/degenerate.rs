//! H81: hierarchies are built and traversed for any triangles.

use super::scenes::{all, differing, point, rays, soup};
use afterimage_lab::rays::{Bvh, Ray};
use afterimage_lab::scene::Triangles;
use afterimage_testing::{Draws, holds};
use glam::{Vec3, vec3};

#[test]
fn h81_triangles_that_no_ray_can_meet_are_dropped_and_counted() {
    let mut triangles = soup("sound", 50, Vec3::ZERO, 1.0);
    let broken = [
        [Vec3::NAN, Vec3::X, Vec3::Y],
        [Vec3::X, vec3(0.0, f32::INFINITY, 0.0), Vec3::Y],
        [Vec3::X, Vec3::Y, Vec3::splat(1e30)],
        [Vec3::X; 3],
        [Vec3::ZERO, Vec3::X, Vec3::X * 2.0],
        [Vec3::ZERO, Vec3::ZERO, Vec3::X],
    ];
    for corners in broken {
        triangles.push_flat(corners, 7);
    }
    let bvh = Bvh::build(&triangles, None, &[]);
    assert_eq!((bvh.dropped(), bvh.triangles().len()), (broken.len() as u32, 50));
    assert_eq!(differing(&bvh, &rays("sound", 1000, Vec3::ZERO, 1.0)), 0);
    for positions in [broken.to_vec(), vec![]] {
        let bvh = Bvh::build(&Triangles { positions, ..Triangles::default() }, None, &[]);
        let ray = Ray { origin: Vec3::ZERO, direction: Vec3::X, t_max: f32::INFINITY };
        assert_eq!((bvh.node_count(), bvh.closest(&ray, all), bvh.occluded(&ray, all)), (0, None, false));
    }
    let (kinds, rest) = (broken.len(), "1000 rays through the rest hit what brute force hits");
    holds!("H81", Cpu, "{kinds} kinds of broken triangles dropped and counted; {rest}");
}

#[test]
fn h81_crowds_of_alike_triangles_take_no_longer_than_others() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
    type Corners<'a> = &'a dyn Fn(f32) -> [Vec3; 3];
    let crowds: [(&str, Corners<'_>); 4] = [
        ("copies", &|_| corners),
        ("a row", &|i| corners.map(|c| c + Vec3::X * i)),
        ("around one centre", &|i| [vec3(-i - 1.0, 0.0, 0.0), vec3(i + 1.0, 0.0, 0.0), vec3(0.0, 0.0, 1.0)]),
        ("ever larger", &|i| corners.map(|c| c * 1.001_f32.powf(i))),
    ];
    for (name, corners) in crowds {
        let mut triangles = Triangles::default();
        for i in 0..30_000 {
            triangles.push_flat(corners(i as f32), 0);
        }
        let bvh = Bvh::build(&triangles, None, &[]);
        println!("{name}: {} nodes, {} dropped, stack {}", bvh.node_count(), bvh.dropped(), bvh.stack_needed());
        assert!(bvh.stack_needed() <= 32);
        let mut d = Draws::new(name);
        let ray = |_| Ray { origin: point(&mut d, 1.0) + Vec3::Z, direction: -Vec3::Z, t_max: f32::INFINITY };
        assert_eq!(differing(&bvh, &(0..20).map(ray).collect::<Vec<_>>()), 0, "{name}");
    }
}

#[test]
fn h81_sizes_over_the_whole_range_of_floats() {
    let mut d = Draws::new("sizes");
    let mut triangles = Triangles::default();
    for i in 0..2000 {
        let scale = 10_f32.powf(-10.0 + 25.0 * i as f32 / 2000.0);
        triangles.push_flat([0; 3].map(|_| point(&mut d, 1.0) * scale), 0);
    }
    assert_eq!(differing(&Bvh::build(&triangles, None, &[]), &rays("sizes", 2000, Vec3::ZERO, 1.0)), 0);
}
