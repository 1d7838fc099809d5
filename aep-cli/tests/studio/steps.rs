//! The loop without a browser: what each request does, and what the commands make of the files.

use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::server::{Server, aep, shared};

/// A test without a browser.
type Test = fn();

pub const TESTS: &[(&str, Test)] = &[
    ("from_a_file_to_the_effect_that_is_missing_and_back", whole),
    ("the_commands_read_what_the_studio_wrote", commands),
    ("what_is_fixed_stays_as_it_is", fixed),
    ("a_law_of_ones_own_is_drawn_and_added", law),
    ("a_killed_server_loses_nothing_but_the_fit_in_progress", killed),
    ("cancel_works_at_once_and_the_next_task_is_done", cancelled),
    ("a_riddle_is_guessed_and_counted", riddle),
    ("another_recording_begins_another_tree_and_files_stay", another),
    ("everything_can_be_taken_away", exports),
    ("the_compensator_is_simulated_on_any_plant_of_the_tree", compensated),
    ("what_is_left_is_told_beside_what_was_left_before", remains),
    ("what_was_brought_can_be_left_and_takes_nothing_from_the_models", left),
    ("a_model_of_ones_own_is_a_column", own_model),
    ("started_again_with_its_file_a_project_goes_on", goes_on),
    ("times_of_a_real_axis", times),
];

fn served() -> (tempfile::TempDir, Server) {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(&folder.path().join("p"), None);
    (folder, server)
}

fn model(state: &Value, id: usize) -> &Value {
    &state["models"][id]
}

fn times_of(state: &Value, id: usize) -> f64 {
    model(state, id)["times"].as_f64().unwrap()
}

