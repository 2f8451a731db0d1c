//! Options of the foveation simulator.

use super::number::{parse_percent, parse_scale};
use super::{Named, by_name};
use crate::failure::Failure;
use afterimage::{Filter, Foveation, Method, Settings};
use afterimage_lab::lattices::{Geometry, SampleOrder};
use afterimage_lab::quad_views::QuadViewLayout;
use afterimage_lab::trace::sampling::{Regions, Sampling};
use clap::Args;

/// Foveation simulator, and the resolution by eccentricity.
#[derive(Args, Clone, Debug)]
pub struct FoveationArgs {
    /// How frames are foveated. quads: one full-rate view, of which each method chooses the quads of 2x2 pixels that
    /// are shaded; given frames simulate it. sparse: one moving sample a block, which scenes render alone; given frames
    /// simulate it. mip, gauss and block simulate blur on full-rate frames; layers and uniform render views of
    /// rasterised scenes. Default: quads for rasterised scenes (sparse with --order, --geometry or a rate above 8),
    /// sparse for traced ones without --sampling, else mip
    #[arg(long = "foveation", value_parser = by_name::<FilterName>())]
    pub filter: Option<FilterName>,
    /// Diameter of the full-rate region, degrees
    #[arg(long, default_value_t = 5.0, value_name = "DEG")]
    pub fovea: f32,
    /// Diameter of the middle region, degrees
    #[arg(long, default_value_t = 15.0, value_name = "DEG")]
    pub mid: f32,
    /// Width of the linear blend outside each radius, degrees
    #[arg(long, default_value_t = 1.0, value_name = "DEG")]
    pub blend: f32,
    /// Block edge in the middle region, pixels, a power of two; quads: 2 to 8; default: 8, for quads 4, at
    /// most --rate-far
    #[arg(long, value_name = "N")]
    pub rate_mid: Option<u32>,
    /// Block edge beyond the middle region, pixels, a power of two; quads: 2 to 8; default: 16, for quads 8, at least
    /// --rate-mid
    #[arg(long, value_name = "N")]
    pub rate_far: Option<u32>,
    /// With --foveation quads: pixels a frame that smr shades by need, beside the even pattern, percent, 0 to 100;
    /// default: 2.5
    #[arg(long, value_parser = parse_percent, value_name = "PERCENT")]
    pub budget: Option<f32>,
    /// With --foveation quads: shades this share of the pixels everywhere alike, without a gaze, percent, 0 to 100; a
    /// temporal upscaler, for example with 25. --fovea, --mid, the rates and --budget follow from it
    #[arg(long, value_parser = parse_percent, value_name = "PERCENT", conflicts_with_all = ["fovea", "mid", "rate_mid", "rate_far", "budget"])]
    pub share: Option<f32>,
    /// Side of the pixels of --foveation uniform, in pixels of the full-rate frame, 1 to 256; need not be whole;
    /// default: 2
    #[arg(long, value_parser = parse_scale, value_name = "S")]
    pub scale: Option<f32>,
    /// With --foveation sparse, layers or uniform: depth and motion of every pixel, or of the nearest sample; those of
    /// every pixel are without jitter; default: of the nearest sample in scenes, full in given frames
    #[arg(long, value_parser = by_name::<Geometry>())]
    pub geometry: Option<Geometry>,
    /// With --foveation sparse: order in which the pixels of a block are sampled
    #[arg(long, value_parser = by_name::<SampleOrder>(), default_value = "bayer")]
    pub order: SampleOrder,
    /// Jitter of the projection, in scenes and analytic clips: full-rate frames then have one sample a pixel, sparse
    /// ones one a block, smr antialiases sparse frames, and --foveation off means sparse frames of blocks of one pixel
    #[arg(long, value_parser = by_name::<Jitter>(), default_value = "off")]
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
    /// Fills in defaults that depend on the input. `default`: how its frames are foveated by default. `is_rendered`:
    /// whether samples are rendered, not taken from given frames.
    #[must_use]
    pub fn with_defaults(self, default: Filter, is_rendered: bool) -> Self {
        if self.is_jittered() && self.filter() == FilterName::Of(Filter::Off) {
            let filter = Some(FilterName::Of(Filter::Sparse));
            let sparse = Self { filter, fovea: 0.0, mid: 0.0, rate_mid: Some(1), rate_far: Some(1), ..self };
            return sparse.with_defaults(default, is_rendered);
        }
        let default = if default == Filter::Quads && self.needs_lattices() { Filter::Sparse } else { default };
        let named = Self { filter: Some(self.filter.unwrap_or(FilterName::Of(default))), ..self };
        let geometry = match named.may_lack_geometry() && is_rendered {
            true => Geometry::Samples,
            false => Geometry::Full,
        };
        Self { geometry: Some(named.geometry.unwrap_or(geometry)), ..named }
    }

