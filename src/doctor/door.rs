//! Lines of code that mend faults.

use super::shape::Shape;

/// Types by which the caller describes frames, and which a line of code must name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Door {
    /// `afterimage::levels::Desc`.
    Context,
    /// `afterimage::Desc` and `afterimage::Camera`.
    #[cfg(feature = "gpu")]
    Planned,
}

impl Door {
    /// Line that changes `fields` of the convention of motion vectors.
    pub fn motion(self, fields: &str) -> String {
        match self {
            Self::Context => format!("desc.motion = MotionConvention {{ {fields}, ..desc.motion }};"),
            #[cfg(feature = "gpu")]
            Self::Planned => {
                format!("desc.motion = Some(MotionConvention {{ {fields}, ..desc.motion.unwrap_or_default() }});")
            }
        }
    }

    /// Line that says whether vectors contain the jitter.
    pub fn jittered(self, contained: bool) -> String {
        match self {
            Self::Context => format!("desc.motion.jittered = {contained};"),
            #[cfg(feature = "gpu")]
            Self::Planned => self.motion(&format!("jittered: {contained}")),
        }
    }

    /// Line that sets the convention of depth. `near`: distance of the near plane, if known.
    pub(super) fn depth(self, shape: Shape, near: Option<f64>) -> String {
        match self {
            Self::Context => of_context(shape, near),
            #[cfg(feature = "gpu")]
            Self::Planned => of_planned_frames(shape, near),
        }
    }
}

fn of_context(shape: Shape, near: Option<f64>) -> String {
    let near = near.map_or("YOUR_NEAR_PLANE".to_owned(), |near| format!("{near:.3}"));
    match shape {
        Shape::Linear => "desc.depth = DepthConvention::Linear;".into(),
        Shape::Forward => format!("desc.depth = DepthConvention::Forward {{ near: {near}, far: f32::INFINITY }};"),
        Shape::Reversed => format!("desc.depth = DepthConvention::Reversed {{ near: {near}, far: f32::INFINITY }};"),
    }
}

/// The camera says how the depth buffer of planned frames is drawn.
#[cfg(feature = "gpu")]
fn of_planned_frames(shape: Shape, near: Option<f64>) -> String {
    let plane = near.map_or(String::new(), |near| format!(", with a near plane at {near:.3}"));
    let buffer =
        |kind| format!("desc.has_distances = false; // Camera: the projection that draws depth, {kind}{plane}");
    match shape {
        Shape::Linear => "desc.has_distances = true;".into(),
        Shape::Forward => buffer("1 is far"),
        Shape::Reversed => buffer("1 is near"),
    }
}
