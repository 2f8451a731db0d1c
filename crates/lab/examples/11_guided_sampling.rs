//! Error of accumulated frames with samples guided to pixels that lack history, against unguided sampling at equal
//! sample counts.
//!
//!     cargo run --release -p afterimage-lab --example 11_guided_sampling

use afterimage::Image;
use afterimage::kernel::color::luma;
use afterimage_lab::device::Backend;
use afterimage_lab::scene::{Scene, SceneLimits};
use afterimage_lab::trace::Tracer;
use afterimage_lab::trace::film::{Film, Moments};
use afterimage_lab::trace::sampling::Sampling;
use afterimage_lab::trace::settings::TraceSettings;
use afterimage_lab::trace::surfaces::Surfaces;
use afterimage_lab::trace::view::View;
use afterimage_lab::trace::work::Spans;
use afterimage_lab::trace::world::World;
use glam::{DMat4, DVec3};

const SIZE: [u32; 2] = [64, 36];
const FRAMES: u64 = 16;
const SAMPLES: u32 = 4;
const REFERENCE_SAMPLES: u32 = 512;
/// Number of independent runs to average errors over.
const RUNS: u64 = 4;

struct Stage {
    world: World,
    tracer: Tracer,
    /// View of each frame.
    views: Vec<View>,
}

impl Stage {
    fn new(name: &str, step_m: f64) -> Result<Self, Box<dyn std::error::Error>> {
        let scene = Scene::open(name, &SceneLimits::default())?;
        let world = World::new(&scene);
        let tracer = Tracer::new(&Backend::Cpu, &world, TraceSettings::default())?;
        let first = View::of_camera(&scene.pose(0.0).cameras[0], SIZE, None)?;
        let aside = |i: u64| DMat4::from_translation(DVec3::X * (step_m * i as f64));
        let view = |i| View::new(*first.geometry(), first.world_from_camera() * aside(i));
        Ok(Self { world, tracer, views: (0..FRAMES).map(view).collect() })
    }

    /// Mean of all frames of a run; and the mask of disocclusions in the last frame.
    fn accumulate(&self, guided: bool, run: u64) -> Result<(Film, Image<bool>), Box<dyn std::error::Error>> {
        let mut film = Film::new(SIZE);
        let mut uncovered = Image::filled(SIZE, true);
        let mut depth: Option<Image<f32>> = None;
        for (i, view) in self.views.iter().enumerate() {
            let frame = run * FRAMES + i as u64;
            let previous = &self.views[i.saturating_sub(1)];
            let seen = Surfaces::trace(&self.world, view, previous, self.world.needs);
            if let Some(before) = &depth {
                film.moments = reprojected(&film.moments, before, &seen);
                uncovered = film.moments.map(|m| m.count == 0);
            }
            depth = Some(seen.depth);
            let mut plan = Sampling::Uniform.plan(view.geometry(), [0.0; 2], SAMPLES, frame);
            if guided {
                plan = plan.guided(&film.guide(), frame, 0)?;
            }
            for spans in &plan.work()[0] {
                self.tracer.trace(&self.world, view, frame, spans, &mut film);
            }
        }
        Ok((film, uncovered))
    }

    fn reference(&self) -> Film {
        let mut film = Film::new(SIZE);
        let spans = Spans::uniform(SIZE[0], 0..SIZE[1], 0..REFERENCE_SAMPLES);
        self.tracer.trace(&self.world, &self.views[FRAMES as usize - 1], 1 << 32, &spans, &mut film);
        film
    }
}

/// Values reprojected from the previous frame by the nearest pixel; the default at disocclusions. For a camera that
/// moves sideways, so that depth is constant.
fn reprojected(moments: &Image<Moments>, before: &Image<f32>, seen: &Surfaces) -> Image<Moments> {
    Image::from_fn(SIZE, |[x, y]| {
        let [dx, dy] = seen.motion.at(x as usize, y as usize);
        let (px, py) = ((x as f32 + dx).round(), (y as f32 + dy).round());
        if px < 0.0 || py < 0.0 || px >= SIZE[0] as f32 || py >= SIZE[1] as f32 {
            return Moments::default();
        }
        let (now, then) = (seen.depth.at(x as usize, y as usize), before.at(px as usize, py as usize));
        let is_same = now == then || (now / then - 1.0).abs() < 0.02;
        if is_same { moments.at(px as usize, py as usize) } else { Moments::default() }
    })
}

/// Mean squared error of tone-mapped luma, x / (1 + x), over the pixels in `of`, minus the variance of the reference.
fn error(film: &Film, reference: &Film, of: impl Fn(usize) -> bool) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for (_, (a, b)) in film.moments.pixels().iter().zip(reference.moments.pixels()).enumerate().filter(|p| of(p.0)) {
        let [a, mean] = [luma(a.mean), luma(b.mean)].map(f64::from);
        let noise = f64::from(luma(b.variance_of_mean().map(f32::sqrt))) / (1.0 + mean).powi(2);
        sum += (a / (1.0 + a) - mean / (1.0 + mean)).powi(2) - noise * noise;
        count += 1.0;
    }
    sum / count
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!(
        "{FRAMES} frames of {SAMPLES} samples a pixel added up, {RUNS} runs. Squared error x 1e6, plain and guided;"
    );
    println!("rays, guided over plain; error times rays, plain over guided");
    println!("{:<18} {:<9} {:>9} {:>9} {:>6} {:>15}", "scene", "camera", "plain", "guided", "rays", "error x rays");
    for (name, step_m) in [("builtin:cornell", 0.015), ("builtin:courtyard", 0.05)] {
        for (camera, step_m) in [("still", 0.0), ("glides", step_m)] {
            let stage = Stage::new(name, step_m)?;
            let reference = stage.reference();
            let runs = |guided| (0..RUNS).map(|run| stage.accumulate(guided, run)).collect::<Result<Vec<_>, _>>();
            let (plain, guided) = (runs(false)?, runs(true)?);
            let uncovered = &plain[0].1;
            let row = |what: &str, of: &dyn Fn(usize) -> bool| {
                let mean = |films: &[(Film, Image<bool>)]| {
                    let error = films.iter().map(|(film, _)| error(film, &reference, of)).sum::<f64>() / RUNS as f64;
                    (error, films.iter().map(|(film, _)| film.rays as f64).sum::<f64>())
                };
                let ((a, a_rays), (b, b_rays)) = (mean(&plain), mean(&guided));
                let (rays, gain) = (b_rays / a_rays, a * a_rays / (b * b_rays));
                println!("{name:<18} {what:<9} {:>9.1} {:>9.1} {rays:>6.2} {gain:>15.2}", a * 1e6, b * 1e6);
            };
            row(camera, &|_| true);
            if camera == "glides" {
                row("uncovered", &|i| uncovered.pixels()[i]);
            }
        }
    }
    Ok(())
}
