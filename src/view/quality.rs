//! How much the picture may cost.

use bevy::{
    prelude::*,
    render::{renderer::RenderAdapterInfo, view::Msaa},
};

/// How much the picture may cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Reflect, Resource)]
#[reflect(Resource)]
pub enum Quality {
    /// For renderers without a GPU: baked shadows, no multisampling, fewer and wider blades, half the resolution in a window.
    Low,
    /// For any GPU: a cascaded shadow map, four samples a pixel, many blades.
    High,
}

impl Quality {
    /// The quality for an adapter, and why, for people.
    pub(super) fn pick(adapter: Option<&RenderAdapterInfo>) -> (Self, String) {
        let Some(adapter) = adapter else {
            return (Self::Low, "no graphics adapter is known".into());
        };
        let name = adapter.name.as_str();
        let software = ["llvmpipe", "lavapipe", "swiftshader", "softpipe"];
        // A device type is an enum of wgpu, which is no dependency of ours; its name is as good.
        if format!("{:?}", adapter.device_type) == "Cpu"
            || software.iter().any(|soft| name.to_lowercase().contains(soft))
        {
            (Self::Low, format!("{name} draws without a GPU"))
        } else {
            (Self::High, format!("{name} is a GPU"))
        }
    }

    /// Whether there is a shadow map.
    pub(super) fn shadows(self) -> bool {
        self == Self::High
    }

    pub(super) fn msaa(self) -> Msaa {
        match self {
            Self::Low => Msaa::Off,
            Self::High => Msaa::Sample4,
        }
    }

    /// How many blades of grass are sown.
    pub(super) fn blades(self) -> usize {
        match self {
            Self::Low => 18_000,
            Self::High => 150_000,
        }
    }

    /// How much wider a blade is than at its finest.
    pub(super) fn blade_width(self) -> f32 {
        match self {
            Self::Low => 2.0,
            Self::High => 1.0,
        }
    }

    /// Of how many pieces a blade is bent.
    pub(super) fn blade_segments(self) -> usize {
        match self {
            Self::Low => 2,
            Self::High => 3,
        }
    }

    /// How many pebbles lie on the path.
    pub(super) fn pebbles(self) -> usize {
        match self {
            Self::Low => 200,
            Self::High => 900,
        }
    }

    /// Of how many sides far round things are.
    pub(super) fn roundness(self) -> usize {
        match self {
            Self::Low => 10,
            Self::High => 18,
        }
    }

    /// How many flowers stand in the grass.
    pub(super) fn meadow_flowers(self) -> usize {
        match self {
            Self::Low => 280,
            Self::High => 640,
        }
    }
}
