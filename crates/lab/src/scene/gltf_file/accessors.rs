//! Accessors: reads typed elements from buffers, of any component type, dense or sparse, with bounds checks.

use super::document::Document;
use crate::error::InputError;
use crate::error::{Bound, Exceeded};
use crate::scene::SceneLimits;
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::{Checked, USize64};
use gltf::json::{Index, buffer};
use std::cell::Cell;

/// Reads accessors, and counts the elements read against [`SceneLimits::max_elements`].
pub(super) struct Accessors<'a> {
    document: &'a Document<'a>,
    elements: Cell<u64>,
}

impl<'a> Accessors<'a> {
    pub fn new(document: &'a Document<'a>) -> Self {
        Self { document, elements: Cell::new(0) }
    }

    /// Number of elements that an accessor states.
    pub fn count(&self, index: Index<Accessor>) -> Result<u64, InputError> {
        Ok(self.accessor(index)?.count.0)
    }

    /// Vectors of `N` floats. Integers are converted, normalised if the accessor says so. An error unless there are
    /// `expected` elements, if that is given.
    pub fn vectors<const N: usize>(
        &self,
        index: Index<Accessor>,
        what: &str,
        expected: Option<usize>,
    ) -> Result<Vec<[f32; N]>, InputError> {
        let shape = match N {
            1 => Type::Scalar,
            2 => Type::Vec2,
            3 => Type::Vec3,
            4 => Type::Vec4,
            _ => Type::Mat4,
        };
        let accessor = self.accessor(index)?;
        self.check_shape(accessor, index, what, shape)?;
        self.check_count(accessor, index, what, expected)?;
        let normalized = accessor.normalized;
        match self.component_type(accessor, index)? {
            ComponentType::F32 => self.read(accessor, index, what, |b: [u8; 4]| f32::from_le_bytes(b)),
            ComponentType::U8 => self.read(accessor, index, what, scaled(normalized, u8::from_le_bytes, 255.0)),
            ComponentType::I8 => self.read(accessor, index, what, scaled(normalized, i8::from_le_bytes, 127.0)),
            ComponentType::U16 => self.read(accessor, index, what, scaled(normalized, u16::from_le_bytes, 65535.0)),
            ComponentType::I16 => self.read(accessor, index, what, scaled(normalized, i16::from_le_bytes, 32767.0)),
            ComponentType::U32 => self.read(accessor, index, what, |b: [u8; 4]| u32::from_le_bytes(b) as f32),
        }
    }

    /// Vectors of `N` unsigned integers: indices of vertices or joints.
    pub fn integers<const N: usize>(
        &self,
        index: Index<Accessor>,
        what: &str,
        expected: Option<usize>,
    ) -> Result<Vec<[u32; N]>, InputError> {
        let accessor = self.accessor(index)?;
        self.check_shape(accessor, index, what, if N == 1 { Type::Scalar } else { Type::Vec4 })?;
        self.check_count(accessor, index, what, expected)?;
        match self.component_type(accessor, index)? {
            ComponentType::U8 => self.read(accessor, index, what, |b: [u8; 1]| b[0].into()),
            ComponentType::U16 => self.read(accessor, index, what, |b: [u8; 2]| u16::from_le_bytes(b).into()),
            ComponentType::U32 => self.read(accessor, index, what, |b: [u8; 4]| u32::from_le_bytes(b)),
            other => Err(self.bad(index, what, format!("has components of type {other:?}, not unsigned integers"))),
        }
    }

    /// Whether the elements are VEC4, not VEC3: colors come with and without alpha.
    pub fn is_vec4(&self, index: Index<Accessor>) -> Result<bool, InputError> {
        Ok(matches!(self.accessor(index)?.type_, Checked::Valid(Type::Vec4)))
    }

