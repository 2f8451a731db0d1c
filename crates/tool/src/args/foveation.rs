//! Options of the foveation simulator.

use crate::failure::Failure;
use afterimage::{Filter, Foveation};
use afterimage_lab::pipeline::{SampleOrder, SparseGeometry};
use afterimage_lab::trace::sampling::{Regions, Sampling};
use clap::{Args, ValueEnum};

/// Foveation simulator, and the resolution by eccentricity.
#[derive(Args, Clone, Debug)]
pub struct FoveationArgs {
    /// Foveation simulator: box mip levels, Gaussian blur, point-sampled blocks, one moving sample a block, or none.
    /// With --sampling regions or layers, sparse gives the traced samples to the methods in their places
    #[arg(long = "foveation", value_enum, default_value = "mip")]
    pub filter: FilterName,
    /// Diameter of the full-rate region, degrees
    #[arg(long, default_value_t = 5.0, value_name = "DEG")]
    pub fovea: f32,
    /// Diameter of the middle region, degrees
    #[arg(long, default_value_t = 15.0, value_name = "DEG")]
    pub mid: f32,
    /// Width of the linear blend outside each radius, degrees
    #[arg(long, default_value_t = 1.0, value_name = "DEG")]
    pub blend: f32,
    /// Block edge in the middle region, pixels, a power of two
    #[arg(long, default_value_t = 8, value_name = "N")]
    pub rate_mid: u32,
    /// Block edge beyond the middle region, pixels, a power of two
    #[arg(long, default_value_t = 16, value_name = "N")]
    pub rate_far: u32,
    /// With --foveation sparse: depth and motion of every pixel, or of the nearest sample
    #[arg(long = "geometry", alias = "sparse-geometry", value_enum, default_value = "full")]
    pub geometry: GeometryName,
    /// With --foveation sparse: order in which the pixels of a block are sampled
    #[arg(long = "order", alias = "sample-order", value_enum, default_value = "bayer")]
    pub order: OrderName,
}

impl FoveationArgs {
    /// The sampling pattern whose lattices are those of `--foveation sparse`, with `spp` paths a point.
    pub fn regions(&self, spp: u32) -> Result<Sampling, Failure> {
        let blocks = [self.rate_mid, self.rate_far];
        let regions =
            Regions { samples: [spp; 3], blocks, diameters_deg: [self.fovea, self.mid], ..Regions::default() };
        let sampling = Sampling::Regions(regions);
        sampling.check_sparse().map_err(|e| {
            Failure::Input(format!("--foveation sparse: {e}; choose --rate-mid above 1 and --rate-far above that"))
        })?;
        Ok(sampling)
    }

    /// Converts the options to the library's settings.
    pub fn foveation(&self) -> Foveation {
        Foveation {
            filter: match self.filter {
                FilterName::Mip => Filter::Mip,
                FilterName::Gauss => Filter::Gauss,
                FilterName::Block => Filter::Block,
                FilterName::Sparse => Filter::Sparse,
                FilterName::Off => Filter::Off,
            },
            fovea_deg: self.fovea,
            mid_deg: self.mid,
            blend_deg: self.blend,
            rate_mid: self.rate_mid,
            rate_far: self.rate_far,
        }
    }
}

/// Values of `--foveation`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FilterName {
    /// Box mip levels, trilinear
    Mip,
    /// Gaussian blur that grows with eccentricity
    Gauss,
    /// One point sample per block
    Block,
    /// One point sample per block that moves every frame, in regions without blends
    Sparse,
    /// Full rate everywhere
    Off,
}

impl FilterName {
    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mip => "mip",
            Self::Gauss => "gauss",
            Self::Block => "block",
            Self::Sparse => "sparse",
            Self::Off => "off",
        }
    }
}

/// Values of `--order`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum OrderName {
    /// Every prefix is spread evenly over the block
    Bayer,
    /// Row by row
    Scanline,
    /// Every power of two of frames is spread evenly over rows and columns
    Sobol,
}

impl OrderName {
    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bayer => "bayer",
            Self::Scanline => "scanline",
            Self::Sobol => "sobol",
        }
    }

    /// The lab's order of this name.
    pub fn order(self) -> SampleOrder {
        match self {
            Self::Bayer => SampleOrder::Bayer,
            Self::Scanline => SampleOrder::Scanline,
            Self::Sobol => SampleOrder::Sobol,
        }
    }
}

/// Values of `--geometry`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum GeometryName {
    /// At every pixel, as from a visibility buffer or a prepass
    Full,
    /// At the samples alone, as from small views that are enlarged
    Samples,
}

impl GeometryName {
    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Full => "full",
            Self::Samples => "samples",
        }
    }

    /// The lab's option of this name.
    pub fn geometry(self) -> SparseGeometry {
        match self {
            Self::Full => SparseGeometry::Full,
            Self::Samples => SparseGeometry::Samples,
        }
    }
}
