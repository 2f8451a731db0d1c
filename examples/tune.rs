use afterimage::Settings;
use afterimage::display::ViewGeometry;
use afterimage::foveation::{Filter, Foveation};
use afterimage::metric::{Scorer, encode};
use afterimage::pipeline::{Backend, LaneKind, Pipeline};
use afterimage::scanpath::{FrameGaze, GazeMap, read_csv};
use afterimage::settings::Method;
use afterimage::source::analytic::AnalyticSource;
use afterimage::source::{self, ReadLimits, SceneOptions};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let d = "/work/shared/data";
    for name in std::env::args().skip(1) {
        let (input, frames, mid, far, filter): (String, u64, u32, u32, Filter) = match name.as_str() {
            "lat24" => (format!("{d}/sequences/sponza_lateral"), 96, 2, 4, Filter::Mip),
            "lat48" => (format!("{d}/sequences/sponza_lateral"), 96, 4, 8, Filter::Mip),
            "latblk" => (format!("{d}/sequences/sponza_lateral"), 96, 2, 4, Filter::Block),
            "latgau" => (format!("{d}/sequences/sponza_lateral"), 96, 4, 8, Filter::Gauss),
            "obj24" => (format!("{d}/sequences/sponza_object"), 64, 2, 4, Filter::Mip),
            "obj" => (format!("{d}/sequences/sponza_object"), 64, 8, 16, Filter::Mip),
            "still" => (format!("{d}/sequences/sponza_still"), 100, 8, 16, Filter::Mip),
            "text" => (format!("{d}/text/page_3840x2160.png"), 60, 8, 16, Filter::Mip),
            n => (format!("analytic:{n}"), 90, 8, 16, Filter::Mip),
        };
        let mut source = source::open(&input, &ReadLimits::default(), &SceneOptions::default())?;
        let info = source.info().clone();
        let hfov = if name == "text" { 80.0 } else { info.hfov_deg.unwrap_or(70.0) };
        let geometry = ViewGeometry::flat(info.size, hfov)?;
        let path = if name == "text" { "reading_1250hz_clean" } else { "image_500hz" };
        let gaze = FrameGaze::new(
            &read_csv(format!("{d}/scanpaths/{path}.csv"))?,
            &geometry,
            GazeMap::Angle,
            if name == "text" { 0.0 } else { 1.0 },
            60.0,
        )?;
        let foveation = Foveation { filter, rate_mid: mid, rate_far: far, ..Foveation::default() };
        let methods = [("none", Method::None), ("taa", Method::Taa), ("wrs", Method::Wrs), ("smr", Method::Smr)];
        let want = std::env::var("M").unwrap_or("none,smr".into());
        let methods: Vec<_> = methods.into_iter().filter(|m| want.split(',').any(|w| w == m.0)).collect();
        let kinds: Vec<_> =
            methods.iter().map(|m| LaneKind::PostProcess(Settings { method: m.1, ..Settings::default() })).collect();
        let mut pipeline = Pipeline::new(geometry, foveation, &kinds, info.still, false, &Backend::Cpu)?;
        let mut scorers = vec![Scorer::default(); kinds.len()];
        let panel =
            input.strip_prefix("analytic:").map(|n| AnalyticSource::new(n, info.size, hfov, 60.0)).transpose()?;
        let mut panels = vec![(0.0_f64, 0.0_f64); kinds.len()];
        let mut worst = vec![(9e9, 0); kinds.len()];
        for index in 0..frames {
            let frame = source.frame(index)?;
            let step = pipeline.step(index, &frame, gaze.px(index))?;
            let reference = encode(&frame.color, 0.0);
            let mut first = 0.0;
            let mask = panel.as_ref().and_then(|p| p.panel_mask(index));
            for (i, (scorer, shown)) in scorers.iter_mut().zip(&step.shown).enumerate() {
                let e = encode(&shown.image, 0.0);
                let psnr = -10.0 * scorer.push(&reference, &e, &step.tracked, &step.ecc_deg).mse.log10();
                if i == 0 {
                    first = psnr;
                }
                if index > 1 && psnr - first < worst[i].0 {
                    worst[i] = (psnr - first, index);
                }
                if let Some(m) = &mask {
                    for ((a, b), &m) in e.pixels().iter().zip(reference.pixels()).zip(m.pixels()) {
                        if m {
                            panels[i].1 += 1.0;
                            panels[i].0 += (0..3).map(|c| f64::from(a[c] - b[c]).powi(2)).sum::<f64>() / 3.0;
                        }
                    }
                }
            }
        }
        for (i, m) in methods.iter().enumerate() {
            let s = scorers[i].scores();
            let db = |v: Option<f64>| v.unwrap_or(f64::NAN);
            println!(
                "{name:8} {:5} psnr {:6.3} ssim {:.4} ret {:6.2} mid {:6.2} flk {:6.2} worst {:6.3}@{} panel {:6.3}",
                m.0,
                db(s.whole.psnr_db),
                db(s.whole.ssim),
                db(s.retained_psnr_db),
                db(s.bands[1].psnr_db),
                db(s.flicker),
                worst[i].0,
                worst[i].1,
                -10.0 * (panels[i].0 / panels[i].1).log10()
            );
        }
    }
    Ok(())
}
