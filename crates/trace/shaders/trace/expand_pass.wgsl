// Expands spans of pixels into a batch's samples; one invocation per sample.

struct Span {
    pixel: u32,
    count: u32,
    before: u32,
}

struct Batch {
    first_pixel: u32,
    first_sample: u32,
    // Samples per pixel in this batch.
    samples: u32,
    items: u32,
}

@group(0) @binding(0) var<uniform> batch: Batch;
@group(0) @binding(1) var<storage, read> spans: array<Span>;
// Pixel and sample number of each item.
@group(0) @binding(2) var<storage, read_write> work: array<vec2u>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= batch.items {
        return;
    }
    let number = batch.first_pixel + id.x / batch.samples;
    // Binary search for the last span that begins at or before the pixel.
    var low = 0u;
    var high = arrayLength(&spans);
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if spans[middle].before <= number {
            low = middle;
        } else {
            high = middle;
        }
    }
    let pixel = spans[low].pixel + (number - spans[low].before);
    work[id.x] = vec2u(pixel, batch.first_sample + id.x % batch.samples);
}
