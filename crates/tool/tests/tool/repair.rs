//! `afterimage run --repair`.

use super::rig::{Folder, SMALL, column, read_json, refuses, run, same_on_both_backends, succeeds, words};

/// Sparse frames of smr with a budget in percent.
fn repaired<'a>(budget: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let sparse = ["--foveation", "sparse", "--rate-mid", "2", "--rate-far", "4", "--method", "none,smr"];
    [&sparse[..], &["--repair", budget], more].concat()
}

#[test]
fn both_backends_write_the_same_bytes_of_repaired_frames() {
    if afterimage_testing::gpu::adapter().is_none() {
        return;
    }
    for (input, line) in [
        ("analytic:occluder", "--jitter halton --reference-samples 2"),
        ("builtin:cubes", "--geometry samples --reference-samples 2"),
        (
            "builtin:cubes",
            "--source trace --spp 2 --max-depth 1 --reference-samples 2 --geometry full --camera lateral",
        ),
    ] {
        // Odd sides: quads lie half beyond the edges.
        let line = format!("--no-flip --size 159x91 --frames 4 {line}");
        let [cpu, _] = same_on_both_backends(&line, input, &repaired("6", &words(&line)));
        assert!(cpu["methods"]["smr"]["repaired_share"].as_f64().unwrap() > 0.0, "{input}");
    }
}

#[test]
fn repair_keeps_to_its_budget_and_shows_what_is_uncovered() {
    let folder = Folder::new();
    let mut before = None;
    for budget in ["0", "2", "10"] {
        let out = folder.text(budget);
        let small = ["--size", "240x136", "--frames", "16", "--backend", "cpu", "--gaze", "90,75", "--no-flip"];
        succeeds(&run("analytic:occluder", &out, &repaired(budget, &small)));
        let methods = &read_json(&folder.path(budget).join("report.json"))["methods"];
        assert!(methods["none"]["repaired_share"].is_null(), "only smr repairs");
        let shares = column(&folder.path(budget), "smr", "repaired_share");
        assert_eq!(shares.len(), 16);
        let most = budget.parse::<f64>().unwrap() / 100.0;
        if budget == "0" {
            assert!(methods["smr"]["repaired_share"].is_null() && shares.iter().all(Option::is_none));
        } else {
            let mean = methods["smr"]["repaired_share"].as_f64().unwrap();
            let shares: Vec<f64> = shares.into_iter().flatten().collect();
            assert!((shares.iter().sum::<f64>() / 16.0 - mean).abs() < 1e-6 && mean > 0.1 * most, "{mean} of {most}");
            assert!(shares.iter().all(|share| *share <= most), "{shares:?}");
        }
        let psnr_db = methods["smr"]["psnr_db"].as_f64().unwrap();
        println!("budget {budget} %: {psnr_db:.2} dB, {} repaired", methods["smr"]["repaired_share"]);
        assert!(before.is_none_or(|before| psnr_db > before + 0.1), "{budget} %: {psnr_db} after {before:?}");
        before = Some(psnr_db);
    }
}

/// The renderer's time is that of the lattices, and for methods that repair also that of the pixels they asked for.
#[test]
fn shading_repaired_pixels_takes_time() {
    if afterimage_testing::gpu::adapter().is_none() {
        return;
    }
    let folder = Folder::new();
    let out = folder.text("out");
    succeeds(&run("builtin:cubes", &out, &repaired("5", &[SMALL, &["--backend", "cpu", "--no-flip"]].concat())));
    for key in ["render_ms", "total_ms"] {
        let [none, smr] = ["none", "smr"].map(|method| column(&folder.path("out"), method, key));
        assert!(none.iter().zip(&smr).all(|(none, smr)| none.unwrap() < smr.unwrap()), "{key}: {none:?}, {smr:?}");
    }
}

#[test]
fn repair_of_what_cannot_be_repaired_is_refused() {
    let folder = Folder::new();
    let out = folder.text("out");
    let still = "analytic:still";
    for budget in ["-1", "101", "NaN", "much"] {
        let budget = format!("--repair={budget}");
        refuses(&run(still, &out, &["--foveation", "sparse", &budget]), &["--repair", "0 to 100 percent"]);
    }
    refuses(&run(still, &out, &["--repair", "3"]), &["--repair", "--foveation sparse"]);
    let wrs = ["--foveation", "sparse", "--repair", "3", "--method", "none,wrs"];
    refuses(&run(still, &out, &wrs), &["--repair", "add smr to --method"]);
    let filled = ["--source", "trace", "--sampling", "regions", "--repair", "3"];
    refuses(&run("builtin:cubes", &out, &filled), &["--repair", "--foveation sparse"]);
    assert!(!folder.path("out").exists(), "nothing was written");
}
