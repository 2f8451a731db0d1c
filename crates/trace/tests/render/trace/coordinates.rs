//! Textures of one material with coordinates of their own: both tracers, and the rasterizer, against what they must be.

use super::rig::{Rig, differing};
use crate::builder::{Gltf, png};
use crate::given::device;
use crate::raster::rig::draw;
use afterimage_lab::scene::Scene;
use afterimage_trace::gpu::scene_buffer::Storage;
use afterimage_trace::settings::TraceSettings;
use serde_json::{Value, json};

const SIZE: [u32; 2] = [64, 64];

/// A 2x2 m quad that fills the frame. Its first texture coordinates repeat four times, its second ones once. Black base
/// color, and an emissive texture whose left half is green, with these coordinates.
fn quad(info: &Value, base_info: &Value, animated: bool) -> Scene {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0f32]];
    let mut file = Gltf::new();
    let unit = |[x, y]: [f32; 2]| [0.5 + 0.5 * x, 0.5 - 0.5 * y];
    let attributes = json!({"POSITION": file.floats(&corners.map(|[x, y]| [x, y, 0.0])),
        "TEXCOORD_0": file.floats(&corners.map(|c| unit(c).map(|x| 4.0 * x))),
        "TEXCOORD_1": file.floats(&corners.map(unit))});
    let indices = file.indices(&[0, 1, 2, 0, 2, 3]);
    let texture = |index: u32, info: &Value| {
        let mut info = info.clone();
        info["index"] = json!(index);
        info
    };
    let material = json!({"emissiveFactor": [1, 1, 1], "emissiveTexture": texture(1, info), "pbrMetallicRoughness":
        {"baseColorFactor": [0, 0, 0, 1], "baseColorTexture": texture(0, base_info), "metallicFactor": 0},
        "extensions": {"KHR_materials_specular": {"specularFactor": 0}}});
    let material = file.push("materials", material);
    file.texture(&png([2, 2], |_, _| [255; 4]));
    // Sharp: the nearest texel.
    file.texture(&png([2, 1], |x, _| if x == 0 { [0, 255, 0, 255] } else { [0, 0, 0, 255] }));
    file.push("samplers", json!({"magFilter": 9728, "minFilter": 9728}));
    file.json["textures"][1]["sampler"] = json!(0);
    let node = file.shape(json!({"attributes": attributes, "indices": indices, "material": material}));
    if animated {
        file.animate(node, "translation", "LINEAR", &[0.0, 1.0], &[[0.0; 3], [0.0, 0.0, 1e-6]]);
    }
    file.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 0.927_295_2, "znear": 0.1}}));
    // tan(0.927295 / 2) = 1/2
    file.node(json!({"camera": 0, "translation": [0, 0, 2]}));
    let scene = file.open();
    assert_eq!(scene.warnings, [""; 0]);
    assert_eq!(scene.still().is_empty(), animated);
    scene
}

/// Whether a column is green, for texture coordinates that pass its middle at this u.
fn is_green(u: f32) -> bool {
    u.rem_euclid(1.0) < 0.5
}

/// What an emissive texture and a base color texture may state, and u of a column in 0 to 1 on screen.
type Case = (Value, Value, fn(f32, f32) -> f32);

fn cases() -> [Case; 6] {
    let transform = |t: Value| json!({"extensions": {"KHR_texture_transform": t}});
    [
        (json!({"texCoord": 1}), json!({}), |x, _| x),
        (json!({}), json!({"texCoord": 1}), |x, _| 4.0 * x),
        (json!({}), transform(json!({"scale": [4, 4]})), |x, _| 4.0 * x),
        (transform(json!({"scale": [0.25, 0.25], "offset": [0.125, 0]})), json!({}), |x, _| x + 0.125),
        // A quarter turn: u is what v was.
        (transform(json!({"texCoord": 1, "rotation": std::f32::consts::FRAC_PI_2})), json!({}), |_, y| y),
        // All alike: baked.
        (transform(json!({"scale": [0.5, 0.5]})), transform(json!({"scale": [0.5, 0.5]})), |x, _| 2.0 * x),
    ]
}

/// Number of pixels whose green is wrong, away from edges.
fn wrong(pixels: impl Fn(usize, usize) -> f32, u: fn(f32, f32) -> f32) -> usize {
    let at = |i: usize| (i as f32 + 0.5) / SIZE[0] as f32;
    let near = |x: f32, y: f32, d: f32| is_green(u(x + d, y + d)) == is_green(u(x - d, y - d));
    // Without the seam of the two triangles, where software Vulkan's derivatives are wrong.
    let inner = (4..60).flat_map(|y| (4..60).map(move |x: usize| (x, y))).filter(|(x, y)| (x + y).abs_diff(63) > 2);
    let steady = inner.filter(|&(x, y)| near(at(x), at(y), 0.02));
    let wrong = steady.filter(|&(x, y)| (pixels(x, y) > 0.5) != is_green(u(at(x), at(y))));
    wrong.inspect(|&(x, y)| println!("{x} {y}: {}", pixels(x, y))).count()
}

#[test]
fn each_texture_has_its_own_set_and_transform() {
    let Some(device) = device() else { return };
    for (i, (info, base, u)) in cases().into_iter().enumerate() {
        let animated = i % 2 == 1;
        let scene = quad(&info, &base, animated);
        let rig = Rig::new(scene.clone(), SIZE);
        let settings = TraceSettings { max_depth: 1, seed: 3, ..TraceSettings::default() };
        let film = rig.cpu(settings, 2);
        let color = film.color();
        assert_eq!(wrong(|x, y| color.at(x, y)[1], u), 0, "traced {info} {base}");
        let storage = if i < 3 { Storage::Texture } else { Storage::Buffer };
        let on_gpu = rig.gpu(&device, settings, storage, 2);
        if afterimage_testing::gpu::rounds_as_the_cpu() {
            assert_eq!(differing(&film, &on_gpu), 0, "{info} {base}");
        }
        let drawn = draw(&device, &scene, [&rig.view; 2], [0.0; 2]).color;
        assert_eq!(wrong(|x, y| drawn.at(x, y)[1], u), 0, "rasterised {info} {base}");
        // Planted error: the coordinates of the base color for all, as it was.
        if i == 0 {
            assert!(wrong(|x, y| color.at(x, y)[1], |x, _| 4.0 * x) > 500);
        }
    }
}
