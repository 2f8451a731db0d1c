//! How the numbers of motion and depth channels are read: conventions in one string, and those of renderers by name.

use afterimage::kernel::depth::{disparity, distance_of};
use afterimage::{DepthConvention, MotionConvention, MotionDirection, MotionUnit, YAxis};
use std::fmt;
use std::str::FromStr;

/// How motion vectors are stored. From a renderer's name ([`PRESETS`](Self::PRESETS)) or from
/// `UNIT,DIRECTION,YAXIS[,centered][,scale=N]`: `px|uv|ndc`, `to-previous|from-previous`, `up|down`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotionReading {
    /// Unit, direction and vertical axis.
    pub convention: MotionConvention,
    /// Whether 0.5 is no motion, and 0 and 1 are -1 and 1: as files without negative numbers need it.
    pub is_centered: bool,
    /// Factor on the vectors; `None`: 1.
    pub scale: Option<f32>,
}

/// How depth is stored. From a renderer's name ([`PRESETS`](Self::PRESETS)) or from `KIND[,near=D][,far=D][,scale=N]`:
/// `view` (distance along the view axis), `inverse` (1 over it), `forward`, `reversed`, `orthographic`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DepthReading {
    /// Kind of the values.
    pub kind: DepthKind,
    /// Factor on the values; `None`: 1.
    pub scale: Option<f32>,
}

/// Kind of stored depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DepthKind {
    /// A convention of the library.
    Convention(DepthConvention),
    /// 1 over the distance along the view axis; 0 at infinity.
    Inverse,
}

/// Distance along the view axis.
pub(super) const VIEW: DepthKind = DepthKind::Convention(DepthConvention::Linear);

impl Default for DepthKind {
    fn default() -> Self {
        VIEW
    }
}

const fn motion(unit: MotionUnit, direction: MotionDirection, y_axis: YAxis) -> MotionReading {
    let convention = MotionConvention { unit, direction, y_axis, ..MotionConvention::FSR2 };
    MotionReading { convention, is_centered: false, scale: None }
}

use MotionDirection::{CurrentMinusPrevious as FromPrevious, PreviousMinusCurrent as ToPrevious};

impl MotionReading {
    /// The library's own: pixels to the previous frame, y down.
    pub const OWN: Self = motion(MotionUnit::Pixels, ToPrevious, YAxis::Down);
    /// Blender's Vector pass.
    pub const BLENDER: Self = motion(MotionUnit::Pixels, ToPrevious, YAxis::Up);
    /// Pixels that a point has moved, y up: Arnold, V-Ray.
    pub const MOVED_PX: Self = motion(MotionUnit::Pixels, FromPrevious, YAxis::Up);
    /// The material of Unreal's Movie Render Queue.
    pub const UNREAL: Self = Self { is_centered: true, ..motion(MotionUnit::Uv, FromPrevious, YAxis::Up) };

    /// Renderers by name (`docs/renderers.md`).
    pub const PRESETS: [(&'static str, Self); 7] = [
        ("blender", Self::BLENDER),
        ("unreal", Self::UNREAL),
        ("unity", motion(MotionUnit::Uv, FromPrevious, YAxis::Down)),
        ("arnold", Self::MOVED_PX),
        ("karma", motion(MotionUnit::Uv, FromPrevious, YAxis::Up)),
        ("vray", Self::MOVED_PX),
        ("nuke", Self::BLENDER),
    ];

    /// Factor and offset that convert each component to pixels, y down, other frame minus this one.
    pub(super) fn to_px(self, size_px: [u32; 2]) -> [(f32, f32); 2] {
        let scale = self.scale.unwrap_or(1.0);
        self.convention.to_internal(size_px).map(|factor| {
            let factor = factor * scale;
            if self.is_centered { (2.0 * factor, -factor) } else { (factor, 0.0) }
        })
    }

    /// The opposite direction.
    pub(super) fn reversed(self) -> Self {
        let direction = match self.convention.direction {
            ToPrevious => FromPrevious,
            FromPrevious => ToPrevious,
        };
        Self { convention: MotionConvention { direction, ..self.convention }, ..self }
    }
}

impl DepthReading {
    /// The material of Unreal's Movie Render Queue: centimeters.
    pub const UNREAL: Self = Self { kind: VIEW, scale: Some(0.01) };
    /// What Nuke's nodes write: 1 over the distance.
    pub const NUKE: Self = Self { kind: DepthKind::Inverse, scale: None };

