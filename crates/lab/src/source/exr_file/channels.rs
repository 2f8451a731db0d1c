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
    /// Components of the full name except the last, in lower case.
    layer: Vec<String>,
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
        Self { part, index, full_name, layer, leaf, plain: !name.contains('.') }
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
}

impl Roles {
    /// Assigns channels; `None` without color channels.
    pub fn find(channels: &[ChannelName]) -> Option<Self> {
        Some(Self {
            color: find_color(channels)?,
            depth: find_depth(channels),
            motion: find_motion(channels, "vector", VectorForm::Blender)
                .or_else(|| find_motion(channels, "motion", VectorForm::Plain)),
        })
    }
}

fn id(c: &ChannelName) -> ChannelId {
    (c.part, c.index)
}

/// The channel `leaf` of the same part and layer as `of`.
fn sibling(channels: &[ChannelName], of: &ChannelName, leaf: &str) -> Option<ChannelId> {
    channels.iter().find(|c| c.part == of.part && c.layer == of.layer && c.plain == of.plain && c.leaf == leaf).map(id)
}

fn find_color(channels: &[ChannelName]) -> Option<[ChannelId; 3]> {
    let complete = channels.iter().filter(|c| c.leaf == "r").filter_map(|r| {
        let g = sibling(channels, r, "g")?;
        let b = sibling(channels, r, "b")?;
        // A renderer's noisy image is the last choice.
        let noisy = r.layer.iter().any(|l| l.contains("noisy") || l.contains("denois"));
        let rank = (!r.in_layer("combined"), !r.plain, noisy, r.layer.len());
        Some((rank, [id(r), g, b]))
    });
    complete.min_by_key(|&(rank, _)| rank).map(|(_, color)| color).or_else(|| {
        let grey = channels.iter().find(|c| c.plain && c.leaf == "y" && sibling(channels, c, "x").is_none())?;
        Some([id(grey); 3])
    })
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
