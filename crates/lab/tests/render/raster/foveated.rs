//! Foveated frames against the full-rate frame's pixels.

use super::rig::{FAST, Frame, device};
use afterimage::{Foveation, Lattice, Lattices};
use afterimage_lab::device::Headless;
use afterimage_lab::raster::{FoveatedTargets, Raster};
use afterimage_lab::scene::{Scene, SceneLimits};
use afterimage_lab::source::SceneCamera;
use afterimage_lab::trace::view::View;

const SIZE: [u32; 2] = [320, 180];

/// A full-rate frame, and the atlas of the same frame.
fn both(device: &Headless, scene: &Scene, views: [&View; 2], lattices: &Lattices) -> [Frame; 2] {
    let size = views[0].geometry().size_px();
    afterimage_testing::gpu::validated(&device.device, "a foveated frame", || {
        let mut raster = Raster::new(&device.device, &device.queue, scene, size, FAST).unwrap();
        let (lattices, atlas_size) = lattices.in_atlas();
        let targets = FoveatedTargets::new(&device.device, atlas_size);
        let mut encoder = device.device.create_command_encoder(&Default::default());
        raster.record_foveated(&device.device, &mut encoder, views, &lattices, &targets);
        raster.record(&device.device, &mut encoder, views[0], views[1]);
        device.queue.submit([encoder.finish()]);
        [raster.targets(), &targets.atlas].map(|targets| Frame {
            color: targets.read_color(device),
            distance: targets.read_distance(device, raster.near()),
            motion: targets.read_motion(device),
        })
    })
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

#[test]
fn measure() {
    let Some(device) = device() else { return };
    for name in ["builtin:courtyard", "builtin:cubes", "sponza"] {
        let path = match name {
            "sponza" => super::real::folder().unwrap().join("sponza/sponza.gltf").to_str().unwrap().to_string(),
            n => n.to_string(),
        };
        let scene = Scene::open(&path, &SceneLimits::default()).unwrap();
        let camera = SceneCamera::choose(&scene, Some("lateral"), SIZE, None).unwrap();
        let [now, before] = [5, 4].map(|i| camera.view(&scene, i, 0.0));
        let foveation = Foveation { rate_mid: 4, rate_far: 8, ..Foveation::default() };
        for (gaze, index) in [([160.0, 90.0], 0), ([20.0, 170.0], 5), ([300.0, 60.0], 9)] {
            let lattices = foveation.lattices(now.geometry(), gaze, index);
            let [full, atlas] = both(&device, &scene, [&now, &before], &lattices);
            for lattice in lattices.in_atlas().0.as_slice() {
                let (mut bits, mut n, mut se, mut off, mut motion, mut dist) = ([0; 3], 0, 0.0, 0, 0.0f32, 0.0f32);
                for (px, texel) in samples(lattice, SIZE) {
                    n += 1;
                    let (a, b) = (full.color.at(px[0], px[1]), atlas.color.at(texel[0], texel[1]));
                    bits[0] += usize::from(a != b);
                    let e = (0..3).map(|k| f64::from((a[k].min(1.0) - b[k].min(1.0)).powi(2))).sum::<f64>() / 3.0;
                    se += e;
                    off += usize::from(e > 1e-4);
                    let (a, b) = (full.distance.at(px[0], px[1]), atlas.distance.at(texel[0], texel[1]));
                    bits[1] += usize::from(a != b);
                    if a.is_finite() && b.is_finite() {
                        dist = dist.max((a / b - 1.0).abs());
                    }
                    let (a, b) = (full.motion.at(px[0], px[1]), atlas.motion.at(texel[0], texel[1]));
                    bits[2] += usize::from(a != b);
                    motion = motion.max((a[0] - b[0]).abs()).max((a[1] - b[1]).abs());
                }
                println!(
                    "{name} step {} n {n} bits {bits:?} psnr {:.1} off {off} motion {motion} dist {dist}",
                    lattice.step,
                    -10.0 * (se / n as f64).log10()
                );
            }
        }
    }
}
