//! The header of an EXR file, and the checks that need no pixel: size, channels, and completeness of the file.

use super::channels::{AlbedoLayer, ChannelName, ChannelNames, NoRoles, Roles, below};
use super::color_space::ColorSpace;
use super::reading::{DepthReading, MotionReading};
use super::{exr_error, guarded};
use crate::error::{InputError, io_error};
use crate::source::limits::{BLOCK_BYTES_PER_PIXEL, ReadLimits};
use exr::math::Vec2;
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Selects the motion vectors to read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vectors {
    /// None.
    Skip,
    /// Position of each point in the frame with the lower number, minus its position in this one.
    ToPrevious,
    /// Position of each point in the frame with the higher number, minus its position in this one.
    ToNext,
}

/// The checked headers of a frame's EXR files: the frame can be decoded unless its compressed data is damaged. Passes
/// in files of their own are one frame.
#[derive(Debug)]
pub struct ExrHeader {
    pub(super) subject: String,
    pub(super) size: [u32; 2],
    /// Where the frame lies in what is stored.
    pub(super) window: Window,
    pub(super) files: Vec<ExrFile>,
    pub(super) roles: Roles,
    pub(super) color_space: ColorSpace,
    channel_names: Vec<String>,
    warnings: Vec<String>,
    contents: Vec<String>,
}

/// One file of a frame.
#[derive(Debug)]
pub(super) struct ExrFile {
    pub path: PathBuf,
    pub subject: String,
    pub meta: MetaData,
    /// Number of the file's first part among those of all files.
    pub first_part: usize,
    /// File offsets of the full-resolution chunks of each part, row by row; empty for a file of which nothing is read.
    pub chunk_offsets: Vec<Vec<u64>>,
    /// y coordinate of each part's first scan line in the file.
    pub first_lines: Vec<i32>,
    pub file_bytes: u64,
}

/// A file of a frame: the name of its pass, which stands in front of its channels' names, and its path.
#[derive(Clone, Copy, Debug)]
pub struct PassFile<'a> {
    /// Name of the pass; empty where one file has the whole frame.
    pub pass: &'a str,
    /// Path.
    pub path: &'a Path,
}

/// The stored pixels (data window) beside those of the frame (display window).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Window {
    /// Width and height of what is stored.
    pub stored_px: [u32; 2],
    /// The frame's first pixel in what is stored.
    pub first_px: [i64; 2],
}

impl ExrHeader {
    /// Reads and checks the header of `path`, whose channels are recognised by their names: [`open_passes`] of one
    /// file.
    ///
    /// # Errors
    /// As of [`open_passes`].
    ///
    /// [`open_passes`]: Self::open_passes
    pub fn open(path: &Path, limits: &ReadLimits) -> Result<Self, InputError> {
        Self::open_passes(&[PassFile { pass: "", path }], limits, &ChannelNames::default())
    }

    /// Reads and checks the headers of a frame's files. Memory is proportional to the headers' actual bytes, regardless
    /// of the sizes that they claim.
    ///
    /// # Errors
    /// - [`Io`](InputError::Io): a file is missing or cannot be read.
    /// - [`Invalid`](InputError::Invalid): one is not EXR, or truncated; there is no color, or no channel that `names`
    ///   names.
    /// - [`NotSupported`](InputError::NotSupported): one is subsampled, deep, has parts of different sizes, or nothing
    ///   of its display window.
    /// - [`Limit`](InputError::Limit): the image, or one block of it, is larger than `limits` allows.
    pub fn open_passes(passes: &[PassFile], limits: &ReadLimits, names: &ChannelNames) -> Result<Self, InputError> {
        let subject = passes.first().map_or(String::new(), |pass| pass.path.display().to_string());
        guarded(&subject, || Self::open_unguarded(passes, &subject, limits, names))
    }

