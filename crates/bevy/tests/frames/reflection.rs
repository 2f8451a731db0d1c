//! What an inspector does, which knows components by their reflection alone: it shows settings and changes them.

use crate::{aliased, courtyards, psnr_db};
use bevy::camera::RenderTarget;
use bevy::ecs::reflect::ReflectComponent;
use bevy::prelude::*;
use bevy::reflect::TypeRegistry;
use bevy::reflect::enums::{DynamicEnum, DynamicVariant, EnumInfo, VariantInfo};
use bevy::reflect::structs::DynamicStruct;
use bevy::reflect::tuple::DynamicTuple;
use bevy::render::RenderApp;
use bevy::render::sync_world::RenderEntity;
use bevy_afterimage::afterimage::DebugView;
use bevy_afterimage::afterimage::internal::{ContextDesc, DepthTest, Method, Settings, Smr, Wrs};
use bevy_afterimage::testing::recorded;
use bevy_afterimage::{Afterimage, AfterimageDebug, AfterimagePlugin, AfterimageStats};

/// A variant whose fields have their defaults, as an inspector makes one when it is chosen from a list.
fn variant(registry: &TypeRegistry, choices: &EnumInfo, name: &str) -> DynamicEnum {
    let default = |id| {
        let default = registry.get_type_data::<ReflectDefault>(id);
        default.unwrap_or_else(|| panic!("{}: no default", choices.variant_path(name))).default().into_partial_reflect()
    };
    let fields = match choices.variant(name).unwrap_or_else(|| panic!("no {}", choices.variant_path(name))) {
        VariantInfo::Unit(_) => DynamicVariant::Unit,
        VariantInfo::Tuple(fields) => {
            let mut values = DynamicTuple::default();
            fields.iter().for_each(|field| values.insert_boxed(default(field.type_id())));
            values.into()
        }
        VariantInfo::Struct(fields) => {
            let mut values = DynamicStruct::default();
            fields.iter().for_each(|field| values.insert_boxed(field.name(), default(field.type_id())));
            values.into()
        }
    };
    DynamicEnum::new(name, fields)
}

/// A camera, its components by their names.
struct Inspector<'a> {
    world: &'a mut World,
    camera: Entity,
}

impl Inspector<'_> {
    fn at(&mut self, component: &str, path: &str, change: impl FnOnce(&TypeRegistry, &mut dyn PartialReflect)) {
        let registry = self.world.resource::<AppTypeRegistry>().clone();
        let registry = registry.read();
        let registration = registry.get_with_short_type_path(component).expect("a registered type");
        let component = registration.data::<ReflectComponent>().expect("a component");
        let mut component = component.reflect_mut(self.world.entity_mut(self.camera)).expect("on the camera");
        change(&registry, component.reflect_path_mut(path).unwrap_or_else(|error| panic!("{path}: {error}")));
    }

    /// Writes a value.
    fn set(&mut self, component: &str, path: &str, value: impl PartialReflect) {
        self.at(component, path, |_, place| place.try_apply(&value).expect("the same type"));
    }

    /// Chooses a variant of an enumeration.
    fn choose(&mut self, component: &str, path: &str, name: &str) {
        self.at(component, path, |registry, place| {
            let choices = place.get_represented_type_info().and_then(|info| info.as_enum().ok()).expect("an enum");
            place.try_apply(&variant(registry, choices, name)).expect("a variant");
        });
    }
}

/// What a camera shows, which an inspector changes on its way.
struct Run {
    component: Afterimage,
    desc: ContextDesc,
    stats: AfterimageStats,
    shot: Vec<u8>,
}

