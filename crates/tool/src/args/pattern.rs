//! `--sampling` and its companions.

use crate::args::gaze::GazeArgs;
use crate::failure::Failure;
use afterimage::ViewGeometry;
use afterimage_lab::trace::sampling::{Acuity, Layers, Regions, Sampling};
use clap::{Args, ValueEnum};

/// How samples are spread over the frame, and where the eye looks.
#[derive(Args, Clone, Debug)]
pub struct PatternArgs {
    #[command(flatten)]
    pub of: SamplingArgs,
    #[command(flatten)]
    gaze: GazeArgs,
}

/// How samples are spread over the frame.
#[derive(Args, Clone, Debug)]
pub struct SamplingArgs {
    /// How samples are spread over the frame; of run: uniform leaves foveation to a simulator, or with --foveation off to nobody
    #[arg(long, value_enum, default_value = "uniform")]
    pub sampling: SamplingName,
    /// Samples of regions: of a pixel in the fovea, of a block in the middle, of a block outside
    #[arg(long, value_delimiter = ',', default_value = "32,16,8", value_name = "A,B,C")]
    pub region_spp: Vec<u32>,
    /// Edges of the blocks of regions in the middle and outside, pixels
    #[arg(long, value_delimiter = ',', default_value = "2,4", value_name = "N,M")]
    pub region_block: Vec<u32>,
    /// Diameters of the two inner regions, degrees
    #[arg(long, value_delimiter = ',', default_value = "5.2,17", value_name = "E1,E2")]
    pub region_deg: Vec<f32>,
    /// Radii of the three inner layers, degrees
    #[arg(long, value_delimiter = ',', default_value = "6,10,20", value_name = "A,B,C")]
    pub layer_deg: Vec<f32>,
    /// Distances of target pixels in the four layers, pixels
    #[arg(long, value_delimiter = ',', default_value = "1,2,3,4", value_name = "A,B,C,D")]
    pub layer_step: Vec<u32>,
    /// Radius of what a headset's lens shows around the view's axis, degrees: layers trace nothing outside; default: all of the screen
    /// is seen
    #[arg(long, value_name = "DEG")]
    pub lens_deg: Option<f32>,
}

/// Names of sampling patterns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SamplingName {
    /// As many everywhere
    Uniform,
    /// Three regions with blocks
    Regions,
    /// Nested lattices with blend masks
    Layers,
    /// As dense as the eye's cells
    Acuity,
}

impl SamplingName {
    /// As typed.
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Regions => "regions",
            Self::Layers => "layers",
            Self::Acuity => "acuity",
        }
    }
}

impl PatternArgs {
    /// Gaze of every frame in pixels; what is lost holds the last one.
    pub fn gaze(&self, view: &ViewGeometry, fps: f32, frames: u64) -> Result<Vec<[f32; 2]>, Failure> {
        let track = self.gaze.resolve(view, fps, Some(frames))?;
        let mut last = view.size_px().map(|s| 0.5 * (s as f32 - 1.0));
        Ok(track
            .px
            .iter()
            .map(|px| {
                last = px.unwrap_or(last);
                last
            })
            .collect())
    }
}

impl SamplingArgs {
    /// The library's form.
    pub fn sampling(&self) -> Result<Sampling, Failure> {
        Ok(match self.sampling {
            SamplingName::Uniform => Sampling::Uniform,
            SamplingName::Regions => Sampling::Regions(Regions {
                samples: exactly("--region-spp", &self.region_spp, |v| (1..=1 << 20).contains(&v))?,
                blocks: exactly("--region-block", &self.region_block, |v| (1..=256).contains(&v))?,
                diameters_deg: exactly("--region-deg", &self.region_deg, |v| v > 0.0 && v < 170.0)?,
                radius_scale: 1.0,
            }),
            SamplingName::Layers => Sampling::Layers(Layers {
                radii_deg: exactly("--layer-deg", &self.layer_deg, |v| v > 0.0 && v < 85.0)?,
                steps: exactly("--layer-step", &self.layer_step, |v| (1..=256).contains(&v))?,
                lens_deg: match self.lens_deg {
                    Some(deg) => Some(exactly::<_, 1>("--lens-deg", &[deg], |v| v > 0.0 && v < 89.0)?[0]),
                    None => None,
                },
            }),
            SamplingName::Acuity => Sampling::Acuity(Acuity::default()),
        })
    }

    /// Samples of a pixel where it is sampled most.
    pub fn most_samples(&self, samples: u32) -> u32 {
        match self.sampling {
            SamplingName::Regions => self.region_spp[0],
            _ => samples,
        }
    }

    /// Samples that the pattern would take without blends and borders.
    pub fn ideal_samples(
        &self,
        sampling: &Sampling,
        view: &ViewGeometry,
        gaze_px: [f32; 2],
        samples: u32,
    ) -> Option<f64> {
        match sampling {
            Sampling::Regions(regions) => Some(regions.ideal_samples(view)),
            Sampling::Acuity(acuity) => Some(acuity.expected(view, gaze_px) * f64::from(samples)),
            _ => None,
        }
    }
}

/// As many values as the option has, all of them allowed.
fn exactly<T: Copy + std::fmt::Display, const N: usize>(
    option: &str,
    values: &[T],
    is_allowed: impl Fn(T) -> bool,
) -> Result<[T; N], Failure> {
    let refuse =
        |what: String| Failure::Input(format!("{option}: {what}; expected {N}, separated by commas, see --help"));
    if let Some(bad) = values.iter().find(|v| !is_allowed(**v)) {
        return Err(refuse(format!("{bad} is out of range")));
    }
    values.try_into().map_err(|_| refuse(format!("{} values were given", values.len())))
}
