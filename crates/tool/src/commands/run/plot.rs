//! The plot of a run: PSNR by frame.

use super::plan::Plan;
use crate::clip::ClipReport;
use crate::output::{Output, WriteError};
use crate::report::frame_plot::{FramePlot, Quantity, Series};
use crate::report::plot::png;
use afterimage::internal::FoveationKind;
use afterimage_lab::quad_views::QuadViewLayout;
use std::path::Path;

/// Writes the plot. `simulator` names what foveates the frames.
pub fn write(plan: &Plan, simulator: &str, report: &ClipReport, out: &Output) -> Result<(), WriteError> {
    let foveation = plan.clip.foveation;
    let foveation = match foveation.kind {
        FoveationKind::Off => "full rate".into(),
        _ if let Some(QuadViewLayout::Uniform { step }) = plan.clip.quad_views => format!("uniform 1/{step}"),
        _ => format!("{simulator} {} and {}", foveation.rate_mid, foveation.rate_far),
    };
    let methods = plan.clip.methods.iter().zip(&report.frame_mse);
    let series: Vec<Series<'_>> = methods.map(|((name, _), mse)| Series { name, mark: name, values: mse }).collect();
    let moved = |pair: &[[f32; 2]]| plan.clip.geometry.eccentricity_deg(pair[1], pair[0]);
    let moves_deg: Vec<f32> = [0.0].into_iter().chain(report.gaze_px.windows(2).map(moved)).collect();
    let file = Path::new(&plan.input).file_name().and_then(|name| name.to_str());
    let plot = FramePlot {
        quantity: Quantity::Psnr,
        input: file.unwrap_or(&plan.input),
        what: &foveation,
        note: "the error of each shown frame alone, against the full-rate frame; at frame 0 the history is empty",
        fps: plan.fps,
        moves_deg: &moves_deg,
        series: &series,
    };
    let svg = plot.svg();
    out.text("psnr.svg", &svg)?;
    out.root_picture("psnr.png", &png(&svg))
}
