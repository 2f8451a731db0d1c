//! Decodes the chunks of a checked EXR file into a frame.

use super::channels::ChannelId;
use super::header::{ExrFile, ExrHeader, Vectors, Window, chunk_header_bytes, full_resolution_chunks};
use super::reading::DepthReading;
use super::{exr_error, guarded};
use crate::error::{InputError, io_error};
use afterimage::{FrameError, Image};
use exr::block::UncompressedBlock;
use exr::block::chunk::{Chunk, CompressedBlock, CompressedScanLineBlock, CompressedTileBlock, TileCoordinates};
use exr::math::Vec2;
use exr::meta::BlockDescription;
use exr::meta::attribute::{ChannelList, Compression, SampleType};
use exr::meta::header::Header;
use exr::prelude::f16;
use rayon::prelude::*;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::slice::from_mut;

/// Decoded bytes per batch of chunks. More occupies more cores and takes as much more memory.
const BATCH_BYTES: usize = 64 << 20;

/// A decoded EXR frame.
#[derive(Clone, Debug)]
pub struct ExrFrame {
    /// Linear color of Rec. 709 primaries; pixels with a NaN or an infinity are black.
    pub color: Image<[f32; 3]>,
    /// Depth along the view axis; NaN where the file has NaN, zero or less.
    pub depth: Option<Image<f32>>,
    /// Motion vectors in pixels, y down: position of a point in the other frame minus that in this one. NaN is kept.
    pub motion: Option<Image<[f32; 2]>>,
    /// Albedo of Rec. 709 primaries. NaN and infinities are kept: there it is not known.
    pub albedo: Option<Image<[f32; 3]>>,
    /// Number of color pixels with a NaN or an infinity.
    pub nonfinite: u64,
}

impl ExrHeader {
    /// Decodes the frame with the selected vectors. Memory: the frame, and one batch of chunks, compressed and decoded.
    ///
    /// # Errors
    /// [`Invalid`](InputError::Invalid) if the file lacks these vectors, has changed, or its compressed data is
    /// damaged; [`NotSupported`](InputError::NotSupported) for compression that the `exr` crate cannot decode;
    /// [`Io`](InputError::Io) if it cannot be read.
    pub fn read(&self, vectors: Vectors) -> Result<ExrFrame, InputError> {
        guarded(&self.subject, || self.read_unguarded(vectors))
    }

    fn read_unguarded(&self, vectors: Vectors) -> Result<ExrFrame, InputError> {
        let mut planes = Planes::new(self, vectors)?;
        let parts = planes.parts();
        for file in &self.files {
            let own = |part: &&usize| (file.first_part..file.first_part + file.meta.headers.len()).contains(part);
            let mut own = parts.iter().filter(own).peekable();
            if own.peek().is_none() {
                continue;
            }
            let mut open = File::open(&file.path).map_err(|e| io_error(&file.subject, &e))?;
            for part in own {
                file.read_part(&mut open, part - file.first_part, &mut planes)?;
            }
        }
        let frame = planes.finish(self);
        let frame = frame.map_err(|e| InputError::invalid(&self.subject, e.to_string(), "export it again"))?;
        self.check_albedo(frame.albedo.as_ref())?;
        Ok(frame)
    }

    /// Refuses an albedo that is known nowhere.
    fn check_albedo(&self, albedo: Option<&Image<[f32; 3]>>) -> Result<(), InputError> {
        let is_known = |albedo: &Image<[f32; 3]>| albedo.pixels().iter().any(|a| a.iter().all(|v| v.is_finite()));
        if albedo.is_none_or(is_known) {
            return Ok(());
        }
        let expected = "expected numbers from 0 to 1; export it again, or leave it out with `albedo`=off";
        Err(InputError::invalid(&self.subject, "its albedo is NaN or infinite at every pixel", expected))
    }
}

