//! Textures of materials: collects those in use, and decodes their images.

use super::buffers;
use super::container::Container;
use super::document::Document;
use super::errors::{named, printable};
use crate::error::InputError;
use crate::scene::{Coordinates, Texture, TextureRef, Wrap};
use gltf::json::texture::{MagFilter, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{self, Index};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use rayon::prelude::*;
use std::borrow::Cow;
use std::collections::HashMap;
use std::io::Cursor;

/// Source of a texture that states none, in the crate `gltf`.
const NO_IMAGE: usize = u32::MAX as usize;

/// Textures in use, each image with a sampler and a conversion once.
pub(super) struct Textures<'a> {
    document: &'a Document<'a>,
    uses: Vec<TextureUse>,
    indices: HashMap<Use, u32>,
}

/// Image, sampler, bits of the glossiness, and coordinates of a texture.
type Use = (usize, Option<usize>, Option<u32>, [u32; 7]);

/// A texture in use.
struct TextureUse {
    image: usize,
    /// The texels become roughness in G, for a glossiness of this times the image's alpha.
    glossiness: Option<f32>,
    coordinates: Coordinates,
    wrap: [Wrap; 2],
    nearest: bool,
}

/// The bits of coordinates.
fn key_of(coordinates: &Coordinates) -> [u32; 7] {
    let [[a, b, c], [d, e, f]] = coordinates.rows.map(|row| row.map(f32::to_bits));
    [u32::from(coordinates.second), a, b, c, d, e, f]
}

/// An encoded image whose header was read.
struct Encoded<'a> {
    bytes: Cow<'a, [u8]>,
    format: ImageFormat,
    texels: u64,
}

impl<'a> Textures<'a> {
    pub fn new(document: &'a Document<'a>) -> Self {
        Self { document, uses: Vec::new(), indices: HashMap::new() }
    }

    /// Whether a texture has an image that can be read.
    pub fn has_image(&self, index: Index<json::Texture>) -> bool {
        self.document.root.textures.get(index.value()).is_some_and(|t| t.source.value() != NO_IMAGE)
    }

    /// Registers a texture of the file as used, as it is or as roughness of a glossiness. `None` if it has no image, of
    /// which the file's warnings tell.
    pub fn use_texture(
        &mut self,
        index: Index<json::Texture>,
        glossiness: Option<f32>,
        coordinates: Coordinates,
    ) -> Result<Option<TextureRef>, InputError> {
        let root = self.document.root;
        let texture = self.document.look_up(&root.textures, index, "texture")?;
        if texture.source.value() == NO_IMAGE {
            return Ok(None);
        }
        self.document.look_up(&root.images, texture.source, "image")?;
        let sampler = match texture.sampler {
            Some(sampler) => Some(self.document.look_up(&root.samplers, sampler, "sampler")?),
            None => None,
        };
        let sampler_index = texture.sampler.map(|s| s.value());
        let key = (texture.source.value(), sampler_index, glossiness.map(f32::to_bits), key_of(&coordinates));
        let next = self.uses.len() as u32;
        let texture = *self.indices.entry(key).or_insert(next);
        if texture == next {
            let wrap = |mode: Option<&Checked<WrappingMode>>| match mode {
                Some(Checked::Valid(WrappingMode::ClampToEdge)) => Wrap::Clamp,
                Some(Checked::Valid(WrappingMode::MirroredRepeat)) => Wrap::Mirror,
                _ => Wrap::Repeat,
            };
            self.uses.push(TextureUse {
                image: key.0,
                glossiness,
                coordinates,
                wrap: [wrap(sampler.map(|s| &s.wrap_s)), wrap(sampler.map(|s| &s.wrap_t))],
                nearest: sampler.is_some_and(|s| matches!(s.mag_filter, Some(Checked::Valid(MagFilter::Nearest)))),
            });
        }
        Ok(Some(TextureRef { texture }))
    }

