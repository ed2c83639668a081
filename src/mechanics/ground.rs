//! How far a ground is, and which way is off it.

use bevy::math::DVec3;

use crate::body::{Ground, Patch, Surface, Terrain};

use super::{Real, State, model::Fading};

/// A surface as it is asked for its distance.
#[derive(Clone, Copy, Debug)]
enum SurfaceRow {
    Floor { height: f64 },
    Plane { normal: [f64; 3], offset: f64 },
    Cliff { edge: f64, radius: f64 },
    Hill { center: [f64; 2], radius: f64, height: f64 },
    Ball { center: [f64; 3], radius: f64 },
}

/// What steps know of the ground.
#[derive(Clone, Debug)]
pub(super) struct Contact<R, const D: usize> {
    pub(super) kind: ContactKind,
    surfaces: Vec<SurfaceRow>,
    patches: Vec<(Patch, Fading<R>)>,
    pub(super) bounce: f64,
    /// Where the step began; kept only over a terrain.
    pub(super) start: Vec<[R; D]>,
}

/// How much there is to ask of the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ContactKind {
    /// There is none.
    None,
    /// It is the plane y = 0.
    Flat,
    /// It has surfaces.
    Terrain,
}

impl<R: Real, const D: usize> Contact<R, D> {
    pub(super) fn new(ground: Option<&Ground>, dt: f64) -> Self {
        let empty = |kind| Self { kind, surfaces: Vec::new(), patches: Vec::new(), bounce: 0.0, start: Vec::new() };
        match ground {
            None => empty(ContactKind::None),
            Some(Ground::Flat) => empty(ContactKind::Flat),
            Some(Ground::Terrain(terrain)) => Self {
                surfaces: rows(terrain),
                patches: terrain.patches().iter().map(|patch| (*patch, Fading::splat(patch.grip(), dt))).collect(),
                bounce: terrain.bounce(),
                ..empty(ContactKind::Terrain)
            },
        }
    }

    pub(super) fn lane(&self, lane: usize) -> Contact<f64, D> {
        Contact {
            kind: self.kind,
            surfaces: self.surfaces.clone(),
            patches: self.patches.iter().map(|(patch, grip)| (*patch, grip.lane(lane))).collect(),
            bounce: self.bounce,
            start: self.start.iter().map(|row| row.map(|value| value.lane(lane))).collect(),
        }
    }

    pub(super) fn has_patches(&self) -> bool {
        !self.patches.is_empty()
    }

    /// Gives every patch at least this side grip in a lane.
    pub(super) fn set_least_grip(&mut self, lane: usize, least: f64, dt: f64) {
        for (patch, fading) in &mut self.patches {
            fading.set_lane(lane, patch.grip().max(least), dt);
        }
    }

    /// Remembers where a step begins.
    #[inline(always)]
    pub(super) fn begin_step(&mut self, state: &State<R, D>) {
        if self.kind == ContactKind::Terrain {
            self.start.clone_from(&state.position);
        }
    }

    /// The distance of a point from a terrain, and the unit vector that leads off it.
    #[inline(never)]
    pub(super) fn distance(&self, x: [R; D]) -> (R, [R; D]) {
        let mut normal = [R::splat(0.0); D];
        let (distance, n) = nearest(&self.surfaces, [x[0], x[1], x[2]]);
        normal[..3].copy_from_slice(&n);
        (distance, normal)
    }

    /// The side grip where a mass stands; `elsewhere` off all patches.
    #[inline(never)]
    pub(super) fn grip(&self, x: [R; D], elsewhere: Fading<R>) -> Fading<R> {
        let mut grip = elsewhere;
        for (patch, own) in &self.patches {
            // Below 0 within the patch.
            let outside = match *patch {
                Patch::Disc { center, radius, .. } => {
                    let (dx, dz) = (x[0] - R::splat(center.0), x[2] - R::splat(center.1));
                    dx * dx + dz * dz - R::splat(radius * radius)
                }
                Patch::Box { from, to, .. } => {
                    let x_out = larger(R::splat(from.0) - x[0], x[0] - R::splat(to.0));
                    let z_out = larger(R::splat(from.1) - x[2], x[2] - R::splat(to.1));
                    larger(x_out, z_out)
                }
            };
            let zero = R::splat(0.0);
            grip.rate = outside.if_below(zero, own.rate, grip.rate);
            grip.loss = outside.if_below(zero, own.loss, grip.loss);
        }
        grip
    }
}

