//! Everything that a tracer on the GPU reads, as one flat array of `vec4<u32>`: a texture or a buffer, whichever the device reads
//! faster, behind one `load(i)` (`shaders/trace/scene_texture.wgsl`, `scene_storage.wgsl`).

use super::Geometry;
use bytemuck::NoUninit;

/// Bytes of an element.
pub const ELEMENT_BYTES: usize = 16;

/// Smallest row, in elements: what is lost at most before a section that is rewritten each frame.
const MIN_WIDTH: u32 = 1024;

/// What a part of the scene buffer holds. At rest until `MovingNodes`, rewritten each frame from there on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Section {
    /// Hierarchy of the triangles at rest: five elements a node, `obvhs`' bytes.
    Nodes,
    /// [`TriangleRecord`](super::TriangleRecord)s, three elements each.
    Triangles,
    /// [`AttributeRecord`](super::AttributeRecord)s, four elements each.
    Attributes,
    /// [`MaterialRecord`](super::shading_records::MaterialRecord)s.
    Materials,
    /// [`TextureRecord`](super::shading_records::TextureRecord)s.
    Textures,
    /// Texels of all textures, four an element.
    Texels,
    /// [`MapRecord`](super::shading_records::MapRecord)s of the environment.
    Map,
    /// Directional albedos of lobes.
    Albedos,
    /// As `Nodes`, of the moving triangles.
    MovingNodes,
    /// As `Triangles`.
    MovingTriangles,
    /// As `Attributes`.
    MovingAttributes,
    /// [`PreviousRecord`](super::PreviousRecord)s, three elements each.
    MovingPrevious,
    /// [`PickRecord`](super::shading_records::PickRecord)s: the lights, which may move.
    Picks,
    /// [`PunctualRecord`](super::shading_records::PunctualRecord)s.
    Punctual,
}

impl Section {
    /// Whether it is rewritten each frame.
    pub fn is_moving(self) -> bool {
        self >= Self::MovingNodes
    }
}

/// Why there is no scene_buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SceneBufferError {
    /// The device has no texture or buffer of the size.
    #[error("the scene takes {elements} elements of 16 bytes on the GPU, and the device has room for {available}")]
    TooLarge {
        /// Elements needed.
        elements: u64,
        /// Elements that the device can hold.
        available: u64,
    },
    /// A section's new contents are larger than what was reserved.
    #[error("{elements} elements do not fit into the {capacity} that were reserved for {section:?}")]
    Full {
        /// Where they were to go.
        section: Section,
        /// How many.
        elements: u64,
        /// How many fit.
        capacity: u32,
    },
}

/// Largest scene_buffer that a device takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneBufferLimits {
    /// Rows, and elements in a row: a texture's largest side. 2^31 for buffers, whose rows are only for alignment.
    pub rows: u32,
    /// Elements.
    pub elements: u64,
}

/// A section's place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Place {
    section: Section,
    base: u32,
    capacity: u32,
}

/// Contents and places.
#[derive(Clone, Debug)]
pub struct SceneBuffer {
    elements: Vec<[u32; 4]>,
    places: Vec<Place>,
    width_log2: u32,
}

/// Collects sections. Each section is given at most once.
#[derive(Clone, Debug, Default)]
pub struct SceneBufferBuilder<'a> {
    parts: Vec<Part<'a>>,
}

/// Contents of a section, and its size.
#[derive(Clone, Copy, Debug)]
struct Part<'a> {
    section: Section,
    bytes: &'a [u8],
    elements: u64,
}

impl<'a> SceneBufferBuilder<'a> {
    /// A section with these contents.
    pub fn fill<T: NoUninit>(&mut self, section: Section, records: &'a [T]) -> &mut Self {
        self.reserve(section, records, 0)
    }

    /// A section with these contents and room for `capacity` elements.
    pub fn reserve<T: NoUninit>(&mut self, section: Section, records: &'a [T], capacity: usize) -> &mut Self {
        let bytes: &[u8] = bytemuck::cast_slice(records);
        let elements = bytes.len().div_ceil(ELEMENT_BYTES).max(capacity) as u64;
        self.parts.push(Part { section, bytes, elements });
        self
    }

    /// Nodes, triangles and attributes. `max_moving` is the largest number of moving triangles at any time.
    pub fn geometry(&mut self, geometry: &'a Geometry, max_moving: usize) -> &mut Self {
        let (still, moving) = (&geometry.still, &geometry.moving);
        self.reserve(Section::Nodes, &still.nodes, NODE_ELEMENTS)
            .fill(Section::Triangles, still.triangles())
            .fill(Section::Attributes, still.attributes());
        if max_moving > 0 {
            // Every node but the root of a lone triangle has two children or more.
            self.reserve(Section::MovingNodes, &moving.nodes, max_moving * NODE_ELEMENTS)
                .reserve(Section::MovingTriangles, moving.triangles(), max_moving * 3)
                .reserve(Section::MovingAttributes, moving.attributes(), max_moving * 4)
                .reserve(Section::MovingPrevious, moving.previous(), max_moving * 3);
        }
        self
    }

