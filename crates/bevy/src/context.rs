//! A camera's post-process: contexts of the drop-in, and the textures between Bevy and them.

use crate::blit::BlitPass;
use crate::camera::FoveationKind;
use crate::counters::Counters;
use crate::frame::ExtractedAfterimage;
use afterimage::gpu::{Afterimage, Frame, Region, Target, Textures};
use afterimage::simulator::{GpuSimulator, SimulatorFrame};
use afterimage::{Exposure, Reset, ViewFrame, wgpu};
use wgpu::{CommandEncoder, Device, TextureFormat, TextureUsages};

/// Format in which the post-process works: Bevy's of cameras with `Hdr`.
const FORMAT: TextureFormat = TextureFormat::Rgba16Float;

/// Sides of the samples' atlas are multiples of this, so that it is not made anew whenever the gaze moves.
const ATLAS_MULTIPLE_PX: u32 = 64;

/// Usages of textures that the post-process writes.
const STORAGE: TextureUsages = TextureUsages::STORAGE_BINDING.union(TextureUsages::TEXTURE_BINDING);

fn texture(device: &Device, [width, height]: [u32; 2], format: TextureFormat, usage: TextureUsages) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("afterimage"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// State of a camera's post-process.
#[derive(Debug)]
pub(crate) struct Context {
    post: Afterimage,
    simulation: Option<Simulation>,
    /// Color input: the samples of lattice cameras, or the camera's pixels.
    pub color: Option<wgpu::Texture>,
    /// How many views of this frame are in `color`.
    pub copied: usize,
    /// Frame, where it cannot be written to the main texture, or where a debug view is shown instead.
    spare: Option<wgpu::Texture>,
    /// Debug view, where it cannot be written to the main texture.
    spare_debug: Option<wgpu::Texture>,
    pub counters: Option<Counters>,
    exposure: Option<f32>,
}

#[derive(Debug)]
struct Simulation {
    simulator: GpuSimulator,
    foveated: wgpu::Texture,
    made_for: afterimage::ContextDesc,
}

/// What a view drew.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawn<'a> {
    pub color: &'a wgpu::Texture,
    /// First pixel of the view in its texture.
    pub from_px: [u32; 2],
    /// First texel of its place in the color input.
    pub to_px: [u32; 2],
    pub size_px: [u32; 2],
}

/// Depth and motion vectors of a camera's viewport, in its prepass textures.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Geometry<'a> {
    pub depth: &'a wgpu::Texture,
    pub motion: &'a wgpu::Texture,
}

/// Main textures of a camera.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Output<'a> {
    /// What the frame is to be written to.
    pub texture: &'a wgpu::Texture,
    pub view: &'a wgpu::TextureView,
    pub origin_px: [u32; 2],
}

/// What a frame has beside its description.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facts {
    pub index: u64,
    /// Factor of the camera on colors.
    pub exposure: f32,
    pub jitter_px: [f32; 2],
}

impl<'a> Geometry<'a> {
    fn regions(self, origin_px: [u32; 2]) -> [[Region<'a>; 1]; 2] {
        [self.depth, self.motion].map(|texture| [Region::new(texture, origin_px)])
    }
}

fn reset(frame: &ExtractedAfterimage) -> Reset {
    if frame.reset { Reset::All } else { Reset::None }
}

impl Context {
    pub fn new(device: &Device, frame: &ExtractedAfterimage) -> Result<Self, String> {
        let post = Afterimage::new(device, &frame.desc, FORMAT).map_err(|error| error.to_string())?;
        Ok(Self {
            post,
            simulation: None,
            color: None,
            copied: 0,
            spare: None,
            spare_debug: None,
            counters: None,
            exposure: None,
        })
    }

    /// Makes settings and textures those of the frame.
    pub fn prepare(&mut self, device: &Device, frame: &ExtractedAfterimage) -> Result<(), String> {
        self.copied = 0;
        if self.post.desc().settings != frame.desc.settings {
            self.post.set_settings(device, frame.desc.settings).map_err(|error| error.to_string())?;
        }
        if frame.kind != FoveationKind::Simulated {
            self.simulation = None;
        } else if self.simulation.as_ref().is_none_or(|simulation| !simulation.serves(frame)) {
            self.simulation = Some(Simulation::new(device, frame)?);
        }
        match (&self.counters, frame.counts) {
            (None, true) => self.counters = Some(Counters::new(device)),
            (Some(_), false) => self.counters = None,
            _ => {}
        }
        Ok(())
    }

    /// Makes the post-process that of views of the frame's size. History survives if their shape is the same.
    fn resize(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &ExtractedAfterimage,
    ) -> Result<(), String> {
        let (has, needs) = (self.post.desc().size_px, frame.desc.size_px);
        if has == needs {
            return Ok(());
        }
        // Sides are rounded to whole pixels.
        let [a, b] = [[has[0], needs[1]], [needs[0], has[1]]].map(|[x, y]| f64::from(x) * f64::from(y));
        let is_same_shape = (a - b).abs() <= f64::from(has.into_iter().chain(needs).max().unwrap_or(0));
        let resized = match is_same_shape {
            true => self.post.resize_keeping_history(device, encoder, needs),
            false => self.post.resize(device, needs),
        };
        resized.map_err(|error| error.to_string())
    }