    /// Whether an option says how samples of lattices lie, or how coarse they are.
    fn needs_lattices(&self) -> bool {
        let is_coarse = [self.rate_mid, self.rate_far].into_iter().flatten().any(|rate| rate > 8);
        is_coarse || self.geometry.is_some() || self.order != SampleOrder::Bayer
    }

    /// How frames are foveated.
    pub fn filter(&self) -> FilterName {
        self.filter.unwrap_or(FilterName::Of(Filter::Mip))
    }

    /// Whether the projection is jittered.
    pub fn is_jittered(&self) -> bool {
        self.jitter == Jitter::Halton
    }

    /// The settings, with history that is antialiased where frames are jittered.
    pub fn antialiased(&self, mut settings: Settings) -> Settings {
        if let Method::Smr(smr) = &mut settings.method {
            let has_samples = matches!(settings.foveation.filter, Filter::Sparse | Filter::Quads);
            smr.antialias = self.is_jittered() && has_samples;
        }
        settings
    }

    /// Depth and motion of frames.
    pub fn geometry(&self) -> Geometry {
        self.geometry.unwrap_or(Geometry::Full)
    }

    /// The sampling pattern whose lattices are those of `--foveation sparse`, with `spp` paths a point.
    pub fn regions(&self, spp: u32) -> Result<Sampling, Failure> {
        let blocks = self.rates();
        let regions =
            Regions { samples: [spp; 3], blocks, diameters_deg: [self.fovea, self.mid], ..Regions::default() };
        let sampling = Sampling::Regions(regions);
        sampling.check_sparse().map_err(|e| {
            Failure::Input(format!("--foveation sparse: {e}; choose --rate-mid above 1 and --rate-far from that on"))
        })?;
        Ok(sampling)
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
            return Foveation::uniform(percent / 100.0);
        }
        let [rate_mid, rate_far] = self.rates();
        Foveation {
            filter: match self.filter() {
                FilterName::Of(filter) => filter,
                // Of quad views, levels of detail are an input.
                FilterName::Layers | FilterName::Uniform => Filter::Mip,
            },
            fovea_deg: self.fovea,
            mid_deg: self.mid,
            blend_deg: self.blend,
            rate_mid,
            rate_far,
            budget: self.budget.map_or(Foveation::default().budget, |percent| percent / 100.0),
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
        self.filter() == FilterName::Of(Filter::Quads)
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

    /// Whether frames may have depth and motion at their samples alone.
    pub fn may_lack_geometry(&self) -> bool {
        self.filter() == FilterName::Of(Filter::Sparse) || self.filter().is_quad_views()
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
        let is_sparse = self.filter() == FilterName::Of(Filter::Sparse);
        let has_samples = self.geometry == Some(Geometry::Samples);
        let order = format!("order {}", self.order.name());
        let misplaced = [
            (self.budget.is_some() && !self.is_quads(), "budget", "frames shaded by quads", "quads"),
            (self.share.is_some() && !self.is_quads(), "share", "frames shaded by quads", "quads"),
            (self.scale.is_some() && !is_uniform, "scale", "uniform frames", "uniform"),
            (has_samples && !self.may_lack_geometry(), "geometry samples", "rendered samples", "sparse or layers"),
            (self.order != SampleOrder::Bayer && !is_sparse, &order, "sparse frames", "sparse"),
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
            format!("--foveation {name} has four samples a pixel; use --foveation sparse")
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
    Of(Filter),
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

impl Named for FilterName {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        let mut rows: Vec<_> = Filter::ALL.map(|filter| (Self::Of(filter), filter.name(), filter.summary())).into();
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
                 moving samples for taau: --foveation sparse --fovea 0 --mid 0 --rate-mid 2 --rate-far 2",
            ),
        ]);
        rows.extend(off);
        rows
    }
}

impl Named for SampleOrder {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::Bayer, "bayer", "Every prefix is spread evenly over the block"),
            (Self::Scanline, "scanline", "Row by row"),
            (Self::Sobol, "sobol", "Every power of two of frames is spread evenly over rows and columns"),
        ]
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_order_has_a_name() {
        assert_eq!(SampleOrder::rows().iter().map(|row| row.0).collect::<Vec<_>>(), SampleOrder::ALL);
    }
}
