//! Options of the foveation simulator.

use super::number::{parse_percent, parse_scale};
use super::{Named, by_name};
use crate::failure::Failure;
use afterimage::internal::{Foveation, FoveationKind, Method, Settings};
use afterimage_lab::quad_views::{Geometry, QuadViewLayout};
use clap::builder::TypedValueParser;
use clap::error::ErrorKind;
use clap::{Arg, Args, Command, Error};
use std::ffi::OsStr;

/// Heading of these options in the help.
const HEADING: &str = "Foveation";

/// Foveation simulator, and the resolution by eccentricity.
#[derive(Args, Clone, Debug)]
pub struct FoveationArgs {
    /// How frames are foveated. planned: one full-rate view, of which each method chooses the pixels that are shaded;
    /// given frames simulate it. mip, gauss and block simulate blur on full-rate frames; layers and uniform render
    /// views of rasterised scenes. Default: planned for scenes without --sampling, else mip
    #[arg(long = "foveation", value_parser = FilterParser, help_heading = HEADING)]
    pub filter: Option<FilterName>,
    /// Diameter of the full-rate region, degrees
    #[arg(long, default_value_t = 5.0, value_name = "DEG", help_heading = HEADING)]
    pub fovea: f32,
    /// Diameter of the middle region, degrees
    #[arg(long, default_value_t = 15.0, value_name = "DEG", help_heading = HEADING)]
    pub mid: f32,
    /// Width of the linear blend outside each radius, degrees
    #[arg(long, default_value_t = 1.0, value_name = "DEG", help_heading = HEADING)]
    pub blend: f32,
    /// Block edge in the middle region, pixels, a power of two; planned: 2 to 8; default: 8, for planned 4, at
    /// most --rate-far
    #[arg(long, value_name = "N", help_heading = HEADING)]
    pub rate_mid: Option<u32>,
    /// Block edge beyond the middle region, pixels, a power of two; planned: 2 to 8; default: 16, for planned 8, at
    /// least --rate-mid
    #[arg(long, value_name = "N", help_heading = HEADING)]
    pub rate_far: Option<u32>,
    /// With --foveation planned: pixels a frame that smr shades by need, beside the even pattern, percent, 0 to 100;
    /// default: 2.5
    #[arg(long, value_parser = parse_percent, value_name = "PERCENT", help_heading = HEADING)]
    pub budget: Option<f32>,
    /// With --foveation planned: shades this share of the pixels everywhere alike, without a gaze, percent, 0 to 100; a
    /// temporal upscaler, for example with 25. --fovea, --mid, the rates and --budget follow from it
    #[arg(long, value_parser = parse_percent, value_name = "PERCENT", conflicts_with_all = ["fovea", "mid", "rate_mid", "rate_far", "budget"], help_heading = HEADING)]
    pub share: Option<f32>,
    /// With --foveation planned: shades one pixel of a chosen quad outside the fovea, not all four; traced frames
    /// always do. One pixel in 4: with --fovea 0 --mid 180 --rate-mid 2 --rate-far 2 --budget 0
    #[arg(long, help_heading = HEADING)]
    pub single_pixels: bool,
    /// Side of the pixels of --foveation uniform, in pixels of the full-rate frame, 1 to 256; need not be whole;
    /// default: 2
    #[arg(long, value_parser = parse_scale, value_name = "S", help_heading = HEADING)]
    pub scale: Option<f32>,
    /// With --foveation layers or uniform: depth and motion of every pixel, or of the nearest pixel of a view; default:
    /// samples
    #[arg(long, value_parser = by_name::<Geometry>(), help_heading = HEADING)]
    pub geometry: Option<Geometry>,
    /// Jitter of the projection, in scenes and analytic clips: frames then have one sample a pixel, which smr
    /// antialiases; --foveation off means planned frames of which every pixel is shaded
    #[arg(long, value_parser = by_name::<Jitter>(), default_value = "off", help_heading = HEADING)]
    pub jitter: Jitter,
}

/// Values of `--jitter`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Jitter {
    /// By Halton's sequence.
    Halton,
    /// None.
    Off,
}

impl Named for Jitter {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::Halton, "halton", "By Halton's sequence of bases 3 and 5, which does not repeat"),
            (Self::Off, "off", "None"),
        ]
    }
}

