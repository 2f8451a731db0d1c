//! Materials, their extensions, their textures and texture coordinates.

use super::builder::{Gltf, TRIANGLE, encoded, png};
use afterimage_lab::scene::{Alpha, Coordinates, Material, TextureRef, Wrap};
use glam::{Vec2, Vec3};
use image::DynamicImage;
use serde_json::{Value, json};

/// Material read from JSON, and the warnings.
#[track_caller]
fn read(material: Value) -> (Material, Vec<String>) {
    let scene = Gltf::with_material(material).open();
    (scene.materials[0].clone(), scene.warnings)
}

/// Material read from JSON, without warnings.
#[track_caller]
fn quietly(material: Value) -> Material {
    let (material, warnings) = read(material);
    assert_eq!(warnings, [""; 0]);
    material
}

#[track_caller]
fn extension(name: &str, value: Value) -> Material {
    quietly(json!({"extensions": {name: value}}))
}

#[test]
fn defaults_are_gltfs() {
    let material = quietly(json!({}));
    let expected = Material { metallic: 1.0, double_sided: false, ..Material::default() };
    assert_eq!(material, expected);
    // A primitive without a material gets the default.
    let scene = Gltf::of(&TRIANGLE).open();
    assert_eq!(scene.materials[scene.still().materials[0] as usize], expected);
}

#[test]
fn core_factors() {
    let material = quietly(json!({
        "name": "paint", "doubleSided": true, "emissiveFactor": [0.1, 0.2, 0.3], "alphaMode": "MASK", "alphaCutoff": 0.25,
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 0.75], "metallicFactor": 0.0, "roughnessFactor": 0.4}
    }));
    let expected = Material {
        name: "paint".into(),
        base_color: [0.5, 0.25, 0.125],
        opacity: 0.75,
        roughness: 0.4,
        emissive: [0.1, 0.2, 0.3],
        alpha: Alpha::Mask { cutoff: 0.25 },
        ..Material::default()
    };
    assert_eq!(material, expected);
    assert_eq!(quietly(json!({"alphaMode": "MASK"})).alpha, Alpha::Mask { cutoff: 0.5 });
    assert_eq!(quietly(json!({"alphaMode": "BLEND"})).alpha, Alpha::Blend);
}

#[test]
fn extensions_of_materials() {
    let strong = quietly(json!({"emissiveFactor": [1.0, 0.5, 0.0],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 100.0}}}));
    assert_eq!(strong.emissive, [100.0, 50.0, 0.0]);
    assert_eq!(extension("KHR_materials_ior", json!({"ior": 1.33})).ior, 1.33);
    assert_eq!(extension("KHR_materials_transmission", json!({"transmissionFactor": 0.9})).transmission, 0.9);
    let factors = json!({"specularFactor": 0.5, "specularColorFactor": [1.0, 0.5, 2.0]});
    let specular = extension("KHR_materials_specular", factors);
    assert_eq!((specular.specular, specular.specular_color), (0.5, [1.0, 0.5, 2.0]));
    let coat = extension("KHR_materials_clearcoat", json!({"clearcoatFactor": 0.8, "clearcoatRoughnessFactor": 0.1}));
    assert_eq!((coat.clearcoat, coat.clearcoat_roughness), (0.8, 0.1));
    let factors = json!({"sheenColorFactor": [0.1, 0.2, 0.3], "sheenRoughnessFactor": 0.7});
    let sheen = extension("KHR_materials_sheen", factors);
    assert_eq!((sheen.sheen_color, sheen.sheen_roughness), ([0.1, 0.2, 0.3], 0.7));
    assert_eq!(extension("KHR_materials_anisotropy", json!({"anisotropyStrength": 0.6})).anisotropy, 0.6);
    let thin = extension("KHR_materials_volume", json!({"thicknessFactor": 0.0}));
    assert!(!thin.volume && thin.absorption == [0.0; 3]);
    let factors = json!({"thicknessFactor": 0.5, "attenuationDistance": 2.0, "attenuationColor": [1.0, 0.5, 0.25]});
    let glass = extension("KHR_materials_volume", factors);
    assert!(glass.volume);
    // Beer-Lambert: the attenuation color remains after the attenuation distance.
    for (share, absorption) in [1.0f64, 0.5, 0.25].into_iter().zip(glass.absorption) {
        assert!(((-f64::from(absorption) * 2.0).exp() - share).abs() < 1e-6);
    }
}

#[test]
fn unlit_emits_its_base_color() {
    let unlit = json!({"alphaMode": "BLEND", "extensions": {"KHR_materials_unlit": {}},
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.0, 0.5]}});
    let (material, warnings) = read(unlit);
    assert_eq!(material.emissive, [0.5, 0.25, 0.0]);
    assert_eq!((material.base_color, material.specular, material.metallic), ([0.0; 3], 0.0, 0.0));
    assert_eq!((material.alpha, material.opacity), (Alpha::Blend, 0.5));
    assert!(warnings.len() == 1 && warnings[0].contains("unlit"), "{warnings:?}");
}

