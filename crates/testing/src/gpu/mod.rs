//! GPU tests: one adapter per test program, devices of single tests, and probes that run a WGSL entry point over a
//! table of inputs.

mod adapter;
mod arithmetic;

pub use adapter::{adapter, choice};
pub use arithmetic::{Arithmetic, arithmetic, rounds_as_the_cpu};
use std::borrow::Cow;
use std::sync::{OnceLock, mpsc};

/// Initial value of every word of a probe's output. A word that keeps it was not written, and fails the comparison.
pub const SENTINEL: u32 = 0xdead_beef;

/// Threads in a workgroup of a probe.
pub const WORKGROUP: u32 = 64;

/// A fresh device with default limits. Uncaptured errors panic.
pub fn device() -> Option<(wgpu::Device, wgpu::Queue)> {
    device_with(&wgpu::DeviceDescriptor::default())
}

/// A fresh device of a description. Uncaptured errors panic.
pub fn device_with(desc: &wgpu::DeviceDescriptor<'_>) -> Option<(wgpu::Device, wgpu::Queue)> {
    let adapter = adapter()?;
    let desc = wgpu::DeviceDescriptor { label: Some("test"), trace: recording(), ..desc.clone() };
    Some(pollster::block_on(adapter.request_device(&desc)).expect("a device with default limits"))
}

/// Where a device of this test is recorded: everything that it is asked to do, and everything that is read back. Folder
/// `AFTERIMAGE_RECORD`, if it is set, and one in it for each device, named after the test. `tests/web.sh` repeats the
/// recordings on another implementation of WebGPU.
fn recording() -> wgpu::Trace {
    use std::sync::atomic::{AtomicU32, Ordering};
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let Some(folder) = record_folder() else { return wgpu::Trace::Off };
    let test = std::thread::current().name().unwrap_or("main").replace("::", ".");
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let folder = std::path::Path::new(folder).join(format!("{test}.{number}"));
    std::fs::create_dir_all(&folder).expect("a folder for the recording");
    wgpu::Trace::Directory(folder)
}

/// Whether devices are recorded.
pub fn is_recorded() -> bool {
    record_folder().is_some()
}

fn record_folder() -> Option<&'static std::ffi::OsStr> {
    static FOLDER: OnceLock<Option<std::ffi::OsString>> = OnceLock::new();
    FOLDER.get_or_init(|| std::env::var_os("AFTERIMAGE_RECORD")).as_deref()
}

/// Adds what was read to the recording: the content of a buffer of this name, after the copy that it was read by.
fn record_read(device: &wgpu::Device, queue: &wgpu::Queue, bytes: &[u8]) {
    if is_recorded() {
        let expected = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("expected"),
            size: bytes.len() as u64,
            usage: wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        queue.write_buffer(&expected, 0, bytes);
    }
}

/// Runs `f`; panics with the message of its first validation error.
#[track_caller]
pub fn validated<T>(device: &wgpu::Device, what: &str, f: impl FnOnce() -> T) -> T {
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let result = f();
    if let Some(error) = pollster::block_on(scope.pop()) {
        panic!("{what}: {error}");
    }
    result
}

/// Runs the compute entry point `entry` of `source` and returns its output.
///
/// Binding 0: `inputs`, read-only storage; binding 1: `out_words` words of storage, filled with [`SENTINEL`]. At least
/// `out_words` invocations run, in workgroups of [`WORKGROUP`] along x, so that each invocation can handle one row.
#[track_caller]
pub fn run_probe(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    source: &str,
    entry: &str,
    inputs: &[u32],
    out_words: usize,
) -> Vec<u32> {
    let bytes = (out_words * 4) as u64;
    let buffer = |label, size, usage| {
        device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
    };
    validated(device, "the probe", || {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("probe"),
            source: wgpu::ShaderSource::Wgsl(Cow::Borrowed(source)),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("probe"),
            layout: None,
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            cache: None,
        });
        let input = buffer(
            "probe input",
            (inputs.len() * 4) as u64,
            wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        );
        let output = buffer(
            "probe output",
            bytes,
            wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
        );
        queue.write_buffer(&input, 0, bytemuck::cast_slice(inputs));
        queue.write_buffer(&output, 0, bytemuck::cast_slice(&vec![SENTINEL; out_words]));
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("probe"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: input.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: output.as_entire_binding() },
            ],
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups((out_words as u32).div_ceil(WORKGROUP), 1, 1);
        }
        queue.submit([encoder.finish()]);
        read_buffer(device, queue, &output)
    })
}

/// Waits for submitted work and reads a buffer with usage `COPY_SRC`: values of `T`.
pub fn read_buffer<T: bytemuck::Pod>(device: &wgpu::Device, queue: &wgpu::Queue, buffer: &wgpu::Buffer) -> Vec<T> {
    let (sender, receiver) = mpsc::channel();
    wgpu::util::DownloadBuffer::read_buffer(device, queue, &buffer.slice(..), move |bytes| {
        let _ = sender.send(bytes.map(|bytes| bytes.to_vec()));
    });
    device.poll(wgpu::PollType::wait_indefinitely()).expect("the device finishes");
    let bytes = receiver.recv().expect("the callback ran").expect("the buffer maps");
    record_read(device, queue, &bytes);
    bytemuck::pod_collect_to_vec(&bytes)
}

/// Writes one array layer of a texture.
pub fn write_layer(queue: &wgpu::Queue, texture: &wgpu::Texture, layer: usize, bytes: &[u8]) {
    let size = wgpu::Extent3d { width: texture.width(), height: texture.height(), depth_or_array_layers: 1 };
    let mut to = texture.as_image_copy();
    to.origin.z = layer as u32;
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(bytes.len() as u32 / size.height),
        rows_per_image: Some(size.height),
    };
    queue.write_texture(to, bytes, layout, size);
}

/// Fills one mip level of a texture, all layers, with one byte value.
pub fn fill_level(queue: &wgpu::Queue, texture: &wgpu::Texture, level: u32, byte: u8) {
    let size = wgpu::Extent3d {
        width: texture.width() >> level,
        height: texture.height() >> level,
        depth_or_array_layers: texture.depth_or_array_layers(),
    };
    let row = size.width * texture.format().block_copy_size(None).unwrap();
    let bytes = vec![byte; (row * size.height * size.depth_or_array_layers) as usize];
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: Some(size.height) };
    let to = wgpu::TexelCopyTextureInfo { mip_level: level, ..texture.as_image_copy() };
    queue.write_texture(to, &bytes, layout, size);
}

/// Reads a texture whose texels are whole words: all words, layer after layer.
pub fn read_texture(device: &wgpu::Device, queue: &wgpu::Queue, texture: &wgpu::Texture) -> Vec<u32> {
    let texel = texture.format().block_copy_size(None).unwrap();
    let row = texture.width() * texel;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let rows = texture.height() * texture.depth_or_array_layers();
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size: u64::from(padded) * u64::from(rows),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: Some(texture.height()) };
    let mut encoder = device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
        texture.size(),
    );
    queue.submit([encoder.finish()]);
    let words: Vec<u32> = read_buffer(device, queue, &buffer);
    words.chunks_exact(padded as usize / 4).flat_map(|r| &r[..row as usize / 4]).copied().collect()
}
