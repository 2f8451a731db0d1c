//! Packing and unpacking of triangle records.

use super::scenes::{dressed, soup};
use afterimage_lab::rays::Bvh;
use glam::{Vec2, Vec3, Vec4};

#[test]
fn attributes_survive_packing() {
    let triangles = dressed("attributes", 500);
    let bvh = Bvh::build(&triangles, None, &[]);
    for (record, attributes) in bvh.triangles().iter().zip(bvh.attributes()) {
        let (source, got) = (record.source() as usize, attributes.unpack());
        assert_eq!(record.positions(), triangles.positions[source]);
        assert_eq!(got.uvs, triangles.uvs[source]);
        for i in 0..3 {
            let (normal, tangent) = (triangles.normals[source][i], triangles.tangents[source][i]);
            // Rounding is half a step of 1/32767 in x and y, plus one step in a tangent's x for the sign bit; z moves
            // by the sum. The sphere is at most sqrt(3) larger than the octahedron: sqrt(3) |(0.5, 0.5, 1)| and sqrt(3)
            // |(1.5, 0.5, 2)| steps.
            assert!(got.normals[i].distance(normal) < 2.13 / 32767.0, "{} {normal}", got.normals[i]);
            assert!(got.tangents[i].truncate().distance(tangent.truncate()) < 4.42 / 32767.0);
            assert_eq!(got.tangents[i].w, tangent.w);
            assert!((got.colors[i] - triangles.colors[source][i]).abs().max_element() <= 0.5 / 255.0 + 1e-6);
        }
    }
}

#[test]
fn bad_attributes_become_harmless() {
    let mut triangles = soup("bad attributes", 1, Vec3::ZERO, 1.0);
    triangles.normals[0] = [Vec3::NAN, Vec3::ZERO, Vec3::INFINITY];
    triangles.uvs[0] = [Vec2::NAN, Vec2::INFINITY, Vec2::ONE];
    triangles.colors[0] = [Vec4::NAN, Vec4::splat(-1.0), Vec4::splat(7.0)];
    triangles.materials.clear();
    let bvh = Bvh::build(&triangles, None, &[]);
    let got = bvh.attributes()[0].unpack();
    assert_eq!(got.normals, [Vec3::Z; 3]);
    assert_eq!(got.uvs, [Vec2::ZERO, Vec2::ZERO, Vec2::ONE]);
    assert_eq!(got.colors, [Vec4::ZERO, Vec4::ZERO, Vec4::ONE]);
    assert_eq!(bvh.triangles()[0].material(), 0);
}
