//! Assigns the channels of an EXR file to color, depth and motion.

/// Name of a channel, split into its parts.
#[derive(Clone, Debug)]
pub(super) struct ChannelName {
    /// Index of the part.
    pub part: usize,
    /// Index in the part's channel list.
    pub index: usize,
    /// Full name for messages: prefixed with the part's name, unless the channel's name starts with it.
    pub full_name: String,
    /// Components of the full name except the last and a stereo view, in lower case.
    layer: Vec<String>,
    /// View of a stereo picture: left (or the only one) 0, right 1.
    view: u8,
    /// Last component, in lower case.
    leaf: String,
    /// Whether the channel's own name has no layer prefix.
    plain: bool,
}

impl ChannelName {
    pub fn new(part: usize, part_name: Option<&str>, index: usize, name: &str) -> Self {
        let full_name = match part_name {
            Some(p) if !p.is_empty() && !name.starts_with(&format!("{p}.")) => {
                format!("{p}.{name}")
            }
            _ => name.to_owned(),
        };
        let mut layer: Vec<String> = full_name.to_lowercase().split('.').map(str::to_owned).collect();
        let leaf = layer.pop().unwrap_or_default();
        let view = match layer.last().map(String::as_str) {
            Some("left") => Some(0),
            Some("right") => Some(1),
            _ => None,
        };
        layer.truncate(layer.len() - usize::from(view.is_some()));
        Self { part, index, full_name, layer, view: view.unwrap_or(0), leaf, plain: !name.contains('.') }
    }

    /// Name of the layer for messages.
    fn layer_name(&self) -> &str {
        self.full_name.rsplit_once('.').map_or("the unnamed layer", |(layer, _)| layer)
    }

    fn in_layer(&self, last: &str) -> bool {
        self.layer.last().is_some_and(|l| l == last)
    }
}

/// Part index and channel index.
pub(super) type ChannelId = (usize, usize);

/// Naming and sign convention of the vectors in a file (table in [`super`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum VectorForm {
    /// `Vector.X/Y/Z/W`.
    Blender,
    /// `motion.X/Y/Z/W`.
    Plain,
}

/// Motion channels.
#[derive(Clone, Copy, Debug)]
pub(super) struct MotionChannels {
    pub form: VectorForm,
    pub to_previous: [ChannelId; 2],
    pub to_next: Option<[ChannelId; 2]>,
}

/// Channels assigned to each image.
#[derive(Clone, Debug)]
pub(super) struct Roles {
    /// Red, green, blue; three times the same channel for grey.
    pub color: [ChannelId; 3],
    pub depth: Option<ChannelId>,
    pub motion: Option<MotionChannels>,
    /// What was chosen among several, a line each.
    pub warnings: Vec<String>,
}

impl Roles {
    /// Assigns channels; `None` without color channels. Of a stereo picture, the channels of one view are read.
    pub fn find(channels: &[ChannelName]) -> Option<Self> {
        let mut warnings = vec![];
        let (color, view) = find_color(channels, &mut warnings)?;
        if channels.iter().any(|c| c.view != view) {
            let side = ["left", "right"][usize::from(view)];
            warnings.push(format!("it has two views; the {side} one is read"));
        }
        let of_view: Vec<ChannelName> = channels.iter().filter(|c| c.view == view).cloned().collect();
        Some(Self {
            color,
            depth: find_depth(&of_view),
            motion: find_motion(&of_view, "vector", VectorForm::Blender)
                .or_else(|| find_motion(&of_view, "motion", VectorForm::Plain)),
            warnings,
        })
    }

    /// Channels that have a role.
    pub fn channels(&self) -> Vec<ChannelId> {
        let motion = self.motion.iter().flat_map(|m| m.to_previous.into_iter().chain(m.to_next.into_iter().flatten()));
        self.color.into_iter().chain(self.depth).chain(motion).collect()
    }
}

/// Layers that hold the picture, the best first; the unnamed layer comes after the first.
const PICTURES: &str = "combined beauty image rgba rgb color colour composite final render main default";
/// Parts of names of layers that hold something else.
const OTHERS: &str = "albedo ambient ao bounce coat crypto depth diff direct emission emit env filter gi gloss id \
    index light mask matte mist motion normal object occlusion pos reflect refract shadow sheen spec sss subsurface \
    trans uv variance vol";

/// How well a layer's name fits the picture; less is better. Layers of the same rank are not told apart.
fn color_rank(c: &ChannelName) -> usize {
    // A renderer's noisy image is the last choice.
    if c.layer.iter().any(|l| l.contains("noisy") || l.contains("denois")) {
        return 100;
    }
    let Some(last) = c.layer.last() else { return 1 };
    if let Some(place) = PICTURES.split(' ').position(|name| name == last) {
        return if place == 0 { 0 } else { 1 + place };
    }
    let words = last.split(|c: char| !c.is_ascii_alphabetic());
    // Short names are whole words: "ao" is not a part of "chaos".
    let is_other = OTHERS.split(' ').any(|other| match other.len() {
        ..=3 => words.clone().any(|word| word == other),
        _ => last.contains(other),
    });
    if is_other { 50 } else { 30 }
}

fn id(c: &ChannelName) -> ChannelId {
    (c.part, c.index)
}

/// The channel `leaf` of the same part and layer as `of`.
fn sibling(channels: &[ChannelName], of: &ChannelName, leaf: &str) -> Option<ChannelId> {
    channels
        .iter()
        .find(|c| {
            c.part == of.part && c.layer == of.layer && c.view == of.view && c.plain == of.plain && c.leaf == leaf
        })
        .map(id)
}

