//! A law whose parameters follow the temperature: linear between the given temperatures, constant
//! outside, as `*ELASTIC` and `*PLASTIC` with a column of temperatures mean it.
//!
//! The law of a point is built again when its temperature changes; what it remembers (plastic
//! strain, back-stress) stays.
// SPDX-License-Identifier: BSD-3-Clause

use super::{Law, State};

#[derive(Clone, Debug)]
pub struct LawTable {
    name: String,
    state: State,
    /// Temperatures, rising, with the parameters of the law there.
    rows: Vec<(f64, Vec<f64>)>,
}

impl LawTable {
    pub fn new(name: &str, state: State, rows: &[(f64, Vec<f64>)]) -> Result<Self, String> {
        let table = Self { name: name.into(), state, rows: rows.to_vec() };
        let rising = rows.windows(2).all(|w| w[0].0 < w[1].0);
        let alike = rows.windows(2).all(|w| w[0].1.len() == w[1].1.len());
        if rows.is_empty() || !rising || !alike || !rows.iter().all(|r| r.0.is_finite()) {
            return Err("a material by temperature needs rising temperatures and as many \
                        parameters at each"
                .into());
        }
        let members = |row: &(f64, Vec<f64>)| Law::new(name, &row.1, state).map(|l| l.n_state());
        let counts = rows.iter().map(members).collect::<Result<Vec<_>, _>>()?;
        if counts.windows(2).any(|w| w[0] != w[1]) {
            return Err(format!("{name}: what a point remembers may not depend on temperature"));
        }
        Ok(table)
    }

    /// The law at a temperature.
    pub fn at(&self, temperature: f64) -> Result<Law, String> {
        let rows = &self.rows;
        let above = rows.partition_point(|r| r.0 <= temperature);
        let (low, high) = (above.saturating_sub(1), above.min(rows.len() - 1));
        let (t0, first) = &rows[low];
        let (t1, last) = &rows[high];
        if !temperature.is_finite() {
            return Err(format!("the temperature {temperature} is not a number"));
        }
        if low == high {
            return Law::new(&self.name, first, self.state);
        }
        let share = (temperature - t0) / (t1 - t0);
        let mix = first.iter().zip(last).map(|(a, b)| a + share * (b - a));
        Law::new(&self.name, &mix.collect::<Vec<_>>(), self.state)
            .map_err(|why| format!("at the temperature {temperature}: {why}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::Plane;

    const FLAT: State = State::Plane(Plane::Stress);

    #[test]
    fn parameters_are_linear_between_temperatures_and_constant_outside() {
        let rows = [(20.0, vec![8.0, 0.2]), (120.0, vec![4.0, 0.4])];
        let table = LawTable::new("elastic", FLAT, &rows).unwrap();
        for (t, e, nu) in [
            (-50.0, 8.0, 0.2),
            (20.0, 8.0, 0.2),
            (70.0, 6.0, 0.3),
            (120.0, 4.0, 0.4),
            (1e6, 4.0, 0.4),
        ] {
            let shear = table.at(t).unwrap().moduli()[2][2];
            assert!((shear - e / (2.0 * (1.0 + nu))).abs() < 1e-14, "{t}");
        }
        assert!(table.at(f64::NAN).is_err());
    }

    #[test]
    fn tables_that_do_not_fit_are_refused() {
        let row = |t: f64, p: &[f64]| (t, p.to_vec());
        let bad = [
            vec![],
            vec![row(0.0, &[8.0, 0.2]), row(0.0, &[4.0, 0.2])],
            vec![row(0.0, &[8.0, 0.2]), row(1.0, &[4.0])],
            vec![row(0.0, &[8.0, 0.2]), row(1.0, &[-4.0, 0.2])],
        ];
        for rows in bad {
            assert!(LawTable::new("elastic", FLAT, &rows).is_err());
        }
        // One back-stress has as many parameters as three more numbers of a yield curve would.
        let one = row(0.0, &[8.0, 0.2, 1.0, 2.0, 0.0, 0.0, 0.1, 0.0]);
        let none = row(1.0, &[8.0, 0.2, 0.0, 2.0, 0.1, 0.1, 1.0, 0.0]);
        assert!(LawTable::new("mises", FLAT, &[one, none]).is_err());
    }
}