    /// Copies what a view drew to its place in the color input.
    pub fn copy(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &ExtractedAfterimage,
        drawn: &Drawn<'_>,
    ) {
        let (needs, format) = (frame.atlas_px, drawn.color.format());
        let has = self.color.as_ref().filter(|color| color.format() == format);
        let has = has.map_or([0, 0], |color| [color.width(), color.height()]);
        // An atlas may be larger than needed. A whole frame has the view's size.
        let (fits, size) = match frame.samples.is_empty() {
            true => (has == needs, needs),
            false => (
                has[0] >= needs[0] && has[1] >= needs[1],
                [0, 1].map(|i| has[i].max(needs[i]).next_multiple_of(ATLAS_MULTIPLE_PX)),
            ),
        };
        if !fits {
            let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST | TextureUsages::COPY_SRC;
            self.color = Some(texture(device, size, format, usage));
        }
        let Some(color) = &self.color else { return };
        let at = |texture, [x, y]: [u32; 2]| wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: 0,
            origin: wgpu::Origin3d { x, y, z: 0 },
            aspect: wgpu::TextureAspect::All,
        };
        let [width, height] = drawn.size_px;
        let extent = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        encoder.copy_texture_to_texture(at(drawn.color, drawn.from_px), at(color, drawn.to_px), extent);
        self.copied += 1;
    }

    /// Records the post-process of the color input, and writes the frame to `output`. After an error nothing is
    /// written.
    pub fn record(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        (frame, facts): (&ExtractedAfterimage, Facts),
        geometry: Option<Geometry<'_>>,
        output: Output<'_>,
        blit: &mut Option<BlitPass>,
    ) -> Result<(), String> {
        let Some(color) = self.color.clone() else { return Err("it has no color".into()) };
        self.resize(device, encoder, frame)?;
        let size = frame.desc.size_px;
        let views = [ViewFrame { jitter_px: facts.jitter_px, ..frame.view }];
        let mut color = &color;
        if let Some(simulation) = &mut self.simulation {
            let simulated = SimulatorFrame::new(color, &simulation.foveated, &views);
            simulation.simulator.record(device, encoder, &simulated).map_err(|error| error.to_string())?;
            color = &simulation.foveated;
        }
        let is_direct =
            output.texture.format() == FORMAT && output.texture.usage().contains(TextureUsages::STORAGE_BINDING);
        for (spare, is_needed) in [
            (&mut self.spare, !is_direct || frame.debug.is_some()),
            (&mut self.spare_debug, !is_direct && frame.debug.is_some()),
        ] {
            if !is_needed {
                *spare = None;
            } else if spare.as_ref().is_none_or(|texture| [texture.width(), texture.height()] != size) {
                *spare = Some(texture(device, size, FORMAT, STORAGE));
            }
        }

        let regions = geometry.map(|geometry| geometry.regions(output.origin_px));
        let [depth, motion] = match &regions {
            Some(regions) => regions.each_ref().map(|region| Some(Textures::Regions(region))),
            None => [None, None],
        };
        let ratio = self.exposure.map_or(1.0, |previous| facts.exposure / previous);
        let described = Frame {
            depth,
            motion,
            reset: reset(frame),
            exposure: if ratio != 1.0 && ratio.is_finite() { Exposure::Changed { ratio } } else { Exposure::Same },
            ..Frame::new(color, &views, facts.index)
        };
        let region = [Region::new(output.texture, output.origin_px)];
        let direct = Textures::Regions(&region);
        let shown = |spare: &'_ Option<wgpu::Texture>| spare.clone();
        let (spare, spare_debug) = (shown(&self.spare), shown(&self.spare_debug));
        if let Some(view) = frame.debug {
            let target = spare_debug.as_ref().map_or(direct, Textures::from);
            self.post.record_view(device, encoder, &described, target, view).map_err(|error| error.to_string())?;
        }
        let target = Target {
            counters: self.counters.as_ref().map(|counters| &counters.buffer),
            ..Target::new(spare.as_ref().map_or(direct, Textures::from))
        };
        self.post.record(device, encoder, &described, target).map_err(|error| error.to_string())?;
        self.exposure = Some(facts.exposure);
        if let Some(counters) = &mut self.counters {
            counters.record(encoder);
        }
        if !is_direct && let Some(frame) = spare_debug.or(spare) {
            let format = output.texture.format();
            if blit.as_ref().is_none_or(|blit| blit.format() != format) {
                *blit = Some(BlitPass::new(device, format));
            }
            if let Some(blit) = blit {
                blit.record(device, encoder, &frame, output.view, output.origin_px);
            }
        }
        Ok(())
    }
}

impl Simulation {
    fn new(device: &Device, frame: &ExtractedAfterimage) -> Result<Self, String> {
        let simulator = GpuSimulator::new(device, &frame.desc, FORMAT).map_err(|error| error.to_string())?;
        let foveated = texture(device, frame.desc.size_px, FORMAT, STORAGE);
        Ok(Self { simulator, foveated, made_for: frame.desc })
    }

    fn serves(&self, frame: &ExtractedAfterimage) -> bool {
        let [made, now] = [&self.made_for, &frame.desc].map(|desc| (desc.size_px, desc.settings.foveation));
        made == now
    }
}
