//! A camera's post-process: the context of the drop-in, and the textures between Bevy and it.

use crate::blit::BlitPass;
use crate::counters::Counters;
use crate::frame::ExtractedAfterimage;
use crate::oblique::ObliquePass;
use afterimage::gpu::{Afterimage, Frame, Prime, Region, Target, Textures};
use afterimage::internal::Reset;
use afterimage::{Exposure, FrameError, wgpu};
use std::slice;
use std::sync::atomic::AtomicBool;
use wgpu::{CommandEncoder, Device, Texture, TextureFormat, TextureUsages};

/// Format in which the post-process works: Bevy's of cameras with `Hdr`.
const FORMAT: TextureFormat = TextureFormat::Rgba16Float;

/// Format of albedos: the smallest that every device can write, and that can say that one is unknown.
pub(crate) const ALBEDO_FORMAT: TextureFormat = TextureFormat::Rgba16Float;

/// Depth of lighting passes where no quad is chosen. Bevy writes the whole numbers from 0 to 255, divided by 255, of
/// which each pass tests one for equality: this is none of them.
const NO_PASS: f32 = 0.5 / 255.0;

/// Usages of textures that compute passes write. Tests read them.
const STORAGE: TextureUsages =
    TextureUsages::STORAGE_BINDING.union(TextureUsages::TEXTURE_BINDING).union(TextureUsages::COPY_SRC);

/// A texture of a size and a format: `kept`, or a new one.
fn fitting(
    kept: Option<Texture>,
    device: &Device,
    size: wgpu::Extent3d,
    format: TextureFormat,
    usage: TextureUsages,
) -> Texture {
    let new = || {
        device.create_texture(&wgpu::TextureDescriptor {
            label: Some("afterimage"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    };
    kept.filter(|kept| kept.size() == size && kept.format() == format).unwrap_or_else(new)
}

/// Size of what a camera draws.
fn extent(frame: &ExtractedAfterimage) -> wgpu::Extent3d {
    let [width, height] = frame.desc.size_px;
    wgpu::Extent3d { width, height, depth_or_array_layers: 1 }
}

/// State of a camera's post-process.
#[derive(Debug)]
pub(crate) struct Context {
    post: Afterimage,
    /// Depth of a plain projection, in place of that of the prepass.
    pub plain: Option<Texture>,
    /// Albedo of every pixel, if the camera is deferred.
    pub albedo: Option<Texture>,
    /// Depth of the prepass, while that of the main pass is closed.
    pub depth: Option<Texture>,
    /// Frame, where it cannot be written to the main texture, or where a debug view is shown instead.
    spare: Option<Texture>,
    /// Debug view, where it cannot be written to the main texture.
    spare_debug: Option<Texture>,
    pub counters: Option<Counters>,
    exposure: Option<f32>,
    /// Quads of this frame are chosen, and the depth of the main pass is closed elsewhere.
    pub is_planned: bool,
    /// The frame is made, and the depth of the main pass is open again.
    pub is_shown: bool,
    /// The main pass has left items out that have no prepass.
    pub has_late: AtomicBool,
}

/// Textures of a camera, of which its viewport is read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawn<'a> {
    pub color: &'a Texture,
    /// Depth and motion vectors of the prepass.
    pub depth: &'a Texture,
    pub motion: &'a Texture,
    /// First pixel of the viewport.
    pub origin_px: [u32; 2],
    /// Depth that is tested in the main pass before pixels are shaded.
    pub tested: &'a wgpu::TextureView,
    /// That of a deferred camera's lighting passes, of the same size.
    pub tested_lighting: Option<&'a wgpu::TextureView>,
}

impl<'a> Drawn<'a> {
    /// Color, depth and motion of the viewport.
    fn regions(self, plain: Option<&'a Texture>) -> [[Region<'a>; 1]; 3] {
        let Self { color, depth, motion, origin_px, .. } = self;
        let depth = plain.map_or(Region::new(depth, origin_px), |plain| Region::new(plain, [0, 0]));
        [[Region::new(color, origin_px)], [depth], [Region::new(motion, origin_px)]]
    }
}

/// A frame as the post-process takes it.
fn described<'a>(frame: &'a ExtractedAfterimage, [color, depth, motion]: &'a [[Region<'a>; 1]; 3]) -> Frame<'a> {
    Frame {
        depth: Some(Textures::Regions(depth)),
        motion: Some(Textures::Regions(motion)),
        reset: if frame.reset { Reset::All } else { Reset::None },
        ..Frame::new(Textures::Regions(color), slice::from_ref(&frame.view), frame.index)
    }
}

impl Context {
    pub fn new(device: &Device, frame: &ExtractedAfterimage) -> Result<Self, String> {
        let post = Afterimage::new(device, &frame.desc, FORMAT).map_err(|error| error.to_string())?;
        Ok(Self {
            post,
            plain: None,
            albedo: None,
            depth: None,
            spare: None,
            spare_debug: None,
            counters: None,
            exposure: None,
            is_planned: false,
            is_shown: false,
            has_late: AtomicBool::new(false),
        })
    }

    /// Makes settings those of the frame.
    pub fn prepare(&mut self, device: &Device, frame: &ExtractedAfterimage) -> Result<(), String> {
        (self.is_planned, self.is_shown) = (false, false);
        self.has_late = AtomicBool::new(false);
        if self.post.desc().has_albedo != frame.desc.has_albedo {
            self.post = Afterimage::new(device, &frame.desc, FORMAT).map_err(|error| error.to_string())?;
        } else if self.post.desc().settings != frame.desc.settings {
            self.post.set_settings(device, frame.desc.settings).map_err(|error| error.to_string())?;
        }
        match (&self.counters, frame.counts) {
            (None, true) => self.counters = Some(Counters::new(device)),
            (Some(_), false) => self.counters = None,
            _ => {}
        }
        Ok(())
    }

