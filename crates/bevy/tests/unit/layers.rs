//! Which camera lies below another one.

use super::*;
use bevy::ecs::system::RunSystemOnce;

#[test]
fn the_camera_below_is_the_nearest_one_that_is_active() {
    let mut world = World::new();
    world.init_resource::<Layers>();
    let mut spawn = |order, is_active| {
        let camera = Camera { order, is_active, ..Default::default() };
        let texture = (RenderTarget::default(), Msaa::default(), CameraMainTextureUsages::default());
        world.spawn((Camera3d::default(), camera, texture)).id()
    };
    let cameras = [(3, true), (0, true), (1, true), (2, false)].map(|(order, is_active)| spawn(order, is_active));
    let [top, bottom, middle, idle] = cameras;
    world.entity_mut(bottom).insert(Afterimage::default());
    world.run_system_once(find_layers).expect("a system");
    let below = cameras.map(|camera| world.resource::<Layers>().below(camera));
    assert_eq!(below, [Some(middle), None, Some(bottom), None], "{top} {bottom} {middle} {idle}");
}

#[test]
fn the_camera_below_has_the_same_format() {
    let mut world = World::new();
    world.init_resource::<Layers>();
    let mut spawn = |order, is_hdr| {
        let camera = Camera { order, ..Default::default() };
        let texture = (RenderTarget::default(), Msaa::default(), CameraMainTextureUsages::default());
        let mut camera = world.spawn((Camera3d::default(), camera, texture));
        if is_hdr {
            camera.insert(Hdr);
        }
        camera.id()
    };
    let cameras = [(0, true), (1, false), (2, true), (3, false)].map(|(order, is_hdr)| spawn(order, is_hdr));
    let [world_camera, middle, ..] = cameras;
    world.entity_mut(world_camera).insert(Afterimage::default());
    world.run_system_once(find_layers).expect("a system");
    let below = cameras.map(|camera| world.resource::<Layers>().below(camera));
    assert_eq!(below, [None, None, Some(world_camera), Some(middle)]);
}
