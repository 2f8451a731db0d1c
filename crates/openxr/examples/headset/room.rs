//! The application's own renderer: a room of bricks with boxes, a page of text, and an object in each hand.

use afterimage_openxr::wgpu::util::{BufferInitDescriptor, DeviceExt};
use afterimage_openxr::wgpu::{self, TextureFormat, TextureUsages};
use afterimage_openxr::{Eye, HalfViews, HiddenMesh, TargetViews, Targets};
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3};

/// Distance of the constants of two eyes in bytes. Those of eyes at half the size follow.
const STRIDE: u64 = 1024;
const SIDE: u32 = 1024;

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Uniforms {
    clip_from_world: [[f32; 4]; 4],
    clip_from_view: [[f32; 4]; 4],
    now: [[f32; 4]; 4],
    before: [[f32; 4]; 4],
    moved: [[[f32; 4]; 4]; 3],
    moved_before: [[[f32; 4]; 4]; 3],
    size: [f32; 4],
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Vertex {
    position: [f32; 3],
    uv: [f32; 2],
    tint: [f32; 3],
    map_pose: [u32; 2],
}

/// Poses of the hands in the world.
pub type Hands = [Mat4; 2];

pub struct Room {
    prepass: wgpu::RenderPipeline,
    color: wgpu::RenderPipeline,
    hidden: wgpu::RenderPipeline,
    vertices: wgpu::Buffer,
    count: u32,
    uniforms: wgpu::Buffer,
    group: wgpu::BindGroup,
    /// Vertices and indices of what the lenses hide.
    meshes: [Option<(wgpu::Buffer, wgpu::Buffer, u32)>; 2],
}

impl Room {
    /// `page`: gray values of the page of text, with its size.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, page: &image::GrayImage) -> Self {
        let module = device.create_shader_module(wgpu::include_wgsl!("room.wgsl"));
        let visibility = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("room"),
            entries: &[
                entry(
                    0,
                    wgpu::BindingType::Buffer {
                        ty: wgpu::BufferBindingType::Uniform,
                        has_dynamic_offset: true,
                        min_binding_size: None,
                    },
                ),
                entry(
                    1,
                    wgpu::BindingType::Texture {
                        sample_type: wgpu::TextureSampleType::Float { filterable: true },
                        view_dimension: wgpu::TextureViewDimension::D2Array,
                        multisampled: false,
                    },
                ),
                entry(2, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)),
            ],
        });
        let pipeline = |[vertex, fragment]: [&str; 2], format: TextureFormat, attributes: &[wgpu::VertexAttribute]| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("room"),
                layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                    label: None,
                    bind_group_layouts: &[Some(&layout)],
                    immediate_size: 0,
                })),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some(vertex),
                    compilation_options: Default::default(),
                    buffers: &[Some(wgpu::VertexBufferLayout {
                        array_stride: attributes.iter().map(|attribute| attribute.format.size()).sum(),
                        step_mode: wgpu::VertexStepMode::Vertex,
                        attributes,
                    })],
                },
                primitive: Default::default(),
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: Targets::DEPTH,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(fragment),
                    compilation_options: Default::default(),
                    targets: &[Some(format.into())],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x2, 2 => Float32x3, 3 => Uint32x2];
        let prepass = pipeline(["vertex", "motion"], Targets::MOTION, &attributes);
        let color = pipeline(["vertex", "color"], Targets::COLOR, &attributes);
        let hidden = pipeline(["hidden", "still"], Targets::MOTION, &wgpu::vertex_attr_array![0 => Float32x2]);
        let vertices = geometry();
        let count = vertices.len() as u32;
        let contents = bytemuck::cast_slice(&vertices);
        let usage = wgpu::BufferUsages::VERTEX;
        let vertices = device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage });
        let uniforms = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 4 * STRIDE,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let maps = maps(device, queue, &[bricks(), fitted(page)]);
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            address_mode_u: wgpu::AddressMode::Repeat,
            address_mode_v: wgpu::AddressMode::Repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                        buffer: &uniforms,
                        offset: 0,
                        size: wgpu::BufferSize::new(size_of::<Uniforms>() as u64),
                    }),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::TextureView(&maps.create_view(&Default::default())),
                },
                wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(&sampler) },
            ],
        });
        Self { prepass, color, hidden, vertices, count, uniforms, group, meshes: [None, None] }
    }

    /// What the lens of an eye hides.
    pub fn hide(&mut self, device: &wgpu::Device, eye: usize, mesh: Option<&HiddenMesh>) {
        self.meshes[eye] = mesh.map(|mesh| {
            let buffer = |contents: &[u8], usage| {
                device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage })
            };
            (
                buffer(bytemuck::cast_slice(&mesh.vertices), wgpu::BufferUsages::VERTEX),
                buffer(bytemuck::cast_slice(&mesh.indices), wgpu::BufferUsages::INDEX),
                mesh.indices.len() as u32,
            )
        });
    }

    /// Draws depth and motion vectors of an eye. `hands`: now and in the last frame.
    pub fn prepass(
        &self,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        views: &TargetViews,
        eye: &Eye,
        hands: [Hands; 2],
    ) {
        self.write(queue, eye.layer, eye, (hands, 0.0));
        // 0 is far away.
        let mut pass = self.pass(encoder, eye.layer, &views.motion, &views.depth, wgpu::LoadOp::Clear(0.0));
        if let Some((vertices, indices, count)) = &self.meshes[eye.layer as usize] {
            pass.set_pipeline(&self.hidden);
            pass.set_vertex_buffer(0, vertices.slice(..));
            pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..*count, 0, 0..1);
        }
        pass.set_pipeline(&self.prepass);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.draw(0..self.count, 0..1);
    }

    /// Draws colors after the prepass of the eye, where `depth` lets them pass.
    pub fn colors(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        eye: &Eye,
        color: &wgpu::TextureView,
        depth: &wgpu::TextureView,
    ) {
        let mut pass = self.pass(encoder, eye.layer, color, depth, wgpu::LoadOp::Load);
        pass.set_pipeline(&self.color);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.draw(0..self.count, 0..1);
    }

    /// Draws colors of an eye at half the width and height.
    pub fn half_colors(
        &self,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        views: &HalfViews,
        eye: &Eye,
        hands: [Hands; 2],
    ) {
        let slot = 2 + eye.layer;
        // Its pixels stand for those of the whole view.
        self.write(queue, slot, eye, (hands, -1.0));
        let mut pass = self.pass(encoder, slot, &views.color, &views.depth, wgpu::LoadOp::Clear(0.0));
        pass.set_pipeline(&self.color);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.draw(0..self.count, 0..1);
    }

    /// Writes the constants of an eye. `hands`: now and in the last frame; then the bias of textures.
    fn write(&self, queue: &wgpu::Queue, slot: u32, eye: &Eye, (hands, bias): ([Hands; 2], f32)) {
        let poses = |[left, right]: Hands| [Mat4::IDENTITY, left, right].map(|pose| pose.to_cols_array_2d());
        let [width, height] = eye.geometry.size_px().map(|n| n as f32);
        let uniforms = Uniforms {
            clip_from_world: eye.jittered_clip_from_world,
            clip_from_view: eye.jittered_clip_from_view,
            now: eye.clip_from_world,
            before: eye.previous_clip_from_world,
            moved: poses(hands[0]),
            moved_before: poses(hands[1]),
            size: [width, height, bias, 0.0],
        };
        queue.write_buffer(&self.uniforms, u64::from(slot) * STRIDE, bytemuck::bytes_of(&uniforms));
    }

    /// A pass over `view`, cleared, with the constants in a slot.
    fn pass<'a>(
        &self,
        encoder: &'a mut wgpu::CommandEncoder,
        slot: u32,
        view: &wgpu::TextureView,
        depth: &wgpu::TextureView,
        depth_load: wgpu::LoadOp<f32>,
    ) -> wgpu::RenderPass<'a> {
        let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store };
        let attachment = wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("room"),
            color_attachments: &[Some(attachment)],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth,
                depth_ops: Some(wgpu::Operations { load: depth_load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.group, &[slot * STRIDE as u32]);
        pass
    }
}