#[test]
fn factors_out_of_range_are_brought_into_it() {
    let (material, warnings) = read(json!({"name": "odd", "emissiveFactor": [-1.0, 1e300, 2.0],
        "pbrMetallicRoughness": {"metallicFactor": 7.0, "roughnessFactor": -1e300, "baseColorFactor": [2.0, 0.5, -3.0, 9.0]},
        "extensions": {"KHR_materials_ior": {"ior": 0.5}}}));
    assert_eq!((material.metallic, material.roughness, material.opacity, material.ior), (1.0, 0.0, 1.0, 1.0));
    assert_eq!(material.base_color, [1.0, 0.5, 0.0]);
    assert!(material.emissive[0] == 0.0 && material.emissive[1].is_finite() && material.emissive[2] == 2.0);
    assert_eq!(warnings, ["factors of materials out of their range are clamped: material 0 (odd)"]);
}

#[test]
fn what_is_not_done_is_named_once() {
    let mut file = Gltf::with_material(json!({"extensions": {
        "KHR_materials_clearcoat": {"clearcoatNormalTexture": {"index": 0}}, "KHR_materials_anisotropy": {"anisotropyTexture": {"index": 0}},
        "KHR_materials_iridescence": {}
    }}));
    file.json["extensionsUsed"] =
        json!(["KHR_materials_iridescence", "KHR_materials_clearcoat", "VENDOR_a\nb", "KHR_materials_iridescence"]);
    let scene = file.open();
    assert_eq!(
        scene.warnings,
        [
            "extension KHR_materials_iridescence is not supported and left out",
            "extension VENDOR_a\\nb is not supported and left out",
            "normal maps of coats are left out: material 0",
            "textures of anisotropy are left out: material 0",
        ]
    );
    for (required, remedy) in [
        ("KHR_draco_mesh_compression", "decompress"),
        ("EXT_meshopt_compression", "decompress"),
        ("KHR_texture_basisu", "convert"),
        ("VENDOR_thing", "export"),
    ] {
        file.json["extensionsRequired"] = json!(["KHR_materials_clearcoat", required]);
        file.assert_refused(&[required, "not supported", remedy]);
    }
}

