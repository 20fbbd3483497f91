//! Settlement laws fitted to the settlement per load cycle, by least squares. Theory manual: eqs. (6.17) to
//! (6.23), (6.40), (6.41).
//!
//! Alva-Hurtado & Selig, 10th ICSMFE, Stockholm 1981; ORE D71, 1970; Hettler 1984; Selig & Waters 1994;
//! Indraratna et al. 1997–2010; Shenton 1985; Sato 1995; Guérin 1996; Thom & Oakley, Proc. ICE Transport 159,
//! 2006; after the review of Dahlberg, Proc. IMechE F 215, 2001.
//!
//! Standard errors of parameters allow for the correlation of neighbouring residuals, ρ between successive
//! cycles: factor √((1 + ρ)/(1 − ρ)) (G. V. Bayley and J. M. Hammersley, Suppl. J. R. Stat. Soc. 8, 1946).

use serde::Serialize;

/// First cycle of fits; earlier ones seat the sleeper.
pub const FIRST: f64 = 10.0;
/// Smallest number of cycles from [`FIRST`] on; with fewer, fits begin at [`EARLY`].
pub const FEWEST: usize = 10;
/// First cycle of short runs.
pub const EARLY: f64 = 2.0;
/// Decimal logarithm of the first cycle of laws for the time after bedding (Thom & Oakley).
const BEDDED: f64 = 2.4;
/// Points beyond the number of parameters.
const SPARE: usize = 2;

/// Fitted law.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fit {
    /// Name.
    pub law: &'static str,
    /// s(N).
    pub form: &'static str,
    /// Names and values of the parameters; settlements [m].
    pub parameters: Vec<(&'static str, f64)>,
    /// Coefficient of determination.
    pub r2: f64,
    /// Standard errors of the parameters; empty if undetermined.
    pub standard_errors: Vec<f64>,
    /// Root-mean-square residual [m].
    pub rms_error: f64,
    /// First and last cycle.
    pub range: [f64; 2],
    /// Number of cycles.
    pub points: usize,
}

impl Fit {
    /// Parameter by name.
    pub fn parameter(&self, name: &str) -> Option<f64> {
        self.parameters.iter().find(|p| p.0 == name).map(|p| p.1)
    }
}

/// Settlement after N cycles [m] by a law with its parameters in the order of [`Fit::parameters`].
pub fn settlement_after(law: &str, parameters: &[f64], n: f64) -> Option<f64> {
    let log = libm::log10(n);
    let value = match (law, parameters) {
        ("Alva-Hurtado & Selig", [s1, c]) => s1 * (1.0 + c * log),
        ("ORE D71", [s1]) => s1 * (1.0 + 0.2 * log),
        ("Indraratna", [s1, a, b]) => s1 * (1.0 + a * log + 0.5 * b * log * log),
        ("power", [a, b]) => a * libm::pow(n, *b),
        ("Shenton", [a, b]) => a * libm::pow(n, 0.2) + b * n,
        ("Guérin, Dahlberg", [a, b]) => a + b * n,
        ("Thom & Oakley", [s0, c]) => s0 + c * (log - BEDDED).powi(2),
        ("Sato", [gamma, alpha, beta]) => -gamma * libm::expm1(-alpha * n) + beta * n,
        _ => return None,
    };
    value.is_finite().then_some(value)
}