/// Triangles of a room around the head, boxes and a page in it, and an object in each hand.
fn geometry() -> Vec<Vertex> {
    let mut vertices = vec![];
    let mut cuboid = |middle: Vec3, half: Vec3, tint: [f32; 3], repeat: f32, map_pose: [u32; 2]| {
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let light = [[0.75, 0.85], [0.55, 1.0], [0.9, 0.7]][axis][usize::from(side > 0.0)];
                let corner = |a: f32, b: f32| {
                    let mut p = half;
                    p[axis] *= side;
                    p[u] *= a;
                    p[v] *= b;
                    // Upright bricks on walls.
                    let along = if u == 1 { [p[v], -p[u]] } else { [p[u], -p[v]] };
                    let position = (middle + p).to_array();
                    Vertex { position, uv: along.map(|x| x * repeat), tint: tint.map(|c| c * light), map_pose }
                };
                let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
                vertices.extend([a, b, c, a, c, d]);
            }
        }
    };
    cuboid(Vec3::new(0.0, 0.2, -1.0), Vec3::new(2.5, 1.6, 3.0), [0.9, 0.8, 0.7], 0.9, [0, 0]);
    cuboid(Vec3::new(-1.1, -0.9, -2.4), Vec3::new(0.4, 0.5, 0.4), [0.9, 0.35, 0.25], 1.6, [0, 0]);
    cuboid(Vec3::new(1.2, -0.7, -1.8), Vec3::new(0.25, 0.7, 0.25), [0.3, 0.55, 0.9], 1.6, [0, 0]);
    cuboid(Vec3::ZERO, Vec3::new(0.05, 0.05, 0.12), [0.5, 0.85, 0.4], 6.0, [0, 1]);
    cuboid(Vec3::ZERO, Vec3::new(0.04, 0.12, 0.04), [0.9, 0.75, 0.3], 6.0, [0, 2]);
    // The page hangs at arm's length, turned a little.
    let pose = Mat4::from_translation(Vec3::new(-0.25, 0.15, -1.2)) * Mat4::from_rotation_y(0.2);
    let corner = |x: f32, y: f32| Vertex {
        position: pose.transform_point3(Vec3::new(0.3 * x, 0.3 * y, 0.0)).to_array(),
        uv: [0.5 + 0.5 * x, 0.5 - 0.5 * y],
        tint: [1.0; 3],
        map_pose: [1, 0],
    };
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    vertices.extend([a, b, c, a, c, d]);
    vertices
}

