//! Assigns the channels of a frame's EXR files to color, depth and motion.

use super::layout::{ALBEDO, DEPTH, LEAVES, MOTION, MotionLayout, Name, candidate};
use super::reading::{DepthReading, MotionReading};

/// Channels and conventions that the user names; the others are recognised by their names. Case is ignored.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChannelNames {
    /// Layer of the color, or one channel for grey.
    pub color: Option<String>,
    /// Layer or channel of the depth.
    pub depth: Option<String>,
    /// Layer of the motion vectors to the previous frame (or from it), or their two channels, separated by a comma.
    pub motion: Option<String>,
    /// How the motion vectors are stored.
    pub motion_convention: Option<MotionReading>,
    /// How the depth is stored.
    pub depth_convention: Option<DepthReading>,
    /// Which layer is the albedo.
    pub albedo: AlbedoLayer,
    /// Whether to read motion vectors of an unknown convention in the library's own: to find theirs.
    pub assume_own_convention: bool,
}

/// The layer of the albedo.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum AlbedoLayer {
    /// None is read.
    #[default]
    Skip,
    /// One that its name tells, if there is one.
    Recognised,
    /// One that the user names.
    Named(String),
}

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
        let full_name = part_name.map_or(name.to_owned(), |part_name| below(part_name, name));
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

    fn in_layer(&self, fits: impl Fn(&str) -> bool) -> bool {
        self.layer.last().is_some_and(|l| fits(l))
    }

    /// Whether the user means this channel: by its full name or the end of it from a dot on.
    fn is_called(&self, name: &str) -> bool {
        ends_with_parts(&self.full_name.to_lowercase(), &name.to_lowercase())
    }

    /// Whether the user means this channel's layer.
    fn is_in(&self, layer: &str) -> bool {
        let own = self.full_name.rsplit_once('.').map_or("", |(layer, _)| layer).to_lowercase();
        let layer = layer.to_lowercase();
        ends_with_parts(&own, &layer) || ends_with_parts(&self.layer.join("."), &layer)
    }
}

/// `name` with `prefix` in front, unless it starts with it.
pub(super) fn below(prefix: &str, name: &str) -> String {
    let starts = name.to_lowercase().starts_with(&format!("{}.", prefix.to_lowercase()));
    if prefix.is_empty() || starts || name.eq_ignore_ascii_case(prefix) {
        name.to_owned()
    } else {
        format!("{prefix}.{name}")
    }
}

fn ends_with_parts(name: &str, end: &str) -> bool {
    name.strip_suffix(end).is_some_and(|before| before.is_empty() || before.ends_with('.'))
}

/// Part index and channel index.
pub(super) type ChannelId = (usize, usize);

/// Channels of vectors to another frame, and how they are read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct VectorChannels {
    pub channels: [ChannelId; 2],
    /// Previous stands for the other frame.
    pub reading: MotionReading,
}

/// Motion channels.
#[derive(Clone, Copy, Debug)]
pub(super) struct MotionChannels {
    pub to_previous: VectorChannels,
    pub to_next: Option<VectorChannels>,
    /// How `depth.Z` beside them is read.
    pub depth_beside: DepthReading,
}

/// Channels assigned to each image.
#[derive(Clone, Debug)]
pub(super) struct Roles {
    /// Red, green, blue; three times the same channel for grey.
    pub color: [ChannelId; 3],
    pub depth: Option<(ChannelId, DepthReading)>,
    pub motion: Option<MotionChannels>,
    /// Red, green, blue.
    pub albedo: Option<[ChannelId; 3]>,
    /// Why there is no motion, if a layer may hold it.
    pub unknown_motion: Option<UnknownMotion>,
    /// What was chosen among several, a line each.
    pub warnings: Vec<String>,
}

/// A layer that may hold motion vectors, of a convention that its name does not tell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct UnknownMotion {
    pub layer: String,
    /// The convention to try, if a renderer writes such a name.
    pub preset: Option<&'static str>,
}

/// Why no roles can be assigned.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum NoRoles {
    /// There is no color.
    Color,
    /// The user names this for a role, and no layer or channel of that name fits.
    Named { role: &'static str, name: String },
}