/// Fits all laws to settlements [m] from [`FIRST`] on, in short runs from [`EARLY`] on; `load` is the largest
/// load [N].
///
/// Laws with too many parameters for the cycles are left out.
pub fn fits(cycles: &[[f64; 2]], load: f64) -> Vec<Fit> {
    let from = |first: f64| -> Vec<[f64; 2]> { cycles.iter().copied().filter(|c| c[0] >= first).collect() };
    let late = from(FIRST);
    let used = if late.len() >= FEWEST { late } else { from(EARLY) };
    let mean = used.iter().map(|c| c[1]).sum::<f64>() / used.len().max(1) as f64;
    let spread = used.iter().map(|c| (c[1] - mean).powi(2)).sum::<f64>();
    // Rounding only.
    if used.len() <= SPARE || spread <= 1e-24 * used.len() as f64 * mean * mean || !spread.is_finite() {
        return Vec::new();
    }
    let data = Data { used: &used, spread };
    let (one, log): (Term, Term) = (&|_| 1.0, &|n| libm::log10(n));
    let mut out = Vec::new();
    if let Some((c, rest)) = data.linear(&[one, log]) {
        let form = "s1 (1 + C log10 N)";
        let fit = data.fit("Alva-Hurtado & Selig", form, vec![("s1", c[0]), ("C", c[1] / c[0])], rest);
        let hettler = hettler(&fit, load);
        out.extend([fit, hettler]);
    }
    if let Some((c, rest)) = data.linear(&[&|n| 1.0 + 0.2 * libm::log10(n)]) {
        out.push(data.fit("ORE D71", "s1 (1 + 0.2 log10 N)", vec![("s1", c[0])], rest));
    }
    if let Some((c, rest)) = data.linear(&[one, log, &|n| libm::log10(n).powi(2)]) {
        let form = "s1 (1 + a log10 N + b/2 (log10 N)^2)";
        let parameters = vec![("s1", c[0]), ("a", c[1] / c[0]), ("b", 2.0 * c[2] / c[0])];
        out.push(data.fit("Indraratna", form, parameters, rest));
    }
    if let Some((b, c, rest)) = search(-4.0, 2.0, |b| data.linear(&[&|n| libm::pow(n, b)])) {
        out.push(data.fit("power", "a N^b", vec![("a", c[0]), ("b", b)], rest));
    }
    if let Some((c, rest)) = data.linear(&[&|n| libm::pow(n, 0.2), &|n| n]) {
        out.push(data.fit("Shenton", "a N^0.2 + b N", vec![("a", c[0]), ("b", c[1])], rest));
    }
    // Range in which the exponential is neither linear nor constant.
    let range = [libm::log(0.05 / used[used.len() - 1][0]), libm::log(5.0 / used[0][0])];
    let sato = |ln: f64| data.linear(&[&|n| -libm::expm1(-libm::exp(ln) * n), &|n| n]);
    if let Some((ln, c, rest)) = search(range[0], range[1], sato) {
        let parameters = vec![("gamma", c[0]), ("alpha", libm::exp(ln)), ("beta", c[1])];
        out.push(data.fit("Sato", "gamma (1 - exp(-alpha N)) + beta N", parameters, rest));
    }
    let bedded = from(libm::pow(10.0, BEDDED));
    let mean = bedded.iter().map(|c| c[1]).sum::<f64>() / bedded.len().max(1) as f64;
    let spread = bedded.iter().map(|c| (c[1] - mean).powi(2)).sum::<f64>();
    let data = Data { used: &bedded, spread };
    // Rates that depend on load and deflection only.
    if let Some((c, rest)) = data.linear(&[one, &|n| n]).filter(|_| bedded.len() >= FEWEST) {
        out.push(data.fit("Guérin, Dahlberg", "a + b N", vec![("a", c[0]), ("b", c[1])], rest));
    }
    let square: Term = &|n| (libm::log10(n) - BEDDED).powi(2);
    if let Some((c, rest)) = data.linear(&[one, square]).filter(|_| bedded.len() >= FEWEST) {
        let form = "s0 + c (log10 N - 2.4)^2";
        out.push(data.fit("Thom & Oakley", form, vec![("s0", c[0]), ("c", c[1])], rest));
    }
    out.retain(|f| f.points >= f.parameters.len() + SPARE && f.parameters.iter().all(|p| p.1.is_finite()));
    out
}

/// Hettler's parameters of a fit by Alva-Hurtado & Selig: mm per kN^1.6, natural logarithm.
fn hettler(fit: &Fit, load: f64) -> Fit {
    let [s1, c] = [fit.parameters[0].1, fit.parameters[1].1];
    let factors = [1e3 / libm::pow(1e-3 * load, 1.6), 1.0 / std::f64::consts::LN_10];
    let errors = fit.standard_errors.iter().zip(factors).map(|(e, f)| e * f);
    Fit {
        law: "Hettler",
        form: "r F^1.6 (1 + C ln N)",
        parameters: vec![("r [mm/kN^1.6]", s1 * factors[0]), ("C", c * factors[1])],
        standard_errors: errors.collect(),
        ..fit.clone()
    }
}

/// Regression of s on ln N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope {
    /// ds/d(ln N) [m].
    pub slope: f64,
    /// Standard error [m].
    pub error: f64,
}

/// Slope of the cycles from `from` on; `None` for fewer than three.
pub fn slope(cycles: &[[f64; 2]], from: f64) -> Option<Slope> {
    let used: Vec<[f64; 2]> =
        cycles.iter().filter(|c| c[0] >= from).map(|c| [libm::log(c[0]), c[1]]).collect();
    if used.len() < 3 {
        return None;
    }
    let n = used.len() as f64;
    let mean = [0, 1].map(|d| used.iter().map(|c| c[d]).sum::<f64>() / n);
    let sxx = used.iter().map(|c| (c[0] - mean[0]).powi(2)).sum::<f64>();
    let sxy = used.iter().map(|c| (c[0] - mean[0]) * (c[1] - mean[1])).sum::<f64>();
    let slope = sxy / sxx;
    let rest = used.iter().map(|c| (c[1] - mean[1] - slope * (c[0] - mean[0])).powi(2)).sum::<f64>();
    let fit = Slope { slope, error: (rest / (n - 2.0) / sxx).sqrt() };
    (fit.slope.is_finite() && fit.error.is_finite()).then_some(fit)
}

type Term<'a> = &'a dyn Fn(f64) -> f64;

struct Data<'a> {
    used: &'a [[f64; 2]],
    /// Sum of squares about the mean [m²].
    spread: f64,
}