fn whole() {
    let (_folder, server) = served();
    let state = server.example();
    assert_eq!(model(&state, 0)["effects"], json!(["coulomb", "viscous", "offset"]));
    let base = times_of(&state, 0);
    let state = server.task(&json!({"task": "suggest", "from": 0}));
    let best = &state["suggestions"]["rows"][0];
    assert_eq!((best["effect"].as_str(), best["likely"].as_bool()), (Some("stribeck"), Some(true)));
    let state = server.task(&json!({"task": "add", "from": 0, "effect": "stribeck"}));
    // The same numbers as those of `aep discover`: 1.36 before, 1.05 after.
    let with = times_of(&state, 1);
    assert!((base - 1.36).abs() < 0.01 && (with - 1.05).abs() < 0.01, "{base} {with}");
    assert_eq!((state["chosen"].as_u64(), model(&state, 1)["parent"].as_u64()), (Some(1), Some(0)));
    // Undone it is still there, and another branch stands beside it.
    server.post("/api/choose", &json!({"model": 0}));
    let state = server.task(&json!({"task": "add", "from": 0, "effect": "asymmetry"}));
    assert_eq!(state["models"].as_array().unwrap().len(), 3);
    assert!(times_of(&state, 2) > with, "the wrong effect explains less");
    // Both branches on one picture.
    let two = server.get("/api/course?of=2&with=1").json();
    let names: Vec<&str> =
        two["models"].as_array().unwrap().iter().map(|m| m["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["model 1: + stribeck", "model 2: + asymmetry"]);
    let path = server.get("/api/course?of=1").json();
    assert_eq!(path["models"].as_array().unwrap().len(), 2);
    let state = server.task(&json!({"task": "remove", "from": 1, "effect": "offset"}));
    assert_eq!(model(&state, 3)["effects"], json!(["coulomb", "viscous", "stribeck"]));
    let state = server.task(&json!({"task": "discover", "from": 0}));
    assert_eq!(state["said"]["verdict"], "Missing effect found");
    assert_eq!(model(&state, 4)["name"], "+ stribeck");
    assert!(state["said"]["summary"].as_str().unwrap().starts_with("Missing: stribeck."));
}

fn commands() {
    let (folder, server) = served();
    server.example();
    server.task(&json!({"task": "add", "from": 0, "effect": "stribeck"}));
    let at = |name: &str| folder.path().join("p").join(name).display().to_string();
    let said = aep(&[
        "compare",
        &at("data/recording.csv"),
        "--model",
        &at("models/0.json"),
        "--model",
        &at("models/1.json"),
    ]);
    assert!(said.contains("stribeck") || said.contains("force"), "{said}");
    let said = aep(&["suggest", &at("data/recording.csv"), "--model", &at("models/1.json")]);
    assert!(!said.contains("Try it:"), "nothing is missing any more: {said}");
    // No half of a file lies about.
    let mut rooms = vec![folder.path().join("p")];
    while let Some(room) = rooms.pop() {
        for entry in std::fs::read_dir(room).unwrap().flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            assert!(!name.starts_with(".tmp"), "{name}");
            if entry.path().is_dir() {
                rooms.push(entry.path());
            }
        }
    }
}

fn fixed() {
    let (folder, server) = served();
    server.example();
    let state = server.task(&json!({"task": "fix", "from": 0, "parameter": "mass", "value": 40.0}));
    let mass = |state: &Value, id: usize| {
        let all = model(state, id)["parameters"].as_array().unwrap().clone();
        all.into_iter().find(|p| p["name"] == "mass").unwrap()
    };
    assert_eq!(
        (mass(&state, 1)["number"].as_f64(), mass(&state, 1)["fixed"].as_bool()),
        (Some(40.0), Some(true))
    );
    assert!(times_of(&state, 1) > times_of(&state, 0), "another mass fits worse");
    // What is added to it keeps it.
    let state = server.task(&json!({"task": "add", "from": 1, "effect": "stribeck"}));
    assert_eq!(mass(&state, 2)["number"].as_f64(), Some(40.0));
    let text = std::fs::read_to_string(folder.path().join("p/models/2.json")).unwrap();
    let written: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(
        (&written["mass"], &written["known"]["fixed"]["mass"]),
        (&json!(40.0), &json!(40.0))
    );
    let state = server.task(&json!({"task": "fix", "from": 2, "parameter": "mass", "value": null}));
    assert!((times_of(&state, 3) - 1.05).abs() < 0.01, "free again: {}", times_of(&state, 3));
    let refused = json!({"task": "fix", "from": 0, "parameter": "mas", "value": 1.0});
    server.post("/api/task", &refused);
    assert!(server.idle()["failed"]["what"].as_str().unwrap().contains("mas"));
}

fn law() {
    let (folder, server) = served();
    server.example();
    let law = json!({
        "name": "hump", "force": "h*s/(1+(v/w)^2)",
        "parameters": {
            "h": {"unit": "N", "low": 0.0, "high": 50.0, "default": 4.0, "linear": true},
            "w": {"unit": "m/s", "low": 1e-4, "high": 0.1, "default": 0.002},
        },
    });
    let drawn = server.post("/api/law", &json!({"law": law, "from": 0}));
    assert_eq!(drawn["along"], "velocity");
    let law_at: Vec<f64> =
        drawn["law"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    let largest = law_at.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    assert!(largest > 0.5 && largest <= 4.0, "{largest}");
    assert_eq!(drawn["left"].as_array().unwrap().len(), law_at.len());
    server.post("/api/effect", &json!({"law": law, "from": 0}));
    let state = server.idle();
    assert!(state["failed"].is_null(), "{}", state["failed"]);
    assert!(times_of(&state, 1) < 0.9 * times_of(&state, 0), "it is nearly what is hidden");
    assert!(server.get("/api/effects").text().contains("\"hump\""));
    // One that has no value somewhere is refused and leaves nothing behind.
    let h = json!({"unit": "N", "low": 0.0, "high": 1.0, "default": 1.0, "linear": true});
    let pole = json!({"name": "pole", "force": "h/(x-x)", "parameters": {"h": h}});
    let body = json!({"law": pole, "from": 0}).to_string();
    let refused = server.post_bytes("/api/effect", body.as_bytes());
    assert!(refused.status == 400 && refused.text().contains("pole"), "{}", refused.text());
    assert!(!folder.path().join("p/effects/pole.toml").exists());
    assert_eq!(server.get("/api/course?of=1").status, 200);
    let at = |name: &str| folder.path().join("p").join(name).display().to_string();
    aep(&[
        "compare",
        &at("data/recording.csv"),
        "--model",
        &at("models/1.json"),
        "--effects-file",
        &at("effects/hump.toml"),
    ]);
    // A later server knows it, too.
    drop(server);
    let server = Server::start(&folder.path().join("p"), None);
    assert_eq!(server.get("/api/course?of=1").status, 200);
}

fn killed() {
    let (folder, server) = served();
    server.example();
    server.task(&json!({"task": "add", "from": 0, "effect": "asymmetry"}));
    let before = server.state();
    let asked = json!({"task": "discover", "from": 1});
    server.post("/api/task", &asked);
    // In the middle of it: the first step was told, the task is not over.
    let began = Instant::now();
    loop {
        let job = server.state()["job"].clone();
        assert!(!job.is_null(), "over too soon");
        if job["message"].as_str().is_some_and(|message| message.contains("candidates")) {
            break;
        }
        assert!(began.elapsed() < Duration::from_mins(1));
    }
    server.kill();
    let server = Server::start(&folder.path().join("p"), None);
    let after = server.state();
    for kept in ["data", "models", "chosen", "hold"] {
        assert_eq!(before[kept], after[kept], "{kept}");
    }
    assert_eq!(after["interrupted"]["task"], asked);
    // It is offered, and done when it is wanted.
    let state = server.task(&after["interrupted"]["task"]);
    assert!(state["interrupted"].is_null() && !state["said"].is_null());
    assert!(state["models"].as_array().unwrap().len() > 2);
}

fn cancelled() {
    let (_folder, server) = served();
    server.example();
    server.post("/api/task", &json!({"task": "discover", "from": 0}));
    assert!(!server.state()["job"].is_null());
    let began = Instant::now();
    server.post("/api/cancel", &json!({}));
    let state = server.state();
    assert!(state["job"].is_null() && state["interrupted"].is_null());
    println!("cancelled after {:?}", began.elapsed());
    let state = server.task(&json!({"task": "add", "from": 0, "effect": "stribeck"}));
    assert_eq!(state["models"].as_array().unwrap().len(), 2, "what was cancelled brought nothing");
    // Nor does it later.
    std::thread::sleep(Duration::from_secs(3));
    assert_eq!(server.state()["models"], state["models"]);
}

fn riddle() {
    let (folder, server) = served();
    server.post("/api/riddle", &json!({"size": "clear"}));
    let state = server.idle();
    assert!(state["failed"].is_null(), "{}", state["failed"]);
    let told = state.to_string() + &server.get("/api/data").text();
    assert!(state["riddle"]["hidden"].is_null() && state["riddle"]["seed"].is_null(), "{told}");
    let truth: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("p/truth.json")).unwrap())
            .unwrap();
    let hidden = truth["hidden"].as_str().unwrap_or("nothing");
    let wrong = if hidden == "drift" { "stribeck" } else { "drift" };
    server.post("/api/guess", &json!({"effect": wrong}));
    let state = server.state();
    assert_eq!((state["riddle"]["left"].as_u64(), state["points"].as_u64()), (Some(2), Some(0)));
    server.post("/api/guess", &json!({"effect": hidden}));
    let state = server.state();
    assert_eq!(
        (state["riddle"]["hidden"].as_str(), state["points"].as_u64()),
        (Some(hidden), Some(2))
    );
    // Another one is worth three again; given up it is worth nothing.
    server.post("/api/riddle", &json!({"size": "moderate"}));
    server.idle();
    server.post("/api/guess", &json!({"effect": null}));
    let state = server.state();
    assert_eq!((state["riddle"]["points"].as_u64(), state["points"].as_u64()), (Some(0), Some(2)));
}

