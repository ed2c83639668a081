//! Where implicit methods become the cheapest.

use crate::mechanics::integrators::Method;

use super::StiffnessStudy;

/// From which stiffness on implicit methods win.
#[derive(Clone, Debug, PartialEq)]
pub enum Crossing {
    /// At every factor that was tried; the cheapest of them at each.
    Always(Vec<Method>),
    /// From a factor on; between two that were tried it is where straight lines through the logarithms cross. The cheapest at those above.
    From(f64, Vec<Method>),
    /// At none, or not up to the largest that was tried.
    Never,
}

/// Compares the cheapest implicit method with the cheapest other one, in seconds.
pub fn crossing(study: &StiffnessStudy) -> Crossing {
    compare(study, Method::is_implicit)
}

/// Compares one implicit method with the cheapest one that is not implicit, in seconds.
pub fn crossing_of(study: &StiffnessStudy, method: Method) -> Crossing {
    compare(study, |other| other == method)
}

fn compare(study: &StiffnessStudy, these: impl Fn(Method) -> bool) -> Crossing {
    let cheapest = |i: usize, implicit: bool| {
        let scene = &study.scenes[i];
        if implicit { scene.cheapest(&these) } else { scene.cheapest(|method| !method.is_implicit()) }
    };
    // How much dearer implicit methods are, as a logarithm.
    let dearer = |i: usize| match (cheapest(i, true), cheapest(i, false)) {
        (Some((_, implicit)), Some((_, other))) => libm::log(implicit / other),
        (Some(_), None) => f64::NEG_INFINITY,
        (None, _) => f64::INFINITY,
    };
    let count = study.scenes.len();
    let first = (0..count).rev().take_while(|&i| dearer(i) < 0.0).last();
    let Some(first) = first else { return Crossing::Never };
    let mut methods: Vec<_> = (first..count).filter_map(|i| Some(cheapest(i, true)?.0)).collect();
    methods.dedup();
    if first == 0 {
        return Crossing::Always(methods);
    }
    let (before, after) = (dearer(first - 1), dearer(first));
    let [low, high] = [first - 1, first].map(|i| study.scenes[i].factor);
    let part = if before.is_finite() && after.is_finite() { before / (before - after) } else { 1.0 };
    Crossing::From(low * libm::pow(high / low, part), methods)
}