    fn open_unguarded(
        passes: &[PassFile],
        subject: &str,
        limits: &ReadLimits,
        names: &ChannelNames,
    ) -> Result<Self, InputError> {
        let (mut opened, mut channels, mut first_part) = (vec![], vec![], 0);
        for pass in passes {
            let file = OpenedFile::open(pass.path, first_part)?;
            channels.extend(channel_names(&file.file.meta, pass.pass, first_part));
            first_part += file.file.meta.headers.len();
            opened.push(file);
        }
        let full_names: Vec<String> = channels.iter().map(|n| n.full_name.clone()).collect();
        let mut roles = Roles::find(&channels, names).map_err(|missing| match missing {
            NoRoles::Color => missing_color(subject, &full_names),
            NoRoles::Named { role, name } => missing_channel(subject, role, &name, &full_names),
        })?;
        let headers: Vec<(&str, &Header)> = opened.iter().flat_map(|f| f.file.headers()).collect();
        if names.albedo == AlbedoLayer::Recognised {
            leave_out_albedo_of_another_size(&headers, &mut roles);
        }
        let (size, window) = checked_size(subject, &headers, &roles, limits)?;
        let color_space = match roles.color {
            // Grey has no primaries.
            [r, g, b] if r == g && g == b => ColorSpace::default(),
            [(part, _), ..] => ColorSpace::of(headers[part].1),
        };
        let aspect = pixel_aspect_warning(headers[roles.color[0].0].1);
        let further = [window.warning(size), color_space.warning.clone(), aspect];
        let warnings = roles.warnings.iter().cloned().chain(further.into_iter().flatten()).collect();
        let used = used_parts(&roles);
        let files = opened.into_iter().map(|file| file.checked(&used)).collect::<Result<_, _>>()?;
        Ok(Self {
            subject: subject.to_owned(),
            size,
            window,
            files,
            contents: contents(&channels, &roles),
            warnings,
            roles,
            color_space,
            channel_names: full_names,
        })
    }

    /// Path of the frame's first file, for messages.
    pub(crate) fn subject(&self) -> &str {
        &self.subject
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Names of all channels, in file order.
    pub fn channel_names(&self) -> &[String] {
        &self.channel_names
    }

    /// What was chosen among several layers or views, or cut to the frame, a line each.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Which channels are read, and which are left out, a line each.
    pub fn contents(&self) -> &[String] {
        &self.contents
    }

    /// Frames per second, if a part states them (`framesPerSecond`).
    pub fn fps(&self) -> Option<f32> {
        let mut headers = self.files.iter().flat_map(|file| &file.meta.headers);
        let stated = headers.find_map(|header| header.own_attributes.frames_per_second)?;
        let fps = (f64::from(stated.0) / f64::from(stated.1)) as f32;
        (0.1..=10_000.0).contains(&fps).then_some(fps)
    }

    /// Whether there is a depth channel.
    pub fn has_depth(&self) -> bool {
        self.roles.depth.is_some()
    }

    /// Whether there is an albedo.
    pub fn has_albedo(&self) -> bool {
        self.roles.albedo.is_some()
    }

    /// The files from which channels are read, by their place among the given ones.
    pub(crate) fn used_files(&self) -> Vec<usize> {
        (0..self.files.len()).filter(|&file| !self.files[file].chunk_offsets.is_empty()).collect()
    }

    /// How motion vectors are stored, if there are any.
    pub fn motion_reading(&self) -> Option<MotionReading> {
        self.roles.motion.map(|motion| motion.to_previous.reading)
    }

    /// How depth is stored, if there is any.
    pub fn depth_reading(&self) -> Option<DepthReading> {
        self.roles.depth.map(|(_, reading)| reading)
    }

    /// The error of a sequence without motion vectors, which says what the file has and how to read it. `input` is what
    /// the user gave.
    pub(crate) fn without_motion(&self, input: &str) -> InputError {
        if let Some(unknown) = &self.roles.unknown_motion {
            let layer = crate::error::one_line(&unknown.layer);
            let quoted = if layer.contains(' ') { format!("'{layer}'") } else { layer.clone() };
            let convention = unknown.preset.unwrap_or("UNIT,DIRECTION,YAXIS");
            return InputError::invalid(
                &self.subject,
                format!("its channels {layer} may be motion vectors, of a convention that their name does not tell"),
                format!(
                    "find it with `info` {input} `motion`={quoted}, and name it: `motion`={quoted} \
                     `motion_convention`={convention}"
                ),
            );
        }
        InputError::invalid(
            &self.subject,
            format!(
                "has no motion vectors, which reprojection of a sequence needs; it has {}",
                listed(&self.channel_names)
            ),
            "expected <layer>.Vector.X/Y (Blender: enable the Vector pass), motion.X/Y or another renderer's \
             (docs/renderers.md); name them with `motion`, or give one frame as a still",
        )
    }

    /// Whether the file has these vectors.
    pub fn has(&self, vectors: Vectors) -> bool {
        let motion = self.roles.motion.as_ref();
        match vectors {
            Vectors::Skip => true,
            Vectors::ToPrevious => motion.is_some(),
            Vectors::ToNext => motion.is_some_and(|m| m.to_next.is_some()),
        }
    }
}

impl ExrFile {
    /// The parts, with the file's name for messages.
    fn headers(&self) -> impl Iterator<Item = (&str, &Header)> {
        self.meta.headers.iter().map(|header| (self.subject.as_str(), header))
    }
}

/// A file whose header is read and not yet checked.
struct OpenedFile {
    file: ExrFile,
    reader: Counting<BufReader<File>>,
    header_end: u64,
}

impl OpenedFile {
    fn open(path: &Path, first_part: usize) -> Result<Self, InputError> {
        let subject = path.display().to_string();
        let io = |e: std::io::Error| io_error(&subject, &e);
        let file = File::open(path).map_err(io)?;
        let file_bytes = file.metadata().map_err(io)?.len();
        if file_bytes == 0 {
            return Err(InputError::invalid(subject, "is empty", "copy or export it again"));
        }
        let mut reader = Counting::new(BufReader::new(file));
        let read = MetaData::read_from_buffered(&mut reader, false);
        let meta = read.map_err(|e| unknown_compression(&subject, path).unwrap_or_else(|| exr_error(&subject, e)))?;
        let header_end = reader.position;
        let (chunk_offsets, first_lines) = (vec![], vec![]);
        let path = path.to_owned();
        let file = ExrFile { path, subject, meta, first_part, chunk_offsets, first_lines, file_bytes };
        Ok(Self { file, reader, header_end })
    }

