//! The largest stable step of each method in a problem: the edges that a chart draws, and from which its steps go down.

use bevy::tasks::TaskPool;

use crate::{
    lab::{Edge, Problem, ProblemBody},
    mechanics::integrators::{Method, StickRule},
};

use super::{alike, predicted_limit};

/// The edge of every method for the body that it is the smallest for, without friction, contact and gravity and with muscles at rest: predicted from
/// the eigenvalues of the linearised bodies, or where those of a body cannot be had, the cheap bound of the gauge, which is never above the edge. Each body and
/// method is looked at on a thread of its own.
pub fn edges(problem: &Problem) -> Vec<Edge> {
    let bodies = alike::distinct(problem.bodies.clone());
    let all = TaskPool::new().scope(|scope| {
        for (method, body) in Method::ALL.into_iter().flat_map(|method| bodies.iter().map(move |body| (method, body))) {
            scope.spawn(async move { edge(body, method) });
        }
    });
    let none = |method| Edge { method, dt: f64::INFINITY, predicted: true };
    let of = |method| all.iter().filter(move |edge| edge.method == method).copied();
    let smallest = |method| of(method).reduce(|a, b| if b.dt < a.dt { b } else { a });
    Method::ALL.map(|method| smallest(method).unwrap_or(none(method))).into()
}

fn edge(body: &ProblemBody, method: Method) -> Edge {
    let parts = body.parts(method, StickRule::InStages);
    match predicted_limit(&parts) {
        Some(dt) => Edge { method, dt, predicted: true },
        None => Edge { method, dt: parts.stability_limit(0.0), predicted: false },
    }
}
