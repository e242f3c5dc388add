//! Figures as people read them.

use accuracy::Rate;

/// A number in three digits, without a power of ten if it needs none.
pub fn plain(number: f64) -> String {
    match number.abs() {
        0.0 => "0".into(),
        100.0.. => format!("{number:.0}"),
        10.0.. => format!("{number:.1}"),
        0.01.. => format!("{number:.2}"),
        _ => power(number),
    }
}

/// A share in percent; of nothing, what it is below.
pub fn share(rate: Rate) -> String {
    match rate.bound_of_zero() {
        Some(bound) => format!("<{}", percent(bound)),
        None if rate.samples == 0 => "–".into(),
        None => percent(rate.share()),
    }
}

/// A share in percent, in two digits or three.
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    // Below one, two digits behind the zeros.
    let zeros = match percent {
        0.0 | 1.0.. => 0,
        _ => -percent.log10().floor() as usize,
    };
    let digits = if zeros == 0 { 1 } else { zeros + 1 };
    format!("{percent:.digits$}%")
}

/// As `3.2e-7`, in two digits: `3.2·10⁻⁷`.
pub fn power(number: f64) -> String {
    if number == 0.0 {
        return "0".into();
    }
    if !number.is_finite() {
        return "not finite".into();
    }
    let text = format!("{number:.1e}");
    match text.split_once('e') {
        Some((digits, exponent)) => format!("{digits}·10{}", superscript(exponent)),
        None => text,
    }
}

/// A power of a base.
pub fn power_of(base: u32, exponent: i32) -> String {
    format!("{base}{}", superscript(&exponent.to_string()))
}

fn superscript(number: &str) -> String {
    let raised = |character: char| match character {
        '-' => '⁻',
        digit => {
            let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
            let place = digit.to_digit(10).map(|digit| digit as usize);
            place.map_or(digit, |place| digits[place])
        }
    };
    number.chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_is_in_percent_and_of_nothing_it_is_said_how_little_that_may_be() {
        let rate = |events, samples| share(Rate { events, samples });
        assert_eq!(rate(653, 1000), "65.3%");
        assert_eq!(rate(3, 100_000), "0.0030%");
        assert_eq!(rate(5, 1000), "0.50%");
        assert_eq!(rate(0, 300_000), "<0.0010%");
        assert_eq!(rate(0, 0), "–");
    }

    #[test]
    fn figures_have_the_digits_that_they_are_worth() {
        assert_eq!(
            [0.0, 0.712, 12.34, 456.7].map(plain),
            ["0", "0.71", "12.3", "457"]
        );
        assert_eq!(plain(3.16e-7), "3.2·10⁻⁷");
        assert_eq!(power(f64::INFINITY), "not finite");
        assert_eq!(power(0.0), "0");
        assert_eq!([power_of(10, -12), power_of(2, 40)], ["10⁻¹²", "2⁴⁰"]);
    }
}
