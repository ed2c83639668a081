//! The plain skin: a ball a particle, a rod a spring, coloured by how far the spring is from its rest length. Under what slides along its spine, and never
//! back, is a scale: it lies flat while its mass slides, and digs in while friction holds it.

use bevy::prelude::*;

use super::{
    clay::{Clay, blend, tint},
    paint::Paint,
    skins::SkinOf,
};
use crate::{
    body::{Ground, ParticleId, Particles, SpineFriction, SpringId, Springs, Tearing},
    physics::Shown,
    scenes::SceneMember,
};

/// The radius of a ball and of a rod, in rest lengths of the springs.
const BALL: f32 = 0.13;
const ROD: f32 = 0.05;
/// The strain at which a rod's colour is fullest.
const FULL_STRAIN: f32 = 0.3;
/// What slides more slowly than this, in lengths a unit of time, is held.
const STILL: f64 = 1e-6;
/// How many colours there are on either side of no strain.
const SHADES: usize = 8;

/// What plain skins are made of; shared by all of them.
pub(super) struct PlainKit {
    ball: Handle<Mesh>,
    rod: Handle<Mesh>,
    scale: Handle<Mesh>,
    scale_paint: Handle<Paint>,
    ball_paint: Handle<Paint>,
    rod_paints: Vec<Handle<Paint>>,
}

impl PlainKit {
    /// Shapes the parts. Rods are blue where the spring is short, pale at rest, red where it is long.
    pub fn new(meshes: &mut Assets<Mesh>, paints: &mut Assets<Paint>, shadows: bool) -> Self {
        let mut ball = Clay::default();
        ball.ball(Transform::default(), 20, |_| tint(0xf2b134));
        let mut rod = Clay::default();
        rod.lathe(Transform::default(), &[(1.0, 0.0), (1.0, 1.0)], 10, |_, _| [1.0, 1.0, 1.0, 0.0]);
        let mut scale = Clay::default();
        scale.lathe(Transform::default(), &[(1.0, 0.0), (0.8, 0.5), (0.0, 1.0)], 12, |_, _| [1.0, 1.0, 1.0, 0.0]);
        let paint = |i: usize| {
            let strain = i as f32 / SHADES as f32 - 1.0;
            let end = if strain < 0.0 { tint(0x2f6fd0) } else { tint(0xe0402e) };
            let color = blend(tint(0xe9e4d8), end, strain.abs());
            Paint { tint: Vec4::from_array(color).with_w(1.0), ..Paint::glossy(shadows, 0.4) }
        };
        Self {
            ball: meshes.add(ball.fire()),
            rod: meshes.add(rod.fire()),
            scale: meshes.add(scale.fire()),
            scale_paint: paints
                .add(Paint { tint: Vec4::from_array(tint(0xb4521e)).with_w(1.0), ..Paint::glossy(shadows, 0.5) }),
            ball_paint: paints.add(Paint::glossy(shadows, 0.6)),
            rod_paints: (0..=2 * SHADES).map(|i| paints.add(paint(i))).collect(),
        }
    }
}

/// Which part of a body an entity shows.
#[derive(Clone, Component, Copy, Debug)]
pub(super) enum PlainPart {
    Ball(usize),
    Rod(SpringId),
    /// Of a particle, with those behind and before it on the spine; at the ends one of them is its own.
    Scale {
        particle: usize,
        behind: usize,
        before: usize,
    },
}

/// The colours of a body's rods, from short to long.
#[derive(Clone, Component)]
pub(super) struct Shades(Vec<Handle<Paint>>);

