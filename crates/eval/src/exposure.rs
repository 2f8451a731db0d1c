//! Exposure before sRGB encoding: given, or found from the first frame.

use afterimage::Image;

/// Luminance that the logarithmic mean of a frame gets: the reflectance of middle grey.
const MIDDLE_GREY: f64 = 0.18;
/// Share of what is lit that may be brighter than `BRIGHT`: shadows beside a lamp do not decide alone.
const BRIGHTER: f64 = 0.05;
const BRIGHT: f64 = 0.8;
/// Pixels darker than the bright ones by this factor count as unlit, so that a black background is not exposed for. The
/// brightest [`BRIGHTER`] of a frame are not asked: a sun or a firefly would make the whole scene unlit.
const UNLIT: f64 = 1e-5;
/// Encoded, it is 3 of 255.
const BLACK: f64 = 0.001;
/// Bound of exposures, stops.
const MOST_STOPS: f32 = 64.0;

/// Exposure of a clip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    /// In stops.
    Stops(f32),
    /// Found from the first frame: its logarithmic mean becomes mid-grey, unless too much would be white.
    Auto,
}

/// Exposure of a clip in stops, and what its user should know of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Chosen {
    /// Stops.
    pub ev: f32,
    /// Whether it was found from the first frame.
    pub found: bool,
    /// What is wrong with the first frame at this exposure, and which one fits; `None` if nothing is.
    pub hint: Option<String>,
}

impl Exposure {
    /// The exposure for a clip with this first frame, linear. Above `white` a channel counts as overexposed.
    pub fn choose(self, first: &Image<[f32; 3]>, white: f64) -> Chosen {
        let tones = Tones::of(first);
        match self {
            Self::Auto => Chosen { ev: tones.fitting_ev().unwrap_or(0.0), found: true, hint: None },
            Self::Stops(ev) => Chosen { ev, found: false, hint: tones.hint(f64::from(ev.exp2()), white) },
        }
    }
}

/// Tones of a frame.
struct Tones<'a> {
    pixels: &'a [[f32; 3]],
    /// Luminance up to which a pixel is unlit.
    unlit: f64,
}

impl<'a> Tones<'a> {
    fn of(frame: &'a Image<[f32; 3]>) -> Self {
        let pixels = frame.pixels();
        let mut above_zero: Vec<f64> = pixels.iter().map(luminance).filter(|l| *l > 0.0).collect();
        Self { pixels, unlit: UNLIT * bright_luminance(&mut above_zero).unwrap_or(0.0) }
    }

    /// Pixels that light reaches.
    fn lit(&self) -> impl Iterator<Item = &[f32; 3]> {
        self.pixels.iter().filter(|p| luminance(p) > self.unlit)
    }

    /// Exposure that makes the logarithmic mean of what is lit middle grey, or less so that few of its pixels are
    /// brighter than [`BRIGHT`]; in tenths of a stop. `None` for a black frame.
    fn fitting_ev(&self) -> Option<f32> {
        let mut lit: Vec<f64> = self.lit().map(luminance).collect();
        let bright = bright_luminance(&mut lit)?;
        let mean = lit.iter().map(|l| l.log2()).sum::<f64>() / lit.len() as f64;
        let ev = (MIDDLE_GREY.log2() - mean).min(BRIGHT.log2() - bright.log2());
        Some(((ev * 10.0).round() / 10.0) as f32).map(|ev: f32| ev.clamp(-MOST_STOPS, MOST_STOPS))
    }

    fn hint(&self, gain: f64, white: f64) -> Option<String> {
        // No exposure helps where there is no light.
        let fitting = self.fitting_ev()?;
        let share =
            |is: &dyn Fn(&[f32; 3]) -> bool, of: usize| self.lit().filter(|p| is(p)).count() as f64 / of.max(1) as f64;
        // Values up to 1 are what the input holds; more are lost.
        let over = share(&|p| p.iter().all(|&c| f64::from(c) * gain > white), self.lit().count());
        let is_dark = |p: &[f32; 3]| p.iter().all(|&c| f64::from(c) * gain < BLACK);
        let bright = 1.0 - share(&is_dark, self.lit().count());
        let problem = match (over, bright) {
            (over, _) if over > 0.5 => format!("{:.0} % of what is lit in the first frame is white", 100.0 * over),
            (_, bright) if bright < 0.05 => "nearly all of the first frame is black".to_owned(),
            _ => return None,
        };
        Some(format!("{problem}; --exposure {fitting} fits, or --exposure auto"))
    }
}

