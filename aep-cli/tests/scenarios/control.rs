//! Control: PD with and without compensation, the compensator as C, the model as JSON.

use crate::harness::{Desk, repository};

/// A model as `aep identify` writes it.
const TABLE: &str = r#"{"axis":"linear","mass":40.0,"effects":[
  {"effect":"coulomb","parameters":{"F_C":9.0}},
  {"effect":"viscous","parameters":{"F_v":200.0}}]}"#;

/// The same with an effect that the compensator does not know.
const PLANT: &str = r#"{"axis":"linear","mass":40.0,"effects":[
  {"effect":"coulomb","parameters":{"F_C":9.0}},
  {"effect":"viscous","parameters":{"F_v":200.0}},
  {"effect":"asymmetry","parameters":{"dF_C":2.0,"dF_v":40.0}}]}"#;

#[test]
fn the_papers_table_is_compensated_without_any_file() {
    let desk = Desk::new();
    let run = desk.aep("control --json m.json -o run.csv --plot run.svg --html run.html");
    for part in ["RMS tracking error", "stick episodes", "limit cycle", "% less RMS error"] {
        assert!(run.done().contains(part), "{part}: {}", run.out);
    }
    let measures = desk.json("m.json");
    assert!(measures["pd"]["stick_episodes"].as_u64().unwrap() > 10);
    assert_eq!(measures["compensated"]["stick_episodes"], 0);
    let header = "time_s,reference_m,pd_position_m,pd_force_N,pd_stuck,compensated_position_m,compensated_force_N,compensation_N,compensated_stuck";
    assert_eq!(desk.read("run.csv").lines().next(), Some(header));
    assert_eq!(desk.read("run.csv").lines().count(), 2002);
    assert!(desk.read("run.svg").contains("tracking error, µm"));
    let page = desk.read("run.html");
    assert!(page.contains("% less RMS error") && page.matches("<figure").count() == 3);
}

#[test]
fn an_identified_model_compensates_a_plant_with_more_effects_than_it_knows() {
    let desk = Desk::new();
    desk.challenge("nothing", 3, "c");
    desk.aep("identify c/recording.csv -q --effects coulomb,viscous,offset -o model.json").done();
    desk.write("table.json", TABLE);
    desk.write("plant.json", PLANT);
    let rms = |line: &str| {
        let run = desk.aep(&format!("control {line} --sample-time 0.001 --json -"));
        let json: serde_json::Value = serde_json::from_str(run.done()).unwrap();
        let of = |kind: &str| json[kind]["rms_error"].as_f64().unwrap();
        (of("pd"), of("compensated"))
    };
    let course = "--reference trapezoid:10mm,10mm/s,100mm/s2";
    let identified = rms(&format!("--model model.json {course}"));
    assert!(identified.1 < 0.5 * identified.0, "{identified:?}");
    let known = rms(&format!("--model plant.json --plant plant.json {course}"));
    let unknown = rms(&format!("--model table.json --plant plant.json {course}"));
    assert!(known.1 < 0.7 * unknown.1 && unknown.1 < 0.5 * unknown.0, "{known:?} {unknown:?}");
}

#[test]
fn every_reference_runs_and_a_file_is_one() {
    let desk = Desk::new();
    desk.write("path.csv", "time_s,reference_mm\n0,0\n1,1\n2,1\n3,0\n");
    for reference in [
        "ramp:0.05cm/s",
        "sine:1mm,0.5Hz",
        "trapezoid:2mm,1mm/s,10mm/s2",
        "reversal:1mm/s,1s",
        "path.csv",
    ] {
        let run = desk.aep(&format!("control --reference {reference}"));
        assert!(run.done().contains("less RMS error"), "{reference}: {}", run.out);
    }
}

#[test]
fn robustness_calls_over_compensation_and_limit_cycles_by_their_names() {
    let desk = Desk::new();
    let run = desk.aep("control --reference ramp:0.01cm/s --robustness --json m.json");
    for part in ["wrong model", "coulomb.F_C", "+20 %", "over-compensated", "limit cycle"] {
        assert!(run.done().contains(part), "{part}: {}", run.out);
    }
    let deviations = &desk.json("m.json")["robustness"];
    assert_eq!(deviations[0]["parameter"], "none");
    assert_eq!(deviations.as_array().unwrap().len(), 1 + 2 * 8);
}

#[test]
fn converter_limits_and_steps_are_kept() {
    let desk = Desk::new();
    desk.write("table.json", TABLE);
    let line = "control --model table.json --reference ramp:5cm/s --duration 1 --force-limit 15 --force-resolution 0.25 -o run.csv";
    desk.aep(line).done();
    let forces: Vec<f64> = desk
        .read("run.csv")
        .lines()
        .skip(1)
        .map(|row| row.split(',').nth(6).unwrap().parse().unwrap())
        .collect();
    assert!(forces.iter().all(|f| f.abs() <= 15.0 && (f / 0.25).fract() == 0.0));
    assert!(forces.contains(&15.0));
}

