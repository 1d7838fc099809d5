//! Comparing optimizers and reproducing the paper's figures on test functions.

use crate::harness::Desk;

#[test]
fn optimizers_are_compared_with_curves_trials_and_a_plot() {
    let desk = Desk::new();
    let line = "optimize rosenbrock --dimension 3 --algorithm aep-practical,de --trials 8 \
                --evaluations 12000 -o out --html page.html --json -";
    let run = desk.aep(&format!("{line} --quiet"));
    let json: serde_json::Value = serde_json::from_str(run.done()).unwrap();
    assert_eq!(json["summaries"][0]["method"], "aep-practical");
    assert_eq!(json["summaries"][0]["successes"], 8);
    assert!(json["first_against"][1]["p_value"].is_number());
    assert!(desk.read("out/curves.csv").starts_with("optimizer,evaluations,mean,median,"));
    assert_eq!(desk.read("out/trials.csv").lines().count(), 1 + 2 * 8);
    assert!(desk.read("out/curves.svg").contains("aep-practical"));
    let page = desk.read("page.html");
    assert!(page.contains("<td class=num>8/8</td>") && page.contains("log10 of cost"));
    // Both curves with their quartiles.
    assert_eq!(
        (page.matches("<polyline class").count(), page.matches("<polygon class").count()),
        (2, 2)
    );
}

#[test]
fn a_comparison_can_be_repeated_whatever_the_number_of_threads() {
    let desk = Desk::new();
    let line = "optimize f2 --shift --trials 4 --evaluations 2000 -q";
    desk.aep(&format!("{line} --threads 1 -o one")).done();
    desk.aep(&format!("{line} --threads 3 -o three")).done();
    assert_eq!(desk.read("one/trials.csv"), desk.read("three/trials.csv"));
}

#[test]
fn unknown_names_are_refused_with_those_there_are() {
    let desk = Desk::new();
    desk.aep("optimize f9").refused(&["no test function or task 'f9'", "hint: there are: f1,"]);
    desk.aep("optimize f1 --algorithm ga").refused(&["no optimizer 'ga'", "cma-es"]);
    desk.aep("optimize f5 --dimension 7").refused(&["defined for 2 components", "--dimension"]);
    desk.aep("optimize f1 --algorithm de --population 2").refused(&["four individuals"]);
    desk.aep("reproduce fig99").refused(&["no figure 'fig99'", "fig2"]);
}

#[test]
fn test_functions_are_listed_and_told_one_by_one() {
    let desk = Desk::new();
    assert!(desk.aep("problems").done().contains("rastrigin"));
    assert!(desk.aep("problems f5").done().contains("0.998"));
}

#[test]
fn identification_tasks_are_listed_told_and_solved_by_the_recommended_method() {
    let desk = Desk::new();
    assert!(desk.aep("problems").done().contains("two-mass"));
    let run = desk.aep("problems two-mass");
    assert!(run.done().contains("backlash") && run.done().contains("kg m^2"));
    let line = "optimize failing-rod --algorithm auto,de --trials 4 --evaluations 8000";
    let run = desk.aep(&format!("{line} --json out.json"));
    assert!(run.done().contains("auto: ") && run.done().contains("residuals"));
    let json = desk.json("out.json");
    let auto = json["summaries"][0]["method"].as_str().unwrap();
    assert!(run.done().contains(&format!("auto: {auto},")));
    assert_eq!(json["summaries"][0]["successes"], 4);
    // Half of the domain fails, and that is counted.
    assert!(json["summaries"][1]["failures"].as_u64().unwrap() > 10);
    for flag in ["--dimension 3", "--shift", "--noise"] {
        desk.aep(&format!("optimize failing-rod {flag}"))
            .refused(&["as it was recorded", "leave --"]);
    }
}

#[test]
fn a_figure_comes_with_its_curves_its_plot_and_a_verdict_on_each_statement() {
    let desk = Desk::new();
    let run = desk.aep("reproduce fig4 -o paper --trials 10");
    assert!(run.done().contains("0 after about 40 generations"));
    assert!(desk.read("paper/fig4.csv").starts_with("line,generation,mean,"));
    assert!(desk.read("paper/fig4.svg").starts_with("<svg"));
    assert!(desk.read("paper/fig4-readings.csv").contains("standard deviation beta f"));
    assert_eq!(desk.read("paper/claims.csv").lines().count(), 4);
}

