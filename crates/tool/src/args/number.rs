//! Parsers of numbers with ranges.

use crate::failure::warn;
use afterimage_eval::exposure::{Chosen, Exposure};
use std::str::FromStr;

/// `WxH` in pixels.
pub fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let expected = "expected WxH in pixels, such as 1280x720";
    let (w, h) = text.split_once('x').ok_or(expected)?;
    match (w.parse(), h.parse()) {
        (Ok(w), Ok(h)) if w > 0 && h > 0 => Ok([w, h]),
        _ => Err(expected.into()),
    }
}

/// `X,Y`, a pixel.
pub fn parse_pixel(text: &str) -> Result<[u32; 2], String> {
    let pixel = text.split_once(',').and_then(|(x, y)| Some([x.parse().ok()?, y.parse().ok()?]));
    pixel.ok_or_else(|| "expected X,Y, whole pixels from 0 on, such as 320,180".into())
}

/// `A..B`, frames from A to B.
pub fn parse_frame_range(text: &str) -> Result<[usize; 2], String> {
    let range = text.split_once("..").and_then(|(a, b)| Some([a.parse().ok()?, b.parse().ok()?]));
    range.filter(|[a, b]| a <= b).ok_or_else(|| "expected A..B, frames from A to B, such as 10..12".into())
}

/// `WxH` in millimetres.
pub fn parse_size_mm(text: &str) -> Result<[f32; 2], String> {
    let expected = "expected WxH in millimeters, such as 531x299";
    let (w, h) = text.split_once('x').ok_or(expected)?;
    let side = |text: &str| text.parse().ok().filter(|v: &f32| v.is_finite() && *v > 0.0);
    side(w).zip(side(h)).map(|(w, h)| [w, h]).ok_or_else(|| expected.into())
}

/// A distance in millimetres.
pub fn parse_distance_mm(text: &str) -> Result<f32, String> {
    within(text, "above 0 and at most 1000000 millimeters", |v| *v > 0.0 && *v <= 1e6)
}

/// Samples per pixel.
pub fn parse_samples(text: &str) -> Result<u32, String> {
    within(text, "1 to 1048576 samples", |v| (1..=1 << 20).contains(v))
}

/// Number of frames: at most two days at 60 frames a second.
pub fn parse_frames(text: &str) -> Result<u64, String> {
    within(text, "1 to 10000000 frames", |v| (1..=10_000_000).contains(v))
}

/// Frames per second.
pub fn parse_fps(text: &str) -> Result<f32, String> {
    within(text, "above 0 and at most 100000 frames per second", |v| *v > 0.0 && *v <= 100_000.0)
}

/// Horizontal field of view in degrees.
pub fn parse_hfov(text: &str) -> Result<f32, String> {
    within(text, "above 0 and below 180 degrees", |v| *v > 0.0 && *v < 180.0)
}

/// Side of a pixel in pixels of the full-rate frame.
pub fn parse_scale(text: &str) -> Result<f32, String> {
    within(text, "1 to 256 pixels", |v| (1.0..=256.0).contains(v))
}

/// Share of a frame's pixels.
pub fn parse_percent(text: &str) -> Result<f32, String> {
    within(text, "0 to 100 percent", |v| (0.0..=100.0).contains(v))
}

/// Latency in milliseconds.
pub fn parse_latency(text: &str) -> Result<f64, String> {
    within(text, "0 to 1000 milliseconds", |v| (0.0..=1000.0).contains(v))
}

/// Luminance of white in cd/m2.
pub fn parse_nits(text: &str) -> Result<f32, String> {
    within(text, "1 to 10000 cd/m2", |v| (1.0..=10_000.0).contains(v))
}

/// Luminance of white over that of black.
pub fn parse_contrast(text: &str) -> Result<f32, String> {
    within(text, "2 to 10000000", |v| (2.0..=1e7).contains(v))
}

/// Illuminance in lux.
pub fn parse_lux(text: &str) -> Result<f32, String> {
    within(text, "0 to 100000 lux", |v| (0.0..=1e5).contains(v))
}

/// Exposure in stops, or `auto`.
pub fn parse_exposure(text: &str) -> Result<Exposure, String> {
    if text == "auto" {
        return Ok(Exposure::Auto);
    }
    parse_stops(text).map(Exposure::Stops).map_err(|e| e + ", or auto")
}

/// Exposure in stops.
pub fn parse_stops(text: &str) -> Result<f32, String> {
    within(text, "-64 to 64 stops", |v| (-64.0..=64.0).contains(v))
}

/// Says which exposure was found, or which one fits better.
pub fn print_exposure(chosen: &Chosen) {
    if chosen.found {
        say!("exposure: {} stops, from the first frame", chosen.ev);
    }
    warn(chosen.hint.as_slice());
}

fn within<T: FromStr>(text: &str, range: &str, is_within: impl Fn(&T) -> bool) -> Result<T, String> {
    text.parse().ok().filter(is_within).ok_or_else(|| format!("expected {range}"))
}