impl Roles {
    /// Assigns channels. Of a stereo picture, the channels of one view are read.
    pub fn find(channels: &[ChannelName], names: &ChannelNames) -> Result<Self, NoRoles> {
        let mut warnings = vec![];
        let (color, view) = match &names.color {
            Some(name) => named_color(channels, name)?,
            None => find_color(channels, &mut warnings).ok_or(NoRoles::Color)?,
        };
        if channels.iter().any(|c| c.view != view) {
            let side = ["left", "right"][usize::from(view)];
            warnings.push(format!("it has two views; the {side} one is read"));
        }
        let of_view: Vec<ChannelName> = channels.iter().filter(|c| c.view == view).cloned().collect();
        let (motion, unknown_motion) = motion_roles(&of_view, names, &mut warnings)?;
        let depth = depth_role(&of_view, names, motion, &mut warnings)?;
        let albedo = albedo_role(&of_view, names, color, &mut warnings)?;
        Ok(Self { color, depth, motion, albedo, unknown_motion, warnings })
    }

    /// Channels that have a role.
    pub fn channels(&self) -> Vec<ChannelId> {
        let vectors = self.motion.iter().flat_map(|m| [Some(m.to_previous), m.to_next]).flatten();
        let depth = self.depth.map(|(id, _)| id);
        let albedo = self.albedo.into_iter().flatten();
        self.color.into_iter().chain(depth).chain(vectors.flat_map(|v| v.channels)).chain(albedo).collect()
    }
}

/// Layers that hold the picture, the best first; the unnamed layer comes after the first.
const PICTURES: &str = "combined beauty finalimage image rgba rgb color colour composite final render main default";
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

/// Red, green and blue of a layer whose red is `r`.
fn rgb_from(channels: &[ChannelName], r: &ChannelName) -> Option<[ChannelId; 3]> {
    let is_red = r.leaf == "r";
    is_red.then(|| Some([id(r), sibling(channels, r, "g")?, sibling(channels, r, "b")?])).flatten()
}

/// The color, and the view of a stereo picture that it belongs to.
fn find_color(channels: &[ChannelName], warnings: &mut Vec<String>) -> Option<([ChannelId; 3], u8)> {
    let complete = channels.iter().filter_map(|r| Some((r, rgb_from(channels, r)?)));
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

/// The color of the layer, or of the channel, that the user names.
fn named_color(channels: &[ChannelName], name: &str) -> Result<([ChannelId; 3], u8), NoRoles> {
    let mut of_layer = channels.iter().filter(|c| c.is_in(name));
    let rgb = of_layer.find_map(|r| Some((rgb_from(channels, r)?, r.view)));
    let grey = || channels.iter().find(|c| c.is_called(name)).map(|c| ([id(c); 3], c.view));
    rgb.or_else(grey).ok_or_else(|| NoRoles::Named { role: "color", name: name.to_owned() })
}

fn depth_role(
    channels: &[ChannelName],
    names: &ChannelNames,
    motion: Option<MotionChannels>,
    warnings: &mut Vec<String>,
) -> Result<Option<(ChannelId, DepthReading)>, NoRoles> {
    let found = match &names.depth {
        Some(name) => {
            let missing = || NoRoles::Named { role: "depth", name: name.clone() };
            Some(named_depth(channels, name).ok_or_else(missing)?)
        }
        None => find_depth(channels),
    };
    let Some((channel, recognised)) = found else { return Ok(None) };
    let beside = motion.map_or_else(DepthReading::default, |motion| motion.depth_beside);
    let reading = names.depth_convention.unwrap_or_else(|| {
        let is_of_motion = beside != DepthReading::default() && channel.in_layer(|own| own == "depth");
        if is_of_motion {
            warnings.push(format!(
                "{} is read as {beside}, which the program that names the motion vectors so writes; if it holds \
                 distances, give `depth_convention`=view",
                channel.full_name
            ));
        }
        if is_of_motion { beside } else { recognised }
    });
    Ok(Some((id(channel), reading)))
}

/// A channel, or the first of z, v, r, x, y of a layer.
fn named_depth<'a>(channels: &'a [ChannelName], name: &str) -> Option<(&'a ChannelName, DepthReading)> {
    let of_layer = |leaf: &&str| channels.iter().find(|c| c.leaf == **leaf && c.is_in(name));
    let channel =
        channels.iter().find(|c| c.is_called(name)).or_else(|| ["z", "v", "r", "x", "y"].iter().find_map(of_layer))?;
    let known = DEPTH.iter().find(|(layer, leaf, _)| channel.leaf == *leaf && channel.in_layer(|own| layer.fits(own)));
    Some((channel, known.map_or_else(DepthReading::default, |(_, _, reading)| *reading)))
}

fn find_depth(channels: &[ChannelName]) -> Option<(&ChannelName, DepthReading)> {
    let known = DEPTH.iter().find_map(|(layer, leaf, reading)| {
        let channel = channels.iter().find(|c| c.leaf == *leaf && c.in_layer(|own| layer.fits(own)))?;
        Some((channel, *reading))
    });
    // A part with vectors or normals has a plain Z too, together with X.
    let plain =
        |c: &&ChannelName| c.plain && (c.leaf == "depth" || c.leaf == "z" && sibling(channels, c, "x").is_none());
    known.or_else(|| channels.iter().find(plain).map(|channel| (channel, DepthReading::default())))
}

