//! Negative controls of the wrs sequence tests: each error planted in the pass or in its inputs must make the executors
//! differ.

use super::rig::{Rig, View, noise, with_w_sum};
use super::sequences::{SIZE, view};
use super::surfaces_controls::differs;
use afterimage::kernel::rng;
use afterimage::kernel::rng::Purpose;
use afterimage::shader::SHADERS;
use afterimage::{Bias, ContextDesc, Foveation, Image, Method, Reset, Sampler, Settings, Wrs};
use afterimage_lab::source::AnalyticSource;
use afterimage_testing::planted::all_caught_once;

fn pass() -> String {
    SHADERS.compose("wrs_pass").source
}

#[test]
fn every_planted_error_in_the_pass_is_caught() {
    let planted = [
        // Candidate and history swapped.
        ("candidate.color, candidate_w, history.past.color", "history.past.color, candidate_w, candidate.color"),
        ("step(candidate.color, candidate_w, past, params,", "step(history.past.color, candidate_w, past, params,"),
        // Motion with the opposite sign.
        ("f32(x) + motion.x", "f32(x) - motion.x"),
        ("f32(y) + motion.y", "f32(y) - motion.y"),
        // Candidate weight 1 % too large.
        ("frame.inv_density_at_fovea);", "1.01 * frame.inv_density_at_fovea);"),
        // History weights not stored.
        ("next_weights, px, view, vec4<u32>(words.z,", "next_weights, px, view, vec4<u32>(0u,"),
        // Random numbers of another frame, and equal ones in each row.
        ("bits(px.x, px.y, frame.frame_low, constants.key)", "bits(px.x, px.y, frame.frame_low + 1u, constants.key)"),
        ("bits(px.x, px.y, frame.frame_low, constants.key)", "bits(0u, px.y, frame.frame_low, constants.key)"),
        // Inputs ignored: trust, exposure, depth.
        ("past = scale_by_trust(past, trust_at(px, view), SAMPLER);", ""),
        ("past.color = expose(past.color, frame.exposure);", ""),
        ("if !is_same_surface(", "if false && !is_same_surface("),
        // Wrong counters.
        ("count_if(valid && decision.take, COUNT_REPLACED);", "count_if(decision.take, COUNT_REPLACED);"),
        ("count_if(!usable, COUNT_NONFINITE);", ""),
    ];
    all_caught_once(pass(), &planted, |source| differs(Settings::paper(), source, false));
    let keys = Method::Wrs(Wrs { sampler: Sampler::AEs, ..Wrs::default() });
    let not_stored = (
        "textureStore(next_extras, px, view, vec4<u32>(bitcast<u32>(decision.log_key),",
        "textureStore(next_extras, px, view, vec4<u32>(0u,",
    );
    all_caught_once(pass(), &[not_stored], |source| {
        differs(Settings { method: keys, ..Settings::paper() }, source, false)
    });
}

/// Tests draws that equal their threshold exactly, which happens once in 2^24 draws: searches for a frame and a pixel
/// with such a draw.
#[test]
fn a_lax_comparison_is_caught() {
    let size = [128, 64];
    let method = Method::Wrs(Wrs { gate: None, bias: Bias::None, ..Wrs::default() });
    let foveation = Foveation { fovea_deg: 180.0, mid_deg: 180.0, ..Foveation::default() };
    let settings = Settings { method, foveation, ..Settings::paper() };
    // With w_sum = 2^k - 1 a candidate of weight 1 is accepted for draws below 2^-k, and rejected for a draw of 2^-k.
    let power = |index: u64, x: u32, y: u32| {
        let key = rng::stream_key(settings.seed, 0, Purpose::Select, index);
        let draw = rng::unit_draw(rng::bits(x, y, index as u32, key));
        (1..=16).find(|&k| draw == 0.5_f32.powi(k))
    };
    let pixels = || (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    let (index, at, k) = (1..100_000_u64)
        .find_map(|index| {
            pixels().find_map(|(x, y)| power(index, x, y).map(|k| (index, (y * size[0] + x) as usize, k)))
        })
        .unwrap();
    println!("frame {index}, pixel {at}: a draw of 2^-{k}");
    let planted = [("draw * w_sum < candidate_w", "draw * w_sum <= candidate_w")];
    all_caught_once(pass(), &planted, |source| {
        let mut rig = Rig::with_shader(ContextDesc::new(size), settings, source)?;
        let words = {
            let first = [View::still(noise(size, "lax"), [0.0; 2])];
            rig.on_cpu(0, Reset::None, &first);
            rig.on_gpu(0, Reset::None, &first).words
        };
        rig.restore(&with_w_sum(&words, 2.0_f32.powi(k) - 1.0));
        let views = [View::still(noise(size, "lax, next"), [0.0; 2])];
        let (gpu, (cpu, trace)) = (rig.on_gpu(index, Reset::None, &views), rig.on_cpu(index, Reset::None, &views));
        assert!(!trace[0].pixels()[at].is_replaced, "strict");
        Some(gpu != cpu)
    });
}

#[test]
fn swapped_and_shifted_inputs_are_caught() {
    let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), Settings::paper()) else { return };
    let mut scene = AnalyticSource::new("lateral", SIZE, 70.0, 60.0).unwrap();
    let [first, second] = [0, 1].map(|index| [view(&mut scene, index)]);
    let mut flipped = second.clone();
    flipped[0].motion = second[0].motion.as_ref().map(|m| m.map(|v| v.map(|x| -x)));
    let mut mirrored = second.clone();
    let color = &second[0].color;
    mirrored[0].color = Image::from_fn(SIZE, |[x, y]| color.at((SIZE[0] - 1 - x) as usize, y as usize));
    rig.both(0, Reset::None, &first);
    for (what, wrong) in [("the previous frame", &first), ("flipped motion", &flipped), ("a mirrored image", &mirrored)]
    {
        // A new rig for each error, so that errors do not accumulate.
        let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), Settings::paper()) else { return };
        rig.both(0, Reset::None, &first);
        assert!(rig.on_gpu(1, Reset::None, wrong) != rig.on_cpu(1, Reset::None, &second).0, "{what}");
    }
}