impl Data<'_> {
    /// Least-squares coefficients and sum of squared residuals [m²]; `None` for dependent terms.
    fn linear(&self, terms: &[Term<'_>]) -> Option<(Vec<f64>, f64)> {
        let rows = self.used.len();
        let mut matrix = nalgebra::DMatrix::from_fn(rows, terms.len(), |i, k| terms[k](self.used[i][0]));
        let values = nalgebra::DVector::from_iterator(rows, self.used.iter().map(|c| c[1]));
        // Normalised columns, for the rank.
        let sizes: Vec<f64> = matrix.column_iter().map(|c| c.norm()).collect();
        if sizes.iter().any(|s| !(s.is_finite() && *s > 0.0)) {
            return None;
        }
        for (mut column, size) in matrix.column_iter_mut().zip(&sizes) {
            column /= *size;
        }
        let qr = matrix.clone().qr();
        let r = qr.r();
        if r.diagonal().iter().any(|d| d.abs() < 1e-9) {
            return None;
        }
        let solved = r.solve_upper_triangular(&(qr.q().transpose() * &values))?;
        let rest = (&matrix * &solved - values).norm_squared();
        let c: Vec<f64> = solved.iter().zip(&sizes).map(|(c, s)| c / s).collect();
        (rest.is_finite() && c.iter().all(|x| x.is_finite())).then_some((c, rest))
    }

    /// Standard errors of the parameters, linearised; `None` if undetermined.
    fn standard_errors(&self, law: &str, parameters: &[f64], rest: f64) -> Option<Vec<f64>> {
        let (rows, count) = (self.used.len(), parameters.len());
        if rows <= count {
            return None;
        }
        let slope = |k: usize, n: f64| -> Option<f64> {
            let step = STEP * parameters[k].abs().max(f64::MIN_POSITIVE.sqrt());
            let at = |sign: f64| {
                let mut moved = parameters.to_vec();
                moved[k] += sign * step;
                settlement_after(law, &moved, n)
            };
            Some((at(1.0)? - at(-1.0)?) / (2.0 * step))
        };
        let mut slopes = nalgebra::DMatrix::zeros(rows, count);
        for (i, point) in self.used.iter().enumerate() {
            for k in 0..count {
                slopes[(i, k)] = slope(k, point[0])?;
            }
        }
        let sizes: Vec<f64> = slopes.column_iter().map(|c| c.norm()).collect();
        for (mut column, size) in slopes.column_iter_mut().zip(&sizes) {
            column /= *size;
        }
        let inverse = (slopes.transpose() * &slopes).try_inverse()?;
        let residuals: Option<Vec<f64>> =
            self.used.iter().map(|p| Some(p[1] - settlement_after(law, parameters, p[0])?)).collect();
        let residuals = residuals?;
        let products: f64 = residuals.windows(2).map(|r| r[0] * r[1]).sum();
        let squares: f64 = residuals.iter().map(|r| r * r).sum();
        let correlation = if squares > 0.0 { (products / squares).clamp(0.0, CORRELATED) } else { 0.0 };
        let variance = rest / (rows - count) as f64 * (1.0 + correlation) / (1.0 - correlation);
        let errors: Vec<f64> =
            (0..count).map(|k| (variance * inverse[(k, k)].max(0.0)).sqrt() / sizes[k]).collect();
        errors.iter().all(|e| e.is_finite()).then_some(errors)
    }

    fn fit(
        &self,
        law: &'static str,
        form: &'static str,
        parameters: Vec<(&'static str, f64)>,
        rest: f64,
    ) -> Fit {
        let points = self.used.len();
        let values: Vec<f64> = parameters.iter().map(|p| p.1).collect();
        let standard_errors = self.standard_errors(law, &values, rest).unwrap_or_default();
        Fit {
            law,
            form,
            parameters,
            standard_errors,
            r2: 1.0 - rest / self.spread,
            rms_error: (rest / points as f64).sqrt(),
            range: [self.used[0][0], self.used[points - 1][0]],
            points,
        }
    }
}

/// Relative step of numerical derivatives.
const STEP: f64 = 1e-6;
/// Largest correlation of successive residuals.
const CORRELATED: f64 = 0.99;

/// Grid points of [`search`].
const GRID: usize = 120;

/// Minimises the residual of a linear fit over one parameter: grid, then golden sections.
fn search(low: f64, high: f64, fit: impl Fn(f64) -> Option<(Vec<f64>, f64)>) -> Option<(f64, Vec<f64>, f64)> {
    let at = |k: usize| low + (high - low) * k as f64 / GRID as f64;
    let rest = |x: f64| fit(x).map_or(f64::INFINITY, |f| f.1);
    let best = (0..=GRID).map(|k| (k, rest(at(k)))).min_by(|a, b| a.1.total_cmp(&b.1))?.0;
    if best == 0 || best == GRID {
        return None;
    }
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut a, mut b) = (at(best - 1), at(best + 1));
    for _ in 0..60 {
        let (p, q) = (b - golden * (b - a), a + golden * (b - a));
        if rest(p) < rest(q) { b = q } else { a = p }
    }
    let x = 0.5 * (a + b);
    fit(x).map(|(c, rest)| (x, c, rest))
}

#[cfg(test)]
#[path = "settlement_tests.rs"]
mod tests;