/// The color, and the view of a stereo picture that it belongs to.
fn find_color(channels: &[ChannelName], warnings: &mut Vec<String>) -> Option<([ChannelId; 3], u8)> {
    let complete = channels.iter().filter(|c| c.leaf == "r").filter_map(|r| {
        let g = sibling(channels, r, "g")?;
        let b = sibling(channels, r, "b")?;
        Some((r, [id(r), g, b]))
    });
    let complete: Vec<_> = complete.collect();
    let best = complete.iter().min_by_key(|(r, _)| (color_rank(r), r.view, !r.plain, r.layer.len()));
    if let Some((best, color)) = best {
        let rank = color_rank(best);
        let rivals = complete.iter().filter(|(r, _)| color_rank(r) == rank && r.view == best.view);
        let names: Vec<&str> = rivals.map(|(r, _)| r.layer_name()).take(4).collect();
        if names.len() > 1 {
            let read = best.layer_name();
            warnings.push(format!("several layers may be the picture ({}); {read} is read", names.join(", ")));
        } else if rank >= 50 {
            warnings.push(format!("no layer is named as the picture; {} is read", best.layer_name()));
        }
        return Some((*color, best.view));
    }
    let grey = channels.iter().find(|c| c.plain && c.leaf == "y" && sibling(channels, c, "x").is_none())?;
    Some(([id(grey); 3], grey.view))
}

fn find_depth(channels: &[ChannelName]) -> Option<ChannelId> {
    let named = |c: &&ChannelName| c.in_layer("depth") && (c.leaf == "z" || c.leaf == "v");
    // A part with vectors or normals has a plain Z too, together with X.
    let plain =
        |c: &&ChannelName| c.plain && (c.leaf == "depth" || c.leaf == "z" && sibling(channels, c, "x").is_none());
    let found = channels.iter().find(named).or_else(|| channels.iter().find(plain));
    found.map(id)
}

fn find_motion(channels: &[ChannelName], layer: &str, form: VectorForm) -> Option<MotionChannels> {
    channels.iter().filter(|c| c.leaf == "x" && c.in_layer(layer)).find_map(|x| {
        let y = sibling(channels, x, "y")?;
        let z = sibling(channels, x, "z");
        let w = sibling(channels, x, "w");
        Some(MotionChannels { form, to_previous: [id(x), y], to_next: z.zip(w).map(|(z, w)| [z, w]) })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(parts: &[(Option<&str>, &[&str])]) -> Vec<ChannelName> {
        let part = |(p, (name, channels)): (usize, &(Option<&str>, &[&str]))| {
            let name = *name;
            let named = channels.iter().enumerate();
            named.map(|(i, c)| ChannelName::new(p, name, i, c)).collect::<Vec<_>>()
        };
        parts.iter().enumerate().flat_map(part).collect()
    }

    #[test]
    fn combined_wins_over_every_other_color() {
        let n = names(&[(
            None,
            &[
                "B",
                "G",
                "R",
                "ViewLayer.Combined.B",
                "ViewLayer.Combined.G",
                "ViewLayer.Combined.R",
                "ViewLayer.Noisy Image.B",
                "ViewLayer.Noisy Image.G",
                "ViewLayer.Noisy Image.R",
            ],
        )]);
        assert_eq!(Roles::find(&n).unwrap().color, [(0, 5), (0, 4), (0, 3)]);
    }

    #[test]
    fn plain_wins_over_a_layer_and_a_clean_layer_over_a_noisy_one() {
        let n = names(&[(None, &["B", "G", "R", "a.B", "a.G", "a.R"])]);
        assert_eq!(Roles::find(&n).unwrap().color, [(0, 2), (0, 1), (0, 0)]);
        let n = names(&[(None, &["a.Noisy.B", "a.Noisy.G", "a.Noisy.R", "b.c.B", "b.c.G", "b.c.R"])]);
        assert_eq!(Roles::find(&n).unwrap().color, [(0, 5), (0, 4), (0, 3)]);
    }

    #[test]
    fn parts_count_as_layers() {
        let n = names(&[
            (Some("view.Combined"), &["A", "B", "G", "R"]),
            (Some("view.Vector"), &["W", "X", "Y", "Z"]),
            (Some("view.Depth"), &["Z"]),
        ]);
        let roles = Roles::find(&n).unwrap();
        assert_eq!(roles.color, [(0, 3), (0, 2), (0, 1)]);
        assert_eq!(roles.depth, Some((2, 0)));
        let motion = roles.motion.unwrap();
        assert_eq!(motion.to_previous, [(1, 1), (1, 2)]);
        assert_eq!(motion.to_next, Some([(1, 3), (1, 0)]));
    }

    #[test]
    fn normals_and_vectors_are_not_depth_and_motion_y_is_not_grey() {
        let n = names(&[(Some("normal"), &["X", "Y", "Z"])]);
        assert!(find_depth(&n).is_none());
        assert!(Roles::find(&n).is_none());
        let n = names(&[(None, &["motion.X", "motion.Y"])]);
        assert!(Roles::find(&n).is_none());
        let n = names(&[(None, &["Y", "Z", "motion.X", "motion.Y"])]);
        let roles = Roles::find(&n).unwrap();
        assert_eq!(roles.color, [(0, 0); 3]);
        assert_eq!(roles.depth, Some((0, 1)));
        assert_eq!(roles.motion.unwrap().form, VectorForm::Plain);
    }
}
