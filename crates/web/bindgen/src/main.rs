//! `bindgen LIBRARY.wasm FOLDER NAME SHADERS...`: the WebAssembly that a browser loads, and the JavaScript that calls
//! it. `SHADERS`: files whose texts are in the library.

use std::env::args;
use std::path::Path;
use std::process::ExitCode;
use std::{error::Error, fs};
use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let words: Vec<_> = args().skip(1).collect();
    let [library, folder, name, shaders @ ..] = words.as_slice() else {
        eprintln!("expected: bindgen LIBRARY.wasm FOLDER NAME SHADERS...");
        return ExitCode::from(2);
    };
    match write(library, Path::new(folder), name, shaders) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{library}: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn write(library: &str, folder: &Path, name: &str, shaders: &[String]) -> Result<(), Box<dyn Error>> {
    let mut bindgen = Bindgen::new();
    bindgen.input_path(library).typescript(false).remove_name_section(true).remove_producers_section(true);
    bindgen.omit_default_module_path(false).out_name(name);
    bindgen.web(true)?.generate(folder)?;
    let file = folder.join(format!("{name}_bg.wasm"));
    let mut wasm = fs::read(&file)?;
    for shader in shaders {
        blank_comments(&mut wasm, &fs::read(shader)?);
    }
    Ok(fs::write(file, wasm)?)
}

/// Comments in a shader's text become spaces, which weigh nothing when compressed. `//#use` lines are instructions.
fn blank_comments(wasm: &mut [u8], text: &[u8]) {
    let Some(start) = wasm.windows(text.len()).position(|window| window == text) else { return };
    for line in wasm[start..start + text.len()].split_mut(|&byte| byte == b'\n') {
        let comment = line.windows(2).position(|pair| pair == b"//").unwrap_or(line.len());
        if !line[comment..].starts_with(b"//#use ") {
            line[comment..].fill(b' ');
        }
    }
}
