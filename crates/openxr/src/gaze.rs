//! Where the eyes look: XR_EXT_eye_gaze_interaction, or what the application knows.

use crate::eye::{position, rotation};
use glam::{Mat4, Vec3};
use openxr as xr;
use xr::sys;

/// The gaze of both eyes together: a ray in the world, from between the eyes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it begins, in metres.
    pub origin: [f32; 3],
    /// Its direction, of length 1.
    pub direction: [f32; 3],
}

/// The runtime's eye tracker. Its action survives sessions, its space does not.
pub(crate) struct Tracker {
    pub set: xr::ActionSet,
    action: xr::Action<xr::Posef>,
    space: Option<xr::Space>,
}

impl Tracker {
    /// `None` unless the system has an eye tracker.
    pub fn new(instance: &xr::Instance, system: xr::SystemId) -> Result<Option<Self>, sys::Result> {
        if instance.exts().ext_eye_gaze_interaction.is_none() || !supports_eye_gaze(instance, system)? {
            return Ok(None);
        }
        let set = instance.create_action_set("gaze", "Gaze", 0)?;
        let action = set.create_action::<xr::Posef>("gaze", "Gaze", &[])?;
        let profile = instance.string_to_path("/interaction_profiles/ext/eye_gaze_interaction")?;
        let path = instance.string_to_path("/user/eyes_ext/input/gaze_ext/pose")?;
        instance.suggest_interaction_profile_bindings(profile, &[xr::Binding::new(&action, path)])?;
        Ok(Some(Self { set, action, space: None }))
    }

    /// Follows a new session, or the end of one.
    pub fn follow(&mut self, session: Option<&xr::Session<xr::Vulkan>>) -> Result<(), sys::Result> {
        self.space = None;
        if let Some(session) = session {
            self.space = Some(self.action.create_space(session, xr::Path::NULL, xr::Posef::IDENTITY)?);
        }
        Ok(())
    }

    /// The gaze at a time; `None` in blinks, and while tracking is lost. Actions were synchronised.
    pub fn at(&self, base: &xr::Space, time: xr::Time) -> Result<Option<Ray>, sys::Result> {
        let Some(space) = &self.space else { return Ok(None) };
        let found = space.locate(base, time)?;
        let needed = xr::SpaceLocationFlags::ORIENTATION_VALID
            | xr::SpaceLocationFlags::ORIENTATION_TRACKED
            | xr::SpaceLocationFlags::POSITION_VALID;
        Ok(found.location_flags.contains(needed).then(|| Ray {
            origin: position(found.pose.position).into(),
            direction: (rotation(found.pose.orientation) * Vec3::NEG_Z).into(),
        }))
    }
}

/// Ray of a direction from between the eyes, in the head's space (x right, y up, -z forward).
pub(crate) fn from_head(views: &[xr::View], direction: [f32; 3]) -> Option<Ray> {
    let between = 0.5 * (position(views[0].pose.position) + position(views[1].pose.position));
    // Displays may be turned outwards by the same angle.
    let turn = rotation(views[0].pose.orientation).slerp(rotation(views[1].pose.orientation), 0.5);
    let direction = Mat4::from_quat(turn).transform_vector3(direction.into()).try_normalize()?;
    Some(Ray { origin: between.into(), direction: direction.into() })
}

/// Whether the system has an eye tracker. The crate `openxr` enables the extension, but does not ask this.
#[expect(unsafe_code, reason = "the property is chained to a struct of the C interface")]
fn supports_eye_gaze(instance: &xr::Instance, system: xr::SystemId) -> Result<bool, sys::Result> {
    let mut gaze = sys::SystemEyeGazeInteractionPropertiesEXT {
        ty: sys::SystemEyeGazeInteractionPropertiesEXT::TYPE,
        next: std::ptr::null_mut(),
        supports_eye_gaze_interaction: sys::FALSE,
    };
    // SAFETY: a struct of plain numbers, for which zeros are valid.
    let mut properties: sys::SystemProperties = unsafe { std::mem::zeroed() };
    properties.ty = sys::SystemProperties::TYPE;
    properties.next = (&raw mut gaze).cast();
    // SAFETY: both structs live until the call returns, and have the types that their `ty` says.
    let result = unsafe { (instance.fp().get_system_properties)(instance.as_raw(), system, &raw mut properties) };
    if result.into_raw() < 0 { Err(result) } else { Ok(gaze.supports_eye_gaze_interaction.into()) }
}