    /// The file with its tables, if some of the parts `used` are its.
    fn checked(mut self, used: &[usize]) -> Result<ExrFile, InputError> {
        let ExrFile { subject, meta, first_part, file_bytes, .. } = &self.file;
        if !used.iter().any(|part| (*first_part..first_part + meta.headers.len()).contains(part)) {
            return Ok(self.file);
        }
        MetaData::validate(&meta.headers, false).map_err(|e| exr_error(subject, e))?;
        let tables = read_tables(&mut self.reader, subject, meta, self.header_end, *file_bytes)?;
        let mut file = self.file;
        file.chunk_offsets = tables;
        file.first_lines = file.meta.headers.iter().map(|h| h.own_attributes.layer_position.1).collect();
        for header in &mut file.meta.headers {
            // Block coordinates are then relative to the corner of the data window.
            header.own_attributes.layer_position = Vec2(0, 0);
        }
        Ok(file)
    }
}

/// Names of a file's channels, below the name of its pass.
fn channel_names(meta: &MetaData, pass: &str, first_part: usize) -> Vec<ChannelName> {
    let mut names = Vec::new();
    for (part, header) in meta.headers.iter().enumerate() {
        // The name of a single part carries no meaning: some writers put the file's name there.
        let several = meta.headers.len() > 1;
        let part_name = header.own_attributes.layer_name.as_ref();
        let part_name = part_name.filter(|_| several).map_or(String::new(), |n| n.to_string());
        let part_name = if part_name.is_empty() { pass.to_owned() } else { below(pass, &part_name) };
        for (index, channel) in header.channels.list.iter().enumerate() {
            let name = channel.name.to_string();
            names.push(ChannelName::new(first_part + part, Some(&part_name), index, &name));
        }
    }
    names
}

/// The error for a compression newer than the `exr` crate, which says only that a header is invalid.
fn unknown_compression(subject: &str, path: &Path) -> Option<InputError> {
    /// Bytes in which the header of the first part has it: attributes may be long, but are not all of it.
    const LOOKED_AT: u64 = 1 << 20;
    const ATTRIBUTE: &[u8] = b"compression\0compression\0\x01\0\0\0";
    const KNOWN: u8 = 11;
    let mut bytes = Vec::new();
    File::open(path).ok()?.take(LOOKED_AT).read_to_end(&mut bytes).ok()?;
    let at = bytes.windows(ATTRIBUTE.len()).position(|window| window == ATTRIBUTE)?;
    let code = bytes.get(at + ATTRIBUTE.len()).filter(|code| **code > KNOWN)?;
    Some(InputError::not_supported(
        subject,
        format!("uses a compression that is not supported (number {code}; ZSTD and others are newer than 11)"),
        "write it with ZIP compression",
    ))
}

/// What to say of pixels that are not square: motion and angles are computed as if they were.
fn pixel_aspect_warning(header: &Header) -> Option<String> {
    const SQUARE: f32 = 0.005;
    let aspect = header.shared_attributes.pixel_aspect;
    ((aspect - 1.0).abs() > SQUARE).then(|| {
        format!(
            "its pixels are {aspect} times as wide as high (pixelAspectRatio), and are taken for square; scale the frames \
             to square pixels, or render them so"
        )
    })
}

/// The channels of a frame, for messages.
fn listed(names: &[String]) -> String {
    const LISTED: usize = 40;
    let mut list = names.iter().take(LISTED).cloned().collect::<Vec<_>>().join(", ");
    if names.len() > LISTED {
        list += &format!(" and {} more", names.len() - LISTED);
    }
    crate::error::one_line(&list)
}

fn missing_color(subject: &str, names: &[String]) -> InputError {
    InputError::invalid(
        subject,
        format!("has no color channels; it has {}", listed(names)),
        "expected <layer>.Combined.R/G/B, R/G/B, <layer>.R/G/B or Y; name another layer or channel with `color`",
    )
}

fn missing_channel(subject: &str, role: &str, name: &str, names: &[String]) -> InputError {
    let name = crate::error::one_line(name);
    let expected = match role {
        "motion" => "a layer with X/Y, U/V or R/G, or two channels as a.x,a.y",
        "color" => "a layer with R/G/B, or one channel",
        "albedo" => "a layer with R/G/B",
        _ => "a channel or a layer",
    };
    let problem = format!("has no {name} for the {role}; it has {}", listed(names));
    InputError::invalid(subject, problem, format!("expected {expected} for `{role}`"))
}

/// Leaves out an albedo that nobody named, and that has not the pixels of the color.
fn leave_out_albedo_of_another_size(headers: &[(&str, &Header)], roles: &mut Roles) {
    let window = |part: usize| (headers[part].1.layer_size, headers[part].1.own_attributes.layer_position);
    let own = window(roles.color[0].0);
    if let Some((part, _)) = roles.albedo.into_iter().flatten().find(|id| window(id.0) != own) {
        let [found, expected] = [window(part).0, own.0].map(|Vec2(w, h)| format!("{w}x{h}"));
        roles.albedo = None;
        roles.warnings.push(format!("its albedo has {found} pixels, not the color's {expected}, and is left out"));
    }
}

/// Checks every part in use, and returns the frame's size, and where it lies in what all of them store. `headers` are
/// the parts of all files, with their files' names.
fn checked_size(
    subject: &str,
    headers: &[(&str, &Header)],
    roles: &Roles,
    limits: &ReadLimits,
) -> Result<([u32; 2], Window), InputError> {
    let mut found = None;
    for part in used_parts(roles) {
        let (subject, header) = headers[part];
        let Vec2(w, h) = header.layer_size;
        let stored_px = limits.check(subject, w as u64, h as u64)?;
        let this = frame_window(subject, header, stored_px, limits)?;
        check_blocks(subject, header, limits)?;
        if *found.get_or_insert(this) != this {
            return Err(InputError::not_supported(
                subject,
                "has parts of different sizes",
                "expected color, depth, motion and albedo of one size; export them again",
            ));
        }
    }
    found.ok_or_else(|| missing_color(subject, &[]))
}

/// Parts with an assigned channel, in file order.
pub(super) fn used_parts(roles: &Roles) -> Vec<usize> {
    let mut parts: Vec<usize> = roles.channels().into_iter().map(|id| id.0).collect();
    parts.sort_unstable();
    parts.dedup();
    parts
}

/// Size of the frame, which is the display window, and where it lies in the data window.
fn frame_window(
    subject: &str,
    header: &Header,
    stored_px: [u32; 2],
    limits: &ReadLimits,
) -> Result<([u32; 2], Window), InputError> {
    let data = header.data_window();
    let display = header.shared_attributes.display_window;
    let size = limits.check(subject, display.size.0 as u64, display.size.1 as u64)?;
    let first = |display: i32, data: i32| i64::from(display) - i64::from(data);
    let first_px = [first(display.position.0, data.position.0), first(display.position.1, data.position.1)];
    let overlaps = |i: usize| first_px[i] < i64::from(stored_px[i]) && first_px[i] + i64::from(size[i]) > 0;
    if !(overlaps(0) && overlaps(1)) {
        return Err(InputError::not_supported(
            subject,
            "its data window lies beside its display window",
            "expected pixels of the frame; export it again",
        ));
    }
    Ok((size, Window { stored_px, first_px }))
}

impl Window {
    /// The stored pixel of a pixel of the frame; `None` if it is not stored.
    pub fn stored(&self, px: [u32; 2]) -> Option<usize> {
        let at = [0, 1].map(|i| i64::from(px[i]) + self.first_px[i]);
        let is_inside = (0..2).all(|i| (0..i64::from(self.stored_px[i])).contains(&at[i]));
        is_inside.then(|| at[1] as usize * self.stored_px[0] as usize + at[0] as usize)
    }