fn another() {
    let (folder, server) = served();
    server.example();
    server.task(&json!({"task": "add", "from": 0, "effect": "stribeck"}));
    let first = std::fs::read(folder.path().join("p/models/1.json")).unwrap();
    // The same name again: the recording of the models stays as it is.
    server.post("/api/example", &json!({}));
    let state = server.state();
    assert_eq!(
        (state["data"].as_str(), state["brought"].as_str()),
        (Some("recording.csv"), Some("2-recording.csv"))
    );
    assert_eq!(state["models"].as_array().unwrap().len(), 2);
    server.post("/api/take", &json!({"mapping": {"hold": "zero-order"}, "effects": ["coulomb"]}));
    let state = server.idle();
    assert_eq!(
        (state["models"].as_array().unwrap().len(), state["models"][0]["id"].as_u64()),
        (1, Some(2))
    );
    assert_eq!(state["models"][0]["effects"], json!(["coulomb"]));
    assert_eq!(std::fs::read(folder.path().join("p/models/1.json")).unwrap(), first);
    assert!(folder.path().join("p/studio-before-2.json").is_file());
}

fn exports() {
    let (folder, server) = served();
    server.example();
    server.task(&json!({"task": "add", "from": 0, "effect": "stribeck"}));
    for form in ["report", "series", "c", "modelica", "mjcf", "urdf"] {
        server.task(&json!({"task": "export", "from": 1, "form": form}));
    }
    let state = server.state();
    let files: Vec<&str> =
        state["files"].as_array().unwrap().iter().map(|f| f["path"].as_str().unwrap()).collect();
    for file in [
        "exports/report-1.html",
        "exports/series-1.csv",
        "exports/c-1/compensator.c",
        "exports/model-1.xml",
        "exports/model_1.mo",
        "exports/model-1.urdf",
    ] {
        assert!(files.contains(&file), "{file} is not in {files:?}");
        let got = server.get(&format!("/api/file?path={file}"));
        assert_eq!(got.body, std::fs::read(folder.path().join("p").join(file)).unwrap());
        assert!(
            got.head.to_lowercase().contains("content-disposition: attachment"),
            "{}",
            got.head
        );
    }
    let page = server.get("/api/file?path=exports/report-1.html").text();
    assert!(page.contains("class=course") && page.contains("+ stribeck"));
    let head = server.get("/api/file?path=exports/series-1.csv").text();
    assert!(
        head.lines().next().unwrap().contains("1_stribeck."),
        "{}",
        head.lines().next().unwrap()
    );
    let state = server
        .task(&json!({"task": "experiment", "from": 0, "effects": ["stribeck", "asymmetry"]}));
    assert!(state["motion"]["position"].as_array().unwrap().len() > 100);
    let motion = state["motion"]["file"].as_str().unwrap();
    assert!(
        server.get(&format!("/api/file?path={motion}")).text().starts_with("time_s,position_m")
    );
}