/// The albedo. A layer of a known name that lacks a channel is left out, and so is the picture.
fn albedo_role(
    channels: &[ChannelName],
    names: &ChannelNames,
    color: [ChannelId; 3],
    warnings: &mut Vec<String>,
) -> Result<Option<[ChannelId; 3]>, NoRoles> {
    let name = match &names.albedo {
        AlbedoLayer::Skip => return Ok(None),
        AlbedoLayer::Recognised => return Ok(known_albedo(channels, color, warnings)),
        AlbedoLayer::Named(name) => name,
    };
    let found = channels.iter().filter(|c| c.is_in(name)).find_map(|r| rgb_from(channels, r));
    found.map(Some).ok_or_else(|| NoRoles::Named { role: "albedo", name: name.clone() })
}

fn known_albedo(channels: &[ChannelName], color: [ChannelId; 3], warnings: &mut Vec<String>) -> Option<[ChannelId; 3]> {
    let of_layer = |layer: &'static Name| {
        channels.iter().filter(move |c| c.in_layer(|own| layer.fits(own)) && !color.contains(&id(c)))
    };
    let found = ALBEDO.iter().flat_map(of_layer).find_map(|r| rgb_from(channels, r));
    let incomplete = ALBEDO.iter().flat_map(of_layer).find(|c| ["r", "g", "b"].contains(&c.leaf.as_str()));
    if let (None, Some(channel)) = (found, incomplete) {
        let layer = channel.layer_name();
        warnings.push(format!("its albedo {layer} lacks a channel of R, G, B, and is left out"));
    }
    found
}

/// The motion, or a layer that may be it.
type FoundMotion = (Option<MotionChannels>, Option<UnknownMotion>);

fn motion_roles(
    channels: &[ChannelName],
    names: &ChannelNames,
    warnings: &mut Vec<String>,
) -> Result<FoundMotion, NoRoles> {
    let vectors = match &names.motion {
        Some(name) => {
            let missing = || NoRoles::Named { role: "motion", name: name.clone() };
            Some(named_vectors(channels, name).ok_or_else(missing)?)
        }
        None => MOTION.iter().find_map(|layout| known_vectors(channels, layout)).or_else(|| may_be_vectors(channels)),
    };
    let Some(Vectors { first, to_previous, layout, preset }) = vectors else { return Ok((None, None)) };
    let reading = match (names.motion_convention, layout) {
        (Some(reading), _) => reading,
        (None, Some(layout)) => layout.reading,
        (None, None) if names.assume_own_convention => {
            warnings.push(format!(
                "the convention of {} is not known; it is read as {}",
                first.layer_name(),
                MotionReading::OWN
            ));
            MotionReading::OWN
        }
        (None, None) => {
            let layer = first.layer_name().to_owned();
            return Ok((None, Some(UnknownMotion { layer, preset })));
        }
    };
    let motion = MotionChannels {
        to_previous: VectorChannels { channels: to_previous, reading },
        to_next: layout.and_then(|layout| vectors_to_next(channels, first, layout, reading)),
        depth_beside: layout.map_or_else(DepthReading::default, |layout| layout.depth_beside),
    };
    Ok((Some(motion), None))
}

/// Motion vectors that were found by name.
struct Vectors<'a> {
    /// The first of their channels.
    first: &'a ChannelName,
    to_previous: [ChannelId; 2],
    layout: Option<&'static MotionLayout>,
    /// The convention to try where there is no layout.
    preset: Option<&'static str>,
}

impl<'a> Vectors<'a> {
    fn of(channels: &[ChannelName], first: &'a ChannelName, leaves: [&str; 2]) -> Option<Self> {
        let second = (first.leaf == leaves[0]).then(|| sibling(channels, first, leaves[1])).flatten()?;
        let is_laid_out = |l: &&MotionLayout| l.leaves == leaves && first.in_layer(|own| l.layer.fits(own));
        let preset = first.layer.last().and_then(|own| candidate(own)).flatten();
        Some(Self { first, to_previous: [id(first), second], layout: MOTION.iter().find(is_laid_out), preset })
    }
}

