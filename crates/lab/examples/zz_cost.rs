use afterimage::gpu::{Afterimage, Frame};
use afterimage::kernel::{pack::half_bits, rng};
use afterimage::shader::SHADERS;
use afterimage::wgpu::{TextureFormat as F, TextureUsages as U};
use afterimage::*;
use afterimage_lab::clock::{Quartiles, Stopwatch};
use afterimage_lab::device::{Headless, PassClock};

fn main() {
    let gpu = Headless::find(true).unwrap();
    let clock = PassClock::new(&gpu);
    let size = [1920u32, 1080];
    let paper = Settings::paper();
    let fov = Foveation { filter: Filter::Sparse, rate_mid: 2, rate_far: 4, ..paper.foveation };
    let sparse = Settings { method: Method::Smr, foveation: fov, ..paper };
    let smr = Settings { method: Method::Smr, ..paper };
    let tex = |f, u| gpu.texture(size, 1, f, u);
    let r = U::TEXTURE_BINDING | U::COPY_DST;
    let (color, depth, motion) = (tex(F::Rgba16Float, r), tex(F::R32Float, r), tex(F::Rg16Float, r));
    let out = tex(F::Rgba16Float, U::STORAGE_BINDING);
    let pixels = || (0..size[1]).flat_map(move |y| (0..size[0]).map(move |x| [x, y]));
    let half = |v: f32| half_bits(v) as u16;
    let c: Vec<[u16; 4]> =
        pixels().map(|[x, y]| [0, 1, 2, 3].map(|i| half(rng::unit_draw(rng::bits(x, y, i, 1))))).collect();
    let d: Vec<f32> = pixels().map(|[x, _]| if x / 64 % 2 == 0 { 3.0 } else { 12.0 }).collect();
    let m: Vec<[u16; 2]> =
        pixels().map(|[x, _]| if x / 64 % 2 == 0 { [half(-3.0), half(1.0)] } else { [0, 0] }).collect();
    let up = |t: &wgpu::Texture, b: &[u8], bpp: u32| {
        gpu.queue.write_texture(
            t.as_image_copy(),
            b,
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(size[0] * bpp), rows_per_image: None },
            t.size(),
        )
    };
    up(&color, bytemuck::cast_slice(&c), 8);
    up(&depth, bytemuck::cast_slice(&d), 4);
    up(&motion, bytemuck::cast_slice(&m), 4);
    let src = |n: &str| SHADERS.compose(n).source;
    let arg: Vec<String> = std::env::args().skip(1).collect();
    // variants: name|pass|from|to ; from file, separated by lines '===='
    struct V {
        name: String,
        post: Afterimage,
        times: Vec<f64>,
        sparse: bool,
    }
    let mut all = vec![];
    let make = |name: &str, s: Settings, edits: &[(String, String)]| {
        let desc = ContextDesc { settings: s, ..ContextDesc::new(size) };
        let edit = |mut t: String| {
            for (a, b) in edits {
                t = t.replace(a, b);
            }
            t
        };
        let pass = if s.foveation.filter == Filter::Sparse { "sparse_pass" } else { "smr_pass" };
        let mut post = Afterimage::with_shader(&gpu.device, &desc, F::Rgba16Float, &edit(src(pass))).unwrap();
        if s.foveation.filter == Filter::Sparse {
            post.set_sample_shaders(&gpu.device, &edit(src("sparse_observe_pass")), &edit(src("sparse_light_pass")));
        }
        V { name: name.into(), post, times: vec![], sparse: s.foveation.filter == Filter::Sparse }
    };
    all.push(make("smr", smr, &[]));
    all.push(make("sparse", sparse, &[]));
    if let Some(f) = arg.first() {
        let text = std::fs::read_to_string(f).unwrap();
        for block in text.split("\n====\n") {
            let (name, rest) = block.split_once('\n').unwrap();
            let edits: Vec<_> = rest
                .split("\n--\n")
                .map(|e| {
                    let (a, b) = e.split_once("\n=>").unwrap();
                    (a.trim_matches('\n').to_owned(), b.trim_matches('\n').to_owned())
                })
                .collect();
            for (a, _) in &edits {
                let n = ["sparse_pass", "sparse_observe_pass", "sparse_light_pass"]
                    .map(|p| src(p).matches(a.as_str()).count());
                if n == [0; 3] {
                    println!("NOT FOUND {name}: {a}");
                }
            }
            all.push(make(name, sparse, &edits));
        }
    }
    let frames: u64 = arg.get(1).map_or(16, |s| s.parse().unwrap());
    for index in 0..frames + 4 {
        let turn = index as f32 * 0.1;
        let px = [(0.5 + 0.3 * turn.cos()) * size[0] as f32, (0.5 + 0.3 * turn.sin()) * size[1] as f32];
        let base = ViewFrame::new(ViewGeometry::flat(size, 70.0).unwrap(), Gaze::At { px });
        for v in &mut all {
            let mut view = base;
            if v.sparse {
                view.lattices = Some(fov.lattices(&view.geometry, px, index));
            }
            let views = [view];
            let frame = Frame {
                depth: Some((&depth).into()),
                motion: Some((&motion).into()),
                ..Frame::new(&color, &views, index)
            };
            let mut e = gpu.device.create_command_encoder(&Default::default());
            let watch = Stopwatch::start();
            v.post.record(&gpu.device, &mut e, &frame, &out).unwrap();
            gpu.queue.submit([e.finish()]);
            gpu.wait();
            let ms = clock.read_ms(&gpu, &watch);
            if index >= 4 {
                v.times.push(ms);
            }
        }
    }
    for v in &all {
        let q = Quartiles::of(&v.times).unwrap();
        println!("{:30} {:7.1} ms  {:6.1} ms/Mpx", v.name, q.median, q.median / 2.0736);
    }
}
