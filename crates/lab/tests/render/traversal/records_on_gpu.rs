//! The device decodes triangle records as the CPU does, bit for bit.

use super::scenes::dressed;
use afterimage::wgpu;
use afterimage_lab::scene::{Alpha, Material};
use afterimage_lab::shader::SHADERS;
use afterimage_lab::trace::gpu::scene_buffer::{GpuSceneBuffer, Storage, geometry_constants, traversal_constants};
use afterimage_lab::trace::scene_buffer::SceneBufferBuilder;
use afterimage_lab::trace::{Bvh, Geometry, TriangleRecord};
use afterimage_testing::Draws;
use afterimage_testing::planted::all_caught_once;

const STILL: u32 = 400;
const MOVING: u32 = 100;
/// Words that the probe writes per triangle.
const WORDS: usize = 34;

const PROBE: &str = "
@group(0) @binding(1) var<storage, read> weights: array<vec2<f32>>;
@group(0) @binding(2) var<storage, read_write> words: array<u32>;
var<private> at: u32;
fn put(x: f32) { words[at] = bitcast<u32>(x); at += 1u; }
fn put3(v: vec3<f32>) { put(v.x); put(v.y); put(v.z); }
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&weights) { return; }
    at = id.x * 34u;
    let t = triangle_at(id.x);
    let before = previous_corners(id.x);
    for (var i = 0u; i < 3u; i++) { put3(t.corners[i]); }
    for (var i = 0u; i < 3u; i++) { put3(before[i]); }
    words[at] = t.material | t.flags;
    words[at + 1u] = t.source;
    at += 2u;
    let a = attributes_at(id.x, weights[id.x].x, weights[id.x].y);
    put3(a.normal); put3(a.tangent); put(a.bitangent_sign); put(a.uv.x); put(a.uv.y);
    put(a.color.x); put(a.color.y); put(a.color.z); put(a.color.w);
    put(f32(is_moving(id.x)));
}
";

fn expected(geometry: &Geometry, weights: &[[f32; 2]]) -> Vec<u32> {
    let mut words = vec![];
    for (i, &[u, v]) in weights.iter().enumerate() {
        let i = i as u32;
        let record: &TriangleRecord = geometry.triangle(i);
        let before = geometry.previous(i).map_or(record.positions(), |p| p.positions());
        let mut put = |x: f32| words.push(x.to_bits());
        record.positions().into_iter().chain(before).flat_map(|p| p.to_array()).for_each(&mut put);
        let flags = [24, 25, 26].iter().filter(|&&bit| record.has(1 << bit)).map(|bit| 1 << bit).sum::<u32>();
        put(f32::from_bits(record.material() | flags));
        put(f32::from_bits(record.source()));
        let a = geometry.attributes(i).at(u, v);
        let floats = [a.normal, a.tangent].map(|v| v.to_array()).concat();
        floats.into_iter().chain([a.bitangent_sign, a.uv.x, a.uv.y]).chain(a.color.to_array()).for_each(&mut put);
        put(f32::from(u8::from(i >= geometry.first_moving())));
    }
    words
}

fn source(storage: Storage) -> String {
    SHADERS.compose_with(&[storage.module(), "accept_all", "geometry"], PROBE).source
}

/// Triangles whose words differ between the device and the CPU.
fn differing(storage: Storage, source: &str) -> Option<usize> {
    let materials = [
        Material { emissive: [1.0; 3], transmission: 0.5, ..Material::default() },
        Material { alpha: Alpha::Blend, ..Material::default() },
    ];
    let (still, moving, before) = (dressed("still", STILL), dressed("moving", MOVING), dressed("before", MOVING));
    let geometry = Geometry {
        still: Bvh::build(&still, None, &materials),
        moving: Bvh::build(&moving, Some(&before.positions), &materials),
    };
    let (device, queue) = afterimage_testing::gpu::device()?;
    let scene_buffer = SceneBufferBuilder::default()
        .geometry(&geometry, MOVING as usize)
        .finish(storage.limits(&device.limits()))
        .unwrap();
    let on_device = GpuSceneBuffer::new(&device, &queue, &scene_buffer, storage);
    let mut d = Draws::new("weights");
    let weights: Vec<[f32; 2]> = (0..STILL + MOVING).map(|_| [d.range(0.0, 0.5), d.range(0.0, 0.5)]).collect();

    let mut constants = traversal_constants(&scene_buffer, &geometry, true, storage);
    constants.extend(geometry_constants(&scene_buffer));
    // Keep only overrides that the probe declares.
    constants.retain(|(name, _)| source.contains(&format!("override {name}:")));
    let words = afterimage_testing::gpu::validated(&device, "the probe", || {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: None,
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants,
                zero_initialize_workgroup_memory: false,
            },
            cache: None,
        });
        let buffer = |size: usize, usage| {
            let size = size as u64;
            device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
        };
        let storage_in = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        let input = buffer(weights.len() * 8, storage_in);
        queue.write_buffer(&input, 0, bytemuck::cast_slice(&weights));
        let output = buffer(weights.len() * WORDS * 4, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: on_device.binding() },
                wgpu::BindGroupEntry { binding: 1, resource: input.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 2, resource: output.as_entire_binding() },
            ],
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups((weights.len() as u32).div_ceil(64), 1, 1);
        }
        queue.submit([encoder.finish()]);
        afterimage_testing::gpu::read_buffer::<u32>(&device, &queue, &output)
    });
    let expected = expected(&geometry, &weights);
    let lines = words.chunks(WORDS).zip(expected.chunks(WORDS));
    let differing: Vec<_> = lines.enumerate().filter(|(_, (got, expected))| got != expected).collect();
    for (i, (got, expected)) in differing.iter().take(3) {
        let columns: Vec<usize> = (0..WORDS).filter(|&w| got[w] != expected[w]).collect();
        println!("triangle {i}: words {columns:?} differ");
    }
    Some(differing.len())
}

#[test]
fn the_device_reads_what_was_packed() {
    for storage in [Storage::Texture, Storage::Buffer] {
        let Some(differing) = differing(storage, &source(storage)) else { return };
        assert_eq!(differing, 0, "{storage:?}");
    }
}

#[test]
fn records_read_wrongly_are_caught() {
    let planted = [
        ("r0.w & 0xff000000u", "r0.w & 0xfe000000u"),
        ("MOVING_PREVIOUS + ", "MOVING_TRIANGLES + "),
        ("(tangents.x & 1u) != 0u", "false"),
        ("vec2<u32>(uv0.z, uv1.x)", "vec2<u32>(uv0.z, uv1.y)"),
        ("(triangle - FIRST_MOVING) * size", "triangle * size"),
    ];
    all_caught_once(source(Storage::Texture), &planted, |source| Some(differing(Storage::Texture, source)? > 0));
}
