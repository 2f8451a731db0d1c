//! taa's and smr's histories: views, bit for bit, and memory.

use super::sequences::{SIZE, settings};
use afterimage::gpu::Afterimage;
use afterimage::internal::{ContextDesc, Foveation, FoveationKind, MethodKind, Settings};
use afterimage::wgpu::{self, TextureFormat};

#[test]
fn memory_bytes_is_what_is_made() {
    let Some((device, _)) = afterimage_testing::gpu::device() else { return };
    for (method, view_count, filter, size) in [
        (MethodKind::Taa, 1, FoveationKind::Mip, SIZE),
        (MethodKind::Taau, 1, FoveationKind::Mip, SIZE),
        (MethodKind::Smr, 1, FoveationKind::Mip, SIZE),
        (MethodKind::Smr, 2, FoveationKind::Block, SIZE),
        (MethodKind::Smr, 1, FoveationKind::Mip, [1, 1]),
    ] {
        let base = settings(method);
        let settings = Settings { foveation: Foveation { kind: filter, ..base.foveation }, ..base };
        let desc = ContextDesc { view_count, settings, ..ContextDesc::new(size) };
        let post = Afterimage::new(&device, &desc, TextureFormat::Rgba16Float).unwrap();
        // Two words a pixel, and four halves a texel of levels 1 to n, whose sides are padded so that halving never
        // rounds.
        let levels = if method != MethodKind::Smr { 0 } else { 5 + u64::from(filter == FoveationKind::Block) };
        let padded = |len: u32| u64::from(len.div_ceil(2)).next_multiple_of(1 << (levels.max(1) - 1));
        let chain: u64 = (0..levels).map(|l| (padded(size[0]) >> l) * (padded(size[1]) >> l)).sum();
        let expected = 2 * 8 * u64::from(view_count) * (u64::from(size[0] * size[1]) + chain);
        assert_eq!(post.memory_bytes(), expected, "{method:?}, {filter:?}, {size:?}");
        let made: u64 = post.history_textures().iter().map(bytes).sum();
        assert_eq!(2 * made, expected, "two sets of textures");
    }
}

/// Of all levels and layers, by what the texture itself says.
fn bytes(texture: &wgpu::Texture) -> u64 {
    let texel = u64::from(texture.format().block_copy_size(None).unwrap());
    let texels = |l: u32| {
        let size = texture.size().mip_level_size(l, texture.dimension());
        u64::from(size.width) * u64::from(size.height) * u64::from(size.depth_or_array_layers)
    };
    (0..texture.mip_level_count()).map(|l| texel * texels(l)).sum()
}