    /// Whether the frame is all that is stored.
    pub fn is_whole(&self, size: [u32; 2]) -> bool {
        self.first_px == [0; 2] && self.stored_px == size
    }

    fn warning(&self, size: [u32; 2]) -> Option<String> {
        let lacks = self.stored([0, 0]).is_none() || self.stored(size.map(|v| v - 1)).is_none();
        let [w, h] = self.stored_px;
        match (self.is_whole(size), lacks) {
            (true, _) => None,
            (_, true) => Some(format!("it stores {w}x{h} of {}x{} pixels; the others are black", size[0], size[1])),
            (_, false) => Some(format!("its overscan ({w}x{h} pixels are stored) is cut off")),
        }
    }
}

/// Which channels are read and which are left out.
fn contents(names: &[ChannelName], roles: &Roles) -> Vec<String> {
    const LISTED: usize = 24;
    let read = roles.channels();
    let list = |is_read: bool| {
        let wanted: Vec<&str> = names
            .iter()
            .filter(|name| read.contains(&(name.part, name.index)) == is_read)
            .map(|name| name.full_name.as_str())
            .collect();
        let more = wanted.len().saturating_sub(LISTED);
        let listed = crate::error::one_line(&wanted[..wanted.len() - more].join(", "));
        if more > 0 { format!("{listed} and {more} more") } else { listed }
    };
    let line = |what: &str, list: String| (!list.is_empty()).then(|| format!("channels {what}: {list}"));
    line("read", list(true)).into_iter().chain(line("left out", list(false))).collect()
}

/// Refuses subsampled channels, and blocks that decode to far more memory than the frame.
fn check_blocks(subject: &str, header: &Header, limits: &ReadLimits) -> Result<(), InputError> {
    if let Some(c) = header.channels.list.iter().find(|c| c.sampling != Vec2(1, 1)) {
        return Err(InputError::not_supported(
            subject,
            crate::error::one_line(&format!("its channel {} is subsampled", c.name)),
            "expected a sample for every pixel; export it as RGB instead of luminance and chroma",
        ));
    }
    let block = header.max_block_pixel_size();
    let pixels = block.0.min(header.layer_size.0) as u64 * block.1.min(header.layer_size.1) as u64;
    let bytes = pixels.saturating_mul(header.channels.bytes_per_pixel as u64);
    if bytes > limits.max_block_bytes() {
        return Err(InputError::limit(
            limits.exceeded(Some(bytes.div_ceil(BLOCK_BYTES_PER_PIXEL))),
            subject,
            format!(
                "one of its blocks decodes to {} MB, above the limit of {} MB that follows from {} million pixels",
                bytes / 1_000_000,
                limits.max_block_bytes() / 1_000_000,
                limits.max_pixels as f64 / 1e6
            ),
            "write it with smaller tiles or fewer channels, or raise the limit",
        ));
    }
    Ok(())
}

/// Reads the chunk offset tables, and checks that every chunk header and the last chunk's data lie in the file.
fn read_tables(
    reader: &mut Counting<BufReader<File>>,
    subject: &str,
    meta: &MetaData,
    header_end: u64,
    file_bytes: u64,
) -> Result<Vec<Vec<u64>>, InputError> {
    let entries = meta.headers.iter().try_fold(0u64, |sum, h| sum.checked_add(h.chunk_count as u64));
    let tables_end = entries
        .and_then(|n| n.checked_mul(8))
        .and_then(|bytes| bytes.checked_add(header_end))
        .filter(|&end| end <= file_bytes)
        .ok_or_else(|| truncated(subject, "its table of chunks does not fit in the file"))?;

    reader.seek(SeekFrom::Start(header_end)).map_err(|e| io_error(subject, &e))?;
    let mut tables = Vec::with_capacity(meta.headers.len());
    let mut last = (0, 0);
    for (part, header) in meta.headers.iter().enumerate() {
        let mut bytes = vec![0u8; header.chunk_count * 8];
        reader.read_exact(&mut bytes).map_err(|e| io_error(subject, &e))?;
        let mut table: Vec<u64> =
            bytes.chunks_exact(8).map(|b| u64::from_le_bytes(b.try_into().unwrap_or_default())).collect();
        let chunk_header = chunk_header_bytes(meta, part);
        let in_file = |&o: &u64| o >= tables_end && o.saturating_add(chunk_header) <= file_bytes;
        if let Some(bad) = table.iter().position(|o| !in_file(o)) {
            let n = table.len();
            return Err(truncated(
                subject,
                &format!("chunk {} of {n} lies outside the file of {file_bytes} bytes", bad + 1),
            ));
        }
        last = last.max((table.iter().copied().max().unwrap_or(0), part));
        let (columns, rows) = full_resolution_chunks(header);
        table.truncate(columns * rows);
        tables.push(table);
    }
    let data_at = last.0 + chunk_header_bytes(meta, last.1);
    check_chunk_is_whole(reader, subject, data_at, file_bytes)?;
    Ok(tables)
}

/// Checks that a chunk ends within the file. Its data starts at `data_at`, right after its size.
fn check_chunk_is_whole(
    reader: &mut Counting<BufReader<File>>,
    subject: &str,
    data_at: u64,
    file_bytes: u64,
) -> Result<(), InputError> {
    let mut size = [0u8; 4];
    reader
        .seek(SeekFrom::Start(data_at - 4))
        .and_then(|_| reader.read_exact(&mut size))
        .map_err(|e| io_error(subject, &e))?;
    let size = u64::try_from(i32::from_le_bytes(size)).unwrap_or(u64::MAX);
    if data_at.saturating_add(size) > file_bytes {
        return Err(truncated(subject, "its last chunk is cut off"));
    }
    Ok(())
}

fn truncated(subject: &str, what: &str) -> InputError {
    InputError::invalid(subject, format!("is truncated or damaged: {what}"), "copy or export it again")
}

/// Bytes before a chunk's data: the part number (multi-part files only), the coordinates, the size.
pub(super) fn chunk_header_bytes(meta: &MetaData, part: usize) -> u64 {
    let part_number = if meta.requirements.is_multilayer() { 4 } else { 0 };
    let position = match meta.headers[part].blocks {
        BlockDescription::ScanLines => 4,
        BlockDescription::Tiles(_) => 16,
    };
    part_number + position + 4
}

/// Columns and rows of blocks at full resolution. They are the first entries of the offset table.
pub(super) fn full_resolution_chunks(header: &Header) -> (usize, usize) {
    let block = header.max_block_pixel_size();
    (header.layer_size.0.div_ceil(block.0), header.layer_size.1.div_ceil(block.1))
}

/// A reader that tracks its position, because the `exr` crate does not report where the header ends.
struct Counting<R> {
    inner: R,
    position: u64,
}

impl<R> Counting<R> {
    fn new(inner: R) -> Self {
        Self { inner, position: 0 }
    }
}

impl<R: Read> Read for Counting<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let n = self.inner.read(buffer)?;
        self.position += n as u64;
        Ok(n)
    }
}

impl<R: Seek> Seek for Counting<R> {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.position = self.inner.seek(to)?;
        Ok(self.position)
    }
}