impl ExrFile {
    /// Reads a part, by its number in this file.
    fn read_part(&self, file: &mut File, part: usize, planes: &mut Planes) -> Result<(), InputError> {
        let header = &self.meta.headers[part];
        let (columns, rows) = full_resolution_chunks(header);
        let block = header.max_block_pixel_size();
        let block_bytes =
            block.0.min(header.layer_size.0) * block.1.min(header.layer_size.1) * header.channels.bytes_per_pixel;
        let batch = (BATCH_BYTES / block_bytes.max(1)).max(1);
        for start in (0..columns * rows).step_by(batch) {
            let end = (start + batch).min(columns * rows);
            let chunks = (start..end)
                .map(|i| self.read_chunk(file, part, i, Vec2(i % columns, i / columns)))
                .collect::<Result<Vec<_>, _>>()?;
            let blocks = chunks
                .into_par_iter()
                .map(|chunk| UncompressedBlock::decompress_chunk(chunk, &self.meta, false))
                .collect::<Result<Vec<_>, _>>()
                .map_err(|e| exr_error(&self.subject, e))?;
            for block in &blocks {
                planes.scatter(self.first_part + part, block, &header.channels, header.layer_size.0);
            }
        }
        Ok(())
    }

    /// Reads chunk `index` of a part. Its header must name the block `tile`, so that every pixel is written exactly
    /// once.
    fn read_chunk(&self, file: &mut File, part: usize, index: usize, tile: Vec2<usize>) -> Result<Chunk, InputError> {
        let io = |e: std::io::Error| io_error(&self.subject, &e);
        let header = &self.meta.headers[part];
        let offset = self.chunk_offsets[part][index];
        let head_bytes = chunk_header_bytes(&self.meta, part);
        let mut head = [0u8; 24];
        let head = &mut head[..head_bytes as usize];
        file.seek(SeekFrom::Start(offset)).map_err(io)?;
        file.read_exact(head).map_err(io)?;
        let fields: Vec<i32> =
            head.chunks_exact(4).map(|b| i32::from_le_bytes(b.try_into().unwrap_or_default())).collect();

        let (&bytes, place) = fields.split_last().unwrap_or((&-1, &[]));
        let rest = self.file_bytes.saturating_sub(offset + head_bytes);
        let bytes = u64::try_from(bytes).ok().filter(|&b| b <= rest);
        let (Some(bytes), true) = (bytes, place == self.chunk_place(part, tile)) else {
            return Err(self.damaged(index));
        };
        let mut data = vec![0u8; bytes as usize];
        file.read_exact(&mut data).map_err(io)?;
        if !dwa_counters_are_sane(header, tile, &data) {
            return Err(self.damaged(index));
        }
        let compressed_block = match header.blocks {
            BlockDescription::ScanLines => CompressedBlock::ScanLine(CompressedScanLineBlock {
                // Relative to the corner of the data window, as in the header in memory.
                y_coordinate: (tile.1 * header.compression.scan_lines_per_block()) as i32,
                compressed_pixels_le: data,
            }),
            BlockDescription::Tiles(_) => CompressedBlock::Tile(CompressedTileBlock {
                coordinates: TileCoordinates { tile_index: tile, level_index: Vec2(0, 0) },
                compressed_pixels_le: data,
            }),
        };
        Ok(Chunk { layer_index: part, compressed_block })
    }

    /// Fields before the size in a chunk's header: part number (multi-part files only) and block coordinates.
    fn chunk_place(&self, part: usize, tile: Vec2<usize>) -> Vec<i32> {
        let header = &self.meta.headers[part];
        let mut place = Vec::with_capacity(5);
        if self.meta.requirements.is_multilayer() {
            place.push(part as i32);
        }
        match header.blocks {
            BlockDescription::ScanLines => {
                let line = tile.1 * header.compression.scan_lines_per_block();
                place.push(self.first_lines[part].wrapping_add(line as i32));
            }
            BlockDescription::Tiles(_) => place.extend([tile.0 as i32, tile.1 as i32, 0, 0]),
        }
        place
    }

    fn damaged(&self, index: usize) -> InputError {
        InputError::invalid(
            &self.subject,
            format!("is truncated or damaged: chunk {} is not what the table of chunks says", index + 1),
            "copy or export it again",
        )
    }
}

