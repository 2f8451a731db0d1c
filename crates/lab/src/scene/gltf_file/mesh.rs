//! Mesh primitives: triangles with their attributes, in local space.

use super::accessors::{Accessors, attribute};
use super::document::Document;
use super::errors::named;
use super::materials::Surface;
use super::skins;
use super::tangents;
use super::uv::PLAIN;
use super::warnings::Warnings;
use crate::error::InputError;
use crate::scene::geometry::{Geometry, Target, is_usable};
use glam::{Vec2, Vec3, Vec4};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{self, Index};

/// Context for reading primitives.
pub(super) struct Primitives<'a> {
    pub document: &'a Document<'a>,
    pub accessors: &'a Accessors<'a>,
    pub surfaces: &'a [Surface],
    /// Material of primitives without one. Its index follows all others.
    pub default_surface: Surface,
}

/// Primitive topology.
#[derive(Clone, Copy)]
enum Topology {
    List,
    Strip,
    Fan,
}

impl Primitives<'_> {
    /// Number of triangles that a primitive states; 0 for points, lines, and primitives without positions.
    pub fn claimed_triangles(&self, primitive: &Primitive) -> Result<u64, InputError> {
        let Some(topology) = topology(primitive) else { return Ok(0) };
        let Some(source) = primitive.indices.or(attribute(primitive, Semantic::Positions)) else { return Ok(0) };
        Ok(topology.triangles(self.accessors.count(source)?))
    }

    /// Mesh of a primitive, and the number of triangles dropped because a corner is not finite or too far; `None` for
    /// points, lines, and primitives without positions.
    pub fn geometry(
        &self,
        mesh: usize,
        primitive: &Primitive,
        skinned: bool,
        warnings: &mut Warnings,
    ) -> Result<Option<(Geometry, u64)>, InputError> {
        let name = || named("mesh", mesh, self.document.root.meshes[mesh].name.as_deref());
        let Some(topology) = topology(primitive) else {
            warnings.about("points and lines are left out", name);
            return Ok(None);
        };
        let Some(positions) = attribute(primitive, Semantic::Positions) else {
            warnings.about("primitives without positions are left out", name);
            return Ok(None);
        };
        let read = self.accessors;
        let positions: Vec<Vec3> = vectors(read.vectors(positions, "positions", None)?);
        let n = positions.len();
        let corners: Vec<u32> = match primitive.indices {
            Some(indices) => read.integers::<1>(indices, "indices", None)?.into_iter().map(|[i]| i).collect(),
            None => (0..n).map(|i| i as u32).collect(),
        };
        if let Some(&outside) = corners.iter().find(|&&i| i as usize >= n) {
            return Err(self.document.damaged(format!("{}: index {outside} of {n} vertices", name())));
        }
        let (material, surface) = match primitive.material {
            Some(index) => {
                (index.value(), self.document.look_up(self.surfaces, Index::new(index.value() as u32), "material")?)
            }
            None => (self.surfaces.len(), &self.default_surface),
        };
        let mut geometry = Geometry {
            positions,
            indices: topology.assemble(&corners),
            material: material as u32,
            ..Geometry::default()
        };
        if let Some(normals) = attribute(primitive, Semantic::Normals) {
            geometry.normals = vectors(read.vectors(normals, "normals", Some(n))?);
        }
        if let Some(tangents) = attribute(primitive, Semantic::Tangents)
            && surface.needs_tangents
            && !geometry.normals.is_empty()
        {
            geometry.tangents =
                read.vectors(tangents, "tangents", Some(n))?.into_iter().map(Vec4::from_array).collect();
        }
        let first = &surface.uv.first;
        let coordinates = |set| attribute(primitive, Semantic::TexCoords(set));
        match coordinates(first.set) {
            Some(uvs) => {
                let uvs = read.vectors(uvs, "texture coordinates", Some(n))?;
                geometry.uvs = uvs.into_iter().map(|uv| Vec2::from_array(first.apply(uv))).collect();
            }
            None if surface.textured => warnings.about("textures without texture coordinates show one texel", name),
            None => {}
        }
        if let Some(set) = surface.uv.second {
            match coordinates(set) {
                Some(uvs) => {
                    let uvs = read.vectors(uvs, "texture coordinates", Some(n))?;
                    geometry.second_uvs = uvs.into_iter().map(|uv| Vec2::from_array(PLAIN.apply(uv))).collect();
                }
                None => warnings.about("textures without texture coordinates show one texel", name),
            }
        }
        if let Some(colors) = attribute(primitive, Semantic::Colors(0)) {
            geometry.colors = self.colors(colors, n)?;
        }
        for target in primitive.targets.iter().flatten() {
            geometry.targets.push(self.target(target, n)?);
        }
        if skinned {
            geometry.influences = skins::influences(self.document, read, primitive, n, warnings, &name)?;
        }
        let left_out = leave_out_unusable(&mut geometry);
        finish(&mut geometry, surface);
        Ok(Some((geometry, left_out)))
    }

    /// Vertex colors: linear factors clamped to 0 to 1.
    fn colors(&self, index: Index<json::Accessor>, n: usize) -> Result<Vec<Vec4>, InputError> {
        let colors: Vec<Vec4> = if self.accessors.is_vec4(index)? {
            self.accessors.vectors(index, "colors", Some(n))?.into_iter().map(Vec4::from_array).collect()
        } else {
            let colors = self.accessors.vectors(index, "colors", Some(n))?;
            colors.into_iter().map(|c| Vec3::from_array(c).extend(1.0)).collect()
        };
        let in_range = |x: f32| if x > 0.0 { x.min(1.0) } else { 0.0 };
        Ok(colors.into_iter().map(|c| Vec4::from_array(c.to_array().map(in_range))).collect())
    }

    fn target(&self, target: &json::mesh::MorphTarget, n: usize) -> Result<Target, InputError> {
        let read = |index: Option<Index<json::Accessor>>, what| match index {
            Some(index) => self.accessors.vectors(index, what, Some(n)).map(vectors),
            None => Ok(Vec::new()),
        };
        Ok(Target {
            positions: read(target.positions, "positions of a morph target")?,
            normals: read(target.normals, "normals of a morph target")?,
            tangents: read(target.tangents, "tangents of a morph target")?,
        })
    }
}

