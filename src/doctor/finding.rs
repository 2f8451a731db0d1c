//! Findings of a doctor.

use std::fmt;

/// An input, or a property of one, that is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Check {
    /// Direction, axes, unit and scale of the motion vectors.
    Motion,
    /// Whether the motion vectors contain the projection's jitter.
    Jitter,
    /// Convention of depth values, and its planes.
    Depth,
    /// Whether colors are linear.
    Color,
    /// Position of the gaze.
    Gaze,
    /// FoveationKind, regions and rates of the foveation.
    Foveation,
}

/// Fault of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Fault {
    /// The motion vectors have the other direction (and perhaps the other vertical axis or unit).
    MotionDirection,
    /// The vertical axis of the motion vectors points the other way.
    MotionYAxis,
    /// The motion vectors have another unit.
    MotionUnit,
    /// The motion vectors are too long or too short by a factor.
    MotionScale,
    /// x and y of the motion vectors are swapped.
    MotionAxes,
    /// The motion vectors contain the camera's motion, or lack it, contrary to
    /// [`MotionConvention::without_camera`](crate::MotionConvention::without_camera); or there are none, and the camera
    /// moves.
    MotionCamera,
    /// The motion vectors contain the projection's jitter, or lack it, contrary to
    /// [`MotionConvention::jittered`](crate::MotionConvention::jittered).
    MotionJitter,
    /// Depth values have another convention.
    DepthConvention,
    /// Distances of the depth convention's planes, or the unit of distances, are wrong by a factor.
    DepthPlanes,
    /// Colors are sRGB-encoded.
    ColorEncoded,
    /// The gaze is not where the frame is sharp: another axis, origin or unit.
    Gaze,
    /// The frame is not foveated at all.
    NotFoveated,
    /// The foveation has another filter.
    FoveationFilter,
    /// The foveation's regions have other sizes.
    FoveationRegions,
    /// The foveation has other block edges.
    FoveationRates,
}

/// Outcome of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// The frames agree with the description.
    Fits,
    /// The frames contain too little evidence, for this reason.
    CannotTell(&'static str),
    /// The frames contradict the description.
    Wrong(Fault),
}

/// Result of one check. Displays as one line: outcome, confidence, figures, and what mends a fault.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// What was checked.
    pub check: Check,
    /// What was found.
    pub outcome: Outcome,
    /// Confidence in the outcome, 0 to 1; 0 for [`Outcome::CannotTell`].
    pub confidence: f32,
    /// Figures on which the outcome rests: name and value.
    pub evidence: Vec<(&'static str, f64)>,
    /// Line of Rust (or, if so marked, of the renderer's shader) that mends a fault.
    pub mend: Option<String>,
}

impl Check {
    /// All checks, in the order of the findings.
    pub const ALL: [Self; 6] = [Self::Motion, Self::Jitter, Self::Depth, Self::Color, Self::Gaze, Self::Foveation];

    /// Stable name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Motion => "motion",
            Self::Jitter => "jitter",
            Self::Depth => "depth",
            Self::Color => "color",
            Self::Gaze => "gaze",
            Self::Foveation => "foveation",
        }
    }
}

impl Fault {
    /// Stable name.
    pub fn name(self) -> &'static str {
        match self {
            Self::MotionDirection => "motion-direction",
            Self::MotionYAxis => "motion-y-axis",
            Self::MotionUnit => "motion-unit",
            Self::MotionScale => "motion-scale",
            Self::MotionAxes => "motion-axes",
            Self::MotionCamera => "motion-camera",
            Self::MotionJitter => "motion-jitter",
            Self::DepthConvention => "depth-convention",
            Self::DepthPlanes => "depth-planes",
            Self::ColorEncoded => "color-encoded",
            Self::Gaze => "gaze",
            Self::NotFoveated => "not-foveated",
            Self::FoveationFilter => "foveation-filter",
            Self::FoveationRegions => "foveation-regions",
            Self::FoveationRates => "foveation-rates",
        }
    }
}

impl Finding {
    pub(crate) fn cannot_tell(check: Check, why: &'static str) -> Self {
        Self { check, outcome: Outcome::CannotTell(why), confidence: 0.0, evidence: vec![], mend: None }
    }

    pub(crate) fn fits(check: Check, confidence: f64, evidence: Vec<(&'static str, f64)>) -> Self {
        Self { check, outcome: Outcome::Fits, confidence: confidence as f32, evidence, mend: None }
    }

    pub(crate) fn wrong(
        check: Check,
        fault: Fault,
        confidence: f64,
        evidence: Vec<(&'static str, f64)>,
        mend: String,
    ) -> Self {
        let outcome = Outcome::Wrong(fault);
        Self { check, outcome, confidence: confidence as f32, evidence, mend: Some(mend) }
    }

    /// The fault, if one was found.
    pub fn fault(&self) -> Option<Fault> {
        match self.outcome {
            Outcome::Wrong(fault) => Some(fault),
            _ => None,
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.check.name())?;
        match self.outcome {
            Outcome::Fits => write!(f, "fits")?,
            Outcome::CannotTell(why) => write!(f, "cannot tell: {why}")?,
            Outcome::Wrong(fault) => write!(f, "WRONG ({})", fault.name())?,
        }
        if self.confidence > 0.0 {
            write!(f, ", confidence {:.2}", self.confidence)?;
        }
        let figures: Vec<_> = self.evidence.iter().map(|(name, value)| format!("{name} {value:.3}")).collect();
        if !figures.is_empty() {
            write!(f, " ({})", figures.join(", "))?;
        }
        match &self.mend {
            Some(mend) => write!(f, "; mend: {mend}"),
            None => Ok(()),
        }
    }
}