/// The signed distance of a point from a ground, below zero inside it, and the unit vector that leads off it.
pub fn ground_distance(ground: &Ground, position: DVec3) -> (f64, DVec3) {
    match ground {
        Ground::Flat => (position.y, DVec3::Y),
        Ground::Terrain(terrain) => {
            let (distance, normal) = nearest(&rows(terrain), position.to_array());
            (distance, DVec3::from_array(normal))
        }
    }
}

/// The side grip (1 a unit of time) of a mass that stands on a ground there; `elsewhere` off all patches.
pub fn ground_grip(ground: &Ground, position: DVec3, elsewhere: f64) -> f64 {
    // Rates do not depend on the step.
    Contact::<f64, 3>::new(Some(ground), 1.0).grip(position.to_array(), Fading::splat(elsewhere, 1.0)).rate
}

fn rows(terrain: &Terrain) -> Vec<SurfaceRow> {
    let mut rows = Vec::new();
    for surface in terrain.surfaces() {
        match *surface {
            Surface::Floor { height } => rows.push(SurfaceRow::Floor { height }),
            Surface::Plane { point, normal } => {
                let normal = DVec3::from(normal).normalize();
                let offset = normal.dot(DVec3::from(point));
                rows.push(SurfaceRow::Plane { normal: normal.to_array(), offset });
            }
            Surface::Cliff { edge, radius, drop } => {
                rows.push(SurfaceRow::Cliff { edge, radius });
                rows.extend(drop.map(|drop| SurfaceRow::Floor { height: -drop }));
            }
            Surface::Hill { center, radius, height } => {
                rows.push(SurfaceRow::Hill { center: [center.0, center.1], radius, height });
            }
            Surface::Ball { center, radius } => {
                rows.push(SurfaceRow::Ball { center: [center.0, center.1, center.2], radius });
            }
        }
    }
    rows
}

/// The least distance of all, with its direction.
#[inline(always)]
fn nearest<R: Real>(surfaces: &[SurfaceRow], x: [R; 3]) -> (R, [R; 3]) {
    let mut nearest = (R::splat(f64::MAX), [R::splat(0.0); 3]);
    for surface in surfaces {
        let (distance, normal) = surface.distance(x);
        for (found, own) in nearest.1.iter_mut().zip(normal) {
            *found = distance.if_below(nearest.0, own, *found);
        }
        nearest.0 = distance.if_below(nearest.0, distance, nearest.0);
    }
    nearest
}

impl SurfaceRow {
    #[inline(always)]
    fn distance<R: Real>(&self, x: [R; 3]) -> (R, [R; 3]) {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        match *self {
            Self::Floor { height } => (x[1] - R::splat(height), [zero, one, zero]),
            Self::Plane { normal, offset } => {
                let n = normal.map(R::splat);
                (n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - R::splat(offset), n)
            }
            Self::Cliff { edge, radius } => {
                let (beyond, above) = (x[0] - R::splat(edge), x[1] + R::splat(radius));
                let from_axis = (beyond * beyond + above * above).sqrt();
                let inverse = zero.if_below(from_axis, one / from_axis, zero);
                // Upright below the round; on the round; level before it.
                let wall = (beyond - R::splat(radius), one, zero);
                let round = (from_axis - R::splat(radius), beyond * inverse, above * inverse);
                let choose =
                    |wall: R, round: R, floor: R| zero.if_below(beyond, above.if_below(zero, wall, round), floor);
                let distance = choose(wall.0, round.0, x[1]);
                (distance, [choose(wall.1, round.1, zero), choose(wall.2, round.2, one), zero])
            }
            Self::Hill { center, radius, height } => {
                let (dx, dz) = (x[0] - R::splat(center[0]), x[2] - R::splat(center[1]));
                let per_square = R::splat(1.0 / (radius * radius));
                let share = one - (dx * dx + dz * dz) * per_square;
                let share = zero.if_below(share, share, zero);
                let height = R::splat(height) * share * share;
                let slope = R::splat(-6.0) * height * per_square;
                let (slope_x, slope_z) = (slope * dx, slope * dz);
                let inverse = one / (one + slope_x * slope_x + slope_z * slope_z).sqrt();
                ((x[1] - height * share) * inverse, [-slope_x * inverse, inverse, -slope_z * inverse])
            }
            Self::Ball { center, radius } => {
                let from: [R; 3] = core::array::from_fn(|axis| x[axis] - R::splat(center[axis]));
                let distance = (from[0] * from[0] + from[1] * from[1] + from[2] * from[2]).sqrt();
                let inverse = zero.if_below(distance, one / distance, zero);
                (distance - R::splat(radius), from.map(|d| d * inverse))
            }
        }
    }
}

#[inline(always)]
fn larger<R: Real>(a: R, b: R) -> R {
    a.if_below(b, b, a)
}
