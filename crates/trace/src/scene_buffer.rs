//! The scene as the GPU tracer reads it: one flat array of `vec4u` behind a function `load(i)`. It is a texture or
//! a storage buffer, whichever the device reads faster (`shaders/trace/scene_texture.wgsl`, `scene_storage.wgsl`).

use afterimage_lab::rays::Geometry;
use bytemuck::NoUninit;
use std::collections::BTreeMap;
use std::ops::Range;

/// Bytes of an element.
pub const ELEMENT_BYTES: usize = 16;

/// Smallest row width in elements. Each section that is rewritten per frame wastes at most this much, as it starts on a
/// row.
const MIN_WIDTH: u32 = 1024;

/// A section of the scene buffer. Sections before `MovingNodes` are static, the others are rewritten each frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Section {
    /// Hierarchy of the static triangles: five elements per node, in `obvhs`' layout.
    Nodes,
    /// [`TriangleRecord`](afterimage_lab::rays::TriangleRecord)s, three elements each.
    Triangles,
    /// [`AttributeRecord`](afterimage_lab::rays::AttributeRecord)s, four elements each.
    Attributes,
    /// [`SecondUvRecord`](afterimage_lab::rays::SecondUvRecord)s, two elements each; absent where no triangle has them.
    SecondUvs,
    /// [`MaterialRecord`](afterimage_lab::scene::shading_records::MaterialRecord)s.
    Materials,
    /// [`TextureRecord`](crate::records::TextureRecord)s, three elements each.
    Textures,
    /// Texels of all textures, four per element.
    Texels,
    /// [`MapRecord`](crate::records::MapRecord)s: texels of the environment map.
    Map,
    /// Tables of the lobes' directional albedos.
    Albedos,
    /// Hierarchy of the moving triangles, as `Nodes`.
    MovingNodes,
    /// Moving triangles, as `Triangles`.
    MovingTriangles,
    /// Attributes of the moving triangles, as `Attributes`.
    MovingAttributes,
    /// Second texture coordinates of the moving triangles, as `SecondUvs`.
    MovingSecondUvs,
    /// [`PickRecord`](crate::records::PickRecord)s: the alias table over all lights, which may move.
    Picks,
    /// [`PunctualRecord`](afterimage_lab::scene::shading_records::PunctualRecord)s.
    Punctual,
}

impl Section {
    /// Whether the section is rewritten each frame.
    pub fn is_moving(self) -> bool {
        self >= Self::MovingNodes
    }
}

/// A scene that does not fit into the scene buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SceneBufferError {
    /// The device has no texture or buffer of this size.
    #[error(
        "scene buffer: needs {elements} elements of 16 bytes, the device allows {available}; use a smaller scene or the CPU"
    )]
    TooLarge {
        /// Elements needed.
        elements: u64,
        /// Elements that the device allows.
        available: u64,
    },
    /// New contents of a section exceed its reserved capacity.
    #[error("scene buffer: {section:?} needs {elements} elements, {capacity} are reserved; create the tracer again")]
    Full {
        /// The section.
        section: Section,
        /// Elements of the new contents.
        elements: u64,
        /// Elements reserved.
        capacity: u32,
    },
}

/// Largest scene buffer that a device allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneBufferLimits {
    /// Largest number of rows, and of elements in a row: a texture's largest side. 2^31 for storage buffers, whose rows
    /// only align sections.
    pub rows: u32,
    /// Largest number of elements.
    pub elements: u64,
}

/// The scene buffer's contents and section layout.
#[derive(Clone, Debug)]
pub struct SceneBuffer {
    elements: Vec<[u32; 4]>,
    /// Elements of each section.
    places: BTreeMap<Section, Range<u32>>,
    width_log2: u32,
}

/// Collects sections for a [`SceneBuffer`]. Add each section at most once.
#[derive(Clone, Debug, Default)]
pub struct SceneBufferBuilder<'a> {
    parts: Vec<Part<'a>>,
}

/// Contents of a section, and its size in elements.
#[derive(Clone, Copy, Debug)]
struct Part<'a> {
    section: Section,
    bytes: &'a [u8],
    elements: u64,
}

impl<'a> SceneBufferBuilder<'a> {
    /// Adds a section with `records` as its contents.
    pub fn fill<T: NoUninit>(&mut self, section: Section, records: &'a [T]) -> &mut Self {
        self.reserve(section, records, 0)
    }

