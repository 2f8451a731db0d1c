//! The convention detector on scenes with known conventions.

use afterimage::{Image, MotionConvention};
use afterimage_lab::source::motion_check::{Verdict, conventions, detect};
use afterimage_testing::holds;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

type Picture = Image<[f32; 3]>;

const SIZE: [u32; 2] = [96, 72];

/// Smooth noise: a sum of waves of random direction and phase, 5 to 40 pixels long.
struct Texture(Vec<[f32; 4]>);

impl Texture {
    fn random(rng: &mut Pcg64) -> Self {
        let wave = |rng: &mut Pcg64| {
            let angle = rng.random_range(0.0..std::f32::consts::TAU);
            let length: f32 = rng.random_range(5.0..40.0);
            let k = std::f32::consts::TAU / length;
            [k * angle.cos(), k * angle.sin(), rng.random_range(0.0..std::f32::consts::TAU), rng.random_range(0.3..1.0)]
        };
        Self((0..36).map(|_| wave(rng)).collect())
    }

    fn at(&self, x: f32, y: f32) -> [f32; 3] {
        std::array::from_fn(|channel| {
            let waves = &self.0[channel * 12..(channel + 1) * 12];
            let sum: f32 = waves.iter().map(|&[kx, ky, phase, a]| a * (kx * x + ky * y + phase).sin()).sum();
            (0.25 * sum).exp()
        })
    }
}

/// Previous frame, current frame, motion vectors in the library's convention: an affine motion with both components.
fn scene(rng: &mut Pcg64) -> (Picture, Picture, Image<[f32; 2]>) {
    let texture = Texture::random(rng);
    let mut part = || {
        let size: f32 = rng.random_range(0.8..6.0);
        if rng.random() { size } else { -size }
    };
    let shift = [part(), part()];
    let linear: [f32; 4] = std::array::from_fn(|_| rng.random_range(-0.01..0.01));
    let motion = Image::from_fn(SIZE, |[x, y]| {
        let (u, v) = (x as f32 - 48.0, y as f32 - 36.0);
        [shift[0] + linear[0] * u + linear[1] * v, shift[1] + linear[2] * u + linear[3] * v]
    });
    let previous = Image::from_fn(SIZE, |[x, y]| texture.at(x as f32, y as f32));
    let current = Image::from_fn(SIZE, |[x, y]| {
        let m = motion.at(x as usize, y as usize);
        texture.at(x as f32 + m[0], y as f32 + m[1])
    });
    (previous, current, motion)
}

fn as_written(motion: &Image<[f32; 2]>, convention: MotionConvention) -> Image<[f32; 2]> {
    let factor = convention.to_internal(motion.size());
    motion.map(|m| [m[0] / factor[0], m[1] / factor[1]])
}

#[test]
fn h56_the_right_convention_is_found_in_random_scenes() {
    let all: Vec<_> = conventions().collect();
    let (mut right, mut margin) = (0, f64::INFINITY);
    for seed in 0..200 {
        let mut rng = Pcg64::seed_from_u64(seed);
        let (previous, current, motion) = scene(&mut rng);
        let truth = all[seed as usize % all.len()];
        let check = detect(&previous, &current, &as_written(&motion, truth)).unwrap();
        if check.best == truth && check.verdict == Verdict::Decided {
            right += 1;
            margin = margin.min(check.margin_db);
        } else {
            println!("seed {seed}: {truth:?} taken for {:?}", check.best);
        }
    }
    assert!(right >= 198, "{right} of 200");
    let scenes = "random textured scenes right, each of 12 conventions";
    holds!("H56", Cpu, "{right} of 200 {scenes}; smallest margin {margin:.1} dB");
}

#[test]
fn a_scene_at_rest_decides_nothing() {
    let mut rng = Pcg64::seed_from_u64(1);
    let (previous, _, motion) = scene(&mut rng);
    for raw in [motion.map(|_| [0.0; 2]), motion.map(|_| [1e-7, -1e-7])] {
        let check = detect(&previous, &previous, &raw).unwrap();
        assert_eq!((check.verdict, check.margin_db, check.psnr_db.len()), (Verdict::Undecidable, 0.0, 12));
    }
}

#[test]
fn horizontal_motion_leaves_the_y_axis_open() {
    for (seed, truth) in conventions().enumerate() {
        let mut rng = Pcg64::seed_from_u64(seed as u64);
        let texture = Texture::random(&mut rng);
        let motion = Image::filled(SIZE, [2.5f32, 0.0]);
        let previous = Image::from_fn(SIZE, |[x, y]| texture.at(x as f32, y as f32));
        let current = Image::from_fn(SIZE, |[x, y]| texture.at(x as f32 + 2.5, y as f32));
        let check = detect(&previous, &current, &as_written(&motion, truth)).unwrap();
        assert_eq!(check.verdict, Verdict::YAxisOpen, "{truth:?}");
        assert_eq!((check.best.unit, check.best.direction), (truth.unit, truth.direction));
    }
}
