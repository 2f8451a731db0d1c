//! Layouts of renderers: which channels are motion vectors and depth, and how they are read (`docs/renderers.md`).

use super::reading::{DepthReading, MotionReading, VIEW};

/// Motion vectors that a layer's name and its channels tell for sure.
pub(super) struct MotionLayout {
    /// Last part of the layer's name, in lower case.
    pub layer: Name,
    /// Channels of the vectors to the previous frame, in lower case.
    pub leaves: [&'static str; 2],
    pub reading: MotionReading,
    /// Layer and channels of the vectors to the next frame, read in the same unit and with the same y axis; and
    /// whether they are this frame minus the next one instead of next minus this.
    pub to_next: Option<(&'static str, [&'static str; 2], bool)>,
    /// How the program that writes this layout stores `depth.Z`.
    pub depth_beside: DepthReading,
}

/// How a layer is recognised.
#[derive(Clone, Copy)]
pub(super) enum Name {
    Is(&'static str),
    /// Movie Render Queue puts the name of the pass in front.
    EndsWith(&'static str),
}

/// Layers of albedo, in lower case; the first that a file has is read. The sum of diffuse and specular albedo comes
/// before the diffuse one.
pub(super) const ALBEDO: [Name; 6] = [
    Name::Is("denoising albedo"),
    Name::Is("albedo"),
    Name::Is("diffuse_albedo"),
    Name::Is("diffusefilter"),
    Name::Is("vraydiffusefilter"),
    Name::Is("diffcol"),
];

impl Name {
    pub fn fits(self, layer: &str) -> bool {
        match self {
            Self::Is(name) => layer == name,
            Self::EndsWith(name) => layer.ends_with(name),
        }
    }
}

/// Distance along the view axis.
const DISTANCE: DepthReading = DepthReading { kind: VIEW, scale: None };

/// The first that a file has is read.
pub(super) const MOTION: [MotionLayout; 5] = [
    MotionLayout {
        layer: Name::Is("vector"),
        leaves: ["x", "y"],
        reading: MotionReading::BLENDER,
        to_next: Some(("vector", ["z", "w"], true)),
        depth_beside: DISTANCE,
    },
    MotionLayout {
        layer: Name::Is("motion"),
        leaves: ["x", "y"],
        reading: MotionReading::OWN,
        to_next: Some(("motion", ["z", "w"], false)),
        depth_beside: DISTANCE,
    },
    MotionLayout {
        layer: Name::EndsWith("movierenderqueue_motionvectors"),
        leaves: ["r", "g"],
        reading: MotionReading::UNREAL,
        to_next: None,
        depth_beside: DISTANCE,
    },
    MotionLayout {
        layer: Name::Is("motionvector"),
        leaves: ["r", "g"],
        reading: MotionReading::MOVED_PX,
        to_next: None,
        depth_beside: DISTANCE,
    },
    MotionLayout {
        layer: Name::Is("backward"),
        leaves: ["u", "v"],
        reading: MotionReading::BLENDER,
        to_next: Some(("forward", ["u", "v"], false)),
        depth_beside: DepthReading::NUKE,
    },
];

/// Channels that hold vectors, in the order in which a layer is searched.
pub(super) const LEAVES: [[&str; 2]; 3] = [["x", "y"], ["u", "v"], ["r", "g"]];

/// Parts of the names of layers that may hold motion vectors, and the renderer that writes such a name; the first that
/// fits counts. Their conventions are not sure.
const CANDIDATES: [(&str, Option<&str>); 6] = [
    ("motionvectors", Some("unity")),
    ("velocity", Some("vray")),
    ("motion", None),
    ("forward", None),
    ("flow", None),
    ("vector", None),
];

/// Whether a layer of this name may hold motion vectors, and the preset to try.
pub(super) fn candidate(layer: &str) -> Option<Option<&'static str>> {
    CANDIDATES.iter().find(|(part, _)| layer.contains(part)).map(|(_, preset)| *preset)
}

/// Depth that a layer's name and its channels tell for sure; the first that a file has is read.
pub(super) const DEPTH: [(Name, &str, DepthReading); 3] = [
    (Name::Is("depth"), "z", DISTANCE),
    (Name::Is("depth"), "v", DISTANCE),
    (Name::EndsWith("movierenderqueue_worlddepth"), "r", DepthReading::UNREAL),
];
