//! Numbers on which the mechanics is written: one `f64`, or several side by side.

use core::{
    fmt::Debug,
    ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign},
};

/// An `f64`, or several that go through the same operations side by side.
///
/// Each operation rounds each lane exactly as `f64` does, and none is fused with another, so the bits of a lane are those of the same
/// computation on an `f64`, on every processor.
pub trait Real:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// How many numbers there are.
    const LANES: usize;

    /// Every lane the same.
    fn splat(value: f64) -> Self;

    /// The number in one lane.
    fn lane(&self, lane: usize) -> f64;

    /// Writes the number in one lane.
    fn set_lane(&mut self, lane: usize, value: f64);

    /// The square root of every lane.
    fn sqrt(self) -> Self;

    /// The absolute value of every lane.
    fn abs(self) -> Self;

    /// In every lane where `self < bound`, `then`; elsewhere, and where either is NaN, `otherwise`.
    fn if_below(self, bound: Self, then: Self, otherwise: Self) -> Self;

    /// Whether any lane is below `bound`: for leaving out work whose result no lane would take.
    fn any_below(self, bound: Self) -> bool;

    /// Numbers that stand alone as what they are; nothing of several side by side.
    fn alone(values: &[Self]) -> Option<&[f64]>;

    /// The same, to be changed.
    fn alone_mut(values: &mut [Self]) -> Option<&mut [f64]>;
}

impl Real for f64 {
    const LANES: usize = 1;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn lane(&self, _: usize) -> f64 {
        *self
    }

    #[inline(always)]
    fn set_lane(&mut self, _: usize, value: f64) {
        *self = value;
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }

    #[inline(always)]
    fn if_below(self, bound: Self, then: Self, otherwise: Self) -> Self {
        if self < bound { then } else { otherwise }
    }

    #[inline(always)]
    fn any_below(self, bound: Self) -> bool {
        self < bound
    }

    fn alone(values: &[Self]) -> Option<&[f64]> {
        Some(values)
    }

    fn alone_mut(values: &mut [Self]) -> Option<&mut [f64]> {
        Some(values)
    }
}

/// `W` numbers side by side. Plain arrays: the compiler turns whole-array operations into the widest vectors of the processor that the code
/// runs on, and no two processors differ in bits.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lanes<const W: usize>([f64; W]);

impl<const W: usize> Lanes<W> {
    /// The first of them, or all of them and zeros behind.
    #[inline(always)]
    pub(super) fn resized<const N: usize>(self) -> Lanes<N> {
        let (mut out, kept) = ([0.0; N], W.min(N));
        out[..kept].copy_from_slice(&self.0[..kept]);
        Lanes(out)
    }
}

impl<const W: usize> From<[f64; W]> for Lanes<W> {
    #[inline(always)]
    fn from(values: [f64; W]) -> Self {
        Self(values)
    }
}

impl<const W: usize> From<Lanes<W>> for [f64; W] {
    #[inline(always)]
    fn from(lanes: Lanes<W>) -> Self {
        lanes.0
    }
}

macro_rules! lanewise {
    ($trait:ident, $method:ident, $assign_trait:ident, $assign_method:ident, $op:tt) => {
        lanewise!($trait, $method, $op);
        impl<const W: usize> $assign_trait for Lanes<W> {
            #[inline(always)]
            fn $assign_method(&mut self, other: Self) {
                *self = *self $op other;
            }
        }
    };
    ($trait:ident, $method:ident, $op:tt) => {
        impl<const W: usize> $trait for Lanes<W> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let mut out = self;
                for lane in 0..W {
                    out.0[lane] = self.0[lane] $op other.0[lane];
                }
                out
            }
        }
    };
}

lanewise!(Add, add, AddAssign, add_assign, +);
lanewise!(Sub, sub, SubAssign, sub_assign, -);
lanewise!(Mul, mul, *);
lanewise!(Div, div, /);

impl<const W: usize> Neg for Lanes<W> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let mut out = self;
        for lane in 0..W {
            out.0[lane] = -self.0[lane];
        }
        out
    }
}

impl<const W: usize> Real for Lanes<W> {
    const LANES: usize = W;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; W])
    }

    #[inline(always)]
    fn lane(&self, lane: usize) -> f64 {
        self.0[lane]
    }

    #[inline(always)]
    fn set_lane(&mut self, lane: usize, value: f64) {
        self.0[lane] = value;
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let mut out = self;
        for lane in 0..W {
            out.0[lane] = self.0[lane].sqrt();
        }
        out
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let mut out = self;
        for lane in 0..W {
            out.0[lane] = self.0[lane].abs();
        }
        out
    }

    #[inline(always)]
    fn if_below(self, bound: Self, then: Self, otherwise: Self) -> Self {
        let mut out = otherwise;
        for lane in 0..W {
            out.0[lane] = if self.0[lane] < bound.0[lane] { then.0[lane] } else { otherwise.0[lane] };
        }
        out
    }

    #[inline(always)]
    fn any_below(self, bound: Self) -> bool {
        self.0.iter().zip(&bound.0).any(|(value, bound)| value < bound)
    }

    fn alone(_: &[Self]) -> Option<&[f64]> {
        None
    }

    fn alone_mut(_: &mut [Self]) -> Option<&mut [f64]> {
        None
    }
}
