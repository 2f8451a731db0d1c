//! Films: sums, samples that are not finite, and results independent of how the work is split.

use super::rig::{Rig, backends, differing};
use super::scenes::{DARK, staged, under_a_map};
use crate::given::{builtin, device};
use afterimage_lab::scene::Environment;
use afterimage_testing::Draws;
use afterimage_trace::Tracer;
use afterimage_trace::cpu::CpuTracer;
use afterimage_trace::film::{Film, Moments};
use afterimage_trace::gpu::scene_buffer::Storage;
use afterimage_trace::settings::TraceSettings;
use afterimage_trace::work::Spans;
use glam::Vec3;

#[test]
fn the_number_of_threads_changes_no_bit() {
    for scene in [builtin("cornell"), under_a_map()] {
        let rig = Rig::new(scene, [40, 30]);
        let [one, three] = [1, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| rig.cpu(TraceSettings::default(), 4))
        });
        assert_eq!(differing(&one, &three), 0);
        assert_eq!((one.rays, one.nonfinite), (three.rays, three.nonfinite));
    }
}

#[test]
fn how_the_work_is_split_changes_no_bit() {
    let rig = Rig::new(builtin("cornell"), [40, 30]);
    let whole = rig.cpu(TraceSettings::default(), 8);
    for backend in backends() {
        let tracer = Tracer::new(&backend, &rig.world, TraceSettings::default()).unwrap();
        // Split by rows, and split by samples.
        let rows = [0..7, 7..8, 8..30].map(|rows| Spans::uniform(40, rows, 0..8));
        let samples = [0..3, 3..4, 4..8].map(|samples| Spans::uniform(40, 0..30, samples));
        for parts in [rows, samples] {
            let mut film = Film::new(rig.size());
            for work in &parts {
                tracer.trace(&rig.world, &rig.view, 0, work, &mut film);
            }
            assert_eq!(differing(&film, &whole), 0);
            assert_eq!(film.rays, whole.rays);
        }
        // Empty work changes nothing.
        let mut film = whole.clone();
        tracer.trace(&rig.world, &rig.view, 0, &Spans::default(), &mut film);
        assert_eq!(differing(&film, &whole), 0);
    }
}

#[test]
fn a_pixel_with_more_samples_than_a_batch_goes_on_in_the_next() {
    let Some(device) = device() else { return };
    let rig = Rig::new(builtin("cornell"), [2, 1]);
    let spp = afterimage_trace::gpu::BATCH + 100;
    let settings = TraceSettings { max_depth: 1, ..TraceSettings::default() };
    assert_eq!(differing(&rig.cpu(settings, spp), &rig.gpu(&device, settings, Storage::Texture, spp)), 0);
}

#[test]
fn other_frames_and_seeds_have_other_noise() {
    let rig = Rig::new(builtin("cornell"), [40, 30]);
    let film = rig.cpu(TraceSettings::default(), 2);
    let other = rig.cpu(TraceSettings { seed: 1, ..TraceSettings::default() }, 2);
    assert!(differing(&film, &other) > 500);
    let mut next = Film::new(rig.size());
    CpuTracer::new(TraceSettings::default()).trace(&rig.world, &rig.view, 1, &rig.spans(2), &mut next);
    assert!(differing(&film, &next) > 500);
}

#[test]
fn only_the_pixels_of_the_work_are_touched() {
    let rig = Rig::new(builtin("furnace"), [16, 8]);
    let mut film = Film::new(rig.size());
    for (pixel, samples) in [([3, 2], 0..1), ([3, 2], 7..8), ([15, 7], 1..2)] {
        let work = Spans::new([pixel], samples);
        CpuTracer::new(TraceSettings::default()).trace(&rig.world, &rig.view, 0, &work, &mut film);
    }
    let counts: Vec<_> = film.moments.pixels().iter().enumerate().filter(|(_, m)| m.count > 0).collect();
    assert_eq!(counts.iter().map(|(i, m)| (*i, m.count)).collect::<Vec<_>>(), [(2 * 16 + 3, 2), (7 * 16 + 15, 1)]);
    assert!(film.variance().at(15, 7)[0].is_infinite() && film.color().at(0, 0) == [0.0; 3]);
}

