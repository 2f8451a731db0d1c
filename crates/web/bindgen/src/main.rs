//! `bindgen LIBRARY.wasm FOLDER NAME SHADERS... [--without SHADERS...]`: the WebAssembly that a browser loads, and the
//! JavaScript that calls it. `SHADERS`: files whose texts are in the library; behind `--without` those that the page
//! never asks for, which weigh nothing.

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
    let used = shaders.iter().position(|word| word == "--without").unwrap_or(shaders.len());
    for shader in &shaders[..used] {
        let text = fs::read(shader)?;
        replace(&mut wasm, &text, &compact(&text));
    }
    for shader in shaders.iter().skip(used + 1) {
        let text = fs::read(shader)?;
        replace(&mut wasm, &text, &[]);
    }
    Ok(fs::write(file, wasm)?)
}

/// `text` in `wasm` becomes the shorter `by`; line ends behind it keep its length.
fn replace(wasm: &mut [u8], text: &[u8], by: &[u8]) {
    if let Some(start) = wasm.windows(text.len()).position(|window| window == text) {
        let (new, rest) = wasm[start..start + text.len()].split_at_mut(by.len());
        new.copy_from_slice(by);
        rest.fill(b'\n');
    }
}

/// A shader's text without comments, indentation, and spaces beside punctuation. The library itself reads lines of
/// `//#use`, `@group` and `override`: these stay.
fn compact(text: &[u8]) -> Vec<u8> {
    let mut short = Vec::with_capacity(text.len());
    for line in text.split(|&byte| byte == b'\n') {
        let comment = line.windows(2).position(|pair| pair == b"//").unwrap_or(line.len());
        let code = if line[comment..].starts_with(b"//#use ") { line } else { &line[..comment] };
        let code = code.trim_ascii();
        let is_read = [&b"//"[..], b"@", b"override"].iter().any(|start| code.starts_with(start));
        // Between two operators they stay, as in `a - -b` and `array<f32, 4> =`; so they do beside `<` and `>`, which
        // are read as brackets.
        let is_spare = |at: usize| {
            let beside = [code[at - 1], *code.get(at + 1).unwrap_or(&b' ')];
            let is_beside = |bytes: &[u8]| beside.iter().any(|byte| bytes.contains(byte));
            let is_operand = |byte: &u8| byte.is_ascii_alphanumeric() || b"_.]".contains(byte);
            let is_at_operand = is_beside(b"+-*/=&|") && beside.iter().any(is_operand);
            code[at] == b' ' && !is_read && (is_beside(b" ,;:(){}") || is_at_operand)
        };
        if !code.is_empty() {
            short.extend((0..code.len()).filter(|&at| at == 0 || !is_spare(at)).map(|at| code[at]));
            short.push(b'\n');
        }
    }
    short
}
