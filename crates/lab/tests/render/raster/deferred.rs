//! Deferred frames against forward ones.

use super::noise::noise;
use super::rig::FAST;
use crate::given::{builtin, device};
use afterimage::Image;
use afterimage_lab::frame::{Content, ShadedColor, ShadingRequest, SourceFrame};
use afterimage_lab::raster::{RasterSettings, Shading};
use afterimage_lab::scene::{Alpha, Environment, Material, Scene, TextureRef};
use afterimage_lab::source::{FrameRequest, FrameSource, RasterSource, SceneCamera, Wanted};

/// Odd sides: the last quads lie half beyond the edges.
const SIZE: [u32; 2] = [159, 91];
const JITTER_PX: [f32; 2] = [0.3, -0.45];
const DEFERRED: RasterSettings = RasterSettings { shading: Shading::Deferred, ..FAST };

/// Walls and floor of random texels in all textures that the G-buffer knows, with holes.
fn textured() -> Scene {
    let mut scene = noise();
    let texture = Some(TextureRef { texture: 0 });
    for texel in &mut scene.textures[0].texels {
        // Normals face outwards, and a tenth of the surface is missing.
        *texel = [96 + texel[0] / 4, 96 + texel[1] / 4, texel[2] | 128, if texel[0] < 26 { 0 } else { 255 }];
    }
    scene.materials = vec![Material {
        alpha: Alpha::Mask { cutoff: 0.5 },
        metallic: 0.5,
        emissive: [0.5, 0.1, 3.0],
        metallic_roughness_texture: texture,
        normal_texture: texture,
        emissive_texture: texture,
        ..scene.materials[0].clone()
    }];
    scene
}

/// The walls without any light of their own, so that there is a sun; below a coat, and with sheen.
fn coated() -> Scene {
    let mut scene = noise();
    scene.environment = Environment::Constant([0.0; 3]);
    scene.materials = vec![Material {
        specular_tint: 0.5,
        sheen_color: [0.2, 0.4, 0.1],
        sheen_tint: 0.7,
        clearcoat: 0.8,
        clearcoat_roughness: 0.2,
        roughness: 0.4,
        ..scene.materials[0].clone()
    }];
    scene
}

/// The courtyard with bushes of which some can be seen through, as the lanterns.
fn blended() -> Scene {
    let mut scene = builtin("courtyard");
    scene.materials[3] = Material { alpha: Alpha::Blend, opacity: 0.4, ..scene.materials[3].clone() };
    scene.materials[2] = Material { alpha: Alpha::Blend, opacity: 0.7, ..scene.materials[2].clone() };
    scene
}

fn scenes() -> impl Iterator<Item = (&'static str, Scene)> {
    let built = ["courtyard", "cubes", "mirror-room", "interior"].map(|name| (name, builtin(name)));
    built.into_iter().chain([("textured", textured()), ("coated", coated()), ("blended", blended())])
}

fn source(scene: &Scene, settings: RasterSettings) -> Option<RasterSource> {
    let camera = SceneCamera::choose(scene, Some("walk"), SIZE, None).unwrap();
    Some(RasterSource::new(device()?, scene.clone(), camera, None, settings).unwrap())
}

fn request() -> FrameRequest {
    FrameRequest { jitter_px: Some(JITTER_PX), ..FrameRequest::full_rate(3) }
}

fn full_rate(source: &mut RasterSource) -> SourceFrame {
    match source.render(&request()).unwrap().content {
        Content::Jittered(frame) => frame,
        _ => panic!("one sample a pixel"),
    }
}

/// PSNR in dB of colors as they are shown.
fn psnr_db(a: &Image<[f32; 3]>, b: &Image<[f32; 3]>) -> f64 {
    let shown = |v: f32| f64::from(v.clamp(0.0, 1.0)).powf(1.0 / 2.2);
    let squares = a.pixels().iter().zip(b.pixels()).flat_map(|(a, b)| [0, 1, 2].map(|c| shown(a[c]) - shown(b[c])));
    -10.0 * (squares.map(|d| d * d).sum::<f64>() / (3 * a.pixels().len()) as f64).log10()
}