type Change = fn(&mut Inspector<'_>);

/// What cameras show that see the same, and that an inspector changes on their way.
fn run<const N: usize>(changes: [Change; N]) -> [Run; N] {
    let (mut headless, targets) = courtyards(changes.map(|_| (aliased(), AfterimageStats::default())));
    headless.frames(6);
    let world = headless.app.world_mut();
    let mut drawn = world.query_filtered::<(Entity, &RenderTarget), With<Afterimage>>();
    let cameras = targets.map(|target| {
        let shows = |own: &RenderTarget| own.as_image() == Some(&target);
        (drawn.iter(world).find(|(_, own)| shows(own)).expect("a camera").0, target)
    });
    cameras.iter().zip(changes).for_each(|(&(camera, _), change)| {
        change(&mut Inspector { world: headless.app.world_mut(), camera });
    });
    headless.frames(6);
    assert_eq!(headless.problems(), &[] as &[String]);
    let drawn = recorded(headless.app.sub_app_mut(RenderApp).world_mut());
    cameras.map(|(camera, target)| {
        let shot = headless.read_target(&target);
        let camera = headless.app.world().entity(camera);
        let own = camera.get::<RenderEntity>().expect("a drawn camera").id();
        let desc = drawn.iter().find(|drawn| drawn.camera == own).expect("a frame with history").desc;
        Run { component: camera.get::<Afterimage>().unwrap().clone(), desc, stats: *camera.get().unwrap(), shot }
    })
}

#[test]
fn settings_change_through_reflection() {
    let steady = Settings::steady();
    let smr = |smr| Settings { method: Method::Smr(smr), ..steady };
    let changes: [(&str, Settings, Change); 5] = [
        ("taa", Settings { method: Method::Taa, ..steady }, |camera| {
            camera.choose("Afterimage", "settings", "Some");
            camera.choose("Afterimage", "settings.0.method", "Taa");
        }),
        ("wrs", Settings { method: Method::Wrs(Wrs { weight_exponent: 3, ..Wrs::default() }), ..steady }, |camera| {
            camera.choose("Afterimage", "settings", "Some");
            camera.choose("Afterimage", "settings.0.method", "Wrs");
            camera.set("Afterimage", "settings.0.method.0.weight_exponent", 3_u32);
        }),
        ("accumulate", smr(Smr { accumulate: 0.25, ..Smr::default() }), |camera| {
            camera.choose("Afterimage", "settings", "Some");
            camera.set("Afterimage", "settings.0.method.0.accumulate", 0.25_f32);
        }),
        ("no depth test", Settings { depth_test: None, ..steady }, |camera| {
            camera.choose("Afterimage", "settings", "Some");
            camera.choose("Afterimage", "settings.0.depth_test", "None");
        }),
        ("depth test", Settings { depth_test: Some(DepthTest { slope_px: 9.0, ..default() }), ..steady }, |camera| {
            camera.choose("Afterimage", "settings", "Some");
            camera.choose("Afterimage", "settings.0.depth_test", "None");
            camera.choose("Afterimage", "settings.0.depth_test", "Some");
            camera.set("Afterimage", "settings.0.depth_test.0.slope_px", 9.0_f32);
        }),
    ];
    let [taa, wrs, accumulate, untested, tested] = changes.map(|(.., change)| change);
    let [unchanged, wide, changed @ ..] = run([
        |_| {},
        |camera| {
            camera.set("Foveated", "mid_deg", 20.0_f32);
            camera.set("Foveated", "fovea_deg", 20.0_f32);
        },
        taa,
        wrs,
        accumulate,
        untested,
        tested,
    ]);
    for ((name, expected, _), changed) in changes.into_iter().zip(changed) {
        assert_eq!(changed.component, Afterimage { settings: Some(expected), ..aliased() }, "{name}");
        let drawn = changed.desc.settings;
        assert_eq!((drawn.method, drawn.depth_test), (expected.method, expected.depth_test), "{name}");
        let psnr = psnr_db(&changed.shot, &unchanged.shot);
        println!("{name}: {psnr:.2} dB to the default, {:?}", changed.stats);
        assert!(psnr < 60.0, "{name} is not seen: {psnr:.2} dB");
        assert_eq!(changed.stats.disoccluded == 0, name == "no depth test", "{name}: {:?}", changed.stats);
    }

    assert_eq!(wide.desc.settings.foveation.fovea_deg, 20.0);
    println!("fovea of 5 and 20 degrees: {} and {} pixels", unchanged.stats.shaded, wide.stats.shaded);
    assert!(2 * wide.stats.shaded > 3 * unchanged.stats.shaded, "{:?}", wide.stats);
}

#[test]
fn an_inspector_can_choose_every_variant() {
    let mut app = App::new();
    app.add_plugins(AfterimagePlugin);
    let registry = app.world().resource::<AppTypeRegistry>().read();
    let mut count = 0;
    for registration in
        registry.iter().filter(|registration| registration.type_info().type_path().contains("afterimage::"))
    {
        let Ok(choices) = registration.type_info().as_enum() else { continue };
        let chosen = registration.data::<ReflectFromReflect>().expect("can be made");
        for name in choices.variant_names() {
            let value = chosen.from_reflect(&variant(&registry, choices, name));
            let value = value.unwrap_or_else(|| panic!("{}", choices.variant_path(name)));
            assert_eq!(value.reflect_ref().as_enum().expect("an enum").variant_name(), *name);
            count += 1;
        }
        println!("{}: {:?}", choices.type_path(), choices.variant_names());
    }
    // Among them the methods and what they name, and the Options of what can be left out.
    assert!(count > 30, "{count}");
    drop(registry);
    let camera = app.world_mut().spawn(AfterimageDebug(DebugView::Age)).id();
    Inspector { world: app.world_mut(), camera }.choose("AfterimageDebug", ".0", "Motion");
    assert_eq!(app.world().get::<AfterimageDebug>(camera), Some(&AfterimageDebug(DebugView::Motion)));
}
