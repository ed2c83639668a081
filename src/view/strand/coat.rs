//! Colour maps and bump maps of animals, made in code.
//!
//! A map is a tile: once around the body (u from 0 in the middle of the belly over ½ on the back) and [`TILE`] segments along it (v).

use bevy::{prelude::*, render::render_resource::TextureFormat};

use crate::view::{
    clay::{Tint, blend, shade, tint},
    maps,
};

/// How many segments a map covers.
pub(super) const TILE: f32 = 2.0;
/// Pixels of a map around and along.
const SIZE: [usize; 2] = [512, 256];
/// How far around an animal is, in segments: what heights are compared with.
const AROUND: f32 = 3.1;

/// A pattern: colour and height by u and v.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Coat {
    /// Rings and wrinkles.
    Worm,
    /// Scales with dark saddles.
    Snake,
    /// Scales with pale saddles on sand.
    Sidewinder,
    /// Thick segments, banded.
    Caterpillar,
}

impl Coat {
    /// Its colour map and its bump map.
    pub fn maps(self) -> [Image; 2] {
        let place = |x: usize, y: usize| (x as f32 / SIZE[0] as f32, y as f32 / SIZE[1] as f32 * TILE);
        let color = maps::image(SIZE, TextureFormat::Rgba8UnormSrgb, |x, y| {
            let (u, v) = place(x, y);
            let [r, g, b, _] = self.color(u, v);
            [r, g, b, 1.0]
        });
        let bumps = maps::image(SIZE, TextureFormat::Rgba8Unorm, |x, y| {
            let (u, v) = place(x, y);
            let step = 0.5 / SIZE[0] as f32;
            let slope = |du: f32, dv: f32| self.height(u + du, v + dv) - self.height(u - du, v - dv);
            let normal = Vec3::new(-slope(step, 0.0) / (2.0 * step * AROUND), -slope(0.0, step) / (2.0 * step), 1.0);
            ((normal.normalize() * 0.5) + 0.5).extend(1.0).to_array()
        });
        [color, bumps]
    }

    fn color(self, u: f32, v: f32) -> Tint {
        // 0 on the back, 1 on the belly.
        let down = (2.0 * (u.rem_euclid(1.0) - 0.5)).abs();
        match self {
            Self::Worm => {
                let side = blend(tint(0xb8606c), tint(0xe0938f), smooth(0.0, 0.7, down));
                let skin = blend(side, tint(0xf4c9b6), smooth(0.65, 1.0, down));
                let groove = smooth(0.72, 1.0, (core::f32::consts::PI * 4.0 * v).cos().abs());
                shade(skin, 1.0 - 0.34 * groove)
            }
            Self::Snake => saddles(u, v, down, [0xa98245, 0x4a321b, 0xead7a0, 0xf3e7c6]),
            Self::Sidewinder => saddles(u, v, down, [0xdcbf92, 0xab8457, 0xf2e2bf, 0xf7ecd6]),
            Self::Caterpillar => {
                let at = v.rem_euclid(1.0);
                let skin = blend(tint(0x9bcb3c), tint(0xd6ea9a), smooth(0.6, 1.0, down));
                let band = smooth(0.2, 0.12, (at - 0.5).abs()) * smooth(0.78, 0.66, down);
                let banded = blend(skin, tint(0x20301a), band);
                // A yellow spot on the band, on either side.
                let spot = ((down - 0.42) * 1.55).hypot(at - 0.5);
                let spotted = blend(banded, tint(0xf8c81e), smooth(0.13, 0.09, spot));
                let stripe = smooth(0.09, 0.05, down) * 0.55;
                shade(blend(spotted, tint(0x3f7a1e), stripe), 1.0 - 0.35 * smooth(0.1, 0.0, at.min(1.0 - at)))
            }
        }
    }

