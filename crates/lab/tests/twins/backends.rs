//! Every entry point of the drop-in and of this crate in the languages of other devices: SPIR-V, Metal, HLSL, GLSL 4.50
//! and that of GLES 3.1. Compilers that are installed check the SPIR-V and the GLSL.

use super::modules::composed_modules;
use afterimage_testing::naga;
use naga::back::{glsl, hlsl, msl, pipeline_constants, spv};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Module, ShaderStage};
use std::collections::BTreeSet;
use std::io::Write;
use std::process::{Command, Stdio};

/// An entry point, with the default values of its overrides.
struct Entry {
    module: Module,
    info: naga::valid::ModuleInfo,
    stage: ShaderStage,
}

const NAME: &str = "main";

impl Entry {
    fn spirv(&self) -> Result<Vec<u8>, String> {
        let options = spv::Options { lang_version: (1, 3), ..spv::Options::default() };
        let entry = spv::PipelineOptions { shader_stage: self.stage, entry_point: NAME.into() };
        let words = spv::write_vec(&self.module, &self.info, &options, Some(&entry)).map_err(|e| e.to_string())?;
        Ok(words.iter().flat_map(|word| word.to_le_bytes()).collect())
    }

    fn metal(&self) -> Result<String, String> {
        let options = msl::Options { lang_version: (2, 4), ..msl::Options::default() };
        let entry =
            msl::PipelineOptions { entry_point: Some((self.stage, NAME.into())), ..msl::PipelineOptions::default() };
        let (text, info) = msl::write_string(&self.module, &self.info, &options, &entry).map_err(|e| e.to_string())?;
        info.entry_point_names.into_iter().collect::<Result<Vec<_>, _>>().map_err(|e| e.to_string())?;
        Ok(text)
    }

    fn hlsl(&self) -> Result<String, String> {
        let mut text = String::new();
        let options = hlsl::Options { shader_model: hlsl::ShaderModel::V6_0, ..hlsl::Options::default() };
        let entry = hlsl::PipelineOptions { entry_point: Some((self.stage, NAME.into())) };
        let mut writer = hlsl::Writer::new(&mut text, &options, &entry);
        let info = writer.write(&self.module, &self.info, None).map_err(|e| e.to_string())?;
        info.entry_point_names.into_iter().collect::<Result<Vec<_>, _>>().map_err(|e| e.to_string())?;
        Ok(text)
    }

    fn glsl(&self, version: glsl::Version) -> Result<String, String> {
        let mut text = String::new();
        let options = glsl::Options { version, ..glsl::Options::default() };
        let entry = glsl::PipelineOptions { shader_stage: self.stage, entry_point: NAME.into(), multiview: None };
        let policies = naga::proc::BoundsCheckPolicies::default();
        let mut writer = glsl::Writer::new(&mut text, &self.module, &self.info, &options, &entry, policies)
            .map_err(|e| e.to_string())?;
        writer.write().map_err(|e| e.to_string())?;
        Ok(text)
    }
}

/// Entry points, each with the path of its file.
fn entries() -> Vec<(String, Entry)> {
    let mut all = vec![];
    let mut seen = BTreeSet::new();
    for composed in composed_modules() {
        let parsed = naga::front::wgsl::parse_str(&composed.source).unwrap();
        let info = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&parsed).unwrap();
        for entry in &parsed.entry_points {
            let line = composed.source.lines().position(|l| l.starts_with(&format!("fn {}(", entry.name))).unwrap();
            let (path, _) = composed.origin(line as u32 + 1).unwrap();
            if !seen.insert((path, entry.name.clone(), composed.source.contains("texture_2d<u32>"))) {
                continue;
            }
            let constants = naga::back::PipelineConstants::default();
            let chosen = Some((entry.stage, entry.name.as_str()));
            let (module, info) = pipeline_constants::process_overrides(&parsed, &info, chosen, &constants).unwrap();
            let mut module = module.into_owned();
            // One name, for the options.
            module.entry_points.iter_mut().for_each(|e| e.name = NAME.into());
            all.push((format!("{path} {}", entry.name), Entry { module, info: info.into_owned(), stage: entry.stage }));
        }
    }
    all
}

/// Runs a compiler on `input`; its complaint, if it has one, or `None` if it is not installed.
fn compiler(command: &str, args: &[&str], input: &[u8]) -> Option<Result<(), String>> {
    let (out, err) = (Stdio::piped(), Stdio::piped());
    let mut child = Command::new(command).args(args).stdin(Stdio::piped()).stdout(out).stderr(err).spawn().ok()?;
    let _ = child.stdin.take().unwrap().write_all(input);
    let output = child.wait_with_output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    Some(if output.status.success() { Ok(()) } else { Err(text.into_owned()) })
}

#[test]
fn every_entry_point_can_be_written_in_the_languages_of_other_devices() {
    let entries = entries();
    let mut faults = vec![];
    let mut checked = [0; 2];
    let mut unchecked = 0;
    for (name, entry) in &entries {
        let stage = match entry.stage {
            ShaderStage::Compute => "comp",
            ShaderStage::Vertex => "vert",
            _ => "frag",
        };
        let mut note = |language: &str, result: Result<(), String>| {
            if let Err(error) = result {
                faults.push(format!("{name}, {language}: {error}"));
            }
        };
        note("Metal", entry.metal().map(drop));
        note("HLSL", entry.hlsl().map(drop));
        let spirv = entry.spirv().and_then(|bytes| {
            let result = compiler("spirv-val", &["--target-env", "vulkan1.1", "-"], &bytes);
            checked[0] += usize::from(result.is_some());
            result.unwrap_or(Ok(()))
        });
        note("SPIR-V", spirv);
        let versions = [("GLSL 4.50", glsl::Version::Desktop(450)), ("GLES 3.1", glsl::Version::new_gles(310))];
        for (language, version) in versions {
            let glsl = entry.glsl(version).and_then(|text| {
                // Devices have storage textures of two words by this extension, which the validator does not know.
                if text.contains("GL_NV_image_formats") {
                    unchecked += 1;
                    return Ok(());
                }
                let result = compiler("glslangValidator", &["--stdin", "-S", stage], text.as_bytes());
                checked[1] += usize::from(result.is_some());
                result.unwrap_or(Ok(()))
            });
            note(language, glsl);
        }
    }
    let (count, [spirv, glsl]) = (entries.len(), checked);
    println!("{count} entry points; checked {spirv} of SPIR-V and {glsl} of GLSL, not {unchecked} with extensions");
    assert!(count > 40);
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n"));
}