#[test]
fn moments_are_those_of_f64() {
    let mut d = Draws::new("moments");
    for (offset, spread, count) in [(0.0, 1.0, 1000), (1000.0, 1.0, 1000), (1e-3, 1e-4, 100_000), (5.0, 0.0, 50)] {
        let samples: Vec<Vec3> = (0..count)
            .map(|_| Vec3::from_array(std::array::from_fn(|_| offset + spread * d.uniform() * d.uniform())))
            .collect();
        let mut m = Moments::default();
        samples.iter().for_each(|&s| m.add(s));
        let n = f64::from(count);
        for k in 0..3 {
            let mean = samples.iter().map(|s| f64::from(s[k])).sum::<f64>() / n;
            let squares = samples.iter().map(|s| (f64::from(s[k]) - mean).powi(2)).sum::<f64>();
            let exact = squares / (n * (n - 1.0));
            let got = f64::from(m.variance_of_mean()[k]);
            // Each step rounds mean and sum by half an ulp. The errors of n steps add up like a random walk: sqrt(n)
            // 6e-8, with a margin.
            let rounding = 2e-7 * n.sqrt();
            assert!((f64::from(m.mean[k]) - mean).abs() <= rounding * mean, "{} {mean}", m.mean[k]);
            // The mean's ulp adds to the error of each deviation.
            let ulp = 1.2e-7 * mean / (squares / n).sqrt().max(1e-30);
            assert!((got - exact).abs() <= (rounding + 4.0 * ulp) * exact + 1e-30, "{got} {exact}");
        }
    }
    assert_eq!(Moments::default().variance_of_mean(), Vec3::INFINITY);
}

#[test]
fn samples_that_are_no_numbers_are_counted_and_black_h37() {
    let settings = TraceSettings { max_depth: 0, ..TraceSettings::default() };
    let spp = 8;
    let wall_of = |emissive| Rig::new(staged("a wall", DARK, |all| all[1].emissive = emissive), [32, 24]);
    let sound = wall_of([1.0; 3]).cpu(settings, spp);
    let hits: f64 = sound.moments.pixels().iter().map(|m| f64::from(m.mean.x) * f64::from(spp)).sum();
    for bad in [f32::INFINITY, f32::NAN] {
        let rig = wall_of([bad, 1.0, 1.0]);
        let mut films = vec![rig.cpu(settings, spp)];
        films.extend(device().map(|d| rig.gpu(&d, settings, Storage::Texture, spp)));
        for film in films {
            assert_eq!(film.nonfinite, hits.round() as u64, "{bad}");
            // The whole sample turns black: zeroing only some channels would tint it.
            assert!(film.moments.pixels().iter().all(|m| (m.mean, m.count) == (Vec3::ZERO, spp)));
        }
    }
    assert!(hits > 100.0);
}

#[test]
fn a_surface_that_is_no_number_stays_in_its_pixels_h17() {
    let film = |red: f32| {
        let sky = Environment::Constant([1.0; 3]);
        let scene = staged("a ball", sky, |materials| materials[3].base_color = [red, 0.5, 0.5]);
        Rig::new(scene, [32, 24]).cpu(TraceSettings { max_depth: 1, ..TraceSettings::default() }, 8)
    };
    let (film, reference) = (film(f32::NAN), film(0.7));
    assert!(film.moments.pixels().iter().all(|m| m.mean.is_finite() && m.squares.is_finite()));
    // Pixels that do not see the ball are the same as with a valid ball: at depth 1 nothing is reflected twice.
    let mut same = 0;
    for (i, (a, b)) in film.moments.pixels().iter().zip(reference.moments.pixels()).enumerate() {
        let (x, y) = ((i % 32) as f32 - 15.5, (i / 32) as f32 - 11.5);
        // The ball is right of the image centre.
        let far = x < 0.0 || y < -9.0;
        assert!(!far || a == b, "pixel {i}");
        same += usize::from(a == b);
    }
    assert!(same < 32 * 24 && same > 32 * 24 / 2, "{same}");
}