impl FoveationArgs {
    /// Fills in defaults that depend on the input. `default`: how its frames are foveated by default. `is_traced`:
    /// whether they are those of a path-traced scene.
    #[must_use]
    pub fn with_defaults(self, default: FoveationKind, is_traced: bool) -> Self {
        if self.is_jittered() && self.filter() == FilterName::Of(FoveationKind::Off) {
            let rates = Self { rate_mid: Some(2), rate_far: Some(2), ..self };
            let filter = Some(FilterName::Of(FoveationKind::Quads));
            return Self { filter, fovea: 180.0, mid: 180.0, budget: Some(0.0), ..rates };
        }
        let named = Self { filter: Some(self.filter.unwrap_or(FilterName::Of(default))), ..self };
        Self { single_pixels: named.single_pixels || (is_traced && named.is_quads()), ..named }
    }

    /// How frames are foveated.
    pub fn filter(&self) -> FilterName {
        self.filter.unwrap_or(FilterName::Of(FoveationKind::Mip))
    }

    /// Whether the projection is jittered.
    pub fn is_jittered(&self) -> bool {
        self.jitter == Jitter::Halton
    }

    /// The settings, with history that is antialiased where frames are jittered.
    pub fn antialiased(&self, mut settings: Settings) -> Settings {
        if let Method::Smr(smr) = &mut settings.method {
            smr.antialias = self.is_jittered() && settings.foveation.kind == FoveationKind::Quads;
        }
        settings
    }

    /// Depth and motion of quad views.
    pub fn geometry(&self) -> Geometry {
        self.geometry.unwrap_or(Geometry::Samples)
    }

    /// Converts the options to the library's settings.
    pub fn foveation(&self) -> Foveation {
        if self.filter() == FilterName::Uniform {
            // Levels of detail are an input; a method reads here how coarse they may be.
            let rate = (self.scale().ceil() as u32).next_power_of_two();
            let no_region = Foveation { fovea_deg: 0.0, mid_deg: 0.0, blend_deg: 0.0, ..Foveation::default() };
            return Foveation { rate_mid: rate, rate_far: rate, ..no_region };
        }
        if let Some(percent) = self.share.filter(|_| self.is_quads()) {
            return Foveation { single_pixels: self.single_pixels, ..Foveation::uniform(percent / 100.0) };
        }
        let [rate_mid, rate_far] = self.rates();
        Foveation {
            kind: match self.filter() {
                FilterName::Of(filter) => filter,
                // Of quad views, levels of detail are an input.
                FilterName::Layers | FilterName::Uniform => FoveationKind::Mip,
            },
            fovea_deg: self.fovea,
            mid_deg: self.mid,
            blend_deg: self.blend,
            rate_mid,
            rate_far,
            budget: self.budget.map_or(Foveation::default().budget, |percent| percent / 100.0),
            single_pixels: self.single_pixels,
        }
    }

    /// Block edges in the middle region and beyond it.
    fn rates(&self) -> [u32; 2] {
        let defaults = if self.is_quads() { Foveation::quads() } else { Foveation::default() };
        let (mid, far) = (self.rate_mid, self.rate_far);
        [
            mid.unwrap_or(defaults.rate_mid.min(far.unwrap_or(defaults.rate_far))),
            far.unwrap_or(defaults.rate_far.max(mid.unwrap_or(defaults.rate_mid))),
        ]
    }

    /// Whether frames are shaded by quads that methods choose.
    pub fn is_quads(&self) -> bool {
        self.filter() == FilterName::Of(FoveationKind::Quads)
    }

    /// Side of a pixel of uniform frames, in pixels.
    fn scale(&self) -> f32 {
        self.scale.unwrap_or(2.0)
    }

    /// Quad views of the frames, if they are composed of such.
    pub fn quad_views(&self) -> Option<QuadViewLayout> {
        match self.filter() {
            FilterName::Layers => Some(QuadViewLayout::Regions),
            FilterName::Uniform => Some(QuadViewLayout::Uniform { step: self.scale() }),
            _ => None,
        }
    }

