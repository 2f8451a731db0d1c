//! The adapter that the tests of a program share.

use std::io::Write;
use std::sync::OnceLock;
use wgpu::{AdapterInfo, DeviceType};

/// Environment variable that chooses the adapter: a part of its name or of its driver's, in any case. The tool reads
/// it, too.
pub const CHOICE: &str = "AFTERIMAGE_ADAPTER";

pub(super) fn say(line: &str) {
    // Not eprintln!, which the test harness captures: skips must be visible in a passing run.
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// Place of the adapter to take. Without a wish, a software adapter, because most tests compare bits with the CPU's,
/// and GPUs may round otherwise; else the fastest.
///
/// # Errors
/// If no adapter is as wished: a line that names those there are.
fn choose(offered: &[AdapterInfo], wish: Option<&str>) -> Result<Option<usize>, String> {
    let rank = |info: &AdapterInfo| match info.device_type {
        DeviceType::Cpu => 0,
        DeviceType::DiscreteGpu => 1,
        DeviceType::IntegratedGpu => 2,
        DeviceType::VirtualGpu | DeviceType::Other => 3,
    };
    let Some(wish) = wish else {
        return Ok((0..offered.len()).min_by_key(|&i| rank(&offered[i])));
    };
    let is_wished = |info: &AdapterInfo| {
        [&info.name, &info.driver].iter().any(|name| name.to_lowercase().contains(&wish.to_lowercase()))
    };
    let found = offered.iter().position(is_wished);
    let names: Vec<_> = offered.iter().map(|info| info.name.as_str()).collect();
    found
        .map(Some)
        .ok_or_else(|| format!("{CHOICE}={wish}: expected a part of one of these names: {}", names.join("; ")))
}

/// What tests print first: the adapter, and why it is this one.
fn described(offered: &[AdapterInfo], taken: usize, is_wished: bool) -> String {
    let info = &offered[taken];
    let (name, driver, version, backend) = (&info.name, &info.driver, &info.driver_info, info.backend);
    let others = offered.iter().filter(|other| other.device_type != DeviceType::Cpu).map(|other| other.name.as_str());
    let others: Vec<_> = others.collect();
    let why = match (is_wished, info.device_type) {
        (true, _) => format!("; chosen by {CHOICE}"),
        (false, DeviceType::Cpu) if others.is_empty() => String::new(),
        (false, DeviceType::Cpu) => {
            format!("; software, which gives the CPU's bits; {CHOICE} chooses another: {}", others.join("; "))
        }
        (false, _) => "; there is no software adapter".to_owned(),
    };
    format!("adapter: {name}, {driver}, {version}, {backend:?}{why}")
}

fn find() -> Option<wgpu::Adapter> {
    let mut desc = wgpu::InstanceDescriptor::new_without_display_handle();
    // Vulkan, Metal, DX12; not GL, whose software adapter would hide that there is no Vulkan driver.
    desc.backends = wgpu::Backends::PRIMARY;
    // Without wgpu's debugging flags: with them, naga searches the line of every expression from the start of the
    // source, a fifth of the CPU time of tests of passes. WGPU_DEBUG=1 switches them on.
    desc.flags = wgpu::InstanceFlags::empty().with_env();
    let instance = wgpu::Instance::new(desc);
    let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let infos: Vec<_> = adapters.iter().map(wgpu::Adapter::get_info).collect();
    let wish = std::env::var(CHOICE).ok();
    let taken = choose(&infos, wish.as_deref()).unwrap_or_else(|error| panic!("{error}"))?;
    say(&described(&infos, taken, wish.is_some()));
    Some(adapters.swap_remove(taken))
}

/// The adapter, without a word if there is none.
pub(super) fn found() -> Option<&'static wgpu::Adapter> {
    static ADAPTER: OnceLock<Option<wgpu::Adapter>> = OnceLock::new();
    ADAPTER.get_or_init(find).as_ref()
}

/// The adapter of this run: the one that `AFTERIMAGE_ADAPTER` names, else a software adapter, else a GPU. Without an
/// adapter, prints a line and returns `None`.
///
/// # Panics
/// Without an adapter, if `AFTERIMAGE_GPU=require` is set, as in CI; without the one that `AFTERIMAGE_ADAPTER` names.
pub fn adapter() -> Option<&'static wgpu::Adapter> {
    let adapter = found();
    if adapter.is_none() {
        let required = std::env::var("AFTERIMAGE_GPU").is_ok_and(|v| v == "require");
        assert!(
            !required,
            "AFTERIMAGE_GPU=require, but there is no adapter: install mesa-vulkan-drivers (software Vulkan) or a driver"
        );
        let test = std::thread::current().name().unwrap_or("a test").to_owned();
        say(&format!("SKIPPED {test}: no adapter (install mesa-vulkan-drivers)"));
    }
    adapter
}

/// What a program that a test starts must find in its environment, to take the adapter that the test takes.
pub fn choice() -> Option<(&'static str, String)> {
    found().map(|adapter| (CHOICE, adapter.get_info().name))
}

#[cfg(test)]
mod tests {
    use super::{choose, described};
    use wgpu::{AdapterInfo, Backend, DeviceType};

    fn offer(name: &str, device_type: DeviceType) -> AdapterInfo {
        AdapterInfo { name: name.to_owned(), ..AdapterInfo::new(device_type, Backend::Vulkan) }
    }

    fn offers() -> Vec<AdapterInfo> {
        vec![
            offer("AMD Radeon Graphics", DeviceType::IntegratedGpu),
            offer("NVIDIA H100", DeviceType::DiscreteGpu),
            AdapterInfo { driver: "Mesa".to_owned(), ..offer("llvmpipe (LLVM 15)", DeviceType::Cpu) },
            offer("SwiftShader Device", DeviceType::Cpu),
        ]
    }

    #[test]
    fn a_software_adapter_comes_before_gpus_and_says_so() {
        let offered = offers();
        assert_eq!(choose(&offered, None), Ok(Some(2)));
        let line = described(&offered, 2, false);
        assert!(line.contains("software") && line.contains("AMD Radeon Graphics; NVIDIA H100"), "{line}");
        let line = described(&offered[2..], 0, false);
        assert!(line.starts_with("adapter: llvmpipe (LLVM 15), Mesa, ") && !line.contains("software"), "{line}");
    }

    #[test]
    fn without_a_software_adapter_the_fastest_is_taken() {
        let offered = offers();
        assert_eq!(choose(&offered[..2], None), Ok(Some(1)));
        assert_eq!(choose(&offered[..1], None), Ok(Some(0)));
        assert_eq!(choose(&[], None), Ok(None));
        assert!(described(&offered[..2], 1, false).ends_with("there is no software adapter"));
    }

    #[test]
    fn a_part_of_a_name_or_driver_chooses_in_any_case() {
        let offered = offers();
        for (wish, expected) in [("nvidia", 1), ("swift", 3), ("Radeon", 0), ("mesa", 2)] {
            assert_eq!(choose(&offered, Some(wish)), Ok(Some(expected)), "{wish}");
            assert!(described(&offered, expected, true).ends_with("chosen by AFTERIMAGE_ADAPTER"));
        }
        let error = choose(&offered, Some("Intel")).unwrap_err();
        assert!(error.starts_with("AFTERIMAGE_ADAPTER=Intel: ") && error.contains("NVIDIA H100; llvmpipe"), "{error}");
        assert!(choose(&[], Some("Intel")).is_err());
    }
}
