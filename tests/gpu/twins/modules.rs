//! Every module composes and is valid; errors name file and line.

use super::library::{LOADS, SHADERS};
use afterimage::shader::Composed;
use afterimage::wgpu::naga;

/// File and line of the first error, with its message.
pub fn validate(composed: &Composed) -> Result<(), String> {
    let module = naga::front::wgsl::parse_str(&composed.source).map_err(|e| {
        let line = e.location(&composed.source).map_or(0, |l| l.line_number);
        let (file, line) = composed.origin(line).unwrap_or(("?", 0));
        format!("{file}:{line}: {}", e.message())
    })?;
    let mut validator =
        naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty());
    validator.validate(&module).map(|_| ()).map_err(|e| {
        // The narrowest span: the widest is a whole function.
        let widths = e.spans().filter_map(|(span, _)| span.to_range().map(|r| (r.len(), *span)));
        let span = widths.min_by_key(|(width, _)| *width).map(|(_, span)| span);
        let line = span.map_or(0, |s| s.location(&composed.source).line_number);
        let (file, line) = composed.origin(line).unwrap_or(("?", 0));
        let mut message = e.as_inner().to_string();
        let mut cause = std::error::Error::source(e.as_inner());
        while let Some(inner) = cause {
            message = format!("{message}: {inner}");
            cause = inner.source();
        }
        format!("{file}:{line}: {message}")
    })
}

/// Every module with those that it uses, and with each choice of the functions that its users provide: `load`,
/// acceptance of hits, a pass's pixel.
pub fn composed_modules() -> Vec<Composed> {
    let mut all = vec![];
    for name in SHADERS.module_names() {
        let source = SHADERS.compose(name).source;
        let lacks = |f: &str| calls(&source, f) && !source.contains(&format!("fn {f}("));
        let loads = if lacks("load") { LOADS.iter().map(|&load| Some(load)).collect() } else { vec![None] };
        let accept = lacks("accept_hit").then_some("accept_all");
        let pixel = lacks("pixel").then_some("none_pass");
        for load in loads {
            let parts: Vec<&str> = load.into_iter().chain(accept).chain(pixel).chain([name]).collect();
            all.push(SHADERS.compose_with(&parts, ""));
        }
    }
    all
}

#[test]
fn every_module_composes_and_is_valid() {
    let modules = composed_modules();
    assert!(modules.len() >= 11);
    for composed in modules {
        validate(&composed).unwrap_or_else(|e| panic!("{e}"));
    }
}

/// Pointers that a block writes through.
fn stores(block: &naga::Block) -> Vec<naga::Handle<naga::Expression>> {
    use naga::Statement::{Block, If, Loop, Store, Switch};
    let of = |statement: &naga::Statement| match statement {
        Store { pointer, .. } => vec![*pointer],
        Block(block) => stores(block),
        If { accept, reject, .. } => [accept, reject].into_iter().flat_map(stores).collect(),
        Switch { cases, .. } => cases.iter().flat_map(|case| stores(&case.body)).collect(),
        Loop { body, continuing, .. } => [body, continuing].into_iter().flat_map(stores).collect(),
        _ => vec![],
    };
    block.iter().flat_map(of).collect()
}

/// Functions of a module that write an element of a vector at an index that is not constant.
fn indexed_writes(source: &str) -> Vec<String> {
    use naga::TypeInner::{Pointer, ValuePointer, Vector};
    let module = naga::front::wgsl::parse_str(source).unwrap();
    let all = naga::valid::ValidationFlags::all();
    let info = naga::valid::Validator::new(all, naga::valid::Capabilities::empty()).validate(&module).unwrap();
    let functions = module.functions.iter().map(|(handle, function)| (function, &info[handle]));
    let entries = (0..).zip(&module.entry_points).map(|(i, entry)| (&entry.function, info.get_entry_point(i)));
    let is_written = |(function, info): &(&naga::Function, &naga::valid::FunctionInfo)| {
        stores(&function.body).into_iter().any(|pointer| match function.expressions[pointer] {
            naga::Expression::Access { base, .. } => match info[base].ty.inner_with(&module.types) {
                ValuePointer { size, .. } => size.is_some(),
                Pointer { base, .. } => matches!(module.types[*base].inner, Vector { .. }),
                _ => false,
            },
            _ => false,
        })
    };
    let names = functions.chain(entries).filter(is_written).map(|(function, _)| function.name.clone());
    names.map(|name| name.unwrap_or("entry point".into())).collect()
}

/// FXC, the compiler of HLSL that wgpu has on Windows where dxcompiler.dll is missing, cannot write an element of a
/// vector at a variable index in a loop that it cannot unroll (X3500, X3550; gfx-rs/wgpu 4436, 8334).
#[test]
fn no_vector_is_written_at_a_variable_index() {
    for composed in composed_modules() {
        let (path, _) = composed.origin(composed.source.lines().count() as u32).unwrap();
        assert_eq!(indexed_writes(&composed.source), [""; 0], "{path}");
    }
    // Planted errors: in a local vector, in that of a structure, and through a pointer in a nested loop.
    let planted = [
        "var v = vec4f(0.0); for (var i = 0u; i < 4u; i++) { v[i] = 1.0; }",
        "var s: S; for (var i = 0u; i < 4u; i++) { if i > 1u { s.v[i] = 1.0; } }",
        "var a: array<vec4u, 2>; for (var i = 0u; i < 2u; i++) { loop { a[i][i] = 1u; break; } }",
    ];
    for body in planted {
        let source = format!("struct S {{ v: vec4f }}\nfn planted() {{ {body} }}\n");
        assert_eq!(indexed_writes(&source), ["planted"], "{body}");
    }
    let array = "fn kept() { var a: array<f32, 4>; for (var i = 0u; i < 4u; i++) { a[i] = 1.0; } var v = vec2f(0.0); v.x = 1.0; }";
    assert_eq!(indexed_writes(array), [""; 0]);
}

/// Whether a text of WGSL calls the function.
pub fn calls(text: &str, name: &str) -> bool {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.match_indices(&format!("{name}(")).any(|(at, _)| !text[..at].ends_with(is_part))
}