fn compensated() {
    let (folder, server) = served();
    server.example();
    server.task(&json!({"task": "add", "from": 0, "effect": "stribeck"}));
    assert!(server.get("/api/control").json()["html"].is_null());
    let reference = "reversal:1mm/s,2s";
    let control = |from: u32, plant: u32| {
        let asked =
            json!({"task": "control", "from": from, "plant": plant, "reference": reference});
        server.task(&asked)["control"]["said"].as_str().unwrap().to_owned()
    };
    let error = |from: u32, plant: u32| {
        let said = control(from, plant);
        assert!(said.contains("% less RMS error"), "{said}");
        let at = |name: &str| folder.path().join("p/models").join(name).display().to_string();
        // The command says the same of the same files.
        let (model, plant) = (at(&format!("{from}.json")), at(&format!("{plant}.json")));
        let words = ["control", "--model", &model, "--plant", &plant, "--reference", reference];
        let told = aep(&words);
        let less = said.split(". ").last().unwrap();
        assert!(told.contains(less), "{said}: {told}");
        told.lines().find(|line| line.contains("RMS tracking error")).unwrap().to_owned()
    };
    // A plant that has the effect is followed better with the compensator that has it.
    assert_ne!(error(0, 1), error(1, 1));
    let card = server.get("/api/control").json()["html"].as_str().unwrap().to_owned();
    assert!(card.contains("PD + compensation") && card.matches("<figure").count() == 3);
    let page = server.get("/api/file?path=exports/control-1-1.html").text();
    assert!(page.contains("Friction compensation, simulated") && page.contains("data-plot="));
    // No file is read, whatever it is called.
    for refused in ["/etc/passwd", "../../x.csv", "sine:5mm", "ramp:1e-9m/s,2", "sine:1mm,1e-9Hz"] {
        server.post("/api/task", &json!({"task": "control", "from": 0, "reference": refused}));
        assert!(!server.idle()["failed"]["what"].is_null(), "{refused}");
    }
    server.post("/api/task", &json!({"task": "control", "from": 0, "plant": 9}));
    assert!(server.idle()["failed"]["what"].as_str().unwrap().contains("no model 9"));
}

fn remains() {
    let (_folder, server) = served();
    server.example();
    server.task(&json!({"task": "add", "from": 0, "effect": "stribeck"}));
    let html = |query: &str| {
        let answer = server.get(&format!("/api/remains?{query}")).json();
        answer["html"].as_str().unwrap().to_owned()
    };
    let (alone, both) = (html("of=0"), html("of=1"));
    assert!(alone.contains("Autocorrelation of the residual") && alone.contains("class=\"band"));
    assert!(!alone.contains("base model") && both.contains("base model"));
    assert!(both.contains("Of the force along the measured motion: The residual is"), "{both}");
    assert_ne!(html("of=0&with=1"), both);
    assert_eq!(server.get("/api/remains?of=7").status, 400);
}