#[test]
fn textures_keep_texels_and_samplers() {
    let mut file = Gltf::with_material(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
        "emissiveTexture": {"index": 1}, "normalTexture": {"index": 2, "scale": 0.5}, "occlusionTexture": {"index": 0}}));
    // Odd sizes, opacity, 16 bits.
    let rgba = png([3, 5], |x, y| [x as u8 * 10, y as u8 * 10, 7, 200]);
    let deep = encoded(&DynamicImage::ImageRgb16(image::ImageBuffer::from_fn(1, 2, |_, y| {
        image::Rgb([65535, 257 * 9, y as u16 * 65535])
    })));
    let gray = encoded(&DynamicImage::ImageLuma16(image::ImageBuffer::from_pixel(7, 1, image::Luma([32896]))));
    for bytes in [rgba, deep, gray] {
        file.texture(&bytes);
    }
    file.push("samplers", json!({"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}));
    file.json["textures"][0]["sampler"] = json!(0);
    let scene = file.open();
    // In the order of the material's slots.
    let [rgba, gray, deep] = &scene.textures[..] else { panic!() };
    assert_eq!((rgba.size, rgba.wrap, rgba.nearest), ([3, 5], [Wrap::Clamp, Wrap::Mirror], true));
    assert_eq!(rgba.texels[4 * 3 + 2], [20, 40, 7, 200]);
    assert_eq!((deep.size, deep.wrap, deep.nearest), ([1, 2], [Wrap::Repeat; 2], false));
    assert_eq!(deep.texels, [[255, 9, 0, 255], [255, 9, 255, 255]]);
    assert_eq!((gray.size, gray.texels[6]), ([7, 1], [128, 128, 128, 255]));
    let material = &scene.materials[0];
    assert_eq!(scene.textures[material.emissive_texture.unwrap().texture as usize].size, [1, 2]);
    assert_eq!(scene.textures[material.normal_texture.unwrap().texture as usize].size, [7, 1]);
    assert_eq!(material.normal_scale, 0.5);
}

#[test]
fn texture_transforms_that_agree_are_baked_and_others_are_the_textures() {
    let transform = |rotation: f64| {
        let transform = json!({"offset": [0.25, 0.5], "rotation": rotation, "scale": [2.0, 4.0]});
        json!({"index": 0, "extensions": {"KHR_texture_transform": transform}})
    };
    let quarter = std::f64::consts::FRAC_PI_2;
    let mut file = Gltf::with_material(json!({"pbrMetallicRoughness": {"baseColorTexture": transform(quarter)},
        "normalTexture": transform(quarter)}));
    file.texture(&png([2, 2], |_, _| [128, 128, 255, 255]));
    let scene = file.open();
    assert_eq!(scene.warnings, [""; 0]);
    // Scaled, rotated counter-clockwise in the image (v increases downwards: u becomes -v), translated.
    let expected = [Vec2::new(0.25, 0.5), Vec2::new(0.25, -1.5), Vec2::new(4.25, 0.5)];
    for (found, expected) in scene.still().uvs[0].iter().zip(expected) {
        assert!(found.abs_diff_eq(expected, 1e-6), "{found} {expected}");
    }
    assert_eq!(scene.textures.iter().map(|t| t.coordinates).collect::<Vec<_>>(), [Coordinates::default()]);
    file.json["materials"][0]["normalTexture"] = transform(0.0);
    let scene = file.open();
    assert_eq!(scene.warnings, [""; 0]);
    assert_eq!(scene.still().uvs[0], [Vec2::ZERO, Vec2::X, Vec2::Y]);
    let [base, normal] = [0, 1].map(|i| scene.textures[i].coordinates);
    assert_eq!(normal, Coordinates { second: false, rows: [[2.0, 0.0, 0.25], [0.0, 4.0, 0.5]] });
    for (found, expected) in base.rows.as_flattened().iter().zip([0.0, 4.0, 0.25, -2.0, 0.0, 0.5]) {
        assert!((found - expected).abs() < 1e-6, "{base:?}");
    }
    assert_eq!(scene.textures[0].texels, scene.textures[1].texels);
    // Of three sets, the third is named.
    let uv = |set: u32| json!({"index": 0, "texCoord": set});
    file.json["materials"][0] = json!({"pbrMetallicRoughness": {"baseColorTexture": uv(0)}, "normalTexture": uv(1),
        "emissiveTexture": uv(2)});
    file.set("TEXCOORD_1", &[[0.5, 0.5]; 3]);
    let scene = file.open();
    assert!(scene.warnings[0].contains("third set of texture coordinates"), "{:?}", scene.warnings);
    assert_eq!(scene.still().second_uvs, [[Vec2::splat(0.5); 3]]);
}

#[test]
fn specular_glossiness_is_converted() {
    let name = "KHR_materials_pbrSpecularGlossiness";
    let read = |value: Value| extension(name, value);
    let factors =
        json!({"diffuseFactor": [0.8, 0.2, 0.1, 0.5], "specularFactor": [0.04, 0.08, 0], "glossinessFactor": 0.3});
    let m = read(factors);
    assert_eq!((m.base_color, m.opacity, m.metallic, m.roughness), ([0.8, 0.2, 0.1], 0.5, 0.0, 0.7));
    assert!(Vec3::from(m.specular_color).abs_diff_eq(Vec3::new(1.0, 2.0, 0.0), 1e-6), "{:?}", m.specular_color);
    // Its defaults: white, and a mirror.
    let m = read(json!({}));
    assert_eq!((m.base_color, m.opacity, m.roughness), ([1.0; 3], 1.0, 0.0));
    assert!((m.specular_color[0] * 0.04 - 1.0).abs() < 1e-6);
    // Textures: glossiness in alpha becomes roughness in G, the specular color stays.
    let spec_gloss = json!({"diffuseTexture": {"index": 0}, "specularGlossinessTexture": {"index": 0},
        "glossinessFactor": 0.5, "specularFactor": [0.5, 0.5, 0.5]});
    let mut file = Gltf::with_material(json!({"extensions": {name: spec_gloss},
        "pbrMetallicRoughness": {"baseColorFactor": [0, 1, 0, 1], "metallicFactor": 1}}));
    file.texture(&png([2, 1], |x, _| [10, 20, 30, if x == 0 { 255 } else { 51 }]));
    file.json["extensionsUsed"] = json!([name]);
    let scene = file.open();
    assert_eq!(scene.warnings, [""; 0]);
    let m = &scene.materials[0];
    let texels = |t: Option<TextureRef>| scene.textures[t.unwrap().texture as usize].texels.clone();
    assert_eq!(texels(m.base_color_texture)[1], [10, 20, 30, 51]);
    assert_eq!(m.specular_color_texture, m.base_color_texture, "one texture");
    let rough: Vec<u8> = texels(m.metallic_roughness_texture).iter().map(|t| t[1]).collect();
    assert_eq!(rough, [128, 230]);
    assert_eq!((m.base_color, m.metallic, m.roughness), ([1.0; 3], 0.0, 1.0));
    // A required extension is supported, too.
    file.json["extensionsRequired"] = json!([name]);
    file.open();
}
