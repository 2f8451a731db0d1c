// Twin of src/kernel/lens.rs.

fn is_visible(x: u32, y: u32, lowest: vec4f, highest: vec4f) -> bool {
    let along = vec4f(f32(x), f32(y), f32(x) + f32(y), f32(x) - f32(y));
    return all(along >= lowest) && all(along <= highest);
}
