//! The way that a creature has come.

use bevy::{math::DVec3, prelude::*};

use super::speck;
use crate::{
    creatures::SixSkin,
    view::clay::{Clay, tint},
};

/// A thin line through the points, which must not leave the picture's world.
pub(super) fn shape(points: &[DVec3], skin: SixSkin) -> Mesh {
    const FAR: f64 = 1e4;
    let points: Vec<_> = points.iter().take_while(|x| x.abs().max_element() < FAR).map(|x| x.as_vec3()).collect();
    let mut line: Vec<Vec3> = Vec::with_capacity(points.len());
    for point in points {
        if line.last().is_none_or(|last| last.distance(point) > 0.15) {
            line.push(point);
        }
    }
    if line.len() < 3 {
        return speck();
    }
    let color = match skin {
        SixSkin::Organic => tint(0xf4d35e),
        SixSkin::Mechanical => tint(0x4cc9f0),
        SixSkin::Plain => tint(0xffffff),
    };
    let mut clay = Clay::default();
    clay.tube(&line, 6, |_| 0.12, |_| color);
    clay.fire()
}
