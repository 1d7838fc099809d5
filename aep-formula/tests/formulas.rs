//! Formulas as users write them, and what is said of mistakes.

use aep_formula::{FUNCTIONS, Formula, MOST_DEPTH, MOST_LENGTH};
use proptest::prelude::*;

fn value(text: &str, values: &[f64]) -> f64 {
    Formula::parse(text).unwrap_or_else(|error| panic!("{error}")).value(values)
}

fn refused(text: &str) -> (String, usize) {
    let error = Formula::parse(text).expect_err(text);
    (error.to_string(), error.at)
}

#[test]
fn operators_bind_as_in_mathematics() {
    for (text, expected) in [
        ("1 + 2*3", 7.0),
        ("(1 + 2)*3", 9.0),
        ("2^3^2", 512.0),
        ("2**3", 8.0),
        ("8/4/2", 1.0),
        ("7 - 2 - 1", 4.0),
        ("-3 + 5", 2.0),
        ("2*-3", -6.0),
        ("2^-1", 0.5),
        ("--2", 2.0),
        ("7 % 4", 3.0),
        ("(2 < 3) + (2 >= 3) + (2 != 3)", 2.0),
        ("1.5e-3*2E3", 3.0),
        (".5 + 1.", 1.5),
        ("max(1, 7, 3) - min(2, -4)", 11.0),
        ("clamp(9, -1, 1) + sign(-2) + sign(0)", 0.0),
        ("if(2 > 1, 10, 20)", 10.0),
        ("atan2(1, 0)*2 - acos(-1)", 0.0),
        ("pow(2, 10)", 1024.0),
        ("abs(-2) + sqrt(9) + log(exp(1)) + ln(1) + tanh(0)", 6.0),
        ("2 - 3^2", -7.0),
        ("3*(-2)^2", 12.0),
    ] {
        assert!((value(text, &[]) - expected).abs() < 1e-12, "{text}");
    }
}

#[test]
fn names_are_those_of_columns() {
    let formula = Formula::parse("`Motor force [N]` - 9.81*m + arm.q1 - m").unwrap();
    assert_eq!(formula.names(), ["Motor force [N]", "m", "arm.q1"]);
    assert_eq!(formula.value(&[100.0, 2.0, 5.0]), 100.0 - 19.62 + 5.0 - 2.0);
}

#[test]
fn a_mistake_is_told_with_its_place() {
    for (text, at, said) in [
        ("a * (b + c", 4, "not closed"),
        ("a * b)", 5, "never opened"),
        ("a b", 2, "operator is missing"),
        ("2 x", 2, "operator is missing"),
        ("a * ", 4, "ends too early"),
        ("a * / b", 4, "before '/'"),
        ("sine(x)", 0, "no function 'sine'"),
        ("min(x)", 0, "takes 2 or more"),
        ("atan2(x)", 0, "takes 2 values, not 1"),
        ("sin()", 0, "takes 1 values, not 0"),
        ("a & b", 2, "has no place"),
        ("a = b", 2, "write =="),
        ("a < b < c", 6, "two at a time"),
        ("-x^2", 0, "two ways"),
        ("`force", 0, "no second one"),
        ("force [N]", 6, "backticks"),
        ("1e999", 0, "too large"),
        ("", 0, "ends too early"),
    ] {
        let (message, place) = refused(text);
        assert!(message.contains(said) && place == at, "{text}: {place} {message}");
    }
    let (message, _) = refused("force_N - 9,81*m");
    assert!(
        message.ends_with("force_N - 9,81*m\n             ^".trim_start_matches(' '))
            || message.contains("         ^")
    );
}

#[test]
fn size_and_depth_are_limited() {
    let deep = "(".repeat(100_000) + "x" + &")".repeat(100_000);
    assert!(refused(&deep).0.contains("at most"));
    let deep = "(".repeat(MOST_DEPTH + 2) + "x" + &")".repeat(MOST_DEPTH + 2);
    assert!(refused(&deep).0.contains("deeper"));
    let tower = "2^".repeat(MOST_DEPTH + 2) + "1";
    assert!(refused(&tower).0.contains("deeper"));
    let long = "1+".repeat(MOST_LENGTH / 2 - 1) + "1";
    assert_eq!(value(&long, &[]), (MOST_LENGTH / 2) as f64);
    assert_eq!(value(&("-".repeat(4000) + "1"), &[]), 1.0);
}

#[test]
fn every_function_is_in_the_list_once_and_works() {
    for (k, function) in FUNCTIONS.iter().enumerate() {
        assert!(FUNCTIONS[..k].iter().all(|other| other.name != function.name));
        let values = ["0.5", "0.25, 0.5", "0.25, 0.5, 0.75"];
        let calls = values.map(|v| Formula::parse(&format!("{}({v})", function.name)));
        assert!(calls.iter().any(Result::is_ok), "{}", function.name);
    }
}

#[test]
fn a_square_is_a_power_to_the_last_bit() {
    // Found by a draw: c * c is another number. A compiler that sees the exponent writes that.
    let c: f64 = 6.112_023_181_922_595;
    let power = c.powf(std::hint::black_box(2.0));
    assert_eq!(value("c^2", &[c]).to_bits(), power.to_bits());
}

proptest! {
    #[test]
    fn no_text_panics(text in "\\PC{0,80}") {
        let _ = Formula::parse(&text).map(|f| f.value(&vec![0.3; f.names().len()])).map_err(|e| e.to_string());
    }

    #[test]
    fn no_soup_of_signs_panics(words in prop::collection::vec(
        prop::sample::select(vec!["x", "1", "(", ")", "+", "-", "*", "/", "^", "**", ",", "sin", "min", "<", "==", "`a b`", " ", "e5", "."]),
        0..40,
    )) {
        let text: String = words.concat();
        match Formula::parse(&text) {
            Ok(formula) => { formula.value(&vec![-1.5; formula.names().len()]); }
            Err(error) => prop_assert!(error.at <= text.len()),
        }
    }

    #[test]
    fn sums_and_products_agree_with_rust(a in -1e3f64..1e3, b in -1e3f64..1e3, c in 0.1f64..10.0) {
        let formula = Formula::parse("a*b + c/a - c^2*(a - b)").unwrap();
        // A compiler that sees the exponent writes c * c, which is not always the last bit of the power.
        let expected = a * b + c / a - c.powf(std::hint::black_box(2.0)) * (a - b);
        prop_assert_eq!(formula.value(&[a, b, c]).to_bits(), expected.to_bits());
    }
}
