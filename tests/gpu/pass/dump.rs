//! `AFTERIMAGE_SHADER_DUMP=DIR`: the texts of composed shaders as files.

use super::*;
use std::path::Path;
use std::process::Command;

const FOLDER: &str = "AFTERIMAGE_SHADER_DUMP";

/// This test again, in a process that dumps to `folder`: what it wrote to standard error.
fn dumped(folder: &Path) -> String {
    let name = std::thread::current().name().expect("tests have named threads").to_owned();
    let mut command = Command::new(std::env::current_exe().unwrap());
    let output = command.args(["--exact", &name, "--nocapture"]).env(FOLDER, folder).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn shaders_are_dumped_where_the_environment_says() {
    if std::env::var_os(FOLDER).is_some() {
        let device = Device::noop(&wgpu::DeviceDescriptor::default()).0;
        let settings = Settings { foveation: Foveation::quads(), ..Settings::default() };
        let desc = ContextDesc { settings, ..ContextDesc::new([64, 48]) };
        Afterimage::new(&device, &desc, TextureFormat::Rgba16Float).unwrap();
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let made = folder.path().join("new/folder");
    let errors = dumped(&made);
    assert!(!errors.contains(FOLDER), "{errors}");
    let mut names: Vec<_> =
        std::fs::read_dir(&made).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    println!("{names:?}");
    for pass in ["quad_pass", "quad_key_pass", "quad_prime_pass"] {
        assert!(names.contains(&format!("{pass}.wgsl")), "{pass}");
    }
    for name in names {
        let text = std::fs::read_to_string(made.join(&name)).unwrap();
        assert_eq!(text, SHADERS.compose(name.strip_suffix(".wgsl").expect("no other files")).source, "{name}");
    }
    // A file in the folder's place: a line a shader, and the context is made.
    let file = folder.path().join("file");
    std::fs::write(&file, "kept").unwrap();
    let errors = dumped(&file);
    assert!(errors.contains("AFTERIMAGE_SHADER_DUMP: no quad_key_pass.wgsl in"), "{errors}");
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "kept");
}
