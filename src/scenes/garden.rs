//! The lay of the garden along the x axis, shared by the scene's logic and by what draws it.

use crate::physics::ShownLap;

/// Where the mouth of the burrow is, from which the worm comes out; its tunnel reaches back to x = −5.
pub const BURROW_MOUTH: f64 = -1.3;

/// Where the front of the worm's house is; its door faces −x, and the inside reaches to x = 14.5, so that the whole worm fits.
pub const DOOR: f64 = 10.0;

/// The worm is shown inside the burrow again once its tail is well behind the door.
pub const LAP: ShownLap = ShownLap { end: 11.2, length: 15.4 };
