//! Claims on planted numbers.

use super::super::experiment::{Axis, Side};
use super::*;

const PANEL: Panel = Panel {
    name: "p",
    scene: [""; 2],
    camera: "clip",
    axis: Axis { symbol: "k", label: "k", values: &[], quick: &[] },
    side: Side::Swept,
    series: &[],
};

/// Returns the points of a series, each with three repeats around a time.
fn series(name: &str, times: &[(u32, f64)]) -> Vec<Point> {
    let point = |&(x, time): &(u32, f64)| {
        let passes = vec![("store".to_owned(), vec![0.99 * time, time, 1.01 * time])];
        let outcome = Outcome::Measured(Measurement { passes, ..Measurement::default() });
        Point { panel: "p".to_owned(), series: name.to_owned(), x, description: String::new(), outcome }
    };
    times.iter().map(point).collect()
}

fn check(check: Check, points: &[Point]) -> Finding {
    finding(check, &[PANEL], points)
}

fn faster(at: &'static [u32]) -> Check {
    Check::Faster { panel: "p", series: "a", than: "b", passes: Passes::All, at }
}

#[test]
fn faster_holds_or_not_by_the_numbers() {
    let points = [series("a", &[(4, 1.0), (64, 3.0)]), series("b", &[(4, 2.0), (64, 2.0)])].concat();
    assert_eq!(check(faster(&[4]), &points), Finding::Agrees("quotient of times 0.50 at k = 4".to_owned()));
    assert_eq!(
        check(faster(&[]), &points),
        Finding::Differs("quotient of times 0.50 at k = 4, 1.50 at k = 64".to_owned())
    );
}

#[test]
fn many_values_are_a_range() {
    let a = series("a", &[(4, 1.0), (8, 1.2), (16, 1.5)]);
    let points = [a, series("b", &[(4, 2.0), (8, 2.0), (16, 2.0)])].concat();
    assert_eq!(check(faster(&[]), &points), Finding::Agrees("quotient of times 0.50 to 0.75 at k = 4 … 16".to_owned()));
}

#[test]
fn a_difference_within_the_spread_decides_nothing() {
    let mut points = [series("a", &[(4, 1.0)]), series("b", &[(4, 1.0)])].concat();
    let Some(Point { outcome: Outcome::Measured(measured), .. }) = points.first_mut() else { unreachable!("planted") };
    measured.passes = vec![("store".to_owned(), vec![0.8, 1.01, 1.2])];
    assert!(matches!(check(faster(&[]), &points), Finding::Undecided(_)));
}

#[test]
fn changes_compare_the_least_and_the_greatest_value() {
    let points =
        [series("a", &[(64, 3.0), (4, 1.0), (16, 9.0)]), series("b", &[(4, 2.0), (16, 2.0), (64, 2.0)])].concat();
    let changes = |change| check(Check::Changes { panel: "p", series: "a", over: "b", change }, &points);
    assert_eq!(changes(Change::Rises), Finding::Agrees("quotient of times 0.50 at k = 4, 1.50 at k = 64".to_owned()));
    assert!(matches!(changes(Change::Falls), Finding::Differs(_)));
}

#[test]
fn exponents_are_compared_with_a_range() {
    let points = series("a", &[(4, 16.0), (8, 64.0), (16, 256.0)]);
    let power = |range| check(Check::Exponent { panel: "p", series: "a", range }, &points);
    assert_eq!(power([1.8, 2.2]), Finding::Agrees("exponent 2.00, quartiles 2.00 to 2.00".to_owned()));
    assert_eq!(power([0.8, 1.2]), Finding::Differs("exponent 2.00, quartiles 2.00 to 2.00".to_owned()));
}

#[test]
fn exponents_around_the_end_of_a_range_decide_nothing() {
    let mut points = series("a", &[(4, 16.0), (16, 256.0)]);
    let Some(Point { outcome: Outcome::Measured(measured), .. }) = points.last_mut() else { unreachable!("planted") };
    // Four times the value: the exponents are 1.5, 2 and 2.5.
    let times = [1.5, 2.0, 2.5].map(|power: f64| 4.0_f64.powf(power));
    let first = [0.99 * 16.0, 16.0, 1.01 * 16.0];
    let planted = first.iter().zip(times).map(|(first, factor)| first * factor).collect();
    measured.passes = vec![("store".to_owned(), planted)];
    let power = |range| check(Check::Exponent { panel: "p", series: "a", range }, &points);
    let text = "exponent 2.00, quartiles 1.75 to 2.25".to_owned();
    assert_eq!(power([1.7, 2.3]), Finding::Agrees(text.clone()));
    assert_eq!(power([1.9, 2.1]), Finding::Undecided(text.clone()));
    assert_eq!(power([0.0, 1.7]), Finding::Differs(text));
}

#[test]
fn what_is_missing_is_named() {
    let mut points = series("b", &[(4, 1.0)]);
    let outcome = Outcome::Unavailable("it lacks interlock".to_owned());
    points.push(Point { outcome, series: "a".to_owned(), ..points[0].clone() });
    assert_eq!(check(faster(&[]), &points), Finding::Missing("it lacks interlock".to_owned()));
    let other = Check::Exponent { panel: "p", series: "c", range: [0.0, 1.0] };
    assert_eq!(check(other, &points), Finding::Missing("no point of c".to_owned()));
}

#[test]
fn statements_with_the_same_reason_share_it() {
    let missing = |reason: &str| Finding::Missing(reason.to_owned());
    let findings = [("a", missing("no x")), ("b", missing("no y")), ("c", missing("no x"))];
    let expected = "P, on D: it is not measured whether a, and whether c (no x), and whether b (no y).";
    assert_eq!(sentence("P", "D", &findings), expected);
}

#[test]
fn the_sentence_says_what_agrees_and_what_does_not() {
    let points = [series("a", &[(4, 1.0), (64, 3.0)]), series("b", &[(4, 2.0), (64, 2.0)])].concat();
    let claims = [Claim { statement: "a is faster", check: faster(&[4]) }];
    let agrees = sentence("K15, Fig. 6", "D", &findings(&claims, &[PANEL], &points));
    assert_eq!(agrees, "K15, Fig. 6, on D: as in the paper, a is faster (quotient of times 0.50 at k = 4).");
    let claims = [Claim { statement: "a is faster", check: faster(&[64]) }, claims[0]];
    let both = sentence("K15", "D", &findings(&claims, &[PANEL], &points));
    assert_eq!(
        both,
        "K15, on D: as in the paper, a is faster (quotient of times 0.50 at k = 4); unlike in the paper, it does not hold that a is \
         faster (quotient of times 1.50 at k = 64)."
    );
}