/// The luminance that [`BRIGHTER`] of these exceed; `None` for none. Reorders them.
fn bright_luminance(luminances: &mut [f64]) -> Option<f64> {
    let last = luminances.len().checked_sub(1)?;
    let place = (last as f64 * (1.0 - BRIGHTER)) as usize;
    Some(*luminances.select_nth_unstable_by(place, f64::total_cmp).1)
}

fn luminance(p: &[f32; 3]) -> f64 {
    let [r, g, b] = p.map(|c| if c.is_finite() { f64::from(c).max(0.0) } else { 0.0 });
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A frame of 10x10 pixels, `lit` of which have this color on black.
    fn frame(lit: usize, color: [f32; 3]) -> Image<[f32; 3]> {
        let pixels = (0..100).map(|i| if i < lit { color } else { [0.0; 3] });
        Image::from_pixels([10, 10], pixels.collect()).unwrap()
    }

    #[test]
    fn the_mean_of_what_is_lit_becomes_middle_grey() {
        for (lit, level, ev) in [(100, 0.18, 0.0), (3, 0.18, 0.0), (40, 0.18 * 2048.0, -11.0), (100, 0.18 / 8.0, 3.0)] {
            let chosen = Exposure::Auto.choose(&frame(lit, [level; 3]), 1.0);
            assert_eq!(chosen, Chosen { ev, found: true, hint: None });
        }
        assert_eq!(Exposure::Auto.choose(&frame(0, [1.0; 3]), 1.0).ev, 0.0, "a black frame");
        assert_eq!(Exposure::Auto.choose(&frame(9, [f32::INFINITY; 3]), 1.0).ev, 0.0);
        assert_eq!(Exposure::Auto.choose(&frame(9, [1e-30; 3]), 1.0).ev, 64.0);
    }

    /// Pixels of a sun, or fireflies, do not make the rest unlit, however bright they are.
    #[test]
    fn a_sun_does_not_black_out_its_scene() {
        let scene = |sun: f32, suns: usize| {
            let pixels = (0..1000).map(|i| if i < suns { [sun; 3] } else { [0.1 * (1 + i % 7) as f32; 3] });
            Image::from_pixels([100, 10], pixels.collect()).unwrap()
        };
        let without = Exposure::Auto.choose(&scene(0.4, 0), 1.0).ev;
        assert!((-1.5..-0.5).contains(&without), "{without}");
        for (sun, suns) in [(1e5, 1), (1e5, 30), (1e9, 1), (1e9, 10), (3e37, 2), (f32::INFINITY, 5)] {
            let frame = scene(sun, suns);
            let ev = Exposure::Auto.choose(&frame, 1.0).ev;
            // Each sun counts with the logarithm of its luminance.
            assert!((ev - without).abs() < 0.8, "{suns} of {sun}: {ev}, without {without}");
            assert_eq!(Exposure::Stops(0.0).choose(&frame, 1.0).hint, None, "{suns} of {sun}");
        }
    }

    #[test]
    fn a_hint_names_an_exposure_that_needs_none() {
        for (lit, level) in [(100, 500.0), (20, 1e6), (100, 2.0), (100, 1e-5), (30, 1e-8)] {
            let frame = frame(lit, [level, level * 0.9, level * 0.8]);
            let hint = Exposure::Stops(0.0).choose(&frame, 1.0).hint.unwrap();
            let ev = hint.split("--exposure ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
            assert_eq!(Exposure::Stops(ev).choose(&frame, 1.0).hint, None, "{hint}");
            assert_eq!(Exposure::Auto.choose(&frame, 1.0).ev, ev);
        }
        // A lit face beside a larger one in the shade: neither is lost.
        let pixels = (0..100).map(|i| if i < 30 { [2000.0; 3] } else { [5.0; 3] });
        let faces = Image::from_pixels([10, 10], pixels.collect()).unwrap();
        assert_eq!(Exposure::Auto.choose(&faces, 1.0).ev, -11.3);
        // A page of paper, a small lamp in the dark, a saturated color.
        for (lit, color) in [(100, [1.0; 3]), (5, [0.5; 3]), (100, [40.0, 0.2, 0.1]), (49, [0.01; 3])] {
            assert_eq!(Exposure::Stops(0.0).choose(&frame(lit, color), 1.0).hint, None, "{color:?}");
        }
        assert_eq!(Exposure::Stops(0.0).choose(&frame(0, [0.0; 3]), 1.0).hint, None, "a black frame");
    }
}
