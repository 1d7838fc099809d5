//! What the program says of itself.

use crate::harness::Desk;

const COMMANDS: [&str; 10] = [
    "discover",
    "identify",
    "compare",
    "suggest",
    "extend",
    "simulate",
    "challenge",
    "effects",
    "control",
    "export",
];

#[test]
fn every_command_explains_itself() {
    let desk = Desk::new();
    let help = desk.aep("--help");
    for command in COMMANDS {
        assert!(help.done().contains(command), "{command}");
        let own = desk.aep(&format!("{command} --help"));
        assert!(own.done().contains("Examples:"), "{command}");
    }
}

#[test]
fn units_of_the_data_stand_in_the_help() {
    let desk = Desk::new();
    let help = desk.aep("discover --help");
    for part in ["time_s,force_N,position_m", "mN", "kgf", "deg", "N per V", "zero-order"] {
        assert!(help.done().contains(part), "{part}");
    }
}

#[test]
fn thresholds_and_limits_stand_in_the_help_with_their_defaults() {
    let desk = Desk::new();
    for command in ["discover", "suggest"] {
        let help = desk.aep(&format!("{command} --help"));
        for part in [
            "--better",
            "80",
            "--share",
            "--local",
            "--chance",
            "--fitted",
            "--complete",
            "--beam",
            "--most-effects",
            "best so far",
            "60",
        ] {
            assert!(help.done().contains(part), "{command} {part}");
        }
    }
}

#[test]
fn effects_are_listed_with_equations_and_told_one_by_one() {
    let desk = Desk::new();
    let list = desk.aep("effects");
    for name in ["coulomb", "stribeck", "presliding", "ripple", "asymmetry", "position-friction"] {
        assert!(list.done().contains(name), "{name}");
    }
    let one = desk.aep("effects stribeck");
    for part in ["v_s", "m/s", "shows in the residual", "source"] {
        assert!(one.done().contains(part), "{part}");
    }
    assert!(desk.aep("effects stribeck --rotary").done().contains("rad/s"));
}

#[test]
fn output_that_nobody_watches_has_no_colours() {
    let desk = Desk::new();
    assert!(!desk.aep("effects").done().contains('\u{1b}'));
    assert!(!desk.aep("discover none.csv").err.contains('\u{1b}'));
}
