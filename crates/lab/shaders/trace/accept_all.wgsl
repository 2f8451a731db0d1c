// Where no material has an opacity of its own: every hit counts.

fn accept_hit(triangle: u32, u: f32, v: f32, key: u32) -> bool {
    return true;
}