    /// For frames without it: keeps what is compiled, without history.
    pub fn rest(&mut self) {
        (self.is_planned, self.is_shown, self.counters, self.exposure) = (false, false, None, None);
        self.post.forget();
    }

    /// The quads that are shaded.
    pub fn mask(&self) -> Option<&Texture> {
        self.post.quad_mask()
    }

    /// Makes the post-process that of views of the frame's size. History survives if their shape is the same.
    fn resize(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &ExtractedAfterimage,
    ) -> Result<(), FrameError> {
        let (has, needs) = (self.post.desc().size_px, frame.desc.size_px);
        if has == needs {
            return Ok(());
        }
        // Sides are rounded to whole pixels.
        let [a, b] = [[has[0], needs[1]], [needs[0], has[1]]].map(|[x, y]| f64::from(x) * f64::from(y));
        let is_same_shape = (a - b).abs() <= f64::from(has.into_iter().chain(needs).max().unwrap_or(0));
        match is_same_shape {
            true => self.post.resize_keeping_history(device, encoder, needs),
            false => self.post.resize(device, needs),
        }
    }

    /// Chooses the quads of a frame, and closes the tested depths elsewhere. After an error every pixel is shaded.
    pub fn plan(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &ExtractedAfterimage,
        drawn: Drawn<'_>,
        oblique: &mut ObliquePass,
    ) -> Result<(), FrameError> {
        self.resize(device, encoder, frame)?;
        let (size, has_albedo) = (extent(frame), frame.desc.has_albedo);
        self.albedo = has_albedo.then(|| fitting(self.albedo.take(), device, size, ALBEDO_FORMAT, STORAGE));
        self.plain = frame.oblique.map(|projection| {
            let plain = fitting(self.plain.take(), device, size, TextureFormat::R32Float, STORAGE);
            let of_view = (projection, frame.view.jitter_px);
            oblique.record(device, encoder, (drawn.depth, drawn.origin_px), &plain, of_view);
            plain
        });
        self.post.plan(device, encoder, &described(frame, &drawn.regions(self.plain.as_ref())))?;
        let (open, copies) = (drawn.tested.texture(), TextureUsages::COPY_DST | TextureUsages::COPY_SRC);
        let kept = fitting(self.depth.take(), device, open.size(), open.format(), copies);
        encoder.copy_texture_to_texture(open.as_image_copy(), kept.as_image_copy(), open.size());
        self.depth = Some(kept);
        let origin_px = drawn.origin_px;
        let main = Prime { target: drawn.tested, origin_px, near_depth: 1.0, stencil: None, is_half: false };
        let lighting = drawn.tested_lighting.map(|target| Prime { target, near_depth: NO_PASS, ..main });
        // Of one size: if the second does not fit, the first does not, and nothing is closed.
        for prime in [Some(main), lighting].into_iter().flatten() {
            self.post.prime(device, encoder, 0, &prime)?;
        }
        self.is_planned = true;
        Ok(())
    }

    /// Opens the depth of the main pass again. That of the prepass is all of it: what has none is drawn later.
    pub fn open(&mut self, encoder: &mut CommandEncoder, tested: &Texture) {
        if let Some(kept) = self.depth.as_ref().filter(|kept| kept.size() == tested.size()) {
            encoder.copy_texture_to_texture(kept.as_image_copy(), tested.as_image_copy(), tested.size());
        }
        self.is_shown = true;
    }

    /// Records the post-process of a planned frame, and writes it to `output`. After an error nothing is written.
    pub fn record(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &ExtractedAfterimage,
        drawn: Drawn<'_>,
        output: &wgpu::TextureView,
        blit: &mut BlitPass,
    ) -> Result<(), FrameError> {
        let ratio = self.exposure.map_or(1.0, |previous| frame.exposure / previous);
        let exposure = if ratio != 1.0 && ratio.is_finite() { Exposure::Changed { ratio } } else { Exposure::Same };
        let regions = drawn.regions(self.plain.as_ref());
        let albedo = self.albedo.as_ref().map(Textures::from);
        let described = Frame { exposure, albedo, ..described(frame, &regions) };
        let shown = output.texture();
        let is_direct = shown.format() == FORMAT && shown.usage().contains(TextureUsages::STORAGE_BINDING);
        let reserve = |kept: &mut Option<Texture>, is_needed: bool| {
            *kept = is_needed.then(|| fitting(kept.take(), device, extent(frame), FORMAT, STORAGE));
        };
        reserve(&mut self.spare, !is_direct || frame.debug.is_some());
        reserve(&mut self.spare_debug, !is_direct && frame.debug.is_some());
        let region = [Region::new(shown, drawn.origin_px)];
        let [spare, spare_debug] = [&self.spare, &self.spare_debug].map(Option::as_ref);
        let direct = Textures::Regions(&region);
        if let Some(view) = frame.debug {
            let target = spare_debug.map_or(direct, Textures::from);
            self.post.record_view(device, encoder, &described, target, view)?;
        }
        let target = Target {
            counters: self.counters.as_ref().map(|counters| &counters.buffer),
            ..Target::new(spare.map_or(direct, Textures::from))
        };
        self.post.record(device, encoder, &described, target)?;
        self.exposure = Some(frame.exposure);
        if let (Some(counters), Some(quads)) = (&mut self.counters, self.post.quad_list(0)) {
            counters.record(encoder, quads);
        }
        if !is_direct && let Some(frame) = spare_debug.or(spare) {
            blit.record(device, encoder, frame, output, drawn.origin_px);
        }
        Ok(())
    }
}
