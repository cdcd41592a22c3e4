//! Statistics of repeated measurements: median, quartiles, ratios of pairs, and exponents of power laws.

/// The median of some numbers with their quartiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spread {
    pub(super) median: f64,
    pub(super) quartiles: [f64; 2],
}

/// Returns the median and the quartiles; `None` without numbers. A quantile between two numbers is interpolated.
pub(super) fn spread(samples: &[f64]) -> Option<Spread> {
    let mut sorted: Vec<f64> = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let quantile = |share: f64| {
        let position = share * (sorted.len() - 1) as f64;
        let (below, part) = (position.floor() as usize, position.fract());
        let (low, high) = (sorted.get(below)?, sorted.get(below + 1).or(sorted.last())?);
        Some(low + part * (high - low))
    };
    if sorted.is_empty() {
        return None;
    }
    Some(Spread { median: quantile(0.5)?, quartiles: [quantile(0.25)?, quantile(0.75)?] })
}

/// Returns the ratio of each pair. Repeats of all series are interleaved, so a pair has seen the same load of the machine.
pub(super) fn ratios(numerators: &[f64], denominators: &[f64]) -> Vec<f64> {
    let pairs = numerators.iter().zip(denominators).filter(|(_, denominator)| **denominator > 0.0);
    pairs.map(|(numerator, denominator)| numerator / denominator).collect()
}

/// Returns the exponent of the power law through points (x, y): the slope of the least-squares line through their logarithms. `None`: there
/// are fewer than two different x.
pub(super) fn exponent(points: &[(f64, f64)]) -> Option<f64> {
    let logarithms: Vec<(f64, f64)> =
        points.iter().filter(|(x, y)| *x > 0.0 && *y > 0.0).map(|(x, y)| (x.ln(), y.ln())).collect();
    let count = logarithms.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| logarithms.iter().map(of).sum::<f64>() / count;
    let (x_mean, y_mean) = (mean(|point| point.0), mean(|point| point.1));
    let (mut both, mut square) = (0.0, 0.0);
    for (x, y) in &logarithms {
        both += (x - x_mean) * (y - y_mean);
        square += (x - x_mean) * (x - x_mean);
    }
    (square > 0.0).then(|| both / square)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_interpolated() {
        let found = spread(&[4.0, 1.0, 3.0, 2.0]);
        assert_eq!(found, Some(Spread { median: 2.5, quartiles: [1.75, 3.25] }));
        assert_eq!(spread(&[7.0]), Some(Spread { median: 7.0, quartiles: [7.0; 2] }));
        assert_eq!(spread(&[]), None);
    }

    #[test]
    fn ratios_are_those_of_pairs() {
        assert_eq!(ratios(&[2.0, 9.0, 1.0], &[1.0, 3.0, 0.0]), [2.0, 3.0]);
    }

    #[test]
    fn exponents_of_planted_power_laws() {
        for planted in [-1.0, 0.0, 0.5, 1.0, 2.0, 3.25] {
            let points: Vec<(f64, f64)> = [4.0, 8.0, 16.0, 64.0].map(|x: f64| (x, 0.37 * x.powf(planted))).to_vec();
            let found = exponent(&points).unwrap_or(f64::NAN);
            assert!((found - planted).abs() < 1.0e-9, "{planted}: {found}");
        }
        assert_eq!(exponent(&[(4.0, 1.0)]), None);
        assert_eq!(exponent(&[(4.0, 1.0), (4.0, 2.0)]), None);
    }
}
