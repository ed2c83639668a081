//! How well sections follow a path.

use std::collections::VecDeque;

use bevy::math::DVec2;

/// How many points a piece of a path has at most; the last is also the first of the next piece.
const PIECE: usize = 51;

/// A path that grows at its end and is forgotten from its start on. It is kept in pieces with the boxes round them: of most pieces it is enough to know that
/// they are far away.
#[derive(Clone, Debug)]
pub(super) struct Path {
    pieces: VecDeque<Piece>,
    /// How many pieces are kept.
    most: usize,
}

#[derive(Clone, Debug)]
struct Piece {
    points: Vec<DVec2>,
    least: DVec2,
    most: DVec2,
}

impl Path {
    /// An empty path of which at least the last `points` are kept.
    pub(super) fn new(points: usize) -> Self {
        Self { pieces: VecDeque::new(), most: points.div_ceil(PIECE - 1) + 1 }
    }

    /// Goes on to a point.
    pub(super) fn push(&mut self, point: DVec2) {
        let full = self.pieces.back().filter(|piece| piece.points.len() == PIECE);
        if self.pieces.is_empty() || full.is_some() {
            let joint = full.and_then(|piece| piece.points.last().copied());
            self.pieces.push_back(Piece::at(joint.unwrap_or(point)));
            if joint.is_none() {
                return;
            }
        }
        if let Some(piece) = self.pieces.back_mut() {
            piece.push(point);
        }
        if self.pieces.len() > self.most {
            self.pieces.pop_front();
        }
    }

    /// The distance of a point from what is kept of the path; infinite where there is none.
    pub(super) fn distance(&self, point: DVec2) -> f64 {
        // What was passed last is mostly near, and spares the rest.
        let square = self.pieces.iter().rev().fold(f64::INFINITY, |nearest, piece| {
            if piece.gap_squared(point) < nearest { nearest.min(piece.distance_squared(point)) } else { nearest }
        });
        square.sqrt()
    }
}

impl Piece {
    fn at(point: DVec2) -> Self {
        Self { points: vec![point], least: point, most: point }
    }

    fn push(&mut self, point: DVec2) {
        self.points.push(point);
        (self.least, self.most) = (self.least.min(point), self.most.max(point));
    }

    /// The squared distance of a point from the box: no more than that from the piece.
    fn gap_squared(&self, point: DVec2) -> f64 {
        (self.least - point).max(point - self.most).max(DVec2::ZERO).length_squared()
    }

    fn distance_squared(&self, point: DVec2) -> f64 {
        let alone = self.points[0].distance_squared(point);
        let squares = self.points.windows(2).map(|piece| {
            let [from, to] = [piece[0], piece[1]];
            let along = to - from;
            let length = along.length_squared();
            let part = if length > 0.0 { ((point - from).dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
            (from + along * part).distance_squared(point)
        });
        squares.fold(alone, f64::min)
    }
}
