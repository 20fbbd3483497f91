//! Work on a contact is stored or dissipated.

use super::{Path, RADIUS, law, plain};
use crate::base::Vec3;
use crate::law::material::Material;
use crate::law::{ContactForce, ContactGeometry, ContactLaw, History};

/// All work is dissipated; no step releases energy.
pub fn a_closed_path_dissipates_its_work<L: ContactLaw>(material: &Material) {
    let law = law::<L>(material);
    for step_size in [1.0, 50.0] {
        let path = Path { step_size, ..Path::USUAL };
        let dt = path.dt();
        let (mut history, mut work, mut dashpot, mut friction) = (History::NONE, 0.0, 0.0, 0.0);
        for m in path.moments() {
            let f = m.evaluate(&law, &mut history, dt);
            let (velocity, spin) = (m.velocity + m.next.0, m.spin + m.next.1);
            work -= 0.5 * dt * (f.force.dot(&velocity) + f.moment.dot(&spin));
            let scale = 1e-9 * work.abs();
            assert!(f.dashpot >= -scale && f.friction >= -scale, "{f:?} of {work:e}");
            dashpot += f.dashpot;
            friction += f.friction;
        }
        friction += law.release(&mut history);
        let gap = work - dashpot - friction;
        assert!(dashpot > 0.0 && friction > 0.0, "{dashpot:e} {friction:e}");
        assert!(gap.abs() < 2e-3 * work, "{gap:e} of {work:e}: {dashpot:e}, {friction:e}, pace {step_size}");
    }
}

struct Led<L> {
    law: L,
    history: History,
    at: (f64, f64),
    last: ContactForce,
    work: f64,
    booked: f64,
}

impl<L: ContactLaw> Led<L> {
    fn new(law: L) -> Led<L> {
        let history = History { rate: law.initial_state(0.0), ..History::NONE };
        Led { law, history, at: (0.0, 0.0), last: ContactForce::default(), work: 0.0, booked: 0.0 }
    }

    fn go(&mut self, d: f64, s: f64) {
        let (n, dt) = (4000, 1e-3);
        let (from_d, from_s) = self.at;
        let rate = ((d - from_d) / (f64::from(n) * dt), (s - from_s) / (f64::from(n) * dt));
        for k in 1..=n {
            let part = f64::from(k) / f64::from(n);
            let overlap = from_d + (d - from_d) * part;
            let g = ContactGeometry { point: Vec3::zeros(), normal: Vec3::z(), overlap, radius: RADIUS };
            let velocity = Vec3::new(rate.1, 0.0, -rate.0);
            let f = self.law.evaluate_one(10.0, &g, &velocity, &Vec3::zeros(), &mut self.history, dt);
            // Work on the contact, trapezoidal rule.
            self.work -= 0.5 * (f.force + self.last.force).dot(&velocity) * dt;
            self.booked += f.friction + f.dashpot;
            self.last = f;
        }
        self.at = (d, s);
    }

    fn stored(&self) -> f64 {
        let (normal, tangential) = self.law.stored(self.at.0, RADIUS, &self.history);
        normal + tangential
    }
}

/// Slow cycles of compression and shear (Elata & Berryman 1996).
pub fn path_work_is_stored_or_dissipated<L: ContactLaw>(material: &Material) {
    let (high, low, s) = (2e-5, 5e-6, 2e-6);
    let cycles = [
        [(high, 0.0), (high, s), (low, s), (low, 0.0), (high, 0.0)],
        [(low, 0.0), (low, s), (high, s), (high, 0.0), (low, 0.0)],
    ];
    for (k, cycle) in cycles.iter().enumerate() {
        for (friction, restitution) in [(0.1, 1.0), (1e3, 1.0), (0.3, 0.5)] {
            let mut led = Led::new(plain::<L>(&Material { friction, ..*material }, restitution));
            for turn in 0..3 {
                let (work, booked, stored) = (led.work, led.booked, led.stored());
                let mut most = 0.0_f64;
                for &(d, s) in cycle {
                    led.go(d, s);
                    most = most.max(led.stored());
                }
                let (work, booked) = (led.work - work, led.booked - booked);
                let gap = work - booked - (led.stored() - stored);
                assert!(booked >= 0.0, "cycle {k}, {turn}: {booked:e}");
                assert!(gap.abs() < 2e-3 * booked + 1e-9 * most, "cycle {k}, {turn}: {gap:e} of {booked:e}");
            }
        }
    }
}
