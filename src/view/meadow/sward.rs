//! Maps of grass as it is seen from above, for the ground between the blades.

use core::f32::consts::TAU;

use bevy::{prelude::*, render::render_resource::TextureFormat};
use rand::{RngExt, SeedableRng, rngs::SmallRng};

use crate::view::maps;

/// How many lengths a map covers; it goes into a tile of the plain without a rest.
pub(super) const COVERS: f32 = 6.0;
/// The mean of each channel of the colour map, in linear light: what is painted with it is so much darker.
pub(super) const MEAN: f32 = 0.4;

/// Pixels each way.
const SIZE: usize = 512;
/// How many leaves lie over each other, and how long and wide they are in pixels.
const LEAVES: usize = 5200;
const LENGTH: [f32; 2] = [18.0, 46.0];
const WIDTH: f32 = 2.6;
/// Its bumps are drawn with this part of the difference of its heights to either side: from afar they are none, and should not be lighter there.
const FLATNESS: f32 = 0.3;
/// How dark it is between the leaves.
const DEPTH: f32 = 0.16;

/// What a pixel shows: how bright, how dry, and how high above the ground in pixels.
#[derive(Clone, Copy)]
struct Spot {
    light: f32,
    dry: f32,
    height: f32,
}

/// Colours, by which the ground's own are multiplied, and bumps.
pub(super) fn maps() -> [Image; 2] {
    let spots = grown();
    let lit = |spot: &Spot| {
        [1.0 + 0.45 * spot.dry, 1.0 + 0.12 * spot.dry, 1.0 - 0.25 * spot.dry].map(|part| spot.light * part)
    };
    // Each channel has the mean, so that the ground keeps the hue of its own colour.
    let sums = spots.iter().map(lit).fold([0.0; 3], |sums, light| core::array::from_fn(|i| sums[i] + light[i]));
    let color = maps::image([SIZE; 2], TextureFormat::Rgba8UnormSrgb, |x, y| {
        let light = lit(&spots[y * SIZE + x]);
        let [r, g, b] = core::array::from_fn(|i| light[i] * MEAN * spots.len() as f32 / sums[i]);
        [r, g, b, 1.0]
    });
    let height = |x: usize, y: usize| spots[y % SIZE * SIZE + x % SIZE].height;
    let bumps = maps::image([SIZE; 2], TextureFormat::Rgba8Unorm, |x, y| {
        let slope = [height(x + 1, y) - height(x + SIZE - 1, y), height(x, y + 1) - height(x, y + SIZE - 1)];
        let normal = Vec3::new(-FLATNESS * slope[0], -FLATNESS * slope[1], 1.0).normalize();
        (normal * 0.5 + 0.5).extend(1.0).to_array()
    });
    [color, bumps]
}

/// Leaves that grew one over the other, the later the lighter.
fn grown() -> Vec<Spot> {
    let mut random = SmallRng::seed_from_u64(11);
    let mut spots = vec![Spot { light: DEPTH, dry: 0.0, height: 0.0 }; SIZE * SIZE];
    for leaf in 0..LEAVES {
        let layer = leaf as f32 / LEAVES as f32;
        let mut at = Vec2::new(random.random(), random.random()) * SIZE as f32;
        let mut direction = random.random_range(0.0..TAU);
        let bend = random.random_range(-0.03..0.03_f32);
        let long = random.random_range(LENGTH[0]..LENGTH[1]);
        let light = (0.3 + 0.5 * layer) * random.random_range(0.75..1.25_f32);
        let dry = random.random::<f32>().powi(5);
        let steps = long as usize;
        for step in 0..steps {
            let t = step as f32 / steps as f32;
            let half = WIDTH * (1.0 - t).sqrt();
            let across = Vec2::from_angle(direction).perp();
            let reach = half.ceil() as i32;
            for side in -reach..=reach {
                let part = side as f32 / half;
                if part.abs() > 1.0 {
                    continue;
                }
                let place = (at + across * side as f32).floor().as_ivec2();
                let [x, y] = [place.x, place.y].map(|part| part.rem_euclid(SIZE as i32) as usize);
                spots[y * SIZE + x] = Spot {
                    // Lighter towards the tip, and a keel along the middle.
                    light: light * (0.7 + 0.5 * t) * (1.0 - 0.25 * (1.0 - part.abs())),
                    dry,
                    height: 2.5 * layer + 1.2 * t + 0.8 * (1.0 - part * part),
                };
            }
            at += Vec2::from_angle(direction);
            direction += bend;
        }
    }
    spots
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grass_is_as_bright_from_near_as_from_afar() {
        let [color, _] = maps();
        let data = color.data.unwrap();
        let (mut side, mut from) = (SIZE, 0);
        for _ in 0..color.texture_descriptor.mip_level_count {
            let level = &data[from..from + 4 * side * side];
            for channel in 0..3 {
                let light = |pixel: &[u8]| LinearRgba::from(Srgba::rgb_u8(pixel[channel], 0, 0)).red;
                let mean = level.chunks(4).map(light).sum::<f32>() / (side * side) as f32;
                assert!((mean / MEAN - 1.0).abs() < 0.02, "{mean} in channel {channel} at {side} pixels");
            }
            (from, side) = (from + 4 * side * side, side / 2);
        }
        assert_eq!(from, data.len());
    }

    #[test]
    fn leaves_go_on_over_the_edge_of_their_map() {
        // Neighbours across an edge differ no more than neighbours elsewhere.
        let spots = grown();
        let differ = |a: usize, b: usize| {
            let pairs = (0..SIZE).map(|y| spots[y * SIZE + a].light - spots[y * SIZE + b].light);
            pairs.map(f32::abs).sum::<f32>() / SIZE as f32
        };
        let inside = (0..16).map(|i| differ(17 + 29 * i, 18 + 29 * i)).sum::<f32>() / 16.0;
        let across = differ(SIZE - 1, 0);
        assert!(across < 1.3 * inside, "{across} at the edge, {inside} elsewhere");
    }
}