#[test]
fn wrong_references_and_gains_are_refused_with_2() {
    let desk = Desk::new();
    desk.write("back.csv", "time_s,reference_mm\n0,0\n1,1\n1,2\n");
    desk.write("unit.csv", "time_s,reference_furl\n0,0\n1,1\n");
    desk.write("angle.csv", "time_s,reference_deg\n0,0\n1,1\n");
    desk.write("bare.json", r#"{"axis":"linear","mass":1.0,"effects":[]}"#);
    for (line, parts) in [
        ("control --reference sine:5mm", vec!["'sine' takes 2: amplitude, frequency", "hint:"]),
        ("control --reference sine:5mm/s,1Hz", vec!["'mm/s'", "a length", "5mm"]),
        ("control --reference ramp:2rpm", vec!["'rpm'", "a speed", "0.1cm/s"]),
        ("control --reference jump:2", vec!["no reference 'jump'", "ramp:0.1cm/s"]),
        ("control --reference ramp:0", vec!["'0' is not a number above 0"]),
        ("control --reference none.csv", vec!["no such file", "none.csv"]),
        ("control --reference back.csv", vec!["must increase", "line 4"]),
        ("control --reference unit.csv", vec!["reference", "unit.csv"]),
        ("control --reference angle.csv", vec!["does not belong to an axis of this kind"]),
        ("control --kp 1e5", vec!["one of the gains", "--kp and --kd"]),
        ("control --kp nan --kd 1", vec!["--kp"]),
        ("control --duration 1e9", vec!["too many samples", "--duration"]),
        ("control --duration 0.01", vec!["samples", "--duration"]),
        ("control --robustness 120", vec!["below 100 %"]),
        ("control --model bare.json", vec!["nothing that a compensator could add"]),
        ("control --model none.json", vec!["cannot read the model"]),
    ] {
        desk.aep(line).refused(&parts);
    }
    let unstable = desk.aep("control --kp 1e8 --kd 1e6");
    assert_eq!(unstable.code, Some(1), "{}", unstable.err);
    assert!(unstable.err.contains("--kp and --kd"), "{}", unstable.err);
}

#[test]
fn the_exported_c_meets_its_own_vectors() {
    let desk = Desk::new();
    desk.write("plant.json", PLANT);
    let line = "export --model plant.json --to c drive --name x_axis --sample-time 0.001 --reference reversal:5mm/s,0.5s";
    assert!(desk.aep(line).done().contains("x_axis.h"));
    for name in ["x_axis.h", "x_axis.c", "x_axis_vectors.csv", "x_axis_test.c"] {
        assert!(desk.path("drive").join(name).exists(), "{name}");
    }
    let vectors = desk.read("drive/x_axis_vectors.csv");
    let header = "reference_m,reference_velocity_m_s,position_m,force_N";
    assert_eq!(vectors.lines().next(), Some(header));
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".into());
    let cc = |args: &[&str]| {
        std::process::Command::new(&compiler).args(args).current_dir(desk.path("drive")).output()
    };
    if !cc(&["--version"]).is_ok_and(|out| out.status.success()) {
        eprintln!(
            "SKIPPED: there is no C compiler '{compiler}', so that the exported C code was not compiled"
        );
        return;
    }
    let flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-ffp-contract=off"];
    let built =
        cc(&[&flags[..], &["x_axis.c", "x_axis_test.c", "-o", "t", "-lm"]].concat()).unwrap();
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let ran = std::process::Command::new(desk.path("drive").join("t"))
        .arg(desk.path("drive").join("x_axis_vectors.csv"))
        .output()
        .unwrap();
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stdout));
}

#[test]
fn a_model_is_exported_with_its_schema_and_read_again() {
    let desk = Desk::new();
    desk.write("plant.json", PLANT);
    desk.aep("export --model plant.json --to json -o exported.json").done();
    assert_eq!(desk.json("exported.json")["$schema"], "model.schema.json");
    desk.aep("control --model exported.json --reference ramp:1mm/s").done();
    desk.aep("export --to schema model.schema.json").done();
    let Some(published) = repository("friction-ident/schema/model.schema.json") else { return };
    let published: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(published).unwrap()).unwrap();
    assert_eq!(desk.json("model.schema.json"), published);
}

#[test]
fn exports_that_cannot_be_are_refused() {
    let desk = Desk::new();
    let lugre = r#"{"axis":"linear","mass":40.0,"effects":[
      {"effect":"coulomb","parameters":{"F_C":9.0}},
      {"effect":"presliding:lugre","parameters":{"k_t":5e6,"sigma_1":100.0}}]}"#;
    desk.write("lugre.json", lugre);
    desk.aep("export --to c").refused(&["PATH"]);
    desk.aep("export --to c drive --name 2nd").refused(&["'2nd' is no name in C"]);
    desk.aep("export --model lugre.json --to c drive")
        .refused(&["presliding:lugre", "--no-presliding"]);
    desk.aep("export --model lugre.json --to c drive --no-presliding").done();
}

#[test]
fn the_papers_control_figures_are_made_and_agree() {
    let desk = Desk::new();
    desk.aep("reproduce fig13 fig14 fig15 fig16 fig17 -o paper").done();
    let claims = desk.read("paper/claims.csv");
    for figure in ["fig13", "fig14", "fig15", "fig16", "fig17"] {
        assert!(desk.path("paper").join(format!("{figure}.svg")).exists());
        let rows: Vec<&str> = claims.lines().filter(|row| row.starts_with(figure)).collect();
        let agrees = |about: &str| {
            rows.iter().any(|row| row.contains(&format!(",{about},")) && row.contains(",agrees,"))
        };
        assert!(figure == "fig17" || agrees("PD alone"), "{rows:?}");
        assert!(figure == "fig16" || agrees("PD + compensation"), "{rows:?}");
    }
    let header = desk.read("paper/fig13.csv");
    assert!(header.starts_with("time_s,reference_cm,pd_cm,compensated_cm"), "{header}");
}
