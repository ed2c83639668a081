//! The dense form: every matrix written out over body and road, every sum over all particles, by the formulas as they are printed.
//!
//! It is what everything else is tested against and compared with, and far too slow for anything else.

use bevy::math::DVec3;

use crate::body::Felt;

use super::{
    SixParts,
    contacts::push,
    road::{Scan, touches},
    rules::{self, Old},
    step::SixState,
};

/// A body and its road as six matrices. Rows of the road follow those of the body.
#[derive(Clone, Debug)]
pub struct Dense {
    p: Vec<DVec3>,
    v: Vec<DVec3>,
    d: Vec<f64>,
    m: Vec<DVec3>,
    /// Row after row.
    b: Vec<bool>,
    c: Vec<bool>,
    /// The initial positions.
    rest: Vec<DVec3>,
    body: usize,
}

impl Dense {
    /// Writes out the matrices.
    pub fn new(parts: &SixParts<'_>) -> Self {
        let (state, body) = (SixState::of(parts), parts.particles.len());
        let road = parts.road.map_or(&[][..], |road| road.points());
        let all = body + road.len();
        let with = |own: &[DVec3], others: &[DVec3]| own.iter().chain(others).copied().collect::<Vec<_>>();
        let still = vec![DVec3::ZERO; road.len()];
        let mut d = parts.columns.damping().to_vec();
        d.resize(all, 0.0);
        let (mut b, mut c) = (vec![false; all * all], vec![false; all * all]);
        for (matrix, relation) in [(&mut b, parts.bonds.relation()), (&mut c, parts.collisions.relation())] {
            for (i, j, felt) in relation.pairs() {
                matrix[i * all + j] |= felt != Felt::Second;
                matrix[j * all + i] |= felt != Felt::First;
            }
        }
        (0..body).for_each(|i| c[i * all + body..(i + 1) * all].fill(true));
        Self {
            p: with(&state.position, road),
            v: with(&state.velocity, &still),
            m: with(&state.memory, &still),
            rest: with(parts.bonds.rest(), road),
            d,
            b,
            c,
            body,
        }
    }

    /// The positions of the body.
    pub fn positions(&self) -> &[DVec3] {
        &self.p[..self.body]
    }

    /// Takes one step of `dt`.
    pub fn step(&mut self, parts: &SixParts<'_>, dt: f64) {
        let all = self.p.len();
        let forces: Vec<_> = (0..all).map(|i| (self.bonds(i), self.collisions(i))).collect();
        let (own, road) = self.p.split_at(self.body);
        let touching: Vec<_> = own.iter().map(|x| road.iter().any(|there| touches(*x, *there))).collect();
        let mut reaction = vec![DVec3::ZERO; self.body];
        let mut memory = reaction.clone();
        let old =
            Old { position: own, velocity: &self.v[..self.body], memory: &self.m[..self.body], touches: &touching };
        rules::apply(parts.rules, &old, Some(&Scan(road)), &mut reaction, &mut memory);
        for (i, (bond, collision)) in forces.into_iter().enumerate() {
            let reaction = reaction.get(i).copied().unwrap_or_default();
            let (k, c) = (parts.bonds.stiffness(), parts.collisions.stiffness());
            self.v[i] = self.d[i] * self.v[i] + k * bond + c * collision + reaction;
            self.p[i] += dt * self.v[i];
        }
        self.m[..self.body].copy_from_slice(&memory);
    }

    /// Σ_j b_ij (p_j − p_i)(1 − ‖p⁰_j − p⁰_i‖²/‖p_j − p_i‖²).
    fn bonds(&self, i: usize) -> DVec3 {
        let row = &self.b[i * self.p.len()..(i + 1) * self.p.len()];
        let mut sum = DVec3::ZERO;
        for (j, bound) in row.iter().enumerate() {
            let apart = self.p[j] - self.p[i];
            let square = apart.length_squared();
            if *bound && square > 0.0 {
                sum += apart * (1.0 - (self.rest[j] - self.rest[i]).length_squared() / square);
            }
        }
        sum
    }

    /// Σ_j c_ij (p_j − p_i)·min{0, 1 − 4/‖p_j − p_i‖²}.
    fn collisions(&self, i: usize) -> DVec3 {
        let row = &self.c[i * self.p.len()..(i + 1) * self.p.len()];
        let mut sum = DVec3::ZERO;
        for (j, collides) in row.iter().enumerate() {
            if *collides && touches(self.p[i], self.p[j]) {
                let apart = self.p[j] - self.p[i];
                sum += push(apart, apart.length_squared());
            }
        }
        sum
    }
}