    /// Adds a section with `records` as its contents and room for at least `capacity` elements.
    pub fn reserve<T: NoUninit>(&mut self, section: Section, records: &'a [T], capacity: usize) -> &mut Self {
        let bytes: &[u8] = bytemuck::cast_slice(records);
        let elements = bytes.len().div_ceil(ELEMENT_BYTES).max(capacity) as u64;
        self.parts.push(Part { section, bytes, elements });
        self
    }

    /// Adds nodes, triangles and attributes. `max_moving` is the largest number of moving triangles at any time.
    pub fn geometry(&mut self, geometry: &'a Geometry, max_moving: usize) -> &mut Self {
        let (still, moving) = (&geometry.still, &geometry.moving);
        self.reserve(Section::Nodes, still.nodes(), NODE_ELEMENTS)
            .fill(Section::Triangles, still.triangles())
            .fill(Section::Attributes, still.attributes());
        if let Some(records) = still.second_uvs() {
            self.fill(Section::SecondUvs, records);
        }
        if let Some(records) = moving.second_uvs().filter(|_| max_moving > 0) {
            self.reserve(Section::MovingSecondUvs, records, max_moving * 2);
        }
        if max_moving > 0 {
            // Every node has at least two children, except the root of a single triangle; so there are at most as many
            // nodes as triangles.
            self.reserve(Section::MovingNodes, moving.nodes(), max_moving * NODE_ELEMENTS)
                .reserve(Section::MovingTriangles, moving.triangles(), max_moving * 3)
                .reserve(Section::MovingAttributes, moving.attributes(), max_moving * 4);
        }
        self
    }

    /// Lays out the sections one after another; those rewritten per frame start on a row.
    ///
    /// # Errors
    /// If they exceed the device's limits.
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
            let elements = vec![[0; 4]; end as usize];
            let mut scene_buffer = SceneBuffer { elements, places: BTreeMap::new(), width_log2 };
            for (part, base) in self.parts.drain(..).zip(starts) {
                let to = bytemuck::cast_slice_mut(&mut scene_buffer.elements[base as usize..]);
                to[..part.bytes.len()].copy_from_slice(part.bytes);
                scene_buffer.places.insert(part.section, base as u32..(base + part.elements) as u32);
            }
            return Ok(scene_buffer);
        }
    }
}

/// Elements of a hierarchy node.
pub const NODE_ELEMENTS: usize = 5;

impl SceneBuffer {
    /// Index of the section's first element; 0 if the section does not exist.
    pub fn base(&self, section: Section) -> u32 {
        self.places.get(&section).map_or(0, |place| place.start)
    }

    /// Elements reserved for the section; 0 if it does not exist.
    pub fn capacity(&self, section: Section) -> u32 {
        self.places.get(&section).map_or(0, |place| place.len() as u32)
    }

    /// All elements, in whole rows.
    pub fn elements(&self) -> &[[u32; 4]] {
        &self.elements
    }

    /// Base-2 logarithm of the row width in elements.
    pub fn width_log2(&self) -> u32 {
        self.width_log2
    }

    /// Number of rows.
    pub fn rows(&self) -> u32 {
        (self.elements.len() >> self.width_log2) as u32
    }

    /// Size in bytes.
    pub fn bytes(&self) -> u64 {
        self.elements.len() as u64 * ELEMENT_BYTES as u64
    }

    /// Overwrites the start of a moving section; elements after `records` keep their old contents.
    ///
    /// # Errors
    /// If `records` exceed the section's capacity.
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

    /// Overwrites the moving triangles' sections with their current state.
    ///
    /// # Errors
    /// If a section's capacity is exceeded.
    pub fn rewrite_moving(&mut self, geometry: &Geometry) -> Result<(), SceneBufferError> {
        let moving = &geometry.moving;
        if !self.places.contains_key(&Section::MovingNodes) && moving.nodes().is_empty() {
            return Ok(());
        }
        // An empty hierarchy is a root without children: zeros.
        match moving.nodes() {
            [] => self.rewrite(Section::MovingNodes, &[[0_u32; 4]; NODE_ELEMENTS])?,
            nodes => self.rewrite(Section::MovingNodes, nodes)?,
        }
        self.rewrite(Section::MovingTriangles, moving.triangles())?;
        self.rewrite(Section::MovingAttributes, moving.attributes())?;
        self.rewrite(Section::MovingSecondUvs, moving.second_uvs().unwrap_or_default())
    }

    /// Rows from the first moving section to the end; empty without moving sections.
    pub fn moving_rows(&self) -> Range<u32> {
        let first = self.places.iter().find(|(section, _)| section.is_moving());
        first.map_or(self.rows(), |(_, place)| place.start >> self.width_log2)..self.rows()
    }
}