    /// Refuses options that do not apply to this foveation. `is_rasterised`: frames are those of a rasterised scene.
    /// `is_analytic`: those of an analytic one.
    pub fn check(&self, is_rasterised: bool, is_analytic: bool) -> Result<(), Failure> {
        if self.is_jittered() {
            self.check_jitter(is_rasterised, is_analytic)?;
        }
        let name = self.filter().name();
        let refuse = |text: String| Err(Failure::Input(text));
        if self.filter().is_quad_views() && !is_rasterised {
            return refuse(format!(
                "--foveation {name}: renders views of a scene; give a scene (.gltf, .glb, builtin:NAME) with --source raster, \
                 or use another --foveation"
            ));
        }
        let is_uniform = self.filter() == FilterName::Uniform;
        let has_geometry = self.geometry.is_some() && !self.filter().is_quad_views();
        let misplaced = [
            (self.budget.is_some() && !self.is_quads(), "budget", "frames of which methods choose pixels", "planned"),
            (self.share.is_some() && !self.is_quads(), "share", "frames of which methods choose pixels", "planned"),
            (self.scale.is_some() && !is_uniform, "scale", "uniform frames", "uniform"),
            (
                self.single_pixels && !self.is_quads(),
                "single-pixels",
                "frames of which methods choose pixels",
                "planned",
            ),
            (has_geometry, "geometry", "quad views", "layers or uniform"),
        ];
        match misplaced.iter().find(|row| row.0) {
            Some((_, option, frames, name)) => {
                refuse(format!("--{option}: applies to {frames} only; add --foveation {name}"))
            }
            None => Ok(()),
        }
    }

    /// Refuses what cannot be jittered.
    fn check_jitter(&self, is_rasterised: bool, is_analytic: bool) -> Result<(), Failure> {
        let name = self.filter().name();
        let text = if !is_rasterised && !is_analytic {
            "moves a projection; give a scene (.gltf, .glb, builtin:NAME) with --source raster or analytic:NAME, since \
             the samples of traced frames lie anywhere in their pixels already"
                .into()
        } else if self.filter().is_quad_views() {
            format!("--foveation {name} has four samples a pixel; use --foveation planned")
        } else {
            return Ok(());
        };
        Err(Failure::Input(format!("--jitter halton: {text}")))
    }
}

/// Values of `--foveation`: the library's filters, and the quad views of scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilterName {
    /// A filter of the library.
    Of(FoveationKind),
    /// Views of the regions.
    Layers,
    /// The whole frame at a lower resolution.
    Uniform,
}

impl FilterName {
    /// Whether frames are composed of quad views.
    pub fn is_quad_views(self) -> bool {
        matches!(self, Self::Layers | Self::Uniform)
    }
}

/// Name of a filter here.
fn named(filter: FoveationKind) -> &'static str {
    if filter == FoveationKind::Quads { "planned" } else { filter.name() }
}

impl Named for FilterName {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        let mut rows: Vec<_> =
            FoveationKind::ALL.map(|filter| (Self::Of(filter), named(filter), filter.summary())).into();
        let off = rows.pop();
        rows.extend([
            (
                Self::Layers,
                "layers",
                "Views of the regions at lower resolutions without moving samples, enlarged bilinearly: quad views, as \
                 headset runtimes draw them",
            ),
            (
                Self::Uniform,
                "uniform",
                "The whole frame at a lower resolution without moving samples, enlarged bilinearly; see --scale. With \
                 moving samples for taau: --foveation planned with --single-pixels",
            ),
        ]);
        rows.extend(off);
        rows
    }
}

impl Named for Geometry {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::Full, "full", "At every pixel, as from a visibility buffer or a prepass"),
            (Self::Samples, "samples", "At the samples alone, as from small views that are enlarged"),
        ]
    }
}

/// Another name of planned frames.
const QUADS: &str = "quads";

/// Parser of `--foveation`, which says what replaces a value of earlier versions.
#[derive(Clone)]
struct FilterParser;

impl TypedValueParser for FilterParser {
    type Value = FilterName;

    fn parse_ref(&self, command: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<FilterName, Error> {
        if value == "sparse" {
            let text = "--foveation sparse: use --foveation planned, which shades better pixels; with --single-pixels \
                        one pixel of a quad\n";
            return Err(Error::raw(ErrorKind::InvalidValue, text).with_cmd(command));
        }
        let value = if value == QUADS { OsStr::new(named(FoveationKind::Quads)) } else { value };
        by_name::<FilterName>().parse_ref(command, arg, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = clap::builder::PossibleValue> + '_>> {
        let values = FilterName::rows().into_iter();
        Some(Box::new(values.map(|(_, name, help)| clap::builder::PossibleValue::new(name).help(help))))
    }
}
