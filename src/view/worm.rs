//! The garden worm's skin: an ellipsoid a particle, orange rings for its scales, and a face.

use bevy::{light::NotShadowCaster, prelude::*};

use super::{paint::Paint, skins::SkinOf, worm_parts};
use crate::{body::Springs, physics::Shown, scenes::SceneMember};

/// The radius of an ellipsoid at rest, in rest lengths of the springs.
const RADIUS: f32 = 0.37;
/// Half the length of an ellipsoid at rest, in rest lengths: neighbours overlap, so that the body is of one piece.
const HALF_LENGTH: f32 = 0.63;
/// How much the worm is lifted off the path: it lies on gravel.
const CLEARANCE: f32 = 0.03;
/// Where on an ellipsoid rings sit, in half lengths from its middle.
const RINGS: [f32; 3] = [-0.4, 0.0, 0.4];

/// What the parts of a worm are made of; shared by all worms.
pub(super) struct WormKit {
    body: Handle<Mesh>,
    ring: Handle<Mesh>,
    eye: Handle<Mesh>,
    mouth: Handle<Mesh>,
    feeler: Handle<Mesh>,
    blot: Handle<Mesh>,
    skin: Paint,
    shadow: Handle<Paint>,
}

impl WormKit {
    /// Shapes the parts. `shelter` is where the worm is in the dark, see [`Paint`].
    pub fn new(meshes: &mut Assets<Mesh>, paints: &mut Assets<Paint>, shadows: bool, shelter: Vec4) -> Self {
        Self {
            body: meshes.add(worm_parts::body()),
            ring: meshes.add(worm_parts::ring()),
            eye: meshes.add(worm_parts::eye()),
            mouth: meshes.add(worm_parts::mouth()),
            feeler: meshes.add(worm_parts::feeler()),
            blot: meshes.add(worm_parts::blot()),
            skin: Paint { shelter, ..Paint::glossy(shadows, 0.7) },
            shadow: paints.add(Paint::blot(if shadows { 0.5 } else { 1.0 })),
        }
    }
}

/// Which part of the worm an entity is.
#[derive(Clone, Component, Copy, Debug)]
pub(super) enum Part {
    /// The ellipsoid of a particle.
    Segment(usize),
    /// A ring on the ellipsoid of a particle, so many half lengths before its middle.
    Ring(usize, f32),
    /// A ring between a particle and the next.
    Joint(usize),
    /// The face, on the last particle: the mouth, or something on the left (−1) or the right (1).
    Mouth,
    Eye(f32),
    Feeler(f32),
    /// The dark spot on the ground under a particle.
    Blot(usize),
}

/// Spawns the skin of a worm of `count` particles, dyed where it has a colour of its own.
pub(super) fn dress(
    body: Entity,
    count: usize,
    dye: Option<Color>,
    kit: &WormKit,
    paints: &mut Assets<Paint>,
    commands: &mut Commands,
) -> Entity {
    let last = count - 1;
    // The worm's own colours are warm and light: what they leave of the dye is to be no darker than the dye.
    let tint = dye.map_or(Vec4::ONE, |dye| (dye.to_linear().to_vec3() * 1.5 + 0.05).extend(1.0));
    let skin = paints.add(Paint { tint, ..kit.skin.clone() });
    let mut parts = vec![Part::Mouth, Part::Eye(-1.0), Part::Eye(1.0), Part::Feeler(-1.0), Part::Feeler(1.0)];
    for i in 0..count {
        parts.extend([Part::Segment(i), Part::Blot(i)]);
        // The face is left free.
        parts.extend(RINGS.into_iter().filter(|at| i < last || *at < -0.1).map(|at| Part::Ring(i, at)));
        if i < last {
            parts.push(Part::Joint(i));
        }
    }
    let root = commands.spawn((SceneMember, SkinOf(body), Transform::default(), Visibility::default())).id();
    for part in parts {
        let (mesh, paint) = match part {
            Part::Segment(_) => (&kit.body, &skin),
            Part::Ring(..) | Part::Joint(_) => (&kit.ring, &skin),
            Part::Mouth => (&kit.mouth, &skin),
            Part::Eye(_) => (&kit.eye, &skin),
            Part::Feeler(_) => (&kit.feeler, &skin),
            Part::Blot(_) => (&kit.blot, &kit.shadow),
        };
        let mut part_of_it =
            commands.spawn((part, SkinOf(body), Mesh3d(mesh.clone()), MeshMaterial3d(paint.clone()), ChildOf(root)));
        if matches!(part, Part::Blot(_)) {
            part_of_it.insert(NotShadowCaster);
        }
    }
    root
}

/// One ellipsoid as it is shown: where, which way, how long and how thick.
#[derive(Clone, Copy)]
struct Segment {
    middle: Vec3,
    turn: Quat,
    half_length: f32,
    radius: f32,
}

impl Segment {
    /// The ellipsoid of a particle. Its length follows the gaps to its neighbours, and its volume stays.
    fn of(i: usize, positions: &[Vec3], rest: f32) -> Self {
        let last = positions.len() - 1;
        let (before, after) = (positions[i.saturating_sub(1)], positions[(i + 1).min(last)]);
        let gaps = (after - positions[i]).length() + (positions[i] - before).length();
        let gap = if i == 0 || i == last { gaps } else { gaps * 0.5 };
        let stretch = (gap / rest).clamp(0.2, 5.0);
        let radius = RADIUS * rest / stretch.sqrt()
            * if i == last {
                1.1
            } else if i == 0 {
                0.92
            } else {
                1.0
            };
        let forward = (after - before).normalize_or(Vec3::X);
        let right = forward.cross(Vec3::Y).normalize_or(Vec3::Z);
        Self {
            middle: positions[i] + Vec3::Y * (radius + CLEARANCE * rest),
            turn: Quat::from_mat3(&Mat3::from_cols(forward, right.cross(forward), right)),
            half_length: HALF_LENGTH * rest * stretch,
            radius,
        }
    }