/// Bricks with grains and lines, as linear gray values.
fn bricks() -> Vec<f32> {
    let hash = |x: u32, y: u32| {
        let mut h = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77);
        h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
        (h >> 8) as f32 / (1 << 24) as f32
    };
    let value = |i: u32| {
        let (x, y) = (i % SIDE, i / SIDE);
        let row = y / 128;
        let along = (x + 128 * (row % 2)) % SIDE;
        let is_joint = along % 256 < 12 || y % 128 < 12;
        let is_stroke = (along % 256 / 16 + y % 128 / 16 * 3 + (hash(along / 256, row) * 7.0) as u32).is_multiple_of(5);
        let brick = 0.35 + 0.3 * hash(along / 256 + 17, row);
        let grain = 0.12 * (hash(x / 4, y / 4) - 0.5);
        if is_joint { 0.75 } else { (brick * if is_stroke { 0.25 } else { 1.0 } + grain).max(0.02) }
    };
    (0..SIDE * SIDE).map(value).collect()
}

/// The upper left square of a page, as linear gray values.
fn fitted(page: &image::GrayImage) -> Vec<f32> {
    let side = page.width().min(page.height()).min(SIDE);
    let page = image::imageops::crop_imm(page, 0, 0, side, side).to_image();
    let page = image::imageops::resize(&page, SIDE, SIDE, image::imageops::FilterType::Triangle);
    page.pixels().map(|p| decoded(f32::from(p.0[0]) / 255.0)).collect()
}

/// Gray textures with mip levels that are means of linear light.
fn maps(device: &wgpu::Device, queue: &wgpu::Queue, layers: &[Vec<f32>]) -> wgpu::Texture {
    let levels = SIDE.ilog2() + 1;
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("maps"),
        size: wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: layers.len() as u32 },
        mip_level_count: levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: TextureFormat::Rgba8UnormSrgb,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (layer, values) in layers.iter().enumerate() {
        let mut level = values.clone();
        for mip_level in 0..levels {
            let side = SIDE >> mip_level;
            let gray = |&v: &f32| [encoded(v); 3].into_iter().chain([255]);
            let bytes: Vec<u8> = level.iter().flat_map(gray).collect();
            let origin = wgpu::Origin3d { x: 0, y: 0, z: layer as u32 };
            let to = wgpu::TexelCopyTextureInfo { mip_level, origin, ..texture.as_image_copy() };
            let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * side), rows_per_image: None };
            let size = wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 };
            queue.write_texture(to, &bytes, layout, size);
            let half = side / 2;
            let at = |x: u32, y: u32| level[(y * side + x) as usize];
            let mean = |i: u32| {
                let (x, y) = (2 * (i % half), 2 * (i / half));
                0.25 * (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1))
            };
            level = (0..half * half).map(mean).collect();
        }
    }
    texture
}

/// sRGB, 8 bits, of linear light.
pub fn encoded(linear: f32) -> u8 {
    let v = linear.clamp(0.0, 1.0);
    let v = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    (255.0 * v + 0.5) as u8
}

fn decoded(v: f32) -> f32 {
    if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}
