//! Bind groups that are kept while their resources stay the same, and the views of textures in them.

use super::compute::ComputeShader;
use super::plane::layer_view;
use std::num::NonZeroU64;
use wgpu::{BindGroup, BindGroupLayout, BindingResource, Buffer, BufferBinding, Device, Texture, TextureView};

/// Frames for which a bind group is kept that none of them uses. Engines hand in two or three textures in turn, and
/// history alternates, so that bind groups recur after at most six frames.
const KEPT_FRAMES: u64 = 8;

#[derive(Clone, Debug, PartialEq)]
pub enum Resource {
    /// Bytes of a buffer from an offset on; `None`: all of them.
    Buffer(Buffer, u64, Option<NonZeroU64>),
    /// A layer of a texture, or all.
    Texture(Texture, Option<u32>),
    View(TextureView),
}

impl From<&Buffer> for Resource {
    fn from(buffer: &Buffer) -> Self {
        Self::Buffer(buffer.clone(), 0, None)
    }
}

impl From<&TextureView> for Resource {
    fn from(view: &TextureView) -> Self {
        Self::View(view.clone())
    }
}

/// Bind groups of a context.
#[derive(Debug, Default)]
pub struct Groups {
    frame: u64,
    list: Vec<Kept>,
}

#[derive(Debug)]
struct Kept {
    layout: BindGroupLayout,
    resources: Vec<Resource>,
    group: BindGroup,
    /// Last frame that used it.
    frame: u64,
}

impl Groups {
    /// Begins a frame, and drops what was not used for long.
    pub fn begin_frame(&mut self) {
        self.frame += 1;
        let frame = self.frame;
        self.list.retain(|kept| frame - kept.frame <= KEPT_FRAMES);
    }

    pub fn clear(&mut self) {
        self.list.clear();
    }

    /// The bind group of `resources`, in the order of the shader's bindings.
    pub fn get(&mut self, device: &Device, shader: &ComputeShader, resources: Vec<Resource>) -> BindGroup {
        let is_same = |kept: &&mut Kept| kept.layout == *shader.group_layout() && kept.resources == resources;
        if let Some(kept) = self.list.iter_mut().find(is_same) {
            kept.frame = self.frame;
            return kept.group.clone();
        }
        let group = make(device, shader, &resources);
        let layout = shader.group_layout().clone();
        self.list.push(Kept { layout, resources, group: group.clone(), frame: self.frame });
        group
    }
}

fn make(device: &Device, shader: &ComputeShader, resources: &[Resource]) -> BindGroup {
    let views: Vec<_> = resources
        .iter()
        .map(|resource| match resource {
            Resource::Buffer(..) => None,
            Resource::Texture(texture, layer) => Some(layer_view(texture, *layer)),
            Resource::View(view) => Some(view.clone()),
        })
        .collect();
    let bound = resources.iter().zip(&views).map(|(resource, view)| match (resource, view) {
        (Resource::Buffer(buffer, offset, size), _) => {
            BindingResource::Buffer(BufferBinding { buffer, offset: *offset, size: *size })
        }
        (_, view) => BindingResource::TextureView(view.as_ref().expect("a texture has a view")),
    });
    shader.group(device, bound)
}