/// Vectors of a layer, or of two channels that a comma separates.
fn named_vectors<'a>(channels: &'a [ChannelName], name: &str) -> Option<Vectors<'a>> {
    if let Some((x, y)) = name.split_once(',') {
        let called = |name: &str| channels.iter().find(|c| c.is_called(name.trim()));
        let (first, second) = (called(x)?, called(y)?);
        let pair = Vectors::of(channels, first, [first.leaf.as_str(), second.leaf.as_str()]);
        let of_pair = pair.filter(|pair| pair.to_previous[1] == id(second));
        return of_pair.or(Some(Vectors { first, to_previous: [id(first), id(second)], layout: None, preset: None }));
    }
    let mut of_layer = LEAVES.iter().flat_map(|leaves| channels.iter().map(move |c| (c, leaves)));
    of_layer.find_map(|(c, leaves)| c.is_in(name).then(|| Vectors::of(channels, c, *leaves)).flatten())
}

fn known_vectors<'a>(channels: &'a [ChannelName], layout: &MotionLayout) -> Option<Vectors<'a>> {
    let mut of_layer = channels.iter().filter(|c| c.in_layer(|own| layout.layer.fits(own)));
    of_layer.find_map(|c| Vectors::of(channels, c, layout.leaves))
}

/// Vectors of a layer whose name says that it holds some.
fn may_be_vectors(channels: &[ChannelName]) -> Option<Vectors<'_>> {
    let named = channels.iter().filter(|c| c.in_layer(|own| candidate(own).is_some()));
    named
        .flat_map(|c| LEAVES.iter().map(move |leaves| (c, *leaves)))
        .find_map(|(c, leaves)| Vectors::of(channels, c, leaves))
}

fn vectors_to_next(
    channels: &[ChannelName],
    first: &ChannelName,
    layout: &MotionLayout,
    reading: MotionReading,
) -> Option<VectorChannels> {
    let (layer, leaves, is_from_next) = layout.to_next?;
    let pair = |c: &ChannelName| Some([sibling(channels, c, leaves[0])?, sibling(channels, c, leaves[1])?]);
    let is_named = |c: &&ChannelName| c.in_layer(|own| own == layer);
    let channels = if is_named(&first) { pair(first) } else { channels.iter().filter(is_named).find_map(pair) }?;
    Some(VectorChannels { channels, reading: if is_from_next { reading.reversed() } else { reading } })
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

    fn find(n: &[ChannelName]) -> Result<Roles, NoRoles> {
        Roles::find(n, &ChannelNames::default())
    }

    fn roles(n: &[ChannelName]) -> Roles {
        find(n).unwrap()
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
        assert_eq!(roles(&n).color, [(0, 5), (0, 4), (0, 3)]);
    }

    #[test]
    fn plain_wins_over_a_layer_and_a_clean_layer_over_a_noisy_one() {
        let n = names(&[(None, &["B", "G", "R", "a.B", "a.G", "a.R"])]);
        assert_eq!(roles(&n).color, [(0, 2), (0, 1), (0, 0)]);
        let n = names(&[(None, &["a.Noisy.B", "a.Noisy.G", "a.Noisy.R", "b.c.B", "b.c.G", "b.c.R"])]);
        assert_eq!(roles(&n).color, [(0, 5), (0, 4), (0, 3)]);
    }

    #[test]
    fn parts_count_as_layers() {
        let n = names(&[
            (Some("view.Combined"), &["A", "B", "G", "R"]),
            (Some("view.Vector"), &["W", "X", "Y", "Z"]),
            (Some("view.Depth"), &["Z"]),
        ]);
        let found = roles(&n);
        assert_eq!(found.color, [(0, 3), (0, 2), (0, 1)]);
        assert_eq!(found.depth.map(|d| d.0), Some((2, 0)));
        let motion = found.motion.unwrap();
        assert_eq!(motion.to_previous.channels, [(1, 1), (1, 2)]);
        assert_eq!(motion.to_next.map(|v| v.channels), Some([(1, 3), (1, 0)]));
    }

    #[test]
    fn normals_and_vectors_are_not_depth_and_motion_y_is_not_grey() {
        let n = names(&[(Some("normal"), &["X", "Y", "Z"])]);
        assert!(find_depth(&n).is_none());
        assert_eq!(find(&n).err(), Some(NoRoles::Color));
        let n = names(&[(None, &["motion.X", "motion.Y"])]);
        assert_eq!(find(&n).err(), Some(NoRoles::Color));
        let n = names(&[(None, &["Y", "Z", "motion.X", "motion.Y"])]);
        let found = roles(&n);
        assert_eq!(found.color, [(0, 0); 3]);
        assert_eq!(found.depth.map(|d| d.0), Some((0, 1)));
        assert_eq!(found.motion.unwrap().to_previous.reading, MotionReading::OWN);
    }
}