/// Whether the counters of a DWA chunk are within the size of its block. The `exr` crate allocates what the counters
/// ask for without a check, and a failed allocation aborts the process.
fn dwa_counters_are_sane(header: &Header, tile: Vec2<usize>, data: &[u8]) -> bool {
    if !matches!(header.compression, Compression::DWAA(_) | Compression::DWAB(_)) {
        return true;
    }
    let block = header.max_block_pixel_size();
    let w = block.0.min(header.layer_size.0 - tile.0 * block.0);
    let h = block.1.min(header.layer_size.1 - tile.1 * block.1);
    let pixel_bytes = header.channels.bytes_per_pixel;
    if data.len() == w * h * pixel_bytes {
        // Stored uncompressed, because compression did not make it smaller.
        return true;
    }
    // Coefficients come in blocks of 8x8; run-length encoding can double their size.
    let most = (2 * w.next_multiple_of(8) * h.next_multiple_of(8) * pixel_bytes) as u64;
    // The first counter is the version.
    let mut counters = data.chunks_exact(8).skip(1).take(9);
    counters.all(|b| u64::from_le_bytes(b.try_into().unwrap_or_default()) <= most)
}

/// Destination of a channel's samples: an image, a component, and for motion a factor and an offset.
#[derive(Clone, Copy)]
enum Slot {
    Color(usize),
    Depth,
    Motion(usize, (f32, f32)),
    Albedo(usize),
}

/// Images of a frame under construction.
struct Planes {
    slots: Vec<(ChannelId, Slot)>,
    color: Vec<[f32; 3]>,
    depth: Option<Vec<f32>>,
    motion: Option<Vec<[f32; 2]>>,
    albedo: Option<Vec<[f32; 3]>>,
}

impl Planes {
    fn new(header: &ExrHeader, vectors: Vectors) -> Result<Self, InputError> {
        let roles = &header.roles;
        let mut slots: Vec<_> = (0..3).map(|i| (roles.color[i], Slot::Color(i))).collect();
        slots.extend(roles.depth.map(|(id, _)| (id, Slot::Depth)));
        slots.extend(roles.albedo.iter().flat_map(|ids| (0..3).map(|i| (ids[i], Slot::Albedo(i)))));
        if vectors != Vectors::Skip {
            let missing = || missing_vectors(header, vectors);
            let motion = roles.motion.ok_or_else(missing)?;
            let read = if vectors == Vectors::ToNext { motion.to_next } else { Some(motion.to_previous) };
            let read = read.ok_or_else(missing)?;
            let to_px = read.reading.to_px(header.size);
            slots.extend((0..2).map(|i| (read.channels[i], Slot::Motion(i, to_px[i]))));
        }
        let pixels = header.window.stored_px.iter().map(|&side| side as usize).product();
        Ok(Self {
            slots,
            color: vec![[0.0; 3]; pixels],
            depth: roles.depth.map(|_| vec![0.0; pixels]),
            motion: (vectors != Vectors::Skip).then(|| vec![[0.0; 2]; pixels]),
            albedo: roles.albedo.map(|_| vec![[0.0; 3]; pixels]),
        })
    }

    /// Parts with a channel in `slots`.
    fn parts(&self) -> Vec<usize> {
        let mut parts: Vec<usize> = self.slots.iter().map(|(id, _)| id.0).collect();
        parts.sort_unstable();
        parts.dedup();
        parts
    }

    /// Copies the channels in `slots` out of a decoded block. Each row of a block stores the samples channel by
    /// channel.
    fn scatter(&mut self, part: usize, block: &UncompressedBlock, channels: &ChannelList, width: usize) {
        let Vec2(x0, y0) = block.index.pixel_position;
        let Vec2(w, h) = block.index.pixel_size;
        let mut first = 0;
        for (index, channel) in channels.list.iter().enumerate() {
            let bytes = w * channel.sample_type.bytes_per_sample();
            let used = self.slots.iter().filter(|(id, _)| *id == (part, index));
            for slot in used.map(|(_, slot)| *slot).collect::<Vec<_>>() {
                for y in 0..h {
                    let at = y * w * channels.bytes_per_pixel + first;
                    let samples = &block.data[at..at + bytes];
                    let start = (y0 + y) * width + x0;
                    self.store(slot, start..start + w, samples, channel.sample_type);
                }
            }
            first += bytes;
        }
    }

