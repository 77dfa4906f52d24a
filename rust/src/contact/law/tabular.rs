//! A table of pressures and overclosures, straight between its points and beyond the last.
// SPDX-License-Identifier: BSD-3-Clause

use super::NormalEntry;
use super::pressure::{Curve, Overclosure};

pub const ENTRY: NormalEntry = ("tabular", |pressure, overclosure| {
    if pressure.len() != overclosure.len() || pressure.len() < 2 {
        return Err("a table needs as many pressures as overclosures, two at least".into());
    }
    let (mut below, mut sum) = (vec![0.0], 0.0);
    for (p, w) in pressure.windows(2).zip(overclosure.windows(2)) {
        sum += 0.5 * (p[1] + p[0]) * (w[1] - w[0]);
        below.push(sum);
    }
    let law = Tabular { pressure: pressure.to_vec(), overclosure: overclosure.to_vec(), below };
    Ok(Box::new(Overclosure(law)))
});

pub struct Tabular {
    pressure: Vec<f64>,
    overclosure: Vec<f64>,
    /// Energy per area at each point.
    below: Vec<f64>,
}

impl Curve for Tabular {
    fn start(&self) -> f64 {
        self.overclosure[0]
    }

    fn at(&self, w: f64) -> [f64; 3] {
        let (ws, ps) = (&self.overclosure, &self.pressure);
        let i = ws.partition_point(|v| *v <= w).saturating_sub(1).min(ws.len() - 2);
        let slope = (ps[i + 1] - ps[i]) / (ws[i + 1] - ws[i]);
        let d = w - ws[i];
        [ps[i] + slope * d, slope, self.below[i] + ps[i] * d + 0.5 * slope * (d * d)]
    }
}