/// Spawns the skin of a body.
pub(super) fn dress(
    body: Entity,
    particles: usize,
    springs: Option<&Springs>,
    friction: Option<&SpineFriction>,
    kit: &PlainKit,
    commands: &mut Commands,
) -> Entity {
    let root = (SceneMember, Shades(kit.rod_paints.clone()), Transform::default(), Visibility::default());
    let root = commands.spawn(root).id();
    for i in 0..particles {
        let looks = (Mesh3d(kit.ball.clone()), MeshMaterial3d(kit.ball_paint.clone()));
        commands.spawn((PlainPart::Ball(i), SkinOf(body), looks, ChildOf(root)));
    }
    for i in 0..springs.map_or(0, Springs::len) {
        let looks = (Mesh3d(kit.rod.clone()), MeshMaterial3d(kit.rod_paints[SHADES].clone()));
        commands.spawn((PlainPart::Rod(SpringId(i as u32)), SkinOf(body), looks, ChildOf(root)));
    }
    // Scales are of what slides one way, mass by mass.
    let spine = friction.filter(|friction| friction.ratchet() && friction.width() == 1).map_or(&[][..], |f| f.spine());
    for (i, particle) in spine.iter().enumerate() {
        let part = PlainPart::Scale {
            particle: particle.index(),
            behind: spine[i.saturating_sub(1)].index(),
            before: spine[(i + 1).min(spine.len() - 1)].index(),
        };
        let looks = (Mesh3d(kit.scale.clone()), MeshMaterial3d(kit.scale_paint.clone()));
        commands.spawn((part, SkinOf(body), looks, ChildOf(root)));
    }
    root
}

/// How a scale of a ball at `at` lies: its root at the ball's underside behind, its tip back along the spine, along the ground or into it.
fn scale(at: Vec3, spine: Vec3, radius: f32, held: bool) -> Transform {
    let (flat, digs) = (0.12, 0.75);
    let down: f32 = if held { digs } else { flat };
    let tip = -spine * down.cos() - Vec3::Y * down.sin();
    Transform::from_translation(at - radius * (0.35 * spine + 0.62 * Vec3::Y))
        .with_rotation(Quat::from_rotation_arc(Vec3::Y, tip.normalize_or(Vec3::NEG_Y)))
        .with_scale(radius * Vec3::new(0.42, 1.15, 0.42))
}

/// What is looked at of a body.
type Seen =
    (&'static Shown, &'static Particles, Option<&'static Springs>, Option<&'static Tearing>, Option<&'static Ground>);

/// Puts every ball, rod and scale where its body is shown.
pub(super) fn follow(
    bodies: Query<Seen>,
    shades: Query<&Shades>,
    mut parts: Query<(&PlainPart, &SkinOf, &ChildOf, &mut Transform, &mut MeshMaterial3d<Paint>)>,
) {
    for (part, of, root, mut transform, mut paint) in &mut parts {
        let Ok((shown, particles, springs, tearing, ground)) = bodies.get(of.0) else { continue };
        let size = springs.and_then(|springs| springs.get(SpringId(0))).map_or(1.0, |spring| spring.rest_length as f32);
        // A ball lies on the ground that its mass, a point, stands on.
        let lift = if ground.is_some() { BALL * size * Vec3::Y } else { Vec3::ZERO };
        let at = |i: usize| shown.positions().get(i).map(|at| *at + lift);
        match *part {
            PlainPart::Ball(i) => {
                let Some(at) = at(i) else { continue };
                *transform = Transform::from_translation(at).with_scale(Vec3::splat(BALL * size));
            }
            PlainPart::Scale { particle, behind, before } => {
                let [Some(place), Some(from), Some(to)] = [particle, behind, before].map(at) else { continue };
                let spine = (to - from).normalize_or(Vec3::X);
                let velocity = particles.velocity(ParticleId(particle as u32)).unwrap_or_default();
                let held = velocity.dot(spine.as_dvec3()) < STILL;
                *transform = scale(place, spine, BALL * size, held);
            }
            PlainPart::Rod(id) => {
                let Some(spring) = springs.and_then(|springs| springs.get(id)) else { continue };
                let [Some(from), Some(to)] = spring.ends.map(|end| at(end.index())) else { continue };
                if tearing.is_some_and(|tearing| tearing.is_torn(id)) {
                    *transform = Transform::from_scale(Vec3::ZERO);
                    continue;
                }
                let (along, rest) = (to - from, spring.rest_length as f32);
                let length = along.length();
                *transform = Transform::from_translation(from)
                    .with_rotation(Quat::from_rotation_arc(Vec3::Y, along.normalize_or(Vec3::Y)))
                    .with_scale(Vec3::new(ROD * size, length, ROD * size));
                let strain = ((length - rest) / rest / FULL_STRAIN).clamp(-1.0, 1.0);
                let shade = ((strain + 1.0) * SHADES as f32).round() as usize;
                if let Ok(shades) = shades.get(root.parent())
                    && shades.0[shade] != paint.0
                {
                    paint.0 = shades.0[shade].clone();
                }
            }
        }
    }
}