#[test]
fn figures_made_before_are_kept_and_others_made_again() {
    let desk = Desk::new();
    let line = "reproduce fig4 -o paper --no-readings --trials";
    assert!(!desk.aep(&format!("{line} 5")).done().contains("kept fig4"));
    let table = desk.read("paper/table.md");
    assert!(table.starts_with("| figure | about |") && table.contains("| fig4 | AEP |"));
    assert!(desk.read("paper/table.html").contains("<td>fig4</td>"));
    let page = desk.read("paper/table.html");
    assert!(page.contains("<section id=\"fig4\">") && page.contains("<polyline class"));
    let again = desk.aep(&format!("{line} 5"));
    assert!(again.done().contains("kept fig4"));
    let figures = |page: &str| page.matches("<polyline class").count();
    assert_eq!(figures(&desk.read("paper/table.html")), figures(&page));
    assert_eq!(desk.read("paper/table.md"), table);
    // Other conditions, a missing file, a record that is none: made again.
    assert!(!desk.aep(&format!("{line} 6")).done().contains("kept fig4"));
    std::fs::remove_file(desk.path("paper/fig4.csv")).unwrap();
    assert!(!desk.aep(&format!("{line} 6")).done().contains("kept fig4"));
    desk.write("paper/fig4-claims.json", "{");
    assert!(!desk.aep(&format!("{line} 6")).done().contains("kept fig4"));
    assert!(!desk.aep(&format!("{line} 6 --again")).done().contains("kept fig4"));
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_comparison_and_reports_the_trials_that_had_ended() {
    let desk = Desk::new();
    let line = "optimize rastrigin --dimension 10 --algorithm meta-ep --target 0 \
                --trials 100000 --evaluations 20000 -o out";
    let run = desk.interrupted(line, 2.0);
    assert_eq!(run.code, Some(130), "{}{}", run.out, run.err);
    assert!(run.err.contains("interrupted") && run.out.contains("meta-ep"), "{}", run.err);
    let rows = desk.read("out/trials.csv").lines().count() - 1;
    assert!(0 < rows && rows < 100_000, "{rows} trials");
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_the_figures_that_are_made() {
    let desk = Desk::new();
    // The first takes a fraction of a second, the other one minutes.
    let line = "reproduce fig2 fig12 -o paper --no-readings --trials 5";
    let run = desk.interrupted(line, 3.0);
    assert_eq!(run.code, Some(130), "{}{}", run.out, run.err);
    assert!(run.err.contains("1 of 2 figures"), "{}", run.err);
    let table = desk.read("paper/table.md");
    assert!(table.contains("| fig2 | AEP |") && !table.contains("fig12"), "{table}");
    assert!(desk.read("paper/fig2.svg").starts_with("<svg"));
    let again = desk.aep("reproduce fig2 -o paper --no-readings --trials 5");
    assert!(again.done().contains("kept fig2"));
}

#[test]
fn a_saved_run_goes_on_to_the_same_end_and_a_broken_file_is_refused() {
    let desk = Desk::new();
    let line = "optimize powers --dimension 6 --algorithm aep-practical --target 0 --generations";
    let whole = desk.aep(&format!("{line} 60 --trace run.jsonl"));
    assert_eq!(desk.read("run.jsonl").lines().count(), 62);
    desk.aep(&format!("{line} 25 --checkpoint run.ckpt --trace run.csv")).done();
    assert!(desk.read("run.csv").starts_with("generation,evaluations,failures,"));
    let bytes = std::fs::read(desk.path("run.ckpt")).unwrap();
    let resumed = desk.aep(&format!("{line} 60 --resume run.ckpt --threads 2"));
    assert_eq!(resumed.done(), whole.done());
    desk.write("run.ckpt", &bytes[..bytes.len() / 2]);
    desk.aep(&format!("{line} 60 --resume run.ckpt"))
        .refused(&["run.ckpt", "truncated or damaged"]);
    desk.write("run.ckpt", "generation,cost\n1,2\n");
    desk.aep(&format!("{line} 60 --resume run.ckpt")).refused(&["not a checkpoint"]);
    desk.write("run.ckpt", &bytes);
    desk.aep(&format!("{line} 60 --seed 2 --resume run.ckpt")).refused(&["another run", "seed"]);
    for other in ["griewank --dimension 6", "powers --dimension 5", "powers --dimension 6 --shift"]
    {
        let resumed =
            desk.aep(&format!("optimize {other} --algorithm aep-practical --resume run.ckpt"));
        resumed.refused(&["another problem", "powers in 6 components"]);
    }
    desk.aep("optimize f1 --algorithm aep,de --trace a.csv").refused(&["single run"]);
    desk.aep("optimize f1 --algorithm aep --trace a.csv --html a.html").refused(&["no page"]);
    desk.aep("optimize f1 --algorithm aep --trace a.txt").refused(&[".csv or a .jsonl"]);
}
