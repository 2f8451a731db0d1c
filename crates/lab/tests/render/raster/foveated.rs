//! Foveated frames against the full-rate frame's pixels.

use super::rig::{Frame, Rig, is_smooth};
use crate::given;
use crate::given::device;
use afterimage::{Foveation, Lattice, Lattices, ViewGeometry};
use afterimage_lab::raster::{AtlasLayout, FoveatedTargets, PixelSamples};
use afterimage_lab::scene::{Environment, Material, Pose, Scene, Texture, TextureRef, Triangles, Wrap, builtin};
use afterimage_lab::source::SceneCamera;
use afterimage_lab::trace::view::View;
use glam::{DMat4, DQuat, DVec3, Vec2, vec3};

const SIZE: [u32; 2] = [320, 180];

/// PSNR that samples of steps up to 16 reach away from silhouettes. Texture levels of detail come from differences over
/// a step instead of over a pixel, and vertices are snapped to 1/256 of a step. Measured: 53 dB and more at step 2, 49
/// at step 4, 47 at step 8, 45 at step 16, 37 at step 32.
const SMOOTH_DB: f64 = 40.0;
/// Largest difference of motion away from silhouettes, in pixels.
const MOTION_PX: f32 = 1e-3;
/// Largest relative difference of distance away from silhouettes.
const DISTANCE: f32 = 2e-5;

/// A floor and a wall of random texels, whose mean is gray: a wrong level of detail shows.
pub(super) fn noise() -> Scene {
    let mut triangles = Triangles::default();
    triangles.push_quad([vec3(-8.0, 0.0, 8.0), vec3(8.0, 0.0, 8.0), vec3(8.0, 0.0, -8.0), vec3(-8.0, 0.0, -8.0)], 0);
    triangles.push_quad([vec3(-8.0, 0.0, -8.0), vec3(8.0, 0.0, -8.0), vec3(8.0, 9.0, -4.0), vec3(-8.0, 9.0, -4.0)], 0);
    for (uvs, corners) in triangles.uvs.iter_mut().zip(&triangles.positions) {
        *uvs = corners.map(|p| Vec2::new(p.x, p.y + p.z) * 0.25);
    }
    let texels = (0..256 * 256_u32).map(|i| {
        let bits = afterimage::kernel::rng::bits(i % 256, i / 256, 0, 1);
        [bits as u8, (bits >> 8) as u8, (bits >> 16) as u8, 255]
    });
    let material = Material { base_color_texture: Some(TextureRef { texture: 0 }), ..Material::default() };
    let environment = Environment::Constant([1.0; 3]);
    let mut scene = Scene::from_parts("noise", vec![material], triangles, Pose::default(), environment).unwrap();
    let (size, wrap, texels) = ([256; 2], [Wrap::Repeat; 2], texels.collect());
    scene.textures = vec![Texture { size, texels, wrap, nearest: false, coordinates: Default::default() }];
    scene
}

/// A view of 70 degrees from 1.6 m above the floor, and the previous one: turned, moved and set back.
pub(super) fn views(geometry: ViewGeometry) -> [View; 2] {
    let now = DMat4::from_translation(DVec3::new(0.5, 1.6, 5.0)) * DMat4::from_rotation_y(0.2);
    let step = DMat4::from_translation(DVec3::new(0.05, -0.01, 0.03)) * DMat4::from_quat(DQuat::from_rotation_y(0.01));
    [now, now * step].map(|world_from_camera| View::new(geometry, world_from_camera))
}

pub(super) fn flat(size: [u32; 2]) -> ViewGeometry {
    ViewGeometry::flat(size, 70.0).unwrap()
}

/// The samples of a foveated frame: their lattices in the atlas, and the atlas.
fn foveated(rig: &mut Rig, views: &[View; 2], lattices: &Lattices, layout: AtlasLayout) -> (Lattices, Frame) {
    let (lattices, size) = layout.place(lattices, views[0].geometry().size_px());
    let targets = FoveatedTargets::new(&rig.device.device, size);
    rig.submit(|raster, device, encoder| {
        raster.record_foveated(device, encoder, views.each_ref(), (&lattices, PixelSamples::Four), &targets);
    });
    (lattices, rig.read(&targets.atlas))
}

/// Pixels of a lattice's samples inside the frame, with their texels.
fn samples(lattice: &Lattice, size: [u32; 2]) -> impl Iterator<Item = ([usize; 2], [usize; 2])> + use<> {
    let Lattice { first_px, step, points, atlas_texel } = *lattice;
    let texel = atlas_texel.unwrap();
    (0..points[1]).flat_map(move |j| (0..points[0]).map(move |i| [i, j])).filter_map(move |point| {
        let px = [0, 1].map(|k| first_px[k] + step * point[k]);
        let inside = (0..2).all(|k| px[k] < size[k]);
        inside.then(|| (px.map(|v| v as usize), [0, 1].map(|k| (texel[k] + point[k]) as usize)))
    })
}

/// Differences of samples from the pixels of the full-rate frame.
#[derive(Debug, Default)]
struct Difference {
    samples: usize,
    /// Samples whose color, distance and motion differ in any bit.
    bits: [usize; 3],
    /// PSNR of all samples' colors, clamped to 1.
    psnr_db: f64,
    /// Of samples away from silhouettes: number, PSNR, and largest differences.
    smooth: usize,
    smooth_db: f64,
    distance: f32,
    motion_px: f32,
}

