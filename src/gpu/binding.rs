//! What passes bind. The number of a binding is the same in every shader.

use crate::uniforms::ORIGINS;

/// Something that passes bind, by its number. Numbers below [`ORIGINS`] are textures of the caller, whose views may be
/// regions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Binding {
    /// Uniforms of the frame, or the pass's own.
    Uniforms,
    Color,
    Depth,
    Motion,
    Trust,
    Lod,
    Noise,
    Reactive = 8,
    Output = 10,
    /// Debug view beside the output.
    Debug,
    Counters,
    Lattices,
    /// Number of the frame that wrote the history.
    PastFrame,
    /// First of three textures of the previous frame's history.
    Past,
    PastSecond,
    /// First of three textures of this frame's history.
    Next = 18,
    /// The pass's own textures and buffers.
    Read = 21,
    ReadSecond,
    Write,
    WriteSecond,
    State,
    List,
    /// Which quads are shaded, and the shaded quads around each.
    QuadMask,
    QuadAround,
}

/// An input of a frame.
pub struct Input {
    pub binding: Binding,
    pub name: &'static str,
    /// Least number of channels.
    pub channels: u8,
    /// Whether it is known before the frame is shaded.
    pub is_geometry: bool,
    /// `override` of the shaders that says whether a frame has it, if they need to know.
    pub has: Option<&'static str>,
}

/// The inputs of a frame.
pub const INPUTS: [Input; 7] = [
    Input { binding: Binding::Color, name: "color", channels: 3, is_geometry: false, has: None },
    Input { binding: Binding::Depth, name: "depth", channels: 1, is_geometry: true, has: Some("HAS_DEPTH") },
    Input { binding: Binding::Motion, name: "motion", channels: 2, is_geometry: true, has: Some("HAS_MOTION") },
    Input { binding: Binding::Trust, name: "trust", channels: 1, is_geometry: true, has: Some("HAS_TRUST_MASK") },
    Input { binding: Binding::Reactive, name: "reactive", channels: 1, is_geometry: true, has: Some("HAS_REACTIVE") },
    Input { binding: Binding::Lod, name: "lod", channels: 1, is_geometry: false, has: Some("HAS_LOD") },
    Input { binding: Binding::Noise, name: "noise", channels: 2, is_geometry: false, has: None },
];

impl Binding {
    /// Its bit in a set of bindings.
    pub const fn bit(self) -> u32 {
        1 << self as u32
    }
}

/// Bindings that a pass uses, of those that its text declares. `None`: all.
pub fn used_by(pass: &str) -> Option<&'static [Binding]> {
    use Binding::{
        Color, Depth, Lattices, Motion, Noise, Past, PastFrame, PastSecond, Reactive, Read, Trust, Uniforms, Write,
        WriteSecond,
    };
    Some(match pass {
        "candidate_pass" => &[Uniforms, Color, Noise, Write],
        "fill_pass" => &[Uniforms, Color, Lattices, Write],
        "fill_geometry_pass" => &[Uniforms, Depth, Motion, Lattices, PastFrame, Past, Write, WriteSecond],
        "sparse_observe_pass" => {
            &[Uniforms, Color, Depth, Motion, Trust, Reactive, Noise, Lattices, PastFrame, Past, PastSecond, Write]
        }
        "sparse_light_pass" => &[Uniforms, Color, Depth, Lattices, PastFrame, Read, Write],
        _ => return None,
    })
}

const _: () = assert!((Binding::Debug as usize) < ORIGINS && (Binding::QuadAround as u32) < 32);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::compute::declared;
    use crate::shader::SHADERS;
    use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};
    use wgpu::naga::{AddressSpace, Expression, ImageClass, Literal, Module, ScalarKind, TypeInner, front::wgsl};
    use wgpu::{BindingType, BufferBindingType, TextureSampleType};

    /// Number of the binding that a variable must have, if its name says so.
    fn number_of(variable: &str) -> Option<u32> {
        let input = INPUTS.iter().find(|input| variable.strip_suffix("_in") == Some(input.name));
        let other = match variable {
            "color_out" => Binding::Output,
            "debug_out" => Binding::Debug,
            "counters" => Binding::Counters,
            "sparse" => Binding::Lattices,
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
            (
                _,
                AddressSpace::Uniform,
                BindingType::Buffer { ty: BufferBindingType::Uniform, has_dynamic_offset, .. },
            ) => {
                let name =
                    module.types.iter().find(|(_, ty)| ty.inner == *inner).and_then(|(_, ty)| ty.name.as_deref());
                has_dynamic_offset == (name == Some("FrameUniforms"))
            }
            (
                _,
                AddressSpace::Storage { access },
                BindingType::Buffer { ty: BufferBindingType::Storage { read_only }, .. },
            ) => read_only != access.contains(wgpu::naga::StorageAccess::STORE),
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
            ("fill_pass", "return textureLoad(color_in", "return textureLoad(trust_in"),
        ];
        for (pass, right, wrong) in planted {
            let source = SHADERS.compose(pass).source;
            assert!(source.contains(right), "{pass}: {right}");
            assert!(!violations(pass, &source.replace(right, wrong)).is_empty(), "{pass}: {wrong}");
        }
    }
}
