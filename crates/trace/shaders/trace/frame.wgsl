// Bindings of all kernels, and the layout of path state. Twin of src/gpu/paths.rs.

struct TraceFrame {
    origin: vec3f,
    key: u32,
    corner: vec3f,
    lights: u32,
    right: vec3f,
    sky_probability: f32,
    down: vec3f,
    width: u32,
    sky: vec3f,
    items: u32,
    map_size: vec2u,
    capacity: u32,
    jitter: f32,
    // Pixel (x, y) has index y * width + x - film_base in the film.
    film_base: u32,
}

// Indices into `counters`.
const NEXT: u32 = 0u;
const SHADOWS: u32 = 1u;
const RAYS_LOW: u32 = 2u;
const RAYS_HIGH: u32 = 3u;
const NONFINITE: u32 = 4u;
// Indices into `plan`, after the workgroup counts along x, y and z of `extend` and `shade` and those of `shadow`.
const BOUNCE: u32 = 6u;
const PATHS_ALIVE: u32 = 7u;
const SHADOW_RAYS: u32 = 8u;

@group(1) @binding(0) var<uniform> frame: TraceFrame;
// Pixel and sample number of each item of the batch in flight.
@group(1) @binding(1) var<storage, read> work: array<vec2u>;
// State of each path, PATH_ROWS rows.
@group(1) @binding(2) var<storage, read_write> paths: array<vec4u>;
// Path indices in three lists of `capacity` each: live paths at even bounces, at odd bounces, and paths with a shadow
// ray.
@group(1) @binding(3) var<storage, read_write> lists: array<u32>;
@group(1) @binding(4) var<storage, read_write> counters: array<atomic<u32>, 5>;

override WORKGROUP: u32 = 64u;

const PATH_ROWS: u32 = 8u;
// Ray origin; density of its direction in w (0 for camera rays).
const PATH_ORIGIN: u32 = 0u;
// Ray direction; in w the density with which light sampling would have chosen it for the environment.
const PATH_DIRECTION: u32 = 1u;
const PATH_THROUGHPUT: u32 = 2u;
const PATH_RADIANCE: u32 = 3u;
// Triangle, distance and barycentric weights of the hit.
const PATH_HIT: u32 = 4u;
// Three rows of a shadow ray: origin and limit, direction, contribution.
const PATH_SHADOW: u32 = 5u;

fn path_row(path: u32, row: u32) -> vec4f {
    return bitcast<vec4f>(paths[path * PATH_ROWS + row]);
}

fn set_path_row(path: u32, row: u32, value: vec3f, last: f32) {
    paths[path * PATH_ROWS + row] = bitcast<vec4u>(vec4f(value, last));
}
