//! Models for other simulators: what the files hold. `.ci/simulators` runs them in `FMPy`, `MuJoCo` and `Rumoca`.

use std::io::Read as _;

use crate::harness::Desk;

/// A model as `aep discover` writes it.
const MODEL: &str = r#"{"axis":"linear","mass":40.0,"effects":[
  {"effect":"coulomb","parameters":{"F_C":9.0}},
  {"effect":"viscous","parameters":{"F_v":200.0}},
  {"effect":"stribeck","parameters":{"dF":3.0,"v_s":0.002}}]}"#;

fn archive(desk: &Desk, name: &str) -> zip::ZipArchive<std::fs::File> {
    zip::ZipArchive::new(std::fs::File::open(desk.path(name)).unwrap()).unwrap()
}

fn names(archive: &zip::ZipArchive<std::fs::File>) -> Vec<String> {
    archive.file_names().map(|name| name.unwrap().into_owned()).collect()
}

#[test]
fn an_fmu_holds_its_description_its_sources_and_a_binary_where_there_is_a_compiler() {
    let desk = Desk::new();
    desk.write("model.json", MODEL);
    let run = desk.aep("export --model model.json --to fmu x_axis.fmu");
    let said = run.done().to_owned();
    assert!(said.contains("expressed: mass, coulomb, viscous, stribeck\n"), "{said}");
    let mut fmu = archive(&desk, "x_axis.fmu");
    let names = names(&fmu);
    for name in ["modelDescription.xml", "sources/fmi2.c", "sources/plant.c", "sources/plant.h"] {
        assert!(names.iter().any(|n| n == name), "{name} is not among {names:?}");
    }
    let binary = names.iter().any(|name| name.starts_with("binaries/"));
    assert_eq!(binary, said.contains("binary: binaries/"), "{said}");
    assert!(binary || said.contains("no binary: "), "{said}");
    let mut description = String::new();
    fmu.by_name("modelDescription.xml").unwrap().read_to_string(&mut description).unwrap();
    for part in ["modelIdentifier=\"x_axis\"", "name=\"stribeck.v_s\"", "start=\"2e-3\""] {
        assert!(description.contains(part), "{part}: {description}");
    }
}

#[test]
fn the_same_model_makes_the_same_fmu_to_the_byte() {
    let desk = Desk::new();
    desk.write("model.json", MODEL);
    for name in ["a.fmu", "b.fmu"] {
        let line = format!("export --model model.json --to fmu {name} --name x_axis --source-only");
        assert!(desk.aep(&line).done().contains("no binary: left out, as asked"));
    }
    let bytes = |name: &str| std::fs::read(desk.path(name)).unwrap();
    assert_eq!(bytes("a.fmu"), bytes("b.fmu"));
    assert!(!names(&archive(&desk, "a.fmu")).iter().any(|name| name.starts_with("binaries")));
}

#[test]
fn what_a_simulator_cannot_express_is_told_on_the_terminal_and_in_the_file() {
    let desk = Desk::new();
    desk.write("model.json", MODEL);
    for (form, name) in [("mjcf", "drive.xml"), ("urdf", "drive.urdf")] {
        let run = desk.aep(&format!("export --model model.json --to {form} {name}"));
        assert!(run.done().contains("left out: stribeck: "), "{}", run.out);
        let text = desk.read(name);
        assert!(text.contains("Left out: stribeck: "), "{text}");
        assert!(text.contains("joint name=\"drive\""), "{text}");
    }
}

#[test]
fn a_modelica_model_says_all_of_the_model_and_a_free_curve_is_left_out() {
    let desk = Desk::new();
    desk.write("model.json", MODEL);
    let run = desk.aep("export --model model.json --to modelica Drive.mo");
    assert!(run.done().contains("expressed: mass, coulomb, viscous, stribeck\n"), "{}", run.out);
    assert!(!run.out.contains("left out"), "{}", run.out);
    let text = desk.read("Drive.mo");
    assert!(text.contains("model Drive ") && text.contains("end Drive;"), "{text}");
    assert!(text.contains("stribeck_v_s(unit=\"m/s\") = 0.002"), "{text}");
    let free = MODEL.replace("]}", ",{\"effect\":\"presliding:free\",\"parameters\":{\"d\":5e-6,\"w_0\":0.3,\"w_1\":0.3,\"w_2\":0.3,\"w_4\":0.3,\"sigma_1\":1000.0}}]}");
    desk.write("free.json", free);
    let run = desk.aep("export --model free.json --to modelica Drive.mo");
    assert!(run.done().contains("left out: presliding:free: "), "{}", run.out);
    assert!(desk.read("Drive.mo").contains("// Left out: presliding:free: "));
    desk.aep("export --model model.json --to modelica model.mo").refused(&["'model'", "--name"]);
}

#[test]
fn what_cannot_be_exported_is_refused_and_writes_nothing() {
    let desk = Desk::new();
    desk.write("model.json", MODEL);
    desk.write("volts.json", MODEL.replace("\"mass\"", "\"effort\":\"V\",\"mass\""));
    desk.write("own.toml", "name = \"bump\"\nforce = \"a*x\"\n\n[parameters]\na = { unit = \"V\", low = -1.0, high = 1.0, default = 0.1, linear = true }\n");
    desk.write(
        "own.json",
        MODEL.replace("\"stribeck\"", "\"bump\"").replace("\"dF\":3.0,\"v_s\":0.002", "\"a\":1.0"),
    );
    desk.aep("export --model volts.json --to mjcf drive.xml").refused(&["in V", "--force-gain"]);
    desk.aep("export --model volts.json --to urdf drive.urdf").refused(&["in V", "URDF"]);
    desk.aep("export --model volts.json --to fmu volts.fmu --source-only").done();
    desk.aep("export --model own.json --effects-file own.toml --to fmu own.fmu")
        .refused(&["'bump' is not written in C"]);
    desk.aep("export --model model.json --to fmu -").refused(&["archive"]);
    desk.aep("export --model model.json --to fmu x.fmu --max-step 0").refused(&["above 0"]);
    desk.aep("export --model model.json --to mjcf x.xml --name 2nd").refused(&["'2nd'"]);
    for name in ["drive.xml", "drive.urdf", "own.fmu", "x.fmu", "x.xml"] {
        assert!(!desk.path(name).exists(), "{name}");
    }
}
