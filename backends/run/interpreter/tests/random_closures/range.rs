//! A float that devices compute with errors: the least and the greatest number that an accurate device may return.
//!
//! Devices may replace numbers nearer to 0 than 1.2e-38 by 0, ignore the sign of 0, fuse operations, and are never asked for
//! infinities or NaN: where a result depends on any of these, it is undefined and nothing is compared.

/// The reason why a closure has no result that can be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Undefined {
    /// Accurate devices may return different results.
    Open(&'static str),
    /// The closure has something that the evaluator does not have: a defect of the evaluator or of the generator.
    Gap(&'static str),
}

/// One rounding of WGSL's correctly rounded operations, in either direction.
pub const ROUNDED: f64 = 1.0 / 8_388_608.0;

/// The limits of a float, both inclusive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub lo: f64,
    pub hi: f64,
    /// The greatest absolute value in the sum that the float results from: devices may regroup it.
    scale: f64,
}

const TINY: f64 = f32::MIN_POSITIVE as f64;
const GREATEST: f64 = f32::MAX as f64;

/// Returns whether an `f32` has exactly this value on every device.
fn is_exact(value: f64) -> bool {
    f64::from(value as f32) == value && (value == 0.0 || value.abs() >= TINY) && value.abs() <= GREATEST
}

impl Range {
    /// Returns the range between two values.
    pub fn between(lo: f64, hi: f64) -> Range {
        Range { lo, hi, scale: lo.abs().max(hi.abs()) }
    }

    /// Returns an exact value, or the values around a number that devices may replace by 0.
    pub fn of(value: f32) -> Range {
        let value = f64::from(value);
        match is_exact(value) {
            true => Range::between(value, value),
            false => Range::between(value.min(0.0), value.max(0.0)),
        }
    }

    /// Returns the results of an operation with a relative and an absolute error.
    pub fn with_errors(lo: f64, hi: f64, relative: f64, absolute: f64) -> Result<Range, Undefined> {
        let lo = lo - lo.abs() * relative - absolute - TINY;
        let hi = hi + hi.abs() * relative + absolute + TINY;
        if lo.is_nan() || hi.is_nan() || lo < -GREATEST || hi > GREATEST {
            return Err(Undefined::Open("not a finite number"));
        }
        Ok(Range::between(lo, hi))
    }

    /// Returns the results of a correctly rounded operation; `exact` is whether the limits have no error of their own.
    pub fn rounded(lo: f64, hi: f64, exact: bool) -> Result<Range, Undefined> {
        match exact && lo == hi && is_exact(lo) {
            true => Ok(Range::between(lo, hi)),
            false => Range::with_errors(lo, hi, ROUNDED, 0.0),
        }
    }

    /// Returns the value if every device has the same.
    pub fn exact(self) -> Option<f64> {
        (self.lo == self.hi).then_some(self.lo)
    }

    /// Returns the greatest absolute value in the sum that the float results from.
    pub fn scale(self) -> f64 {
        self.scale
    }

    pub fn contains(self, value: f32) -> bool {
        let value = f64::from(value);
        self.lo - TINY <= value && value <= self.hi + TINY
    }

    pub fn negate(self) -> Range {
        Range { lo: -self.hi, hi: -self.lo, scale: self.scale }
    }

    pub fn add(self, other: Range) -> Result<Range, Undefined> {
        let (lo, hi) = (self.lo + other.lo, self.hi + other.hi);
        let exact = self.is_small() && other.is_small();
        let scale = self.scale.max(other.scale);
        let sum = match scale > 16.0 * lo.abs().max(hi.abs()) {
            true => Range::with_errors(lo, hi, ROUNDED, 4.0 * ROUNDED * scale)?,
            false => Range::rounded(lo, hi, exact)?,
        };
        Ok(Range { scale: scale.max(sum.scale), ..sum })
    }

    pub fn subtract(self, other: Range) -> Result<Range, Undefined> {
        self.add(other.negate())
    }

    /// Multiplies. Devices may regroup products, so the factors must be far from the limits of the type.
    pub fn multiply(self, other: Range) -> Result<Range, Undefined> {
        self.moderate()?;
        other.moderate()?;
        let (lo, hi) = corners(self, other, |x, y| x * y);
        let product = Range::rounded(lo, hi, true)?;
        let scale = (self.scale * other.abs().hi).max(other.scale * self.abs().hi);
        Ok(Range { scale: scale.max(product.scale), ..product })
    }

