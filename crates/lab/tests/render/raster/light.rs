//! Rasterized colors against closed forms.

use super::rig::draw;
use crate::given::device;
use crate::scene_files::builder::Gltf;
use afterimage::ViewGeometry;
use afterimage_lab::scene::Scene;
use afterimage_lab::view::View;
use glam::{DMat4, DVec3};
use serde_json::{Value, json};
use std::f32::consts::PI;

/// A 2x2 m quad facing +z, with more properties of its Lambertian material, under a directional light of irradiance 2
/// at 60 degrees to its normal. `alpha`: of the vertices on the left and on the right.
fn quad(alpha: [f32; 2], more: &[(&str, Value)]) -> Scene {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let mut file = Gltf::new();
    let attributes = json!({"POSITION": file.floats(&corners.map(|[x, y]| [x, y, 0.0])),
        "COLOR_0": file.floats(&corners.map(|[x, _]| [1.0, 1.0, 1.0, alpha[usize::from(x > 0.0)]]))});
    let indices = file.indices(&[0, 1, 2, 0, 2, 3]);
    let mut material = json!({"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.4, 0.2, 1], "metallicFactor": 0},
        "extensions": {"KHR_materials_specular": {"specularFactor": 0}}});
    more.iter().for_each(|(name, value)| material[*name] = value.clone());
    let material = file.push("materials", material);
    file.shape(json!({"attributes": attributes, "indices": indices, "material": material}));
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual", "KHR_materials_specular"]);
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 2}]}});
    // The light's node is rotated by 60 degrees about y. A light shines along its own -z, so this one comes from +z and
    // +x.
    let rotation = [0.0, 0.5, 0.0, 0.75_f64.sqrt()];
    file.node(json!({"rotation": rotation, "extensions": {"KHR_lights_punctual": {"light": 0}}}));
    file.open()
}

/// Colors of the middle row seen from the front, and which pixels have a surface.
fn middle_row(alpha: [f32; 2], more: &[(&str, Value)]) -> Option<(Vec<[f32; 3]>, Vec<bool>)> {
    let device = device()?;
    let scene = quad(alpha, more);
    // tan(26.565 degrees) = 1/2: the quad exactly fills the image's width.
    let geometry = ViewGeometry::flat([128, 64], 53.130_1).unwrap();
    let view = View::new(geometry, DMat4::from_translation(DVec3::Z * 2.0));
    let frame = draw(&device, &scene, [&view; 2], [0.0; 2]);
    Some((frame.color.row(32).to_vec(), frame.distance.row(32).iter().map(|d| d.is_finite()).collect()))
}

/// Lambertian reflection of irradiance 2 at 60 degrees.
const EXPECTED: [f32; 3] = [0.8 / PI, 0.4 / PI, 0.2 / PI];

fn off(found: [f32; 3], expected: [f32; 3]) -> f32 {
    (0..3).map(|i| (found[i] / expected[i] - 1.0).abs()).fold(0.0, f32::max)
}

#[test]
fn a_lambert_quad_under_one_light() {
    let Some((row, _)) = middle_row([0.0, 1.0], &[]) else { return };
    // Half floats have 11 significant bits.
    assert!(row.iter().all(|&c| off(c, EXPECTED) < 1.0 / 1024.0), "{:?} not {EXPECTED:?}", row[64]);
    // Planted error: a different angle.
    assert!(off(row[64], EXPECTED.map(|v| v * 0.866 / 0.5)) > 0.1);
}

/// glTF: what has the cutoff's alpha is opaque. The color factor's alpha is the cutoff, or it is that of all vertices.
#[test]
fn alpha_equal_to_the_cutoff_is_opaque() {
    for cutoff in [1.0, 0.5, 0.3_f32] {
        let mask = [("alphaMode", json!("MASK")), ("alphaCutoff", json!(cutoff))];
        let Some((row, there)) = middle_row([cutoff; 2], &mask) else { return };
        assert!(there.iter().all(|&there| there), "cutoff {cutoff}");
        let wrong: Vec<_> = (0..128).filter(|&x| off(row[x], EXPECTED) >= 1.0 / 1024.0).map(|x| (x, row[x])).collect();
        assert!(wrong.is_empty(), "cutoff {cutoff}: {wrong:?}");
        // Planted: less alpha, by a step of 8 bits.
        let (row, there) = middle_row([cutoff - 1.0 / 255.0; 2], &mask).unwrap();
        let seen = row.iter().filter(|&&c| c != [0.0; 3]).count();
        assert!(seen < 8 && !there.iter().any(|&there| there), "cutoff {cutoff}: {seen} pixels");
    }
}

#[test]
fn masks_cut_at_their_cutoff_and_blended_surfaces_are_there_where_they_are_more_than_half() {
    let mask = [("alphaMode", json!("MASK")), ("alphaCutoff", json!(0.75))];
    for (mode, cutoff) in [(&mask[..], 0.75), (&[("alphaMode", json!("BLEND"))], 0.5)] {
        let Some((row, there)) = middle_row([0.0, 1.0], mode) else { return };
        for x in 0..128 {
            let alpha = (x as f32 + 0.5) / 128.0;
            assert_eq!(there[x], alpha > cutoff, "column {x}");
            // Over black. At the edge of a mask, samples of a pixel differ.
            let share = if cutoff == 0.5 { alpha } else { f32::from(u8::from(there[x])) };
            let is_right = (0..3).all(|i| (row[x][i] - EXPECTED[i] * share).abs() < 1e-3);
            assert!(is_right || cutoff != 0.5 && (95..=96).contains(&x), "column {x}: {:?}", row[x]);
        }
    }
}