    fn store(&mut self, slot: Slot, pixels: std::ops::Range<usize>, samples: &[u8], kind: SampleType) {
        match slot {
            Slot::Color(i) => {
                let out = self.color[pixels].iter_mut().map(|p| &mut p[i]);
                convert(samples, kind, (1.0, 0.0), out);
            }
            Slot::Depth => {
                if let Some(depth) = &mut self.depth {
                    convert(samples, kind, (1.0, 0.0), depth[pixels].iter_mut());
                }
            }
            Slot::Motion(i, to_px) => {
                if let Some(motion) = &mut self.motion {
                    let out = motion[pixels].iter_mut().map(|m| &mut m[i]);
                    convert(samples, kind, to_px, out);
                }
            }
            Slot::Albedo(i) => {
                if let Some(albedo) = &mut self.albedo {
                    convert(samples, kind, (1.0, 0.0), albedo[pixels].iter_mut().map(|a| &mut a[i]));
                }
            }
        }
    }

    /// The frame, cut to its own window, in Rec. 709.
    fn finish(mut self, header: &ExrHeader) -> Result<ExrFrame, FrameError> {
        let (size, window) = (header.size, header.window);
        if !window.is_whole(size) {
            self.color = cut(&self.color, [0.0; 3], size, window);
            self.depth = self.depth.map(|depth| cut(&depth, f32::NAN, size, window));
            self.motion = self.motion.map(|motion| cut(&motion, [0.0; 2], size, window));
            self.albedo = self.albedo.map(|albedo| cut(&albedo, [f32::NAN; 3], size, window));
        }
        let nonfinite = blacken_nonfinite(&mut self.color);
        header.color_space.convert(&mut self.color);
        // Of an unknown albedo the conversion would make black.
        let known = self.albedo.iter_mut().flatten().filter(|albedo| albedo.iter().all(|v| v.is_finite()));
        known.for_each(|albedo| header.color_space.convert(from_mut(albedo)));
        let reading = header.roles.depth.map_or_else(DepthReading::default, |(_, reading)| reading);
        for d in self.depth.iter_mut().flatten() {
            *d = reading.distance(*d);
        }
        Ok(ExrFrame {
            color: Image::from_pixels(size, self.color)?,
            depth: self.depth.map(|d| Image::from_pixels(size, d)).transpose()?,
            motion: self.motion.map(|m| Image::from_pixels(size, m)).transpose()?,
            albedo: self.albedo.map(|a| Image::from_pixels(size, a)).transpose()?,
            nonfinite,
        })
    }
}

/// Pixels of the frame; `absent` where nothing is stored.
fn cut<T: Copy>(stored: &[T], absent: T, [width, height]: [u32; 2], window: Window) -> Vec<T> {
    let at = |y: u32| (0..width).map(move |x| window.stored([x, y]).map_or(absent, |i| stored[i]));
    (0..height).flat_map(at).collect()
}

/// Sets pixels with a NaN or an infinity to black, and returns their number.
fn blacken_nonfinite(color: &mut [[f32; 3]]) -> u64 {
    let mut count = 0;
    for pixel in color {
        if !pixel.iter().all(|c| c.is_finite()) {
            *pixel = [0.0; 3];
            count += 1;
        }
    }
    count
}

/// Samples by a factor, plus an offset.
fn convert<'a>(samples: &[u8], kind: SampleType, (factor, offset): (f32, f32), out: impl Iterator<Item = &'a mut f32>) {
    let quad = |b: &[u8]| <[u8; 4]>::try_from(b).unwrap_or_default();
    match kind {
        SampleType::F16 => {
            for (b, o) in samples.chunks_exact(2).zip(out) {
                *o = offset + factor * f16::from_ne_bytes([b[0], b[1]]).to_f32();
            }
        }
        SampleType::F32 => {
            for (b, o) in samples.chunks_exact(4).zip(out) {
                *o = offset + factor * f32::from_ne_bytes(quad(b));
            }
        }
        SampleType::U32 => {
            for (b, o) in samples.chunks_exact(4).zip(out) {
                *o = offset + factor * u32::from_ne_bytes(quad(b)) as f32;
            }
        }
    }
}

fn missing_vectors(header: &ExrHeader, vectors: Vectors) -> InputError {
    let (which, needed) = match vectors {
        Vectors::ToNext => (
            "to the next frame, which playing backwards needs",
            "<layer>.Vector.Z/W, motion.Z/W or forward.u/v; add them, or ask for no more frames than there are",
        ),
        _ => ("to the previous frame", "<layer>.Vector.X/Y or motion.X/Y; add them, or process one frame as a still"),
    };
    InputError::invalid(&header.subject, format!("has no motion vectors {which}"), format!("expected {needed}"))
}