fn left() {
    let (folder, server) = served();
    server.example();
    let models = server.state()["models"].clone();
    let beside = folder.path().join("p/data/recording.toml");
    let read = std::fs::read_to_string(&beside).unwrap();
    // Of the same name with another ending: how the models' recording is read is not its own.
    assert_eq!(server.post_bytes("/api/upload?name=recording.mat", b"no such thing").status, 200);
    assert_eq!(server.get("/api/preview").status, 400);
    assert_eq!(std::fs::read_to_string(&beside).unwrap(), read);
    server.post("/api/leave", &json!({}));
    let state = server.state();
    assert_eq!((&state["brought"], &state["models"]), (&Value::Null, &models));
    assert_eq!(server.get("/api/course?of=0").status, 200);
}

fn own_model() {
    let (_folder, server) = served();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/model_force.csv");
    assert_eq!(
        server.post_bytes("/api/upload?name=own.csv", &std::fs::read(file).unwrap()).status,
        200
    );
    let seen = server.get("/api/preview").json();
    let names: Vec<&str> =
        seen["columns"].as_array().unwrap().iter().map(|c| c["name"].as_str().unwrap()).collect();
    let own = names.iter().find(|name| name.contains("model")).unwrap();
    server.post("/api/take", &json!({"mapping": {"model_force": {"column": own}}}));
    let state = server.idle();
    assert!(state["failed"].is_null(), "{}", state["failed"]);
    assert_eq!(model(&state, 0)["effects"], json!([]), "nothing of ours is in it");
    let state = server.task(&json!({"task": "suggest", "from": 0}));
    let best = state["suggestions"]["rows"][0]["effect"].as_str().unwrap().to_owned();
    let state = server.task(&json!({"task": "add", "from": 0, "effect": best}));
    assert!(times_of(&state, 1) < times_of(&state, 0));
    assert_eq!(server.get("/api/course?of=1").status, 200);
}

fn goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let (data, project) = (folder.path().join("run.csv"), folder.path().join("p"));
    std::fs::write(&data, "time_s,force_N,position_m\n".to_owned() + &crate::attacks::rows(4000))
        .unwrap();
    std::fs::write(folder.path().join("run.toml"), "hold = \"sampled\"\n").unwrap();
    let server = Server::start(&project, Some(&data));
    assert_eq!(server.get("/api/preview").json()["mapping"]["hold"], "sampled");
    server.post("/api/take", &json!({"mapping": {"hold": "sampled"}}));
    let models = server.idle()["models"].clone();
    assert_eq!(models.as_array().unwrap().len(), 1);
    drop(server);
    let state = Server::start(&project, Some(&data)).state();
    assert_eq!((&state["models"], &state["brought"]), (&models, &Value::Null));
    let run = std::process::Command::new(env!("CARGO_BIN_EXE_aep"))
        .args(["studio", "--no-open", "nowhere.csv"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_eq!(run.status.code(), Some(2), "{}", String::from_utf8_lossy(&run.stderr));
    assert!(!folder.path().join("nowhere-studio").exists());
}

/// From "add" to the new error, and the whole ladder, on 25,000 samples.
fn times() {
    let Some(data) = shared("emps/DATA_EMPS.mat") else { return };
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(&folder.path().join("p"), Some(Path::new(&data)));
    let timed = |what: &str, act: &dyn Fn() -> Value| {
        let began = Instant::now();
        let state = act();
        println!("EMPS: {what}: {:.2} s", began.elapsed().as_secs_f64());
        state
    };
    let state = timed("reading and fitting the base model", &|| {
        server.post("/api/take", &json!({"mapping": {}}));
        server.idle()
    });
    assert!((times_of(&state, 0) - 1.74).abs() < 0.01, "{}", times_of(&state, 0));
    let state = timed("adding asymmetry", &|| {
        server.task(&json!({"task": "add", "from": 0, "effect": "asymmetry"}))
    });
    assert!((times_of(&state, 1) - 1.65).abs() < 0.01, "{}", times_of(&state, 1));
    timed("the pictures of both models", &|| server.get("/api/course?of=1").json());
    timed("trying every effect", &|| server.task(&json!({"task": "suggest", "from": 1})));
    let state = timed("all of the ladder, unaided", &|| {
        server.task(&json!({"task": "discover", "from": 0}))
    });
    let added: Vec<&str> = state["models"].as_array().unwrap()[2..]
        .iter()
        .map(|m| m["name"].as_str().unwrap())
        .collect();
    println!("EMPS: {added:?}");
    assert!(added.contains(&"+ asymmetry"), "{added:?}");
}
