//! Axes of plots: where a value is drawn, and which values are named.

use super::text;

/// How values are named.
#[derive(Clone, Copy, Debug)]
pub enum Naming {
    /// As decimals.
    Decimal,
    /// In percent.
    Percent,
    /// As powers of ten, and multiples of them.
    Power,
}

impl Naming {
    fn name(self, digit: f64, exponent: i32) -> String {
        // By way of text, so that 3e-1 is 0.3.
        let times_ten_to = |power: i32| {
            format!("{digit}e{power}")
                .parse()
                .map_or(digit, |it: f64| it)
        };
        match self {
            Naming::Decimal => times_ten_to(exponent).to_string(),
            Naming::Percent => format!("{}%", times_ten_to(exponent + 2)),
            Naming::Power if digit == 1.0 => text::power_of(10, exponent),
            Naming::Power => format!("{digit}·{}", text::power_of(10, exponent)),
        }
    }
}

/// From values to places.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Whether equal steps are equal factors.
    is_logarithmic: bool,
    /// The least and the greatest value.
    values: (f64, f64),
    /// Where these are drawn, in pixels.
    places: (f64, f64),
    /// Values that are named, and their names.
    pub ticks: Vec<(f64, String)>,
}

impl Axis {
    /// An axis of equal factors that has all values in it, and some room. What is not positive and finite is not
    /// looked at.
    pub fn logarithmic(
        values: impl Iterator<Item = f64>,
        naming: Naming,
        places: (f64, f64),
    ) -> Axis {
        let values = values.filter(|value| value.is_finite() && *value > 0.0);
        let (least, greatest) = values
            .fold((f64::INFINITY, 0.0_f64), |(least, greatest), value| {
                (least.min(value), greatest.max(value))
            });
        let (least, greatest) = match least <= greatest {
            true => (least, greatest),
            false => (1.0, 1.0),
        };
        // A sixth on either side, for labels, and more where there is hardly a span.
        let room = (greatest / least).powf(0.17).clamp(1.15, 3.0);
        let values = (least / room, greatest * room);
        Axis {
            is_logarithmic: true,
            values,
            places,
            ticks: round_values(values, naming),
        }
    }

    /// An axis of equal factors from a value to a value, on which every so many powers of a base are named.
    pub fn powers(base: u32, values: (f64, f64), step: usize, places: (f64, f64)) -> Axis {
        let exponent = |value: f64| value.log(f64::from(base));
        let (least, greatest) = (exponent(values.0).ceil(), exponent(values.1).floor());
        let exponents = (least as i32..=greatest as i32)
            .filter(|exponent| exponent.rem_euclid(step as i32) == 0);
        Axis {
            is_logarithmic: true,
            values,
            places,
            ticks: exponents
                .map(|exponent| {
                    let value = f64::from(base).powi(exponent);
                    (value, text::power_of(base, exponent))
                })
                .collect(),
        }
    }

    /// An axis of shares from none to all.
    pub fn shares(places: (f64, f64)) -> Axis {
        let ticks = (0..=4).map(|quarter| {
            let percent = 25 * quarter;
            (f64::from(percent) / 100.0, format!("{percent}%"))
        });
        Axis {
            is_logarithmic: false,
            values: (0.0, 1.0),
            places,
            ticks: ticks.collect(),
        }
    }

    /// An axis of equal steps from a value to a greater one, on which round values are named.
    pub fn linear(values: (f64, f64), name: impl Fn(f64) -> String, places: (f64, f64)) -> Axis {
        let step = round_step(values.1 - values.0);
        let (first, last) = ((values.0 / step).ceil(), (values.1 / step).floor());
        let ticks = (first as i64..=last as i64).map(|multiple| {
            let value = multiple as f64 * step;
            (value, name(value))
        });
        Axis {
            is_logarithmic: false,
            values,
            places,
            ticks: ticks.collect(),
        }
    }

    /// Where a value is drawn; what is beyond an end, at the end.
    pub fn place(&self, value: f64) -> f64 {
        let on_scale = |value: f64| match self.is_logarithmic {
            true => value.ln(),
            false => value,
        };
        let (least, greatest) = self.values;
        let value = on_scale(value.clamp(least, greatest));
        let share = (value - on_scale(least)) / (on_scale(greatest) - on_scale(least));
        let (start, end) = self.places;
        start + share * (end - start)
    }
}

