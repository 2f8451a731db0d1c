//! Energy.

use crate::surfaces::*;
use afterimage::kernel::bsdf::{self, Layers, Lobes, Surface};
use glam::Vec3;

/// Integral of `eval` over all directions: for each lobe a grid over the draws of its sampler, weighted by the density of the whole
/// mixture.
pub fn reflected(layers: &Layers, wo: Vec3, grid: u32) -> f64 {
    let mut sum = 0.0;
    let mut before = 0.0;
    for (lobe, &chance) in layers.chances.iter().enumerate() {
        if chance > 0.0 {
            let choices = if lobe == 3 { 16 } else { 1 };
            let mut mean = 0.0;
            for i in 0..grid * grid * choices {
                let at = |k: u32, n: u32| (k as f32 + 0.5) / n as f32;
                let t = at(i / grid % grid, grid);
                let turn = at(i % grid, grid);
                let power = if lobe == 0 { 4 } else { 2 };
                let radial = 1.0 - t.powi(power);
                let [a, b] = if lobe == 0 { [radial, turn] } else { [turn, radial] };
                let u = [before + 0.5 * chance, a, b, at(i / (grid * grid), choices)];
                let s = bsdf::sample(layers, wo, u, Lobes::ALL);
                if s.scatter.pdf > 0.0 {
                    mean +=
                        f64::from(power) * f64::from(t).powi(power - 1) * f64::from(s.scatter.value.x / s.scatter.pdf);
                }
            }
            sum += f64::from(chance) * mean / f64::from(grid * grid * choices);
        }
        before += chance;
    }
    sum
}

fn energy(surface: &Surface, wo: Vec3, grid: u32) -> f64 {
    reflected(&bsdf::layers(surface, wo, &TABLES, Lobes::ALL), wo, grid)
}

thread_local! {static GRID: u32 = std::env::var("GRID").map_or(48, |v| v.parse().unwrap());}
#[test]
fn explore() {
    let t = std::time::Instant::now();
    let _ = &*TABLES;
    println!("tables {:?}", t.elapsed());
    let t = std::time::Instant::now();
    let kinds: Vec<(&str, Box<dyn Fn(f32, f32) -> Surface>)> = vec![
        ("retro", Box::new(|r, _| Surface { roughness: r, specular: 1e-12, ..WHITE })),
        ("metal", Box::new(|r, _| Surface { roughness: r, metallic: 1.0, ..WHITE })),
        ("grey metal", Box::new(|r, _| Surface { roughness: r, specular: 1.0, ..WHITE })),
        ("coat", Box::new(|r, _| Surface { clearcoat_roughness: r, clearcoat: 1.0, ..WHITE })),
        ("sheen", Box::new(|r, _| Surface { sheen_roughness: r, sheen_color: Vec3::ONE, ..WHITE })),
        (
            "thin",
            Box::new(|r, i| Surface { roughness: r, specular: 1.0, transmission: 1.0, thin: true, ior: i, ..WHITE }),
        ),
        ("enter", Box::new(|r, i| Surface { roughness: r, specular: 1.0, transmission: 1.0, ior: i, ..WHITE })),
        (
            "leave",
            Box::new(|r, i| Surface {
                roughness: r,
                specular: 1.0,
                transmission: 1.0,
                ior: i,
                entering: false,
                ..WHITE
            }),
        ),
        ("enter0", Box::new(|r, i| Surface { roughness: r, specular: 0.0, transmission: 1.0, ior: i, ..WHITE })),
        (
            "leave0",
            Box::new(|r, i| Surface {
                roughness: r,
                specular: 0.0,
                transmission: 1.0,
                ior: i,
                entering: false,
                ..WHITE
            }),
        ),
        ("aniso 0.5", Box::new(|r, _| Surface { roughness: r, metallic: 1.0, anisotropy: 0.5, ..WHITE })),
        ("aniso 1.0", Box::new(|r, _| Surface { roughness: r, metallic: 1.0, anisotropy: 1.0, ..WHITE })),
    ];
    let only = std::env::var("ONLY").unwrap_or_default();
    for (name, make) in &kinds {
        if !name.contains(&only) {
            continue;
        }
        let iors: &[f32] = if name.contains("n") && (name.contains("enter") || name.contains("leave")) {
            &[1.03, 1.09, 1.33, 1.5, 2.0, 3.0]
        } else {
            &[1.5]
        };
        let mut worst = vec![];
        for &i in iors {
            for r in [0.0, 0.03, 0.07, 0.11, 0.16, 0.23, 0.31, 0.43, 0.5, 0.63, 0.77, 0.9, 1.0] {
                for z in [1e-7, 1e-4, 0.003, 0.01, 0.03, 0.08, 0.15, 0.22, 0.31, 0.42, 0.55, 0.7, 0.87, 1.0] {
                    for turns in if name.contains("aniso") { vec![0.0, 0.125, 0.25] } else { vec![0.1] } {
                        let e = energy(&make(r, i), direction(z, turns), GRID.with(|g| *g)) - 1.0;
                        worst.push((e, r, z, i, turns));
                    }
                }
            }
        }
        worst.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
        let rms = (worst.iter().map(|w| w.0 * w.0).sum::<f64>() / worst.len() as f64).sqrt();
        println!("{name}: rms {rms:.1e}, worst (e, rough, z, ior) {:.5?}", &worst[..5]);
    }
    println!("{:?}", t.elapsed());
}
