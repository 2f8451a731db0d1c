//! The header of an EXR file, and the checks that need no pixel: size, channels, and completeness of the file.

use super::channels::{ChannelName, Roles};
use super::color_space::ColorSpace;
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

/// A checked EXR header: the frame can be decoded unless its compressed data is damaged.
#[derive(Debug)]
pub struct ExrHeader {
    pub(super) path: PathBuf,
    pub(super) subject: String,
    pub(super) size: [u32; 2],
    /// Where the frame lies in what is stored.
    pub(super) window: Window,
    pub(super) meta: MetaData,
    pub(super) roles: Roles,
    pub(super) color_space: ColorSpace,
    /// File offsets of the full-resolution chunks of each part, row by row.
    pub(super) chunk_offsets: Vec<Vec<u64>>,
    /// y coordinate of each part's first scan line in the file.
    pub(super) first_lines: Vec<i32>,
    pub(super) file_bytes: u64,
    channel_names: Vec<String>,
    warnings: Vec<String>,
    contents: Vec<String>,
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
    /// Reads and checks the header of `path`. Memory is proportional to the header's actual bytes, regardless of the
    /// sizes that it claims.
    ///
    /// # Errors
    /// - [`Io`](InputError::Io): the file is missing or cannot be read.
    /// - [`Invalid`](InputError::Invalid): it is not EXR, truncated, or without color.
    /// - [`NotSupported`](InputError::NotSupported): it is subsampled, deep, has parts of different sizes, or nothing
    ///   of its display window.
    /// - [`Limit`](InputError::Limit): the image, or one block of it, is larger than `limits` allows.
    pub fn open(path: &Path, limits: &ReadLimits) -> Result<Self, InputError> {
        let subject = path.display().to_string();
        guarded(&subject, || Self::open_unguarded(path, &subject, limits))
    }

    fn open_unguarded(path: &Path, subject: &str, limits: &ReadLimits) -> Result<Self, InputError> {
        let io = |e: std::io::Error| io_error(subject, &e);
        let file = File::open(path).map_err(io)?;
        let file_bytes = file.metadata().map_err(io)?.len();
        if file_bytes == 0 {
            return Err(InputError::invalid(subject, "is empty", "copy or export it again"));
        }
        let mut reader = Counting::new(BufReader::new(file));
        let invalid = |e| exr_error(subject, e);
        let read = MetaData::read_from_buffered(&mut reader, false);
        let mut meta = read.map_err(|e| unknown_compression(subject, path).unwrap_or_else(|| invalid(e)))?;
        let header_end = reader.position;

        let names = channel_names(&meta);
        let full_names: Vec<String> = names.iter().map(|n| n.full_name.clone()).collect();
        let roles = Roles::find(&names).ok_or_else(|| missing_color(subject, &full_names))?;
        let (size, window) = checked_size(subject, &meta, &roles, limits)?;
        let color_space = match roles.color {
            // Grey has no primaries.
            [r, g, b] if r == g && g == b => ColorSpace::default(),
            [(part, _), ..] => ColorSpace::of(&meta.headers[part]),
        };
        let further = [window.warning(size), color_space.warning.clone(), pixel_aspect_warning(&meta)];
        let warnings = roles.warnings.iter().cloned().chain(further.into_iter().flatten()).collect();
        let contents = contents(&names, &roles);
        MetaData::validate(&meta.headers, false).map_err(invalid)?;
        let tables = read_tables(&mut reader, subject, &meta, header_end, file_bytes)?;
        let windows = meta.headers.iter();
        let first_lines = windows.map(|h| h.own_attributes.layer_position.1).collect();
        for header in &mut meta.headers {
            // Block coordinates are then relative to the corner of the data window.
            header.own_attributes.layer_position = Vec2(0, 0);
        }
        Ok(Self {
            path: path.to_owned(),
            subject: subject.to_owned(),
            size,
            window,
            warnings,
            contents,
            chunk_offsets: tables,
            first_lines,
            meta,
            roles,
            color_space,
            file_bytes,
            channel_names: full_names,
        })
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
        let stated = self.meta.headers.iter().find_map(|header| header.own_attributes.frames_per_second)?;
        let fps = (f64::from(stated.0) / f64::from(stated.1)) as f32;
        (0.1..=10_000.0).contains(&fps).then_some(fps)
    }

    /// Whether there is a depth channel.
    pub fn has_depth(&self) -> bool {
        self.roles.depth.is_some()
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

fn channel_names(meta: &MetaData) -> Vec<ChannelName> {
    let mut names = Vec::new();
    for (part, header) in meta.headers.iter().enumerate() {
        // The name of a single part carries no meaning: some writers put the file's name there.
        let several = meta.headers.len() > 1;
        let part_name = header.own_attributes.layer_name.as_ref();
        let part_name = part_name.filter(|_| several).map(|n| n.to_string());
        for (index, channel) in header.channels.list.iter().enumerate() {
            let name = channel.name.to_string();
            names.push(ChannelName::new(part, part_name.as_deref(), index, &name));
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
fn pixel_aspect_warning(meta: &MetaData) -> Option<String> {
    const SQUARE: f32 = 0.005;
    let aspect = meta.headers.first()?.shared_attributes.pixel_aspect;
    ((aspect - 1.0).abs() > SQUARE).then(|| {
        format!(
            "its pixels are {aspect} times as wide as high (pixelAspectRatio), and are taken for square; scale the frames \
             to square pixels, or render them so"
        )
    })
}

fn missing_color(subject: &str, names: &[String]) -> InputError {
    const LISTED: usize = 40;
    let mut list = names.iter().take(LISTED).cloned().collect::<Vec<_>>().join(", ");
    if names.len() > LISTED {
        list += &format!(" and {} more", names.len() - LISTED);
    }
    InputError::invalid(
        subject,
        format!("has no color channels; it has {}", crate::error::one_line(&list)),
        "expected <layer>.Combined.R/G/B, R/G/B, <layer>.R/G/B or Y",
    )
}

/// Checks every part in use, and returns the frame's size, and where it lies in what all of them store.
fn checked_size(
    subject: &str,
    meta: &MetaData,
    roles: &Roles,
    limits: &ReadLimits,
) -> Result<([u32; 2], Window), InputError> {
    let mut found = None;
    for part in used_parts(roles) {
        let header = &meta.headers[part];
        let Vec2(w, h) = header.layer_size;
        let stored_px = limits.check(subject, w as u64, h as u64)?;
        let this = frame_window(subject, header, stored_px, limits)?;
        check_blocks(subject, header, limits)?;
        if *found.get_or_insert(this) != this {
            return Err(InputError::not_supported(
                subject,
                "has parts of different sizes",
                "expected color, depth and motion of one size; export them again",
            ));
        }
    }
    found.ok_or_else(|| missing_color(subject, &[]))
}

/// Parts with an assigned channel, in file order.
pub(super) fn used_parts(roles: &Roles) -> Vec<usize> {
    let mut parts: Vec<usize> = roles.color.iter().chain(&roles.depth).map(|c| c.0).collect();
    parts.extend(roles.motion.iter().map(|m| m.to_previous[0].0));
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