    fn accessor(&self, index: Index<Accessor>) -> Result<&'a Accessor, InputError> {
        self.document.look_up(&self.document.root.accessors, index, "accessor")
    }

    fn component_type(&self, accessor: &Accessor, index: Index<Accessor>) -> Result<ComponentType, InputError> {
        match accessor.component_type {
            Checked::Valid(kind) => Ok(kind.0),
            Checked::Invalid => Err(self.document.damaged(format!("accessor {index} has an unknown component type"))),
        }
    }

    fn check_shape(
        &self,
        accessor: &Accessor,
        index: Index<Accessor>,
        what: &str,
        expected: Type,
    ) -> Result<(), InputError> {
        match accessor.type_ {
            Checked::Valid(found) if found == expected => Ok(()),
            Checked::Valid(found) => Err(self.bad(index, what, format!("is {found:?}, expected {expected:?}"))),
            Checked::Invalid => Err(self.bad(index, what, "is of an unknown type")),
        }
    }

    fn check_count(
        &self,
        accessor: &Accessor,
        index: Index<Accessor>,
        what: &str,
        expected: Option<usize>,
    ) -> Result<(), InputError> {
        let found = accessor.count.0;
        if let Some(expected) = expected.filter(|&n| n as u64 != found) {
            return Err(self.bad(index, what, format!("has {found} elements, expected {expected}")));
        }
        let elements = self.elements.get().saturating_add(found);
        let limit = self.document.limits.max_elements();
        if elements > limit {
            let needed = Some(elements.div_ceil(SceneLimits::ELEMENTS_PER_TRIANGLE));
            return Err(InputError::limit(
                Exceeded { bound: Bound::Triangles, needed, allowed: self.document.limits.max_triangles },
                self.document.subject,
                format!("its vertices, indices and keys come to more than {limit} elements"),
                "use a smaller scene, or raise SceneLimits::max_triangles",
            ));
        }
        self.elements.set(elements);
        Ok(())
    }

    /// Reads all elements, each of `N` components of `S` bytes.
    fn read<const N: usize, const S: usize, T: Copy + Default>(
        &self,
        accessor: &Accessor,
        index: Index<Accessor>,
        what: &str,
        component: impl Fn([u8; S]) -> T,
    ) -> Result<Vec<[T; N]>, InputError> {
        let element = |bytes: &[u8]| {
            let (components, _) = bytes.as_chunks::<S>();
            std::array::from_fn(|i| components.get(i).map_or_else(T::default, |&b| component(b)))
        };
        let outside = || self.bad(index, what, "reaches beyond its buffer");
        let mut elements: Vec<[T; N]> = match accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.unwrap_or_default();
                let (bytes, stride) = self.strided(view, offset, accessor.count, N * S).ok_or_else(outside)?;
                bytes.chunks(stride).take(accessor.count.0 as usize).map(element).collect()
            }
            // Without a buffer view all elements are zero. No valid file has a count above its number of bytes.
            None if accessor.count.0 <= self.document.buffers.total_bytes => {
                vec![[T::default(); N]; accessor.count.0 as usize]
            }
            None => return Err(self.bad(index, what, format!("has {} elements and no buffer", accessor.count.0))),
        };
        if let Some(sparse) = &accessor.sparse {
            let bytes_of_index = match sparse.indices.component_type {
                Checked::Valid(kind) => kind.0.size(),
                Checked::Invalid => return Err(self.bad(index, what, "has sparse indices of an unknown type")),
            };
            let indices = self
                .strided(sparse.indices.buffer_view, sparse.indices.byte_offset, sparse.count, bytes_of_index)
                .ok_or_else(outside)?;
            let values = self
                .strided(sparse.values.buffer_view, sparse.values.byte_offset, sparse.count, N * S)
                .ok_or_else(outside)?;
            let pairs = indices.0.chunks(indices.1).zip(values.0.chunks(values.1));
            for (at, value) in pairs.take(sparse.count.0 as usize) {
                let at = at[..bytes_of_index].iter().rev().fold(0usize, |n, &b| n << 8 | usize::from(b));
                *elements.get_mut(at).ok_or_else(|| self.bad(index, what, format!("sets element {at}")))? =
                    element(value);
            }
        }
        Ok(elements)
    }

    /// Bytes of `count` elements from `offset` on in a buffer view, and their stride; `None` if they exceed the view.
    fn strided(
        &self,
        view: Index<buffer::View>,
        offset: USize64,
        count: USize64,
        element: usize,
    ) -> Option<(&'a [u8], usize)> {
        let (bytes, stride) = self.document.buffers.view(&self.document.root.buffer_views, view)?;
        let stride = stride.unwrap_or(element);
        if stride < element {
            return None;
        }
        let offset = usize::try_from(offset.0).ok()?;
        let count = usize::try_from(count.0).ok()?;
        let length = match count {
            0 => 0,
            _ => (count - 1).checked_mul(stride)?.checked_add(element)?,
        };
        Some((bytes.get(offset..offset.checked_add(length)?)?, stride))
    }

    fn bad(&self, index: Index<Accessor>, what: &str, problem: impl std::fmt::Display) -> InputError {
        self.document.damaged(format!("accessor {index} for {what} {problem}"))
    }
}

/// Conversion of an integer component to float, scaled to at most 1 if it is normalised (glTF 2.0, 3.11).
fn scaled<const S: usize, T: Into<f32>>(
    normalized: bool,
    decode: impl Fn([u8; S]) -> T,
    largest: f32,
) -> impl Fn([u8; S]) -> f32 {
    move |bytes| {
        let value = decode(bytes).into();
        if normalized { (value / largest).max(-1.0) } else { value }
    }
}

/// The accessor of an attribute of a primitive.
pub(super) fn attribute(primitive: &Primitive, semantic: Semantic) -> Option<Index<Accessor>> {
    primitive.attributes.get(&Checked::Valid(semantic)).copied()
}
