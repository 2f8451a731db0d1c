//! `--sampling` and its options.

use crate::args::gaze::GazeArgs;
use crate::failure::Failure;
use afterimage::ViewGeometry;
use afterimage_lab::scanpath::HeadPath;
use afterimage_trace::sampling::{Acuity, Layers, Regions, Sampling};
use clap::{Args, ValueEnum};

/// Sampling pattern and gaze.
#[derive(Args, Clone, Debug)]
pub struct PatternArgs {
    #[command(flatten)]
    pub of: SamplingArgs,
    #[command(flatten)]
    pub gaze: GazeArgs,
}

/// Heading of these options in the help.
const HEADING: &str = "Sampling of traced frames";

/// Sampling pattern of traced frames.
#[derive(Args, Clone, Debug)]
pub struct SamplingArgs {
    /// Sampling pattern. With run, uniform frames are foveated by a simulator, or not at all with --foveation off
    #[arg(long, value_enum, default_value = "uniform", help_heading = HEADING)]
    pub sampling: SamplingName,
    /// regions: samples per pixel in the fovea, per block in the middle region, per block outside
    #[arg(long, value_delimiter = ',', default_value = "32,16,8", value_name = "A,B,C", help_heading = HEADING)]
    pub region_spp: Vec<u32>,
    /// regions: block edges in the middle region and outside, pixels
    #[arg(long, value_delimiter = ',', default_value = "2,4", value_name = "N,M", help_heading = HEADING)]
    pub region_block: Vec<u32>,
    /// regions: diameters of the two inner regions, degrees
    #[arg(long, value_delimiter = ',', default_value = "5.2,17", value_name = "E1,E2", help_heading = HEADING)]
    pub region_deg: Vec<f32>,
    /// layers: radii of the three inner layers, degrees
    #[arg(long, value_delimiter = ',', default_value = "6,10,20", value_name = "A,B,C", help_heading = HEADING)]
    pub layer_deg: Vec<f32>,
    /// layers: spacing of traced pixels in the four layers, pixels
    #[arg(long, value_delimiter = ',', default_value = "1,2,3,4", value_name = "A,B,C,D", help_heading = HEADING)]
    pub layer_step: Vec<u32>,
    /// layers: radius of the area that a headset's lens shows, degrees from the view's axis; nothing is traced outside;
    /// default: the whole frame
    #[arg(long, value_name = "DEG", help_heading = HEADING)]
    pub lens_deg: Option<f32>,
}

/// Values of `--sampling`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SamplingName {
    /// The same number of samples in every pixel
    Uniform,
    /// Three regions with blocks
    Regions,
    /// Nested lattices with blend masks
    Layers,
    /// Density proportional to that of retinal ganglion cells
    Acuity,
}

impl SamplingName {
    /// Name on the command line.
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
    /// Gaze of every frame in pixels; the last known position where tracking is lost.
    pub fn gaze(
        &self,
        view: &ViewGeometry,
        fps: f32,
        frames: u64,
        head: Option<&HeadPath>,
    ) -> Result<Vec<[f32; 2]>, Failure> {
        let track = self.gaze.resolve(view, fps, Some(frames), head, 0.0)?;
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
    /// Converts the options to the library's pattern.
    pub fn sampling(&self) -> Result<Sampling, Failure> {
        Ok(match self.sampling {
            SamplingName::Uniform => Sampling::Uniform,
            SamplingName::Regions => Sampling::Regions(Regions {
                samples: exactly("--region-spp", &self.region_spp, |v| (1..=1 << 20).contains(&v))?,
                blocks: exactly("--region-block", &self.region_block, |v| (1..=256).contains(&v))?,
                diameters_deg: exactly("--region-deg", &self.region_deg, |v| v > 0.0 && v < 170.0)?,
                ..Regions::default()
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

    /// Samples per pixel where the pattern is densest.
    pub fn most_samples(&self, samples: u32) -> u32 {
        match self.sampling {
            SamplingName::Regions => self.region_spp[0],
            _ => samples,
        }
    }

    /// Samples of the pattern without overlaps for blending and partial blocks at borders, if known.
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

/// Checks that an option has exactly `N` values, all within range.
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
