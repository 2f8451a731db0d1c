//! `afterimage info adapters`: lists the adapters and tests their arithmetic.

use crate::failure::Failure;
use afterimage::wgpu;
use afterimage_lab::device::Headless;
use afterimage_lab::self_test::self_test;

/// Lists all adapters; with `test`, runs the self-test on each.
pub fn adapters_info(test: bool) -> Result<(), Failure> {
    let adapters = Headless::adapters();
    if adapters.is_empty() {
        say!("no GPU adapters; install a software one (Debian: mesa-vulkan-drivers)");
    }
    let mut wrong = vec![];
    for adapter in &adapters {
        let info = adapter.get_info();
        say!("{:?}: {}, {} {}, {:?}", info.device_type, info.name, info.driver, info.driver_info, info.backend);
        if !test {
            continue;
        }
        let findings = Headless::on(adapter, wgpu::Limits::default())
            .map_err(|e| e.to_string())
            .and_then(|gpu| self_test(&gpu).map_err(|e| e.to_string()));
        match findings {
            Ok(findings) => {
                for finding in findings {
                    let mark = match finding.holds {
                        Some(true) => "ok",
                        Some(false) => "NO",
                        None => "",
                    };
                    say!("  {mark:2}  {:29}  {}", finding.what, finding.found);
                    if finding.holds == Some(false) {
                        wrong.push(format!("{} on {}", finding.what, info.name));
                    }
                }
            }
            Err(error) => wrong.push(format!("{}: {error}", info.name)),
        }
    }
    say!("CPU: {} threads", rayon::current_num_threads());
    if wrong.is_empty() {
        return Ok(());
    }
    Err(Failure::Work(format!(
        "self-test: {}; pictures there are not the CPU's: run with --backend cpu, or report it with this text",
        wrong.join("; ")
    )))
}