    /// In segments.
    fn height(self, u: f32, v: f32) -> f32 {
        let down = (2.0 * (u.rem_euclid(1.0) - 0.5)).abs();
        match self {
            Self::Worm => {
                let ring = (core::f32::consts::PI * 4.0 * v).sin().abs().sqrt();
                let (u, v) = (core::f32::consts::TAU * u, core::f32::consts::TAU * v);
                let wrinkle = (10.0 * v + 3.0 * (2.0 * u).sin()).sin() * (4.0 * u + 5.0 * v.sin()).sin();
                0.045 * ring + 0.004 * wrinkle
            }
            Self::Snake | Self::Sidewinder => {
                let scutes = 0.03 * (core::f32::consts::TAU * 4.0 * v).sin().abs().sqrt();
                let belly = smooth(0.78, 0.86, down);
                scale(u, v) * (1.0 - belly) + scutes * belly
            }
            Self::Caterpillar => {
                let at = v.rem_euclid(1.0);
                let fold = 0.012 * smooth(0.09, 0.0, (at - 0.33).abs()) + 0.012 * smooth(0.09, 0.0, (at - 0.67).abs());
                0.1 * (core::f32::consts::PI * at).sin().sqrt() - fold
            }
        }
    }
}

/// How many scales there are around; along, as many in a tile.
const SCALES: f32 = 30.0;

/// A scale of the diamond lattice, as a dome that rises towards the tail, with a keel.
fn scale(u: f32, v: f32) -> f32 {
    let (a, b) = (u * SCALES, v / TILE * SCALES);
    let (x, y) = ((a + b).rem_euclid(1.0) - 0.5, (a - b).rem_euclid(1.0) - 0.5);
    let dome = (1.0 - 4.0 * x * x).max(0.0) * (1.0 - 4.0 * y * y).max(0.0);
    let keel = smooth(0.12, 0.0, (x + y).abs());
    0.035 * dome.sqrt() + 0.008 * keel * dome + 0.008 * (y - x)
}

/// Dark saddles with pale edges over the back, spots between them on the sides, a pale belly; `colors` has ground, saddle, edge, belly.
fn saddles(u: f32, v: f32, down: f32, colors: [u32; 4]) -> Tint {
    let [ground, saddle, edge, belly] = colors.map(tint);
    let at = (v / TILE).rem_euclid(1.0) - 0.5;
    let inside = at.abs() / 0.34 + down / 0.62;
    let side = ((at.abs() - 0.5) / 0.12).hypot((down - 0.6) / 0.13);
    let mut color = blend(ground, edge, smooth(1.22, 1.1, inside) * smooth(0.86, 0.98, inside));
    color = blend(color, saddle, smooth(1.02, 0.94, inside));
    color = blend(color, shade(saddle, 1.25), smooth(1.0, 0.8, side));
    // Seams between scales are darker.
    color = shade(color, 0.74 + 0.26 * (scale(u, v) / 0.03).clamp(0.0, 1.0));
    let scute = 0.82 + 0.18 * (core::f32::consts::TAU * 4.0 * v).sin().abs().sqrt();
    blend(color, shade(belly, scute), smooth(0.76, 0.86, down))
}

/// 0 below `from`, 1 above `to`, smooth between; the other way round where `from` is above `to`.
fn smooth(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Coat; 4] = [Coat::Worm, Coat::Snake, Coat::Sidewinder, Coat::Caterpillar];

    #[test]
    fn maps_close_around_the_body_and_along_it() {
        for coat in ALL {
            for i in 0..50 {
                let (u, v) = (i as f32 / 50.0, TILE * (i * 7 % 50) as f32 / 50.0);
                for (far, near) in [
                    (coat.height(u + 1.0, v), coat.height(u, v)),
                    (coat.height(u, v + TILE), coat.height(u, v)),
                    (coat.color(u, v + TILE)[0], coat.color(u, v)[0]),
                ] {
                    assert!((far - near).abs() < 2e-3, "{coat:?} at {u}, {v}: {far} and {near}");
                }
            }
        }
    }

    #[test]
    fn a_bump_map_is_made_of_unit_normals_that_point_out() {
        for coat in ALL {
            let [_, bumps] = coat.maps();
            let data = bumps.data.unwrap();
            let (mut tilted, mut count) = (0, 0);
            for pixel in data[..4 * SIZE[0] * SIZE[1]].chunks(4) {
                let normal = Vec3::from([0, 1, 2].map(|i| f32::from(pixel[i]) / 127.5 - 1.0));
                assert!((normal.length() - 1.0).abs() < 0.02 && normal.z > 0.0, "{coat:?}: {normal}");
                (tilted, count) = (tilted + usize::from(normal.z < 0.98), count + 1);
            }
            assert!(tilted * 10 > count, "{coat:?} has bumps: {tilted} of {count}");
        }
    }
}