    /// A point of the ellipsoid's surface: `direction` is one of the unit ball (x forward, y up, z right).
    fn surface(&self, direction: Vec3) -> Vec3 {
        self.middle + self.turn * (direction * Vec3::new(self.half_length, self.radius, self.radius))
    }

    /// Half the thickness, so many half lengths before the middle.
    fn thickness(&self, at: f32) -> f32 {
        self.radius * (1.0 - at * at).max(0.0).sqrt()
    }
}

/// Puts every part of a worm where its particles are shown.
pub(super) fn follow(bodies: Query<(&Shown, Option<&Springs>)>, mut parts: Query<(&Part, &SkinOf, &mut Transform)>) {
    for (part, of, mut transform) in &mut parts {
        let Ok((shown, springs)) = bodies.get(of.0) else { continue };
        let positions = shown.positions();
        if positions.len() < 2 {
            continue;
        }
        let rest = rest_length(springs);
        let last = positions.len() - 1;
        let segment = |i: usize| Segment::of(i.min(last), positions, rest);
        *transform = match *part {
            Part::Segment(i) => {
                let it = segment(i);
                place(it.middle, it.turn, Vec3::new(it.half_length, it.radius, it.radius))
            }
            Part::Ring(i, at) => {
                let it = segment(i);
                // Rings lean back at the tail and forward at the head, as scales do on a bent body; here they only shrink to fit.
                let wide = it.thickness(at) * 1.015;
                place(it.surface(Vec3::X * at), it.turn, Vec3::new(rest * 0.5, wide, wide))
            }
            Part::Joint(i) => {
                let (a, b) = (segment(i), segment(i + 1));
                let wide = 0.5 * (a.thickness(0.5 / HALF_LENGTH) + b.thickness(0.5 / HALF_LENGTH)) * 1.06;
                place((a.middle + b.middle) * 0.5, a.turn.slerp(b.turn, 0.5), Vec3::new(rest * 0.56, wide, wide))
            }
            Part::Mouth => {
                let it = segment(last);
                place(it.middle, it.turn, Vec3::new(it.half_length, it.radius, it.radius) * 1.004)
            }
            Part::Eye(side) => {
                let it = segment(last);
                let turn = it.turn * Quat::from_rotation_y(-side * 0.55) * Quat::from_rotation_z(0.16);
                place(it.surface(Vec3::new(0.62, 0.6, side * 0.5)), turn, Vec3::splat(it.radius * 0.4))
            }
            Part::Feeler(side) => {
                let it = segment(last);
                let turn = it.turn * Quat::from_rotation_x(side * 0.45) * Quat::from_rotation_z(-0.1);
                place(it.surface(Vec3::new(0.3, 0.88, side * 0.36)), turn, Vec3::splat(it.radius))
            }
            Part::Blot(i) => {
                let it = segment(i);
                let under = it.middle.with_y(it.middle.y - it.radius + CLEARANCE * 0.8 + 0.004 * (i + 1) as f32);
                place(
                    under + Vec3::new(0.08, 0.0, -0.06),
                    it.turn,
                    Vec3::new(it.half_length * 1.15, 1.0, it.radius * 1.35),
                )
            }
        };
    }
}

fn place(translation: Vec3, rotation: Quat, scale: Vec3) -> Transform {
    Transform { translation, rotation, scale }
}

/// The mean rest length of a body's springs: the scale of its skin.
fn rest_length(springs: Option<&Springs>) -> f32 {
    let Some(springs) = springs.filter(|springs| !springs.is_empty()) else { return 1.0 };
    (springs.iter().map(|spring| spring.rest_length).sum::<f64>() / springs.len() as f64) as f32
}

#[cfg(test)]
mod tests {
    use core::f32::consts::PI;

    use super::*;

    #[test]
    fn an_ellipsoid_keeps_its_volume_while_it_stretches() {
        let volume = |gap: f32| {
            let positions = [Vec3::ZERO, Vec3::X * gap, Vec3::X * 2.0 * gap];
            let it = Segment::of(1, &positions, 1.0);
            (it.half_length * it.radius * it.radius, it.radius)
        };
        let (rest, thick) = volume(1.0);
        for gap in [0.72, 0.9, 1.31] {
            let (volume, radius) = volume(gap);
            assert!((volume / rest - 1.0).abs() < 1e-5, "at {gap}: {volume} and not {rest}");
            assert_eq!(radius > thick, gap < 1.0, "a short segment is thick");
        }
    }

    #[test]
    fn an_ellipsoid_lies_on_the_path_whatever_the_heading() {
        for heading in [0.0, 0.7, 2.0, -1.5, PI] {
            let forward = Quat::from_rotation_y(heading) * Vec3::X;
            let it = Segment::of(2, &[Vec3::ZERO, forward, forward * 2.0], 1.0);
            assert!((it.turn * Vec3::X).distance(forward) < 1e-5);
            assert!((it.turn * Vec3::Y).distance(Vec3::Y) < 1e-5, "it stays upright at {heading}");
            assert!((it.middle.y - it.radius - CLEARANCE).abs() < 1e-5);
        }
    }
}