/// A round step that fits four to nine times into a span.
fn round_step(span: f64) -> f64 {
    let power = 10_f64.powf((span / 9.0).log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power);
    let fits = |step: &f64| span / step <= 9.0;
    steps.into_iter().find(fits).unwrap_or(10.0 * power)
}

/// Round values in a range: powers of ten and, the shorter the range, more between them.
fn round_values((least, greatest): (f64, f64), naming: Naming) -> Vec<(f64, String)> {
    let decades = (greatest / least).log10();
    let digits: &[f64] = match decades {
        2.5.. => &[1.0],
        1.2.. => &[1.0, 2.0, 5.0],
        0.5.. => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
        _ => &[
            1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0,
        ],
    };
    let exponents = least.log10().floor() as i32..=greatest.log10().ceil() as i32;
    let named = exponents.flat_map(|exponent| {
        digits.iter().map(move |digit| {
            let value = digit * 10_f64.powi(exponent);
            (value, naming.name(*digit, exponent))
        })
    });
    named
        .filter(|(value, _)| (least..=greatest).contains(value))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(axis: &Axis) -> Vec<&str> {
        axis.ticks.iter().map(|(_, name)| name.as_str()).collect()
    }

    #[test]
    fn equal_factors_are_equal_steps() {
        let axis = Axis::powers(10, (1.0, 1e4), 2, (100.0, 500.0));
        let places = [1.0, 10.0, 1e4, 1e9, 0.1].map(|value| axis.place(value).round());
        assert_eq!(places, [100.0, 200.0, 500.0, 500.0, 100.0]);
        assert_eq!(names(&axis), ["10⁰", "10²", "10⁴"]);
    }

    #[test]
    fn equal_steps_are_named_at_round_values() {
        let percent = |value: f64| format!("{:.0}%", 100.0 * value);
        let axis = Axis::linear((-0.2, 0.2), percent, (0.0, 400.0));
        assert_eq!(
            names(&axis),
            [
                "-20%", "-15%", "-10%", "-5%", "0%", "5%", "10%", "15%", "20%"
            ]
        );
        assert_eq!(
            [-0.2, 0.0, 0.1].map(|value| axis.place(value).round()),
            [0.0, 200.0, 300.0]
        );
        for span in [0.013, 0.9, 2.6, 10.0, 480.0] {
            let axis = Axis::linear((0.0, span), |value| value.to_string(), (0.0, 400.0));
            assert!(
                (4..=10).contains(&axis.ticks.len()),
                "{span}: {:?}",
                axis.ticks
            );
        }
    }

    #[test]
    fn all_values_are_on_the_axis_and_a_few_are_named() {
        for values in [
            vec![0.71, 2.1],
            vec![3e-5, 0.33],
            vec![3.1e-7, 2.9e-6],
            vec![1.0],
        ] {
            let axis = Axis::logarithmic(values.iter().copied(), Naming::Power, (0.0, 400.0));
            for value in values {
                assert!((20.0..380.0).contains(&axis.place(value)), "{value}");
            }
            assert!((2..12).contains(&axis.ticks.len()), "{:?}", axis.ticks);
        }
        let nothing = [f64::NAN, 0.0].into_iter();
        let axis = Axis::logarithmic(nothing, Naming::Power, (0.0, 400.0));
        assert_eq!(axis.place(1.0).round(), 200.0);
    }

    #[test]
    fn values_are_named_as_what_they_are() {
        let axis = |naming| Axis::logarithmic([3.3e-5, 0.33].into_iter(), naming, (0.0, 400.0));
        assert_eq!(
            names(&axis(Naming::Power)),
            ["10⁻⁴", "10⁻³", "10⁻²", "10⁻¹"]
        );
        assert_eq!(
            names(&axis(Naming::Percent)),
            ["0.01%", "0.1%", "1%", "10%"]
        );
        let axis = Axis::logarithmic([0.7, 3.0].into_iter(), Naming::Decimal, (0.0, 400.0));
        assert_eq!(names(&axis), ["0.7", "1", "1.5", "2", "3"]);
    }
}
