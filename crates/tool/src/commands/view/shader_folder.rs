//! Shaders from a folder, read again as they change, for `--shaders`.

use crate::failure::Failure;
use afterimage::internal::Sources;
use afterimage::shader::{Module, SHADERS};
use afterimage::wgpu::{self, Device};
use std::borrow::Cow;
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime};

/// Time between two looks at the files.
const PERIOD: Duration = Duration::from_millis(300);

/// Texts of the modules that the folder has, by module.
type Texts = HashMap<&'static str, String>;

/// The folder `shaders` of the drop-in, or one like it. Modules that it lacks are built in.
pub struct ShaderFolder {
    folder: PathBuf,
    /// When each file was written that was read last.
    stamps: Vec<Option<SystemTime>>,
    next: Instant,
    /// Texts that compile.
    pub sources: Sources,
}

impl ShaderFolder {
    /// Reads the folder. Its texts must compile on `device`.
    pub fn open(folder: &Path, device: &Device) -> Result<Self, Failure> {
        let texts = read(folder);
        if texts.is_empty() {
            return Err(Failure::Input(format!(
                "--shaders {}: no module of the shaders is there, such as lib/color.wgsl; give the folder shaders of the \
                 sources",
                folder.display()
            )));
        }
        let sources = compiled(texts, device).map_err(Failure::Input)?;
        Ok(Self { stamps: stamps(folder), folder: folder.to_owned(), next: Instant::now(), sources })
    }

    /// Whether files have changed, and compile: then [`sources`](Self::sources) are new. A line on standard error says
    /// what was read, or what is wrong.
    pub fn has_changed(&mut self, device: &Device) -> bool {
        let now = Instant::now();
        if now < self.next {
            return false;
        }
        self.next = now + PERIOD;
        let stamps = stamps(&self.folder);
        if stamps == self.stamps {
            return false;
        }
        self.stamps = stamps;
        match compiled(read(&self.folder), device) {
            Ok(sources) => {
                eprintln!("afterimage: the shaders of {} are read again", self.folder.display());
                self.sources = sources;
                true
            }
            Err(line) => {
                eprintln!("afterimage: {line}; the shaders stay as they were");
                false
            }
        }
    }
}

/// Path of a module in the folder.
fn path(folder: &Path, module: &Module) -> PathBuf {
    folder.join(module.path.trim_start_matches("shaders/"))
}

fn modules() -> impl Iterator<Item = &'static Module> {
    afterimage::shader::MODULES.iter()
}

fn stamps(folder: &Path) -> Vec<Option<SystemTime>> {
    modules().map(|module| fs::metadata(path(folder, module)).and_then(|data| data.modified()).ok()).collect()
}

fn read(folder: &Path) -> Texts {
    modules().filter_map(|module| Some((module.name, fs::read_to_string(path(folder, module)).ok()?))).collect()
}

/// Sources of texts, of which every pass compiles. Otherwise a line with the file, and what is wrong there.
fn compiled(texts: Texts, device: &Device) -> Result<Sources, String> {
    let texts = Arc::new(texts);
    let text_of = move |module: &'static Module| -> Cow<'static, str> {
        texts.get(module.name).map_or(module.text.into(), |text| text.clone().into())
    };
    for pass in modules().filter(|module| module.name.ends_with("_pass")) {
        let composed = SHADERS.compose_edited(pass.name, None, &text_of)?;
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let source = wgpu::ShaderSource::Wgsl(composed.source.as_str().into());
        let _ = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(pass.name), source });
        if let Some(error) = pollster::block_on(scope.pop()) {
            return Err(line_of(&error.to_string(), |line| composed.origin(line)));
        }
    }
    Ok(Sources::edited(text_of))
}

/// One line of a compiler's message, which has the place in the composed text as `wgsl:LINE:COLUMN`.
fn line_of(message: &str, origin: impl Fn(u32) -> Option<(&'static str, u32)>) -> String {
    let what = message.lines().map(str::trim).find_map(|line| line.strip_prefix("error: "));
    let what = what.unwrap_or_else(|| message.lines().last().unwrap_or("it does not compile").trim());
    let place = message.split("wgsl:").nth(1).and_then(|rest| rest.split(':').next()?.parse().ok());
    match place.and_then(origin) {
        Some((file, line)) => format!("{file}:{line}: {what}"),
        None => what.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Writes a text of the module `color` into the folder, at a time in seconds: clocks of file systems may be coarse.
    fn write_color(folder: &Path, seconds: u64, change: impl Fn(&str) -> String) {
        let module = modules().find(|module| module.name == "color").unwrap();
        let file = path(folder, module);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(&file, change(module.text)).unwrap();
        let written = SystemTime::UNIX_EPOCH + Duration::from_secs(seconds);
        fs::File::options().write(true).open(&file).unwrap().set_modified(written).unwrap();
    }

    #[test]
    fn changed_files_that_compile_are_taken_and_others_are_named() {
        let Some((device, _queue)) = afterimage_testing::gpu::device() else { return };
        let folder = tempfile::tempdir().unwrap();
        assert!(ShaderFolder::open(folder.path(), &device).is_err(), "an empty folder");
        write_color(folder.path(), 1, str::to_owned);
        let mut shaders = ShaderFolder::open(folder.path(), &device).unwrap();
        let changes = |shaders: &mut ShaderFolder| {
            shaders.next = Instant::now();
            shaders.has_changed(&device)
        };
        assert!(!changes(&mut shaders));
        write_color(folder.path(), 2, |text| format!("{text}// new\n"));
        assert!(changes(&mut shaders));
        assert!(shaders.sources.text("quad_pass").contains("// new\n"));
        assert!(shaders.sources.text_with_view("quad_pass").contains("// new\n"));
        // What does not compile changes nothing.
        for (seconds, broken) in [(3, "fn ragged("), (4, "//#use nothing\n")] {
            write_color(folder.path(), seconds, |text| format!("{broken}{text}"));
            assert!(!changes(&mut shaders), "{broken}");
            assert!(shaders.sources.text("quad_pass").contains("// new\n"));
        }
    }

    #[test]
    fn messages_name_the_file() {
        let message = "Validation Error\n\nCaused by:\n  Shader 'x' parsing error: expected `:`\n\nerror: expected `:`\n   ┌─ wgsl:7:3\n";
        let origin = |line| (line == 7).then_some(("shaders/lib/color.wgsl", 3));
        assert_eq!(line_of(message, origin), "shaders/lib/color.wgsl:3: expected `:`");
        assert_eq!(line_of("lost", origin), "lost");
    }
}
