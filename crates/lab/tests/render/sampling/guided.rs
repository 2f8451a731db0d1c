//! Guided sampling: it meets its budget and uses it well, means stay unbiased, invalid guides are harmless.

use afterimage::{Image, ViewGeometry};
use afterimage_lab::device::{Backend, Headless};
use afterimage_lab::frame::Guide;
use afterimage_lab::scene::{Scene, builtin};
use afterimage_lab::trace::Tracer;
use afterimage_lab::trace::film::Film;
use afterimage_lab::trace::sampling::{Acuity, Layers, Plan, Regions, Sampling};
use afterimage_lab::trace::settings::TraceSettings;
use afterimage_lab::trace::view::View;
use afterimage_lab::trace::work::Spans;
use afterimage_lab::trace::world::World;
use afterimage_testing::{Draws, accept, p_of_z, reject};
use std::collections::BTreeMap;

const SIZE: [u32; 2] = [160, 90];

fn patterns() -> [Sampling; 4] {
    [
        Sampling::Uniform,
        Sampling::Regions(Regions::default()),
        Sampling::Layers(Layers::default()),
        Sampling::Acuity(Acuity::default()),
    ]
}

fn plan(sampling: &Sampling, samples: u32) -> Plan {
    sampling.plan(&ViewGeometry::flat(SIZE, 90.0).unwrap(), [70.0, 40.0], samples, 0)
}

fn guide(known: f32, deviation: f32) -> Guide {
    Guide { known: Image::filled(SIZE, known), deviation: Image::filled(SIZE, deviation) }
}

/// A random guide with realistic values: counts from 0 to 60, deviations over three powers of ten.
fn some_guide(name: &str) -> Guide {
    let mut draws = Draws::new(name);
    let known = Image::from_fn(SIZE, |_| draws.range(0.0, 60.0).floor());
    Guide { known, deviation: Image::from_fn(SIZE, |_| 10.0_f32.powf(draws.range(-3.0, 0.0))) }
}

/// Number of samples of each point of a ring.
fn counts(work: &[Spans]) -> BTreeMap<[u32; 2], u32> {
    let mut counts = BTreeMap::new();
    for spans in work {
        for span in spans.spans() {
            for pixel in span.pixel..span.pixel + span.count {
                *counts.entry([pixel & 0xffff, pixel >> 16]).or_default() += spans.samples().len() as u32;
            }
        }
    }
    counts
}

#[test]
fn every_ring_spends_its_budget_on_average_and_every_point_has_a_sample() {
    const FRAMES: u64 = 40;
    for (name, sampling) in ["uniform", "regions", "layers", "acuity"].iter().zip(patterns()) {
        let plan = plan(&sampling, 4);
        let (budgets, guide) = (plan.samples(), some_guide(name));
        let mut sums = vec![0.0; budgets.len()];
        let mut points = vec![0; budgets.len()];
        for frame in 0..FRAMES {
            let guided = plan.guided(&guide, frame, 3).unwrap();
            for (i, (ring, plain)) in guided.work().iter().zip(plan.work().iter()).enumerate() {
                let (counts, targets) = (counts(ring), counts(plain));
                assert!(counts.keys().eq(targets.keys()), "{name}, ring {i}: the same points");
                let most = 8 * targets.values().max().unwrap();
                assert!(counts.values().all(|n| (1..=most).contains(n)), "{name}, ring {i}");
                sums[i] += guided.samples()[i] as f64;
                points[i] = counts.len();
            }
        }
        for (i, (sum, &budget)) in sums.iter().zip(&budgets).enumerate() {
            // A stochastically rounded number has a variance of at most 1/4.
            let sd = (FRAMES as f64 * points[i] as f64 / 4.0).sqrt();
            let what = format!("{name}, ring {i}: {:.1} samples a frame of {budget}", sum / FRAMES as f64);
            accept(&what, p_of_z((sum - FRAMES as f64 * budget as f64) / sd));
        }
    }
}

#[test]
fn what_is_known_well_enough_gets_the_least() {
    for sampling in patterns() {
        let plan = plan(&sampling, 4);
        for guide in [guide(f32::INFINITY, 1.0), guide(0.0, 0.0)] {
            let guided = plan.guided(&guide, 0, 0).unwrap();
            assert!(guided.work().iter().flat_map(|ring| counts(ring).into_values()).all(|n| n == 1), "{sampling:?}");
        }
    }
}