    /// Renderers by name (`docs/renderers.md`).
    pub const PRESETS: [(&'static str, Self); 2] = [("unreal", Self::UNREAL), ("nuke", Self::NUKE)];

    /// Distance along the view axis of a stored value; NaN for none.
    pub(super) fn distance(self, stored: f32) -> f32 {
        let value = stored * self.scale.unwrap_or(1.0);
        let distance = match self.kind {
            DepthKind::Convention(DepthConvention::Linear) => value,
            // Infinity for 0, which the far plane of infinite projections has.
            DepthKind::Inverse if value >= 0.0 => 1.0 / value,
            DepthKind::Inverse => f32::NAN,
            DepthKind::Convention(convention) => match disparity(value, convention.disparity_map()) {
                0.0 => f32::INFINITY,
                disparity => distance_of(disparity),
            },
        };
        if distance > 0.0 { distance } else { f32::NAN }
    }
}

impl FromStr for MotionReading {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const FORM: &str = "UNIT,DIRECTION,YAXIS[,centered][,scale=N] with px|uv|ndc, to-previous|from-previous, \
                            up|down (as px,to-previous,up), or";
        let expected = || format!("expected {FORM} {}", names(&Self::PRESETS));
        let mut words = text.split(',').map(str::trim);
        let first = words.next().unwrap_or_default();
        let mut reading = match Self::PRESETS.iter().find(|(name, _)| *name == first) {
            Some((_, preset)) => *preset,
            None => {
                let unit = match first {
                    "px" => MotionUnit::Pixels,
                    "uv" => MotionUnit::Uv,
                    "ndc" => MotionUnit::Ndc,
                    _ => return Err(expected()),
                };
                let direction = match words.next() {
                    Some("to-previous") => ToPrevious,
                    Some("from-previous") => FromPrevious,
                    _ => return Err(expected()),
                };
                let y_axis = match words.next() {
                    Some("up") => YAxis::Up,
                    Some("down") => YAxis::Down,
                    _ => return Err(expected()),
                };
                motion(unit, direction, y_axis)
            }
        };
        for word in words {
            match word.split_once('=') {
                None if word == "centered" => reading.is_centered = true,
                Some(("scale", value)) => reading.scale = Some(parse_scale(value)?),
                _ => return Err(expected()),
            }
        }
        Ok(reading)
    }
}

impl fmt::Display for MotionReading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let MotionConvention { unit, direction, y_axis, .. } = self.convention;
        let unit = match unit {
            MotionUnit::Uv => "uv",
            MotionUnit::Ndc => "ndc",
            _ => "px",
        };
        let direction = match direction {
            ToPrevious => "to-previous",
            FromPrevious => "from-previous",
        };
        let y_axis = match y_axis {
            YAxis::Up => "up",
            YAxis::Down => "down",
        };
        write!(f, "{unit},{direction},{y_axis}")?;
        if self.is_centered {
            write!(f, ",centered")?;
        }
        self.scale.map_or(Ok(()), |scale| write!(f, ",scale={scale}"))
    }
}

impl FromStr for DepthReading {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const FORM: &str = "KIND[,near=D][,far=D][,scale=N] with view, inverse, forward, reversed or orthographic (as \
                            reversed,near=0.1 or view,scale=0.01), or";
        let expected = || format!("expected {FORM} {}", names(&Self::PRESETS));
        let mut words = text.split(',').map(str::trim);
        let kind = words.next().unwrap_or_default();
        let (mut near, mut far, mut scale) = (None, None, None);
        for word in words {
            let (name, value) = word.split_once('=').ok_or_else(expected)?;
            let number = value.parse::<f32>().ok().filter(|v| !v.is_nan()).ok_or_else(expected)?;
            match name {
                "near" => near = Some(number),
                "far" => far = Some(number),
                "scale" => scale = Some(parse_scale(value)?),
                _ => return Err(expected()),
            }
        }
        let planes = || near.ok_or_else(|| format!("{kind} depth needs near=D; {}", expected()));
        let convention = match kind {
            "forward" => DepthConvention::Forward { near: planes()?, far: far.unwrap_or(f32::INFINITY) },
            "reversed" => DepthConvention::Reversed { near: planes()?, far: far.unwrap_or(f32::INFINITY) },
            "orthographic" => DepthConvention::Orthographic { near: planes()?, far: far.unwrap_or(f32::INFINITY) },
            _ if near.or(far).is_some() => return Err(format!("{kind} depth has no planes; {}", expected())),
            "view" => DepthConvention::Linear,
            "inverse" => return Ok(Self { kind: DepthKind::Inverse, scale }),
            _ => {
                let preset = Self::PRESETS.iter().find(|(name, _)| *name == kind).ok_or_else(expected)?.1;
                return Ok(Self { scale: scale.or(preset.scale), ..preset });
            }
        };
        convention.validate().map_err(|e| e.to_string())?;
        Ok(Self { kind: DepthKind::Convention(convention), scale })
    }
}

impl fmt::Display for DepthReading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (kind, planes) = match self.kind {
            DepthKind::Inverse => ("inverse", None),
            DepthKind::Convention(DepthConvention::Forward { near, far }) => ("forward", Some((near, far))),
            DepthKind::Convention(DepthConvention::Reversed { near, far }) => ("reversed", Some((near, far))),
            DepthKind::Convention(DepthConvention::Orthographic { near, far }) => ("orthographic", Some((near, far))),
            DepthKind::Convention(_) => ("view", None),
        };
        write!(f, "{kind}")?;
        if let Some((near, far)) = planes {
            write!(f, ",near={near},far={far}")?;
        }
        self.scale.map_or(Ok(()), |scale| write!(f, ",scale={scale}"))
    }
}

fn names<T>(presets: &[(&str, T)]) -> String {
    presets.iter().map(|(name, _)| *name).collect::<Vec<_>>().join("|")
}

fn parse_scale(text: &str) -> Result<f32, String> {
    let scale = text.parse::<f32>().ok().filter(|scale| scale.is_finite() && *scale != 0.0);
    scale.ok_or_else(|| format!("expected a number other than 0 in scale={text}"))
}