/// Normalises normals and tangents, and generates tangents that are needed and absent.
fn finish(geometry: &mut Geometry, surface: &Surface) {
    // Unused vertices cost as much as used ones when posed.
    if geometry.positions.len() > geometry.indices.len() * 3 {
        geometry.unweld();
    }
    for normal in &mut geometry.normals {
        *normal = normal.normalize_or_zero();
    }
    for tangent in &mut geometry.tangents {
        let sign = if tangent.w < 0.0 { -1.0 } else { 1.0 };
        *tangent = tangent.truncate().normalize_or_zero().extend(sign);
    }
    let coordinates = &surface.tangents;
    let along = if coordinates.second { &geometry.second_uvs } else { &geometry.uvs };
    if surface.needs_tangents && geometry.tangents.is_empty() && !along.is_empty() {
        let along = along.iter().map(|&uv| coordinates.of(uv)).collect();
        tangents::generate(geometry, along);
    }
    if surface.tangent_turn != 0.0 {
        let (sin, cos) = surface.tangent_turn.sin_cos();
        for (tangent, normal) in geometry.tangents.iter_mut().zip(&geometry.normals) {
            let t = tangent.truncate();
            *tangent = (t * cos + normal.cross(t) * (tangent.w * sin)).extend(tangent.w);
        }
    }
}

fn topology(primitive: &Primitive) -> Option<Topology> {
    match primitive.mode {
        Checked::Valid(Mode::Triangles) => Some(Topology::List),
        Checked::Valid(Mode::TriangleStrip) => Some(Topology::Strip),
        Checked::Valid(Mode::TriangleFan) => Some(Topology::Fan),
        _ => None,
    }
}

impl Topology {
    fn triangles(self, vertices: u64) -> u64 {
        match self {
            Self::List => vertices / 3,
            Self::Strip | Self::Fan => vertices.saturating_sub(2),
        }
    }

    /// Triangles, counter-clockwise seen from the front (glTF 2.0, 3.7.2.1).
    fn assemble(self, v: &[u32]) -> Vec<[u32; 3]> {
        let strip = |(i, w): (usize, &[u32])| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] };
        match self {
            Self::List => v.as_chunks::<3>().0.to_vec(),
            Self::Strip => v.windows(3).enumerate().map(strip).collect(),
            Self::Fan => v.get(1..).unwrap_or_default().windows(2).map(|w| [w[0], w[1], v[0]]).collect(),
        }
    }
}

fn vectors(arrays: Vec<[f32; 3]>) -> Vec<Vec3> {
    arrays.into_iter().map(Vec3::from_array).collect()
}

/// Removes triangles with a corner that is not finite or too far, at rest or in a morph target, and returns their
/// number.
fn leave_out_unusable(geometry: &mut Geometry) -> u64 {
    let (targets, positions) = (&geometry.targets, &geometry.positions);
    let usable = |i: &u32| {
        let i = *i as usize;
        is_usable(&positions[i]) && targets.iter().all(|t| t.positions.get(i).is_none_or(is_usable))
    };
    let before = geometry.indices.len();
    geometry.indices.retain(|triangle| triangle.iter().all(usable));
    (before - geometry.indices.len()) as u64
}
