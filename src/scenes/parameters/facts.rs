//! What is known of every quantity that can be set: where it belongs, what it must be, and what it is.

use super::quantity::{Group, Quantity};
use crate::body::{Neighbours, Requirement};

/// What is said about a quantity: group, field, what it must be, the usual range, unit and help.
pub(super) type Facts = (Group, &'static str, Requirement, (f64, f64), &'static str, &'static str);

impl Quantity {
    pub(super) fn facts(self) -> Facts {
        use Requirement::{Finite, NonNegative, Positive};
        const SPRINGS: Group = Group::Springs;
        const MUSCLES: Group = Group::Muscles;
        const WAVES: Group = Group::Waves;
        const GAIT: Group = Group::Gait;
        const FRICTION: Group = Group::Friction;
        const COULOMB: Group = Group::Coulomb;
        match self {
            Self::Dt => (Group::Clock, "dt", Positive, (0.0001, 1.0), "time", "step of the integration, dt"),
            Self::TimeScale => (
                Group::Clock,
                "time_scale",
                NonNegative,
                (0.0, 30.0),
                "time/s",
                "simulated time that passes in a second",
            ),
            Self::Stiffness => (SPRINGS, "stiffness", NonNegative, (0.0, 10.0), "force/length", "spring stiffness k"),
            Self::Damping => (SPRINGS, "damping", NonNegative, (0.0, 10.0), "force·time/length", "spring damping D"),
            Self::RestLength => {
                // Ten times the least is longer than what springs usually hold apart: nothing is torn out of its pose by a slider.
                (SPRINGS, "rest_length", Positive, (0.2, 4.0), "length", "rest length L without its muscle")
            }
            Self::Mass => (Group::Particles, "mass", Positive, (0.1, 10.0), "mass", "mass of a particle"),
            Self::Amplitude => (
                MUSCLES,
                "amplitude",
                NonNegative,
                (0.0, 0.8),
                "of L",
                "how far a muscle drives the rest length, as a fraction of L",
            ),
            Self::Period => (MUSCLES, "period", Positive, (0.5, 30.0), "time", "time of one cycle of the wave"),
            Self::Phase => (MUSCLES, "phase", Finite, (-1.0, 1.0), "cycles", "lag of the wave; positive is later"),
            Self::Ramp => {
                (MUSCLES, "ramp", NonNegative, (0.0, 5.0), "cycles", "cycles over which the amplitude grows from 0")
            }
            Self::WaveAmplitude => {
                (WAVES, "amplitude", NonNegative, (0.0, 0.8), "of L", "how far the wave drives rest lengths, of L")
            }
            Self::WavePeriod => (WAVES, "period", Positive, (5.0, 120.0), "time", "time of one cycle of the wave"),
            Self::Wavelength => (WAVES, "wavelength", Positive, (2.0, 30.0), "segments", "length of one wave"),
            Self::Lead => (WAVES, "lead", Finite, (-0.5, 0.5), "cycles", "by how much the wave is ahead"),
            Self::Steering => {
                (GAIT, "steering", Finite, (-0.15, 0.15), "of L", "left longer, right shorter; positive turns right")
            }
            Self::GaitRamp => (
                GAIT,
                "ramp",
                NonNegative,
                (0.0, 5.0),
                "cycles",
                "cycles over which the muscles come to work or to rest",
            ),
            Self::Active => {
                (GAIT, "active", NonNegative, (0.0, 1.0), "0 or 1", "whether the muscles work; at rest it brakes")
            }
            Self::Isotropic => (
                FRICTION,
                "isotropic",
                NonNegative,
                (0.0, 5.0),
                "1/time",
                "rate at which sliding in any direction dies away",
            ),
            Self::Brake => (
                FRICTION,
                "brake",
                NonNegative,
                (0.0, 5.0),
                "1/time",
                "least drag and side grip while the muscles rest",
            ),
            Self::Drag => {
                (FRICTION, "drag", NonNegative, (0.0, 5.0), "1/time", "rate at which forward sliding dies away")
            }
            Self::Grip => {
                (FRICTION, "grip", NonNegative, (0.0, 20.0), "1/time", "rate at which sideways sliding dies away")
            }
            Self::Ratchet => (
                FRICTION,
                "ratchet",
                NonNegative,
                (0.0, 1.0),
                "0 or 1",
                "scales let nothing slide back along the spine",
            ),
            Self::Forward => {
                (COULOMB, "forward", NonNegative, (0.0, 2.0), "of the load", "Coulomb friction against sliding forward")
            }
            Self::Backward => (
                COULOMB,
                "backward",
                NonNegative,
                (0.0, 2.0),
                "of the load",
                "Coulomb friction against sliding backward",
            ),
            Self::Sideways => {
                (COULOMB, "sideways", NonNegative, (0.0, 2.0), "of the load", "Coulomb friction against sliding across")
            }
            Self::DampingRate => (
                Group::MassDamping,
                "rate",
                NonNegative,
                (0.0, 5.0),
                "1/time",
                "rate at which what surrounds the body takes its velocity",
            ),
            Self::DampingPerStep => (
                Group::MassDamping,
                "per_step",
                NonNegative,
                (0.0, 0.9),
                "of velocity",
                "part of the velocity that every step takes, λ",
            ),
            Self::Gravity => {
                (Group::Gravity, "gravity", NonNegative, (0.0, 1.0), "length/time²", "acceleration towards the ground")
            }
            Self::Tilt => (
                Group::Block,
                "tilt",
                Finite,
                (-90.0, 90.0),
                "°",
                "how far it leans; setting it puts it back to its start",
            ),
            Self::KindStiffness(kind) => {
                let (field, help) = match kind {
                    Neighbours::Edges => ("edges.stiffness", "stiffness k of springs along the edges of cells"),
                    Neighbours::Faces => ("faces.stiffness", "stiffness k of springs across the faces of cells"),
                    Neighbours::Cubes => ("cubes.stiffness", "stiffness k of springs across cells"),
                };
                (Group::Block, field, NonNegative, (0.0, 10.0), "force/length", help)
            }
            Self::KindDamping(kind) => {
                let (field, help) = match kind {
                    Neighbours::Edges => ("edges.damping", "damping D of springs along the edges of cells"),
                    Neighbours::Faces => ("faces.damping", "damping D of springs across the faces of cells"),
                    Neighbours::Cubes => ("cubes.damping", "damping D of springs across cells"),
                };
                (Group::Block, field, NonNegative, (0.0, 10.0), "force·time/length", help)
            }
            Self::KindRestLength(kind) => {
                let (field, help) = match kind {
                    Neighbours::Edges => ("edges.rest_length", "rest length L of springs along the edges of cells"),
                    Neighbours::Faces => ("faces.rest_length", "rest length L of springs across the faces of cells"),
                    Neighbours::Cubes => ("cubes.rest_length", "rest length L of springs across cells"),
                };
                (Group::Block, field, Positive, (0.2, 4.0), "length", help)
            }
            Self::Six(six) => six.facts(),
        }
    }
}