    /// Divides within 2.5 ULP, as WGSL does.
    pub fn divide(self, other: Range) -> Result<Range, Undefined> {
        self.moderate()?;
        other.moderate()?;
        if other.lo <= 0.0 && other.hi >= 0.0 {
            return Err(Undefined::Open("a division by a number that may be zero"));
        }
        let (lo, hi) = corners(self, other, |x, y| x / y);
        Range::with_errors(lo, hi, 3.0 * ROUNDED, 0.0)
    }

    /// Returns whether sums of such numbers are exact however devices group them.
    fn is_small(self) -> bool {
        self.exact().is_some_and(|value| value.abs() <= 4096.0 && (value * 1024.0).fract() == 0.0)
    }

    fn moderate(self) -> Result<(), Undefined> {
        let size = self.abs();
        if size.hi > 1e10 || (size.lo > 0.0 && size.lo < 1e-10) {
            return Err(Undefined::Open("a factor near the limits of the type"));
        }
        Ok(())
    }

    /// Returns `self % other`, if no rounding of the quotient changes its whole part.
    pub fn remainder(self, other: Range) -> Result<Range, Undefined> {
        let quotient = self.divide(other)?;
        let whole = quotient.lo.trunc();
        if whole != quotient.hi.trunc() || whole.abs() > 1e6 {
            return Err(Undefined::Open("the quotient of a remainder is near a whole number"));
        }
        let product = other.multiply(Range::between(whole, whole))?;
        let error = 4.0 * ROUNDED * self.lo.abs().max(self.hi.abs());
        Range::with_errors(self.lo - product.hi, self.hi - product.lo, ROUNDED, error)
    }

    /// Applies a function that never decreases, with the errors of a device.
    pub fn rising(self, function: fn(f64) -> f64, relative: f64, absolute: f64) -> Result<Range, Undefined> {
        Range::with_errors(function(self.lo), function(self.hi), relative, absolute)
    }

    /// Applies a function that never decreases and whose results are whole numbers.
    pub fn whole(self, function: fn(f64) -> f64) -> Range {
        Range::between(function(self.lo), function(self.hi))
    }

    pub fn abs(self) -> Range {
        match (self.lo >= 0.0, self.hi <= 0.0) {
            (true, _) => self,
            (_, true) => self.negate(),
            _ => Range { lo: 0.0, hi: self.hi.max(-self.lo), scale: self.scale },
        }
    }

    pub fn min(self, other: Range) -> Range {
        Range::between(self.lo.min(other.lo), self.hi.min(other.hi))
    }

    pub fn max(self, other: Range) -> Range {
        Range::between(self.lo.max(other.lo), self.hi.max(other.hi))
    }

    /// Returns the range that contains both.
    pub fn hull(self, other: Range) -> Range {
        Range::between(self.lo.min(other.lo), self.hi.max(other.hi))
    }

    /// Returns the sign, unless devices may have either.
    pub fn sign(self) -> Result<f64, Undefined> {
        match (self.lo > 0.0, self.hi < 0.0) {
            (true, _) => Ok(1.0),
            (_, true) => Ok(-1.0),
            _ => Err(Undefined::Open("the sign of a number near 0")),
        }
    }

    /// Requires that all values are in these limits.
    pub fn within(self, lo: f64, hi: f64) -> Result<Range, Undefined> {
        if self.lo >= lo && self.hi <= hi {
            Ok(self)
        } else {
            Err(Undefined::Open("an argument outside of the method's domain"))
        }
    }

    /// Compares, unless devices may have either result.
    pub fn compare(self, other: Range) -> Result<std::cmp::Ordering, Undefined> {
        use std::cmp::Ordering;
        match (self.exact(), other.exact()) {
            (Some(left), Some(right)) if left == right => Ok(Ordering::Equal),
            _ if self.hi < other.lo => Ok(Ordering::Less),
            _ if self.lo > other.hi => Ok(Ordering::Greater),
            _ => Err(Undefined::Open("a comparison of floats that may be equal")),
        }
    }
}

/// Returns the least and the greatest result for the ends of two ranges.
fn corners(left: Range, right: Range, function: fn(f64, f64) -> f64) -> (f64, f64) {
    let all = [(left.lo, right.lo), (left.lo, right.hi), (left.hi, right.lo), (left.hi, right.hi)];
    let results = all.map(|(x, y)| function(x, y));
    (results.into_iter().fold(f64::INFINITY, f64::min), results.into_iter().fold(f64::NEG_INFINITY, f64::max))
}
