//! Bindings of the passes: `src/gpu/binding.rs` says what the shaders declare and use.

use afterimage::internal::{Binding, INPUTS, declared, used_by};
use afterimage::shader::SHADERS;
use afterimage::wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};
use afterimage::wgpu::naga::{self, AddressSpace, Expression, ImageClass, Literal, Module, ScalarKind, TypeInner};
use afterimage::wgpu::{BindingType, BufferBindingType, TextureSampleType};
use naga::front::wgsl;

/// Number of the binding that a variable must have, if its name says so.
fn number_of(variable: &str) -> Option<u32> {
    let input = INPUTS.iter().find(|input| variable.strip_suffix("_in") == Some(input.name));
    let other = match variable {
        "color_out" => Binding::Output,
        "debug_out" => Binding::Debug,
        "counters" => Binding::Counters,
        "stored_frame" => Binding::PastFrame,
        "state" => Binding::State,
        "list" => Binding::List,
        "quad_mask" => Binding::QuadMask,
        "quad_around" => Binding::QuadAround,
        _ => input?.binding,
    };
    Some(other as u32)
}

fn is_of_type(module: &Module, inner: &TypeInner, space: AddressSpace, ty: BindingType) -> bool {
    match (inner, space, ty) {
        (
            TypeInner::Image { class: ImageClass::Sampled { kind, .. }, .. },
            _,
            BindingType::Texture { sample_type, .. },
        ) => (*kind == ScalarKind::Uint) == (sample_type == TextureSampleType::Uint),
        (TypeInner::Image { class: ImageClass::Storage { .. }, .. }, _, BindingType::StorageTexture { .. }) => true,
        (_, AddressSpace::Uniform, BindingType::Buffer { ty: BufferBindingType::Uniform, has_dynamic_offset, .. }) => {
            let name = module.types.iter().find(|(_, ty)| ty.inner == *inner).and_then(|(_, ty)| ty.name.as_deref());
            has_dynamic_offset == (name == Some("FrameUniforms"))
        }
        (
            _,
            AddressSpace::Storage { access },
            BindingType::Buffer { ty: BufferBindingType::Storage { read_only }, .. },
        ) => read_only != access.contains(naga::StorageAccess::STORE),
        _ => false,
    }
}

/// What is wrong with the bindings of a pass: numbers, types, and which the entry point uses.
fn violations(pass: &str, source: &str) -> Vec<String> {
    let module = wgsl::parse_str(source).unwrap();
    let info = Validator::new(ValidationFlags::empty(), Capabilities::all()).validate(&module).unwrap();
    let mut used = vec![];
    let mut wrong = vec![];
    for (handle, variable) in module.global_variables.iter() {
        let (Some(at), Some(name)) = (variable.binding, &variable.name) else { continue };
        if !info.get_entry_point(0)[handle].is_empty() {
            used.push(at.binding);
        }
        if number_of(name).is_some_and(|number| number != at.binding) {
            wrong.push(format!("{name} has the number {}", at.binding));
        }
        let ty = declared(source).iter().find(|(number, _)| *number == at.binding).map(|(_, ty)| *ty);
        if ty.is_none_or(|ty| !is_of_type(&module, &module.types[variable.ty].inner, variable.space, ty)) {
            wrong.push(format!("{name} is read as {ty:?}"));
        }
    }
    for (_, constant) in module.constants.iter() {
        let name = constant.name.as_deref().unwrap_or_default();
        if let (true, Expression::Literal(Literal::U32(value))) =
            (name.ends_with("_IN") || name.ends_with("_OUT"), &module.global_expressions[constant.init])
            && number_of(&name.to_lowercase()).is_some_and(|number| number != *value)
        {
            wrong.push(format!("{name} is {value}"));
        }
    }
    used.sort_unstable();
    let listed = used_by(pass).map(|bindings| bindings.iter().map(|&binding| binding as u32).collect::<Vec<_>>());
    if listed.is_some_and(|mut listed| {
        listed.sort_unstable();
        listed != used
    }) {
        wrong.push(format!("{pass} uses {used:?}"));
    }
    wrong
}

#[test]
fn bindings_are_those_of_the_shaders() {
    let passes: Vec<_> = SHADERS.module_names().filter(|name| name.ends_with("_pass")).collect();
    for pass in &passes {
        assert_eq!(violations(pass, &SHADERS.compose(pass).source), [""; 0], "{pass}");
    }
    println!("{} passes", passes.len());
    assert!(passes.len() > 15);
    // Planted errors.
    let planted = [
        ("smr_pass", "@binding(3) var motion_in", "@binding(9) var motion_in"),
        ("smr_pass", "TRUST_IN: u32 = 4u", "TRUST_IN: u32 = 5u"),
        ("candidate_pass", "return textureLoad(color_in", "return textureLoad(trust_in"),
    ];
    for (pass, right, wrong) in planted {
        let source = SHADERS.compose(pass).source;
        assert!(source.contains(right), "{pass}: {right}");
        assert!(!violations(pass, &source.replace(right, wrong)).is_empty(), "{pass}: {wrong}");
    }
}