impl Difference {
    /// As the bars of coarse samples demand.
    fn is_small(&self) -> bool {
        self.smooth_db >= SMOOTH_DB && self.distance <= DISTANCE && self.motion_px <= MOTION_PX
    }
}

/// `shift`: planted error, added to the full-rate pixel.
fn difference(full: &Frame, made: &Frame, lattice: &Lattice, shift: usize) -> Difference {
    let mut d = Difference::default();
    let (mut squares, mut smooth_squares) = (0.0, 0.0);
    for (px, texel) in samples(lattice, [full.color.width() as u32, full.color.height() as u32]) {
        let x = (px[0] + shift).min(full.color.width() - 1);
        let (color, seen) = (full.color.at(x, px[1]), made.color.at(texel[0], texel[1]));
        let (distance, far) = (full.distance.at(x, px[1]), made.distance.at(texel[0], texel[1]));
        let (motion, moved) = (full.motion.at(x, px[1]), made.motion.at(texel[0], texel[1]));
        let error = (0..3).map(|k| f64::from((color[k].min(1.0) - seen[k].min(1.0)).powi(2))).sum::<f64>() / 3.0;
        d.samples += 1;
        squares += error;
        let differ = [color != seen, distance != far, motion != moved];
        (0..3).for_each(|i| d.bits[i] += usize::from(differ[i]));
        if is_smooth(&full.distance, [x, px[1]]) {
            d.smooth += 1;
            smooth_squares += error;
            let off = if distance == far { 0.0 } else { (far / distance - 1.0).abs() };
            d.distance = if off.is_nan() { f32::INFINITY } else { d.distance.max(off) };
            d.motion_px = d.motion_px.max((motion[0] - moved[0]).abs()).max((motion[1] - moved[1]).abs());
        }
    }
    let db = |squares: f64, n: usize| -10.0 * (squares / n.max(1) as f64).log10();
    (d.psnr_db, d.smooth_db) = (db(squares, d.samples), db(smooth_squares, d.smooth));
    d
}

pub(super) const FOVEATION: fn() -> Foveation =
    || Foveation { rate_mid: 4, rate_far: 8, fovea_deg: 20.0, ..Foveation::default() };

/// In the middle, at a corner, and beyond the edge.
const GAZES: [[f32; 2]; 3] = [[161.0, 90.0], [2.0, 178.0], [330.0, 61.0]];

fn scenes() -> Vec<(&'static str, Scene, [View; 2])> {
    let moving = |scene: &Scene, camera| {
        let camera = SceneCamera::choose(scene, Some(camera), SIZE, None).unwrap();
        [31_u64, 30].map(|i| camera.view(scene, i, i as f64 / 60.0))
    };
    let courtyard = builtin::courtyard();
    let mut scenes =
        vec![("noise", noise(), views(flat(SIZE))), ("courtyard", courtyard.clone(), moving(&courtyard, "walk"))];
    if let Some(sponza) = given::path_of("sponza/sponza.gltf") {
        let sponza = given::open(&sponza);
        let views = moving(&sponza, "walk");
        scenes.push(("sponza", sponza, views));
    }
    scenes
}

#[test]
fn samples_are_pixels_of_the_full_rate_frame() {
    let Some(device) = device() else { return };
    for (name, scene, views) in scenes() {
        let mut rig = Rig::new(&device, &scene, SIZE);
        let full = rig.full(views.each_ref());
        for (gaze, index) in GAZES.into_iter().zip([0, 5, 9]) {
            let lattices = FOVEATION().lattices(views[0].geometry(), gaze, index);
            // In place, foveal samples have the bits of the frame.
            let (placed, atlas) = foveated(&mut rig, &views, &lattices, AtlasLayout::InPlace);
            let fovea = &placed.as_slice()[0];
            assert_eq!(fovea.step, 1);
            let d = difference(&full, &atlas, fovea, 0);
            println!("{name}, in place: {d:?}");
            assert!(d.samples > 500 && d.bits == [0; 3]);
            // Planted: the neighbour's pixel.
            let planted = difference(&full, &atlas, fovea, 1);
            assert!(planted.bits.iter().any(|&n| 10 * n > planted.samples), "{planted:?}");

            // In the smallest atlas, rounding differs.
            let (placed, mut atlas) = foveated(&mut rig, &views, &lattices, AtlasLayout::Compact);
            let [fovea, coarse @ ..] = placed.as_slice() else { unreachable!() };
            let d = difference(&full, &atlas, fovea, 0);
            println!("{name}, compact: {d:?}");
            assert!(d.psnr_db > 60.0 && d.distance < 1e-5 && d.motion_px < 2e-3, "{d:?}");
            for lattice in coarse {
                let d = difference(&full, &atlas, lattice, 0);
                println!("{name}, step {}: {d:?}", lattice.step);
                assert!(lattice.step > 1 && d.smooth > 20 && d.is_small());
                // Planted: samples of the neighbouring pixel.
                let planted = difference(&full, &atlas, lattice, 1);
                assert!(!planted.is_small(), "{planted:?}");
            }
            // Planted: motion in pixels of the small view.
            let far = *coarse.last().unwrap();
            atlas.motion = atlas.motion.map(|m| m.map(|v| v / far.step as f32));
            let planted = difference(&full, &atlas, &far, 0);
            assert!(planted.motion_px > 100.0 * MOTION_PX, "{planted:?}");
        }
    }
}