#[test]
fn what_was_hidden_gets_what_others_can_spare() {
    // A tenth of the frame has no history. Elsewhere 1 of 4 samples remains; the others amount to 31 per pixel there.
    let mut guide = guide(64.0, 0.3);
    let hidden = |x: u32| (32..48).contains(&x);
    guide.known = Image::from_fn(SIZE, |[x, _]| if hidden(x) { 0.0 } else { 64.0 });
    let guided = plan(&Sampling::Uniform, 4).guided(&guide, 5, 0).unwrap();
    for ([x, y], n) in counts(&guided.work()[0]) {
        let expected = if hidden(x) { 30..=32 } else { 1..=1 };
        assert!(expected.contains(&n), "{n} samples at {x}, {y}");
    }
    // Blocks and lattices, in the fovea and in the periphery.
    for sampling in &patterns()[1..] {
        let plan = plan(sampling, 8);
        let guided = plan.guided(&guide, 5, 0).unwrap();
        for (ring, work) in guided.work().iter().enumerate().filter(|(_, work)| !work.is_empty()) {
            let step = match sampling {
                Sampling::Regions(r) => [1, r.blocks[0], r.blocks[1]][ring],
                Sampling::Layers(l) => l.steps[ring],
                _ => 1,
            };
            let counts = counts(work);
            // Points whose neighbourhood lies on one side.
            let of = |inside: bool| {
                let is_clear = move |x: u32| hidden(x + step) == inside && hidden(x.saturating_sub(step)) == inside;
                counts.iter().filter(move |([x, _], _)| is_clear(x * step)).map(|(_, n)| *n)
            };
            if let (Some(least), Some(most)) = (of(true).min(), of(false).max()) {
                assert!(least > most, "{sampling:?}, ring {ring}: {least} where hidden, {most} elsewhere");
            }
        }
    }
}

#[test]
fn deviations_decide_where_nothing_is_known() {
    // Neyman allocation: proportional to the deviations.
    let mut guide = guide(0.0, 0.1);
    guide.deviation = Image::from_fn(SIZE, |[x, _]| if x < 80 { 0.1 } else { 0.3 });
    let guided = plan(&Sampling::Uniform, 20).guided(&guide, 0, 0).unwrap();
    for ([x, _], n) in counts(&guided.work()[0]) {
        assert_eq!(n, if x < 80 { 10 } else { 30 });
    }
}

#[test]
fn a_number_that_makes_no_sense_says_that_nothing_is_known() {
    let same = |a: &Guide, b: &Guide| {
        for sampling in patterns() {
            let plan = plan(&sampling, 4);
            let [a, b] = [a, b].map(|guide| plan.guided(guide, 1, 2).unwrap().work().into_owned());
            assert_eq!(a, b, "{sampling:?}");
        }
    };
    let odd = |[x, y]: [u32; 2]| (x / 8 + y / 8) % 2 == 1;
    for nonsense in [f32::NAN, -1.0, f32::NEG_INFINITY] {
        let with = |value| Guide {
            known: Image::from_fn(SIZE, |at| if odd(at) { value } else { 9.0 }),
            deviation: Image::filled(SIZE, 0.5),
        };
        same(&with(nonsense), &with(0.0));
    }
    for nonsense in [f32::NAN, -1.0, f32::NEG_INFINITY, f32::INFINITY] {
        let with = |value| Guide {
            known: some_guide("known").known,
            deviation: Image::from_fn(SIZE, |at| if odd(at) { value } else { 0.5 }),
        };
        same(&with(nonsense), &with(0.5));
        same(&guide(3.0, nonsense), &guide(3.0, 1.0));
    }
    // Arbitrary bit patterns.
    let mut draws = Draws::new("any bits");
    for _ in 0..4 {
        let mut any = || Image::from_fn(SIZE, |_| f32::from_bits(draws.bits()));
        let guide = Guide { known: any(), deviation: any() };
        for sampling in patterns() {
            let plan = plan(&sampling, 4);
            let guided = plan.guided(&guide, 0, 0).unwrap();
            for ((ring, plain), spent) in guided.work().iter().zip(plan.work().iter()).zip(guided.samples()) {
                let (counts, targets) = (counts(ring), counts(plain));
                assert!(counts.keys().eq(targets.keys()) && counts.values().all(|n| *n >= 1));
                let budget = plain.iter().map(Spans::len).sum::<u64>() as f64;
                assert!(spent as f64 <= budget + 5.0 * (targets.len() as f64).sqrt(), "{spent} of {budget}");
            }
        }
    }
}

#[test]
fn a_guide_of_another_size_is_refused_and_no_budget_is_no_work() {
    let plan = plan(&Sampling::Uniform, 0);
    let guided = plan.guided(&some_guide("none"), 0, 0).unwrap();
    assert_eq!((guided.samples(), guided.work()[0].len()), (vec![0], 0));
    let mut wrong = guide(0.0, 1.0);
    wrong.deviation = Image::filled([90, 160], 1.0);
    let error = plan.guided(&wrong, 0, 0).unwrap_err().to_string();
    assert!(error.contains("guide.deviation") && error.contains("90 x 160"), "{error}");
}

/// The Cornell box at a small size.
struct Box {
    world: World,
    tracer: Tracer,
    view: View,
}

impl Box {
    const SIZE: [u32; 2] = [16, 16];