/// Base colors have 8 bits, which alone is 59 dB: 255 steps of rms 1 / sqrt(12).
#[test]
fn deferred_frames_are_the_forward_ones_up_to_the_precision_of_the_g_buffer() {
    for (name, scene) in scenes() {
        let (Some(mut forward), Some(mut deferred)) = (source(&scene, FAST), source(&scene, DEFERRED)) else { return };
        assert!(!forward.is_deferred() && deferred.is_deferred(), "{name}");
        let [expected, found] = [full_rate(&mut forward), full_rate(&mut deferred)];
        let db = psnr_db(&expected.color, &found.color);
        let depths = expected.depth.as_ref().unwrap().pixels().iter().zip(found.depth.as_ref().unwrap().pixels());
        let depth_off = depths.map(|(a, b)| if a == b { 0.0 } else { (a / b - 1.0).abs() }).fold(0.0, f32::max);
        let motions = expected.motion.as_ref().unwrap().pixels().iter().zip(found.motion.as_ref().unwrap().pixels());
        let motion_off = motions.map(|(a, b)| (a[0] - b[0]).abs().max((a[1] - b[1]).abs())).fold(0.0, f32::max);
        let [albedo, kept] = [&mut forward, &mut deferred].map(|source| source.albedo(3, JITTER_PX).unwrap());
        let albedo_db = psnr_db(&albedo, &kept);
        println!("{name}: {db:.1} dB, albedo {albedo_db:.1} dB, depth off by {depth_off}, motion by {motion_off} px");
        assert!(db > 50.0 && albedo_db > 50.0, "{name}");
        assert!(depth_off < 1e-6 && motion_off < 1e-3, "{name}");
    }
}

/// The chosen quads have the bits of the full-rate frame, and nothing else is lit; nor do surfaces differ.
#[test]
fn lit_quads_are_those_of_the_deferred_frame() {
    for (name, scene) in scenes() {
        let Some(mut source) = source(&scene, DEFERRED) else { return };
        let full = full_rate(&mut source);
        let frame = source.render(&FrameRequest { wanted: Wanted::Surfaces, albedo: true, ..request() }).unwrap();
        let Content::OnDevice(content) = &frame.content else { panic!("surfaces on the device") };
        let (depth, motion) = content.read_geometry().unwrap();
        assert!(full.depth.as_ref() == Some(&depth) && full.motion.as_ref() == Some(&motion), "{name}");
        let is_chosen = |[x, y]: [u32; 2]| (x / 2 * 7 + y / 2 * 5 + x / 2 * (y / 2)) % 4 == 0;
        let chosen = Image::from_fn(SIZE, is_chosen);
        let shaded = source.shade(&frame, &ShadingRequest::new(chosen, None)).unwrap().unwrap();
        let ShadedColor::InMemory(color) = shaded.color else { panic!("asked for in memory") };
        // The second picture has the next quads: a planted error.
        let [expected, planted] = [0, 2].map(|shift| {
            let lit = |[x, y]: [u32; 2]| {
                if is_chosen([x + shift, y]) { full.color.at(x as usize, y as usize) } else { [0.0; 3] }
            };
            Image::from_fn(SIZE, lit)
        });
        assert!(color == expected && color != planted, "{name}: {:.1} dB", psnr_db(&color, &expected));
        assert!(frame.albedo == Some(source.albedo(3, JITTER_PX).unwrap()), "{name}");
    }
}

/// One pixel of each quad has the full-rate frame's bits where nothing is blended.
#[test]
fn one_pixel_of_each_quad_is_that_of_the_deferred_frame() {
    for (name, scene) in [("courtyard", builtin("courtyard")), ("textured", textured())] {
        let Some(mut source) = source(&scene, DEFERRED) else { return };
        let full = full_rate(&mut source);
        let frame = source.render(&FrameRequest { wanted: Wanted::Surfaces, ..request() }).unwrap();
        for place in [[0, 0], [1, 0], [1, 1]] {
            let mask = Image::from_fn(SIZE, |px| px.map(|v| v % 2) == place);
            let shaded = source.shade(&frame, &ShadingRequest::new(mask, None)).unwrap().unwrap();
            let Some(ShadedColor::InMemory(half)) = shaded.half else { panic!("half the size") };
            let pixels = (0..SIZE[1] / 2).flat_map(|y| (0..SIZE[0] / 2).map(move |x| [x as usize, y as usize]));
            for [x, y] in pixels {
                let expected = full.color.at(2 * x + place[0] as usize, 2 * y + place[1] as usize);
                assert_eq!(half.at(x, y), expected, "{name}, {place:?}, ({x}, {y})");
            }
        }
    }
}

/// Highlights that are stretched along tangents need what the G-buffer has not: such scenes are drawn forward.
#[test]
fn scenes_beyond_the_g_buffer_are_drawn_forward() {
    let mut scene = coated();
    scene.materials[0].anisotropy = 0.5;
    let (Some(mut forward), Some(mut deferred)) = (source(&scene, FAST), source(&scene, DEFERRED)) else { return };
    assert!(!deferred.is_deferred());
    assert!(full_rate(&mut forward).color == full_rate(&mut deferred).color);
}
