//! Many steps of a body, in the widest vectors that the processor has.

use core::marker::PhantomData;

use super::{
    Model, Real, State,
    integrators::{
        DampedVerlet, ExactFlow, ExplicitEuler, ImplicitEuler, ImplicitMidpoint, Integrator, LaneByLane, Leapfrog,
        Located, Method, RungeKutta2, RungeKutta4, SemiImplicitEuler, StickRule, StormerVerlet, Xpbd,
    },
};

/// Which time each step has: t = t_base + (n − n_base)·dt with a whole number n, so that time does not drift.
#[derive(Clone, Copy, Debug, PartialEq, bevy::reflect::Reflect)]
pub struct Timeline {
    /// The step.
    pub dt: f64,
    /// n_base.
    pub base_step: u64,
    /// t_base, the time of the base step.
    pub base_time: f64,
}

impl Timeline {
    /// The time of a step, no earlier than the base step.
    #[inline(always)]
    pub fn time_at(&self, step: u64) -> f64 {
        self.base_time + (step - self.base_step) as f64 * self.dt
    }
}

/// A number of steps to take with a body, or with several side by side.
#[derive(Debug)]
pub struct Advance<'a, R, const D: usize> {
    /// The body.
    pub model: &'a mut Model<R, D>,
    /// Where it is and how it moves; moved on by the steps.
    pub state: &'a mut State<R, D>,
    /// The method.
    pub method: Method,
    /// The time of each step.
    pub timeline: Timeline,
    /// The first step to take.
    pub first: u64,
    /// How many steps to take.
    pub steps: u64,
}

impl<R: Real, const D: usize> Advance<'_, R, D> {
    /// Takes the steps. Which vectors the processor has decides how fast, and not what comes out.
    pub fn run(self) {
        if self.model.lattice.is_some()
            && let Some(rule) = self.method.kick_drift(self.model)
            && self.model.step_lattice(rule, self.state, self.steps)
        {
            return;
        }
        let located = self.model.stick == StickRule::Located && self.model.coulomb.is_none();
        match self.method {
            Method::RungeKutta2 if located => self.wide::<LaneByLane<Located<RungeKutta2<f64, D>, D>, R, D>>(),
            Method::RungeKutta4 if located => self.wide::<LaneByLane<Located<RungeKutta4<f64, D>, D>, R, D>>(),
            Method::SemiImplicitEuler => self.wide::<SemiImplicitEuler<R, D>>(),
            Method::ExplicitEuler => self.wide::<ExplicitEuler<R, D>>(),
            Method::StormerVerlet => self.wide::<StormerVerlet<R, D>>(),
            Method::DampedVerlet => self.wide::<DampedVerlet<R, D>>(),
            Method::RungeKutta2 => self.wide::<RungeKutta2<R, D>>(),
            Method::RungeKutta4 => self.wide::<RungeKutta4<R, D>>(),
            Method::Xpbd => self.wide::<Xpbd<R, D>>(),
            Method::Leapfrog => self.plain::<LaneByLane<Leapfrog<D>, R, D>>(),
            Method::ImplicitMidpoint => self.plain::<LaneByLane<ImplicitMidpoint<D>, R, D>>(),
            Method::ImplicitEuler => self.plain::<LaneByLane<ImplicitEuler<D>, R, D>>(),
            Method::ExactFlow => self.plain::<LaneByLane<ExactFlow, R, D>>(),
        }
    }

    /// In the widest vectors. A method at a time: one function that held them all would be compiled for minutes.
    fn wide<I: Integrator<R, D>>(self) {
        pulp::Arch::new().dispatch(Wide::<I, R, D> { advance: self, method: PhantomData });
    }

    /// As any processor can: methods that spend their time in solvers, or in scalars.
    #[inline(always)]
    fn plain<I: Integrator<R, D>>(self) {
        let mut integrator = I::new(self.state.position.len());
        for step in self.first..self.first + self.steps {
            self.model.begin_step(self.state);
            integrator.step(self.model, self.state, self.timeline.time_at(step));
        }
    }
}

/// Steps by one method, to be compiled for each kind of processor.
struct Wide<'a, I, R, const D: usize> {
    advance: Advance<'a, R, D>,
    method: PhantomData<I>,
}

impl<I: Integrator<R, D>, R: Real, const D: usize> pulp::NullaryFnOnce for Wide<'_, I, R, D> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.advance.plain::<I>();
    }
}