    fn new() -> Self {
        let scene = Scene::open("builtin:cornell", &Default::default()).unwrap();
        let world = World::new(&scene);
        let settings = TraceSettings { max_depth: 1, ..TraceSettings::default() };
        let tracer = Tracer::new(&Backend::Cpu, &world, settings).unwrap();
        let view = View::of_camera(&scene.pose(0.0).cameras[0], Self::SIZE, None).unwrap();
        Self { world, tracer, view }
    }

    fn film(&self, frame: u64, samples: std::ops::Range<u32>) -> Film {
        let mut film = Film::new(Self::SIZE);
        self.tracer.trace(&self.world, &self.view, frame, &Spans::uniform(16, 0..16, samples), &mut film);
        film
    }

    /// Sum and sum of squares of the means of 4x4 regions over independent frames.
    fn sums(&self, frames: std::ops::Range<u64>, guide_of: impl Fn(u64) -> Option<Guide>) -> [[f64; 2]; 16] {
        let plan = Sampling::Uniform.plan(self.view.geometry(), [0.0; 2], 4, 0);
        let mut sums = [[0.0; 2]; 16];
        for frame in frames {
            let guided = guide_of(frame).map(|guide| plan.guided(&guide, frame, 0).unwrap());
            let done = guided.as_ref().unwrap_or(&plan).trace(&self.tracer, &self.world, &self.view, frame);
            let mut means = [0.0; 16];
            for (i, c) in done.color.pixels().iter().enumerate() {
                means[i / 64 * 4 + i % 16 / 4] += f64::from(c[0] + c[1] + c[2]) / 16.0;
            }
            for (sum, mean) in sums.iter_mut().zip(means) {
                *sum = [sum[0] + mean, sum[1] + mean * mean];
            }
        }
        sums
    }
}

const FRAMES: u64 = 500;

/// Smallest p-value for equal means over 16 regions, corrected for 16 tests.
fn p_of_regions(a: [[f64; 2]; 16], b: [[f64; 2]; 16]) -> f64 {
    let n = FRAMES as f64;
    let of = |[sum, squares]: [f64; 2]| (sum / n, (squares / n - (sum / n).powi(2)) / (n - 1.0));
    let p = |(a, b)| {
        let ((a, var_a), (b, var_b)) = (of(a), of(b));
        p_of_z((a - b) / (var_a + var_b).sqrt())
    };
    (16.0 * a.into_iter().zip(b).map(p).fold(1.0, f64::min)).min(1.0)
}

#[test]
fn means_are_those_without_a_guide() {
    let cornell = Box::new();
    let plain = cornell.sums(FRAMES..2 * FRAMES, |_| None);
    // Past frames have other frame numbers.
    let past = cornell.film(1 << 40, 0..4).guide();
    let guided = cornell.sums(0..FRAMES, |_| Some(past.clone()));
    accept("guided by a frame gone by", p_of_regions(guided, plain));
    let guided = cornell.sums(0..FRAMES, |f| Some(cornell.film((2 << 40) + f, 0..4).guide()));
    accept("guided by another frame each", p_of_regions(guided, plain));
    // A guide from the frame's own first sample: pixels that happen to be bright get more samples to average, dark ones
    // stay as they are.
    let own = |frame| {
        let bright = cornell.film(frame, 1..2).moments.map(|m| m.mean.y);
        Some(Guide { known: Image::filled(Box::SIZE, 0.0), deviation: bright })
    };
    reject("guided by the frame's own samples", p_of_regions(cornell.sums(0..FRAMES, own), plain));
}

#[test]
fn a_plan_is_the_same_whatever_the_number_of_threads() {
    let (plan, guide) = (plan(&Sampling::Regions(Regions::default()), 4), some_guide("threads"));
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| plan.guided(&guide, 7, 7).unwrap().work().into_owned())
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn the_device_traces_the_same_guided_frames() {
    // Prints that there is no adapter, and fails where one is required.
    if afterimage_testing::gpu::device().is_none() {
        return;
    }
    let device = Headless::find_roomy(true).expect("there is an adapter");
    let scene = builtin::courtyard_of(2000);
    let world = World::new(&scene);
    let [cpu, gpu] = [Backend::Cpu, Backend::Gpu(device)]
        .map(|backend| Tracer::new(&backend, &world, TraceSettings::default()).unwrap());
    let view = View::of_camera(&scene.pose(0.0).cameras[0], SIZE, None).unwrap();
    for sampling in [Sampling::Uniform, Sampling::Regions(Regions::default())] {
        let plan = sampling.plan(view.geometry(), [60.0, 50.0], 2, 5).guided(&some_guide("device"), 5, 0).unwrap();
        let [a, b] = [&cpu, &gpu].map(|tracer| plan.trace(tracer, &world, &view, 5));
        assert_eq!((a.samples, a.rays), (b.samples, b.rays), "{sampling:?}");
        assert!(a.color == b.color, "{sampling:?}");
    }
}
