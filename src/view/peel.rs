//! The animals without their skins: masses, springs by strain, muscles by activation, spine vectors, contact and grip.

use bevy::{
    color::palettes::css,
    gizmos::config::{GizmoConfigGroup, GizmoConfigStore},
    math::Isometry3d,
    prelude::*,
};

use super::{help::typing, jelly::JellySkin, strand::StrandSkin};
use crate::{
    body::{Ground, ParticleId, Particles, SpineFriction, SpringId, Strand, StrandSpring},
    mechanics::{ground_distance, ground_grip, rest_lengths},
    physics::{Clock, Shown, body_parts},
};

/// Whether animals are shown without their skins; key `X`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Resource)]
#[reflect(Resource)]
pub struct Peeled(pub bool);

/// What each colour means, in the order of the legend.
pub(super) const LEGEND: [(Srgba, &str); 8] = [
    (SHORT, "spring, shorter than at rest"),
    (LONG, "spring, longer than at rest"),
    (PULLS, "muscle that pulls (shortens)"),
    (PUSHES, "muscle that pushes (lengthens)"),
    (MASS, "mass in the air"),
    (TOUCHES, "mass that touches the ground"),
    (SPINE, "spine vector"),
    (GRIP, "side grip: the longer, the firmer"),
];

const SHORT: Srgba = Srgba::new(0.13, 0.4, 0.95, 1.0);
const LONG: Srgba = Srgba::new(0.95, 0.2, 0.1, 1.0);
const REST: Srgba = Srgba::new(0.9, 0.9, 0.86, 1.0);
const PULLS: Srgba = Srgba::new(0.85, 0.1, 0.75, 1.0);
const PUSHES: Srgba = Srgba::new(0.1, 0.7, 0.45, 1.0);
const MASS: Srgba = css::WHITE;
const TOUCHES: Srgba = Srgba::new(1.0, 0.6, 0.0, 1.0);
const SPINE: Srgba = Srgba::new(1.0, 0.9, 0.1, 1.0);
const GRIP: Srgba = Srgba::new(0.45, 0.25, 0.1, 1.0);

/// The strain, and the part of a rest length, at which a colour is fullest.
const FULL: f32 = 0.2;

/// Thick lines, for muscles.
#[derive(Default, GizmoConfigGroup, Reflect)]
struct MuscleLines;

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Peeled>()
        .init_gizmo_group::<MuscleLines>()
        .add_systems(Startup, configure)
        .add_systems(Update, (toggle.run_if(not(typing)), hide, draw.run_if(peeled)).chain());
}

fn configure(mut store: ResMut<GizmoConfigStore>) {
    // In front of the ground that they touch and of each other.
    let (lines, _) = store.config_mut::<DefaultGizmoConfigGroup>();
    (lines.line.width, lines.depth_bias) = (1.6, -0.02);
    let (lines, _) = store.config_mut::<MuscleLines>();
    (lines.line.width, lines.depth_bias) = (4.5, -0.02);
}

fn peeled(peeled: Res<Peeled>) -> bool {
    peeled.0
}

fn toggle(keys: Res<ButtonInput<KeyCode>>, mut peeled: ResMut<Peeled>) {
    if keys.just_pressed(KeyCode::KeyX) {
        peeled.0 = !peeled.0;
    }
}

/// Skins that can be taken off.
type Peelable = Or<(With<StrandSkin>, With<JellySkin>)>;

fn hide(peeled: Res<Peeled>, mut skins: Query<&mut Visibility, Peelable>) {
    let wanted = if peeled.0 { Visibility::Hidden } else { Visibility::Inherited };
    for mut visibility in &mut skins {
        visibility.set_if_neq(wanted);
    }
}

/// A colour from `low` at −1 over pale at 0 to `high` at 1.
fn between(low: Srgba, high: Srgba, part: f32) -> Color {
    let end = if part < 0.0 { low } else { high };
    Color::from(REST).mix(&Color::from(end), part.abs().min(1.0))
}

fn draw(
    bodies: Query<EntityRef, With<Particles>>,
    clock: Res<Clock>,
    mut lines: Gizmos,
    mut muscles: Gizmos<MuscleLines>,
) {
    for body in &bodies {
        let (Some(parts), Some(shown)) = (body_parts(body), body.get::<Shown>()) else { continue };
        let positions = shown.positions();
        if positions.len() != parts.particles.len() {
            continue;
        }
        let rests = rest_lengths(&parts, clock.time());
        let driven = |id: SpringId| match parts.strand {
            Some(strand) => matches!(strand.role(id), StrandSpring::Axial { .. }),
            None => parts.muscles.is_some_and(|muscles| muscles.iter().any(|muscle| muscle.spring == id)),
        };
        for (i, (spring, &rest)) in parts.springs.iter().zip(&rests).enumerate() {
            if parts.tearing.is_some_and(|tearing| tearing.is_torn(SpringId(i as u32))) {
                continue;
            }
            let [from, to] = spring.ends.map(|end| positions[end.index()]);
            if driven(SpringId(i as u32)) {
                let activation = (rest / spring.rest_length - 1.0) as f32;
                muscles.line(from, to, between(PULLS, PUSHES, activation / FULL));
            } else {
                let strain = (from.distance(to) / rest as f32) - 1.0;
                lines.line(from, to, between(SHORT, LONG, strain / FULL));
            }
        }
        draw_masses(positions, parts.ground, &mut lines);
        if let Some(friction) = parts.friction {
            draw_spine(positions, friction, parts.strand, parts.ground, &mut lines);
        }
    }
}

fn draw_masses(positions: &[Vec3], ground: Option<&Ground>, lines: &mut Gizmos) {
    for &at in positions {
        let touches = ground.is_some_and(|ground| ground_distance(ground, at.as_dvec3()).0 < Ground::CONTACT_DISTANCE);
        let (color, radius) = if touches { (TOUCHES, 0.075) } else { (MASS, 0.05) };
        lines.sphere(Isometry3d::from_translation(at), radius, color).resolution(8);
    }
}

/// Spine vectors at the middles of the sections, and across them how firmly their masses hold sideways.
fn draw_spine(
    positions: &[Vec3],
    friction: &SpineFriction,
    strand: Option<Strand>,
    ground: Option<&Ground>,
    lines: &mut Gizmos,
) {
    let at = |id: &ParticleId| positions[id.index()];
    let middles: Vec<_> =
        friction.sections().map(|section| section.iter().map(at).sum::<Vec3>() / section.len().max(1) as f32).collect();
    let last = middles.len().saturating_sub(1);
    let size = if strand.is_some() { 0.55 } else { 0.4 };
    for (i, section) in friction.sections().enumerate() {
        let along = (middles[(i + 1).min(last)] - middles[i.saturating_sub(1)]).normalize_or_zero();
        lines.arrow(middles[i], middles[i] + along * size, SPINE).with_tip_length(0.18);
        for at in section.iter().map(at) {
            let grip = match ground {
                Some(ground) => {
                    let (distance, _) = ground_distance(ground, at.as_dvec3());
                    if distance < Ground::CONTACT_DISTANCE {
                        ground_grip(ground, at.as_dvec3(), friction.grip())
                    } else {
                        0.0
                    }
                }
                None => friction.grip(),
            };
            if grip > 0.0 {
                let side = along.cross(Vec3::Y).normalize_or_zero() * (0.12 + 0.1 * (1.0 + grip as f32).ln());
                lines.line(at - side, at + side, GRIP);
            }
        }
    }
}
