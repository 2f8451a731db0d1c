//! Drawing to chosen quads of 2x2 pixels only. All other pixels have the depth of the near plane, so that the depth
//! test rejects drawing to them. Chunks of triangles that cannot touch a chosen quad are left out.

use super::pixels::Pixels;
use super::window::DrawCall;
use crate::device::{bind_group, empty_buffer};
use crate::shader::SHADERS;
use crate::view::View;
use afterimage::internal::{ComputeShader, filled};
use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use wgpu::{BindGroup, BindGroupLayout, Buffer, BufferUsages, CommandEncoder, Device};

/// Binary logarithm of the quads along a tile; twin of `TILE_QUADS_LOG2` in `shaders/raster/tile_pass.wgsl`.
const TILE_QUADS_LOG2: u32 = 3;
const TILE_PX: u32 = 2 << TILE_QUADS_LOG2;
/// Bytes of the arguments of a draw.
const DRAW_BYTES: u64 = 16;
/// Place of the arguments of a dispatch in the list of quads, in bytes.
pub(super) const LIST_DISPATCH: u64 = 16;
/// Pixels around a chunk's rectangle, for rounding.
const MARGIN_PX: f64 = 1.0;

/// A chunk of triangles and the tiles that it may cover. Twin of `Chunk` in `shaders/raster/chunk_pass.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Chunk {
    first_vertex: u32,
    vertices: u32,
    low: u32,
    high: u32,
}

/// The passes that choose the draw calls.
#[derive(Debug)]
pub(super) struct ChunkTest {
    tile: ComputeShader,
    chunk: ComputeShader,
}

/// Chosen quads, and arguments of the draw calls that may touch them.
#[derive(Debug)]
pub(super) struct ChosenQuads {
    /// The quads, in the form of `gpu::Afterimage::quad_list`.
    pub list: Buffer,
    pub group: BindGroup,
    draws: Buffer,
}

impl ChosenQuads {
    /// Arguments of draw call `i`.
    pub fn draw(&self, i: usize) -> (&Buffer, u64) {
        (&self.draws, DRAW_BYTES * i as u64)
    }
}

impl ChunkTest {
    pub fn new(device: &Device) -> Self {
        let shader = |name| ComputeShader::new(device, name, &SHADERS.compose(name).source);
        Self { tile: shader("tile_pass"), chunk: shader("chunk_pass") }
    }

    /// Records the choice of the draw calls that may touch a quad of `list`. `calls`: all draw calls, with boxes around
    /// their triangles; `view`: the camera.
    pub fn record(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        view: &View,
        calls: &[(DrawCall, [DVec3; 2])],
        (list, layout): (&Buffer, &BindGroupLayout),
    ) -> ChosenQuads {
        let tiles = view.geometry().size_px().map(|side| side.div_ceil(TILE_PX));
        let words_per_row = tiles[0].div_ceil(32);
        let eye = view.world_from_camera().w_axis.truncate();
        let rectangles = Rectangles { pixels: Pixels::of(view), eye, last: tiles.map(|n| n - 1) };
        let mut chunks: Vec<Chunk> = calls
            .iter()
            .map(|(call, bounds)| {
                let [low, high] = rectangles.tiles(*bounds).map(|[x, y]| x | (y << 16));
                let vertices = call.vertices.len() as u32;
                Chunk { first_vertex: call.vertices.start, vertices, low, high }
            })
            .collect();
        // wgpu cannot bind an empty array.
        chunks.resize(chunks.len().max(1), Chunk::zeroed());
        let empty = |bytes, usage| empty_buffer(device, "chosen quads", bytes, usage);
        let marked = empty(4 * u64::from(words_per_row * tiles[1]), BufferUsages::STORAGE);
        let draws = empty(DRAW_BYTES * chunks.len() as u64, BufferUsages::STORAGE | BufferUsages::INDIRECT);
        let words = [words_per_row, 0, 0, 0];
        let words = filled(device, "chosen quads", bytemuck::bytes_of(&words), BufferUsages::UNIFORM);
        let count = chunks.len() as u32;
        let chunks = filled(device, "chosen quads", bytemuck::cast_slice(&chunks), BufferUsages::STORAGE);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        let group = self.tile.group(device, [&words, list, &marked].map(Buffer::as_entire_binding));
        pass.set_pipeline(&self.tile.pipeline(device, &[]));
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups_indirect(list, LIST_DISPATCH);
        let group = self.chunk.group(device, [&words, &chunks, &marked, &draws].map(Buffer::as_entire_binding));
        self.chunk.dispatch(device, &mut pass, &[], &group, [count, 1], 1);
        drop(pass);
        let group = bind_group(device, "chosen quads", layout, [list.as_entire_binding()]);
        ChosenQuads { list: list.clone(), group, draws }
    }
}

/// Rectangles of boxes, in tiles.
struct Rectangles {
    pixels: Pixels,
    eye: DVec3,
    /// Last tile along x and y.
    last: [u32; 2],
}

impl Rectangles {
    /// First and last tile that a box may cover: all tiles if a part of the box may be behind the eye or is not finite.
    fn tiles(&self, [low, high]: [DVec3; 2]) -> [[u32; 2]; 2] {
        let mut px = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for corner in 0..8 {
            let of = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
            let direction = DVec3::new(of(0), of(1), of(2)) - self.eye;
            let [x, y, along] = self.pixels.rows.map(|row| row.dot(direction));
            if along.is_nan() || along <= 1e-6 {
                return [[0; 2], self.last];
            }
            for (i, v) in [x / along, y / along].into_iter().enumerate() {
                px[0][i] = px[0][i].min(v);
                px[1][i] = px[1][i].max(v);
            }
        }
        let tile = |v: f64, i: usize| (v / f64::from(TILE_PX)).clamp(0.0, f64::from(self.last[i])) as u32;
        [[0, 1].map(|i| tile(px[0][i] - MARGIN_PX, i)), [0, 1].map(|i| tile(px[1][i] + MARGIN_PX, i))]
    }
}