    /// Reads and decodes the images in use. Sizes are checked against the limits before any image is decoded.
    pub fn load(self, file: &Container) -> Result<Vec<Texture>, InputError> {
        let mut total_bytes = self.document.buffers.total_bytes;
        let mut texels = 0u64;
        let mut encoded = Vec::new();
        let mut place_of_image = HashMap::new();
        for used in &self.uses {
            let place = match place_of_image.get(&used.image) {
                Some(&place) => place,
                None => {
                    encoded.push((used.image, self.encoded(file, used.image, &mut total_bytes)?));
                    place_of_image.insert(used.image, encoded.len() - 1);
                    encoded.len() - 1
                }
            };
            texels = texels.saturating_add(encoded[place].1.texels);
            self.document.limits.check_texels(self.document.subject, texels)?;
        }
        let decoded: Result<Vec<_>, _> =
            encoded.par_iter().map(|(image, encoded)| self.decoded(*image, encoded)).collect();
        let mut decoded = decoded?;
        let mut remaining = vec![0; decoded.len()];
        for used in &self.uses {
            remaining[place_of_image[&used.image]] += 1;
        }
        let texture = |used: &TextureUse| {
            let place = place_of_image[&used.image];
            remaining[place] -= 1;
            let (size, texels) = &mut decoded[place];
            let mut texels = if remaining[place] == 0 { std::mem::take(texels) } else { texels.clone() };
            if let Some(factor) = used.glossiness {
                for texel in &mut texels {
                    let rough = 1.0 - factor * f32::from(texel[3]) / 255.0;
                    *texel = [255, (rough * 255.0 + 0.5) as u8, 255, 255];
                }
            }
            Texture { size: *size, texels, wrap: used.wrap, nearest: used.nearest, coordinates: used.coordinates }
        };
        Ok(self.uses.iter().map(texture).collect())
    }

    fn encoded(&self, file: &Container, index: usize, total_bytes: &mut u64) -> Result<Encoded<'a>, InputError> {
        let document = self.document;
        let image = &document.root.images[index];
        let bytes = match (&image.buffer_view, &image.uri) {
            (Some(view), _) => {
                let view = document.buffers.view(&document.root.buffer_views, *view);
                let (bytes, _) = view.ok_or_else(|| self.bad(index, "reaches beyond its buffer".into()))?;
                Cow::Borrowed(bytes)
            }
            (None, Some(address)) => {
                let bytes = buffers::fetch(file, address, *total_bytes, document.limits)?;
                *total_bytes += bytes.len() as u64;
                document.limits.check_file_bytes(document.subject, *total_bytes)?;
                Cow::Owned(bytes)
            }
            (None, None) => return Err(self.bad(index, "has neither an address nor a buffer view".into())),
        };
        let reader = ImageReader::new(Cursor::new(&*bytes)).with_guessed_format();
        let format = reader.ok().and_then(|r| r.format());
        let Some(format @ (ImageFormat::Png | ImageFormat::Jpeg)) = format else {
            let found = format.map_or("of an unknown format".to_owned(), |f| format!("{f:?}"));
            return Err(InputError::not_supported(
                document.subject,
                format!("{} is {found}", self.name(index)),
                "expected PNG or JPEG; convert it",
            ));
        };
        let size = ImageReader::with_format(Cursor::new(&*bytes), format).into_dimensions();
        let (w, h) = size.map_err(|e| self.undecodable(index, &e))?;
        if w == 0 || h == 0 {
            return Err(self.bad(index, format!("is {w}x{h} texels")));
        }
        Ok(Encoded { bytes, format, texels: u64::from(w) * u64::from(h) })
    }

    fn decoded(&self, index: usize, encoded: &Encoded) -> Result<([u32; 2], Vec<[u8; 4]>), InputError> {
        let undecodable = |e| self.undecodable(index, &e);
        let reader = ImageReader::with_format(Cursor::new(&*encoded.bytes), encoded.format);
        let mut decoder = reader.into_decoder().map_err(undecodable)?;
        // The largest format has four components of 16 bits; the decoder needs as much again.
        let mut limits = Limits::default();
        limits.max_alloc = Some(encoded.texels.saturating_mul(16).max(1 << 20));
        decoder.set_limits(limits).map_err(undecodable)?;
        let image = DynamicImage::from_decoder(decoder).map_err(undecodable)?.into_rgba8();
        let size = [image.width(), image.height()];
        let texels = image.into_raw().as_chunks::<4>().0.to_vec();
        Ok((size, texels))
    }

    fn undecodable(&self, index: usize, error: &image::ImageError) -> InputError {
        self.bad(index, format!("cannot be decoded: {}", printable(&error.to_string())))
    }

    fn bad(&self, index: usize, problem: String) -> InputError {
        self.document.damaged(format!("{} {problem}", self.name(index)))
    }

    fn name(&self, index: usize) -> String {
        let image = &self.document.root.images[index];
        named("image", index, image.name.as_deref().or(image.uri.as_deref().filter(|u| !u.starts_with("data:"))))
    }
}