    /// Sections one after the other, the moving ones at starts of rows.
    ///
    /// # Errors
    /// If the device has no room for them.
    pub fn finish(&mut self, limits: SceneBufferLimits) -> Result<SceneBuffer, SceneBufferError> {
        self.parts.sort_by_key(|part| part.section);
        let mut width_log2 = MIN_WIDTH.ilog2();
        loop {
            let width = 1_u64 << width_log2;
            let mut end = 0_u64;
            let mut starts = vec![];
            for part in &self.parts {
                if part.section.is_moving() {
                    end = end.next_multiple_of(width);
                }
                starts.push(end);
                end = end.saturating_add(part.elements).min(1 << 62);
            }
            end = end.next_multiple_of(width).max(width);
            let rows = end / width;
            if rows > u64::from(limits.rows) && width * 2 <= u64::from(limits.rows) {
                width_log2 += 1;
                continue;
            }
            if rows > u64::from(limits.rows) || end > limits.elements || end > u64::from(u32::MAX) {
                return Err(SceneBufferError::TooLarge { elements: end, available: limits.elements });
            }
            let mut scene_buffer = SceneBuffer { elements: vec![[0; 4]; end as usize], places: vec![], width_log2 };
            for (part, base) in self.parts.drain(..).zip(starts) {
                let to = bytemuck::cast_slice_mut(&mut scene_buffer.elements[base as usize..]);
                to[..part.bytes.len()].copy_from_slice(part.bytes);
                scene_buffer.places.push(Place {
                    section: part.section,
                    base: base as u32,
                    capacity: part.elements as u32,
                });
            }
            return Ok(scene_buffer);
        }
    }
}

/// Elements of a node.
pub const NODE_ELEMENTS: usize = 5;

impl SceneBuffer {
    /// Index of the section's first element; 0 if there is no such section.
    pub fn base(&self, section: Section) -> u32 {
        self.place(section).map_or(0, |p| p.base)
    }

    /// Elements that the section has room for; 0 if there is no such section.
    pub fn capacity(&self, section: Section) -> u32 {
        self.place(section).map_or(0, |p| p.capacity)
    }

    /// All of it, whole rows.
    pub fn elements(&self) -> &[[u32; 4]] {
        &self.elements
    }

    /// Elements in a row are 2 to this power.
    pub fn width_log2(&self) -> u32 {
        self.width_log2
    }

    /// Rows.
    pub fn rows(&self) -> u32 {
        (self.elements.len() >> self.width_log2) as u32
    }

    /// Bytes of all.
    pub fn bytes(&self) -> u64 {
        self.elements.len() as u64 * ELEMENT_BYTES as u64
    }

    /// New contents of a moving section. What is left of it stays.
    ///
    /// # Errors
    /// If they are more than was reserved.
    pub fn rewrite<T: NoUninit>(&mut self, section: Section, records: &[T]) -> Result<(), SceneBufferError> {
        let bytes: &[u8] = bytemuck::cast_slice(records);
        let count = bytes.len().div_ceil(ELEMENT_BYTES) as u64;
        let (base, capacity) = (self.base(section), self.capacity(section));
        if count > u64::from(capacity) {
            return Err(SceneBufferError::Full { section, elements: count, capacity });
        }
        bytemuck::cast_slice_mut(&mut self.elements[base as usize..])[..bytes.len()].copy_from_slice(bytes);
        Ok(())
    }

    /// The moving triangles as they are now.
    ///
    /// # Errors
    /// If they are more than was reserved.
    pub fn rewrite_moving(&mut self, geometry: &Geometry) -> Result<(), SceneBufferError> {
        let moving = &geometry.moving;
        if self.place(Section::MovingNodes).is_none() && moving.nodes.is_empty() {
            return Ok(());
        }
        // An empty hierarchy is a node without children.
        let none = [obvhs::cwbvh::node::CwBvhNode::default()];
        let nodes = if moving.nodes.is_empty() { &none[..] } else { &moving.nodes };
        self.rewrite(Section::MovingNodes, nodes)?;
        self.rewrite(Section::MovingTriangles, moving.triangles())?;
        self.rewrite(Section::MovingAttributes, moving.attributes())?;
        self.rewrite(Section::MovingPrevious, moving.previous())
    }

    /// Rows of the moving sections, up to the end of the scene buffer. Empty if there are none.
    pub fn moving_rows(&self) -> std::ops::Range<u32> {
        let first = self.places.iter().find(|p| p.section.is_moving());
        first.map_or(self.rows(), |p| p.base >> self.width_log2)..self.rows()
    }

    fn place(&self, section: Section) -> Option<&Place> {
        self.places.iter().find(|p| p.section == section)
    }
}
