//! The four corners of a section side by side: springs of a strand are computed four at a time, in vectors where the processor has them.
//!
//! Every operation is written out: closures over arrays are left as calls where little is optimised, and the tests would crawl.

use core::ops::{Add, Mul, Sub};

use super::Real;

/// One number for each corner of a section.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quad<R>([R; 4]);

macro_rules! cornerwise {
    ($trait:ident, $method:ident, $op:tt) => {
        impl<R: Real> $trait for Quad<R> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
                Self([a $op e, b $op f, c $op g, d $op h])
            }
        }
    };
}

cornerwise!(Add, add, +);
cornerwise!(Sub, sub, -);
cornerwise!(Mul, mul, *);

impl<R: Real> Quad<R> {
    #[inline(always)]
    pub(super) fn splat(value: R) -> Self {
        Self([value; 4])
    }

    /// Four numbers in a row.
    #[inline(always)]
    pub(super) fn read(values: &[R], from: usize) -> Self {
        let row = &values[from..from + 4];
        Self([row[0], row[1], row[2], row[3]])
    }

    /// Two numbers in a row, and the same again.
    #[inline(always)]
    pub(super) fn twice(values: &[R], from: usize) -> Self {
        let row = &values[from..from + 2];
        Self([row[0], row[1], row[0], row[1]])
    }

    #[inline(always)]
    pub(super) fn write(self, values: &mut [R], to: usize) {
        values[to..to + 4].copy_from_slice(&self.0);
    }

    /// Writes one coordinate of four vectors in a row.
    #[inline(always)]
    pub(super) fn scatter(self, vectors: &mut [[R; 3]], to: usize, axis: usize) {
        for (row, value) in vectors[to..to + 4].iter_mut().zip(self.0) {
            row[axis] = value;
        }
    }

    /// At each corner what the next one has.
    #[inline(always)]
    pub(super) fn next(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([b, c, d, a])
    }

    /// At each corner what the one before has.
    #[inline(always)]
    pub(super) fn previous(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([d, a, b, c])
    }

    /// At each corner what the opposite one has.
    #[inline(always)]
    fn opposite(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([c, d, a, b])
    }

    #[inline(always)]
    pub(super) fn sqrt(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([a.sqrt(), b.sqrt(), c.sqrt(), d.sqrt()])
    }

    #[inline(always)]
    pub(super) fn sum(self) -> R {
        let [a, b, c, d] = self.0;
        (a + b) + (c + d)
    }

    /// 1 where any corner is not 0, else `otherwise`.
    #[inline(always)]
    pub(super) fn any(self, otherwise: R) -> R {
        R::splat(0.0).if_below(self.sum(), R::splat(1.0), otherwise)
    }

    #[inline(always)]
    pub(super) fn if_below(self, bound: Self, then: Self, otherwise: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, bound.0);
        let ([i, j, k, l], [m, n, o, p]) = (then.0, otherwise.0);
        Self([a.if_below(e, i, m), b.if_below(f, j, n), c.if_below(g, k, o), d.if_below(h, l, p)])
    }

    /// 1/x, and 0 where x is no more than 0.
    #[inline(always)]
    fn inverse(self) -> Self {
        let (zero, one, [a, b, c, d]) = (R::splat(0.0), R::splat(1.0), self.0);
        let inverses = Self([one / a, one / b, one / c, one / d]);
        Self::splat(zero).if_below(self, inverses, Self::splat(zero))
    }
}

/// A vector for each corner of a section.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point<R>([Quad<R>; 3]);

/// Four vectors in a row.
#[inline(always)]
pub(super) fn point<R: Real>(rows: &[[R; 3]], from: usize) -> Point<R> {
    let rows = &rows[from..from + 4];
    let coordinate = |axis: usize| Quad([rows[0][axis], rows[1][axis], rows[2][axis], rows[3][axis]]);
    Point([coordinate(0), coordinate(1), coordinate(2)])
}

impl<R: Real> Point<R> {
    #[inline(always)]
    pub(super) fn next(&self) -> Self {
        let [x, y, z] = self.0;
        Self([x.next(), y.next(), z.next()])
    }

    #[inline(always)]
    pub(super) fn opposite(&self) -> Self {
        let [x, y, z] = self.0;
        Self([x.opposite(), y.opposite(), z.opposite()])
    }

    #[inline(always)]
    fn minus(&self, other: &Self) -> [Quad<R>; 3] {
        [self.0[0] - other.0[0], self.0[1] - other.0[1], self.0[2] - other.0[2]]
    }

    /// The distances from here to there.
    #[inline(always)]
    pub(super) fn length_to(&self, to: &Self) -> Quad<R> {
        let apart = to.minus(self);
        dot(&apart, &apart).sqrt()
    }
}

#[inline(always)]
fn dot<R: Real>(a: &[Quad<R>; 3], b: &[Quad<R>; 3]) -> Quad<R> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The forces on the first ends of four springs, whose ends are at these positions and have these velocities: towards the second ends where the springs are
/// too long. `too_long` becomes 1 where one is not shorter than its longest.
#[inline(always)]
pub(super) fn spring_force<R: Real>(
    a: &(Point<R>, Point<R>),
    b: &(Point<R>, Point<R>),
    stiffness: Quad<R>,
    damping: Quad<R>,
    rest: Quad<R>,
    longest: Quad<R>,
    too_long: &mut Quad<R>,
) -> [Quad<R>; 3] {
    let apart = b.0.minus(&a.0);
    let length = dot(&apart, &apart).sqrt();
    *too_long = length.if_below(longest, *too_long, Quad::splat(R::splat(1.0)));
    let inverse = length.inverse();
    // Along the line, per length of it.
    let speed = dot(&b.1.minus(&a.1), &apart) * inverse;
    let force = (stiffness * (length - rest) + damping * speed) * inverse;
    [apart[0] * force, apart[1] * force, apart[2] * force]
}
