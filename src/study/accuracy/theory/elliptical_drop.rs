//! An ellipse of fluid in flight whose velocity is (−A x, A y) (Monaghan 1994): dA/dt = A² (a⁴ − 1)/(a⁴ + 1) and
//! da/dt = −a A, for a drop that is round at first, of radius one.

/// Rate A and half of the axis along x, which becomes the short one; the other is 1/a.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipse {
    pub rate: f64,
    pub short: f64,
}

impl Ellipse {
    fn change(self) -> Self {
        let fourth = self.short.powi(4);
        Self {
            rate: self.rate * self.rate * (fourth - 1.0) / (fourth + 1.0),
            short: -self.short * self.rate,
        }
    }

    fn after(self, change: Self, time: f64) -> Self {
        Self {
            rate: self.rate + time * change.rate,
            short: self.short + time * change.short,
        }
    }

    /// At time `t` (s) of a drop that begins with this rate (1/s), by Runge and Kutta's method of fourth order.
    pub fn at(rate: f64, t: f64) -> Self {
        const STEPS: u32 = 1000;
        let h = t / f64::from(STEPS);
        let mut ellipse = Self { rate, short: 1.0 };
        for _ in 0..STEPS {
            let a = ellipse.change();
            let b = ellipse.after(a, h / 2.0).change();
            let c = ellipse.after(b, h / 2.0).change();
            let d = ellipse.after(c, h).change();
            for (change, share) in [(a, 6.0), (b, 3.0), (c, 3.0), (d, 6.0)] {
                ellipse = ellipse.after(change, h / share);
            }
        }
        ellipse
    }
}
