//! What is made of the arguments, and the commands that the READMEs tell.

use crate::harness::{Desk, repository};

/// Every command, from the program's own help.
fn commands(desk: &Desk) -> Vec<String> {
    let help = desk.aep("--help");
    let list = help.done().split("Commands:").nth(1).unwrap().split("\n\n").next().unwrap();
    // Wrapped descriptions are indented further than the names.
    let names = list.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    names.filter_map(|line| line.split_whitespace().next()).map(str::to_owned).collect()
}

#[test]
fn every_shell_gets_completions_of_every_command() {
    let desk = Desk::new();
    let commands = commands(&desk);
    assert!(commands.len() > 10, "{commands:?}");
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = desk.aep(&format!("completions {shell}"));
        for command in &commands {
            assert!(script.done().contains(command), "{shell}: {command}");
        }
        assert!(script.done().contains("time-limit"), "{shell}");
    }
    desk.aep("completions cmd").refused(&["cmd", "possible values", "bash"]);
}

#[cfg(unix)]
#[test]
fn bash_takes_its_completions() {
    let desk = Desk::new();
    desk.write("aep.bash", desk.aep("completions bash").done());
    let complete = "source aep.bash; COMP_WORDS=(aep disc); COMP_CWORD=1; \
                    _aep aep disc aep; echo \"${COMPREPLY[@]}\"";
    let mut bash = std::process::Command::new("bash");
    let Ok(output) = bash.args(["-c", complete]).current_dir(desk.path("")).output() else {
        eprintln!("skipped: there is no bash");
        return;
    };
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), "discover");
}

#[test]
fn every_command_has_a_manual_page_with_its_flags() {
    let desk = Desk::new();
    assert!(desk.aep("man").done().contains(".TH aep 1"));
    desk.aep("man --dir pages").done();
    for command in commands(&desk).iter().filter(|command| *command != "help") {
        let page = desk.read(&format!("pages/aep-{command}.1"));
        assert!(page.contains(&format!(".TH aep-{command} 1")), "{command}");
        assert!(page.contains("threads"), "{command} lacks the flags of every command");
    }
    assert!(desk.read("pages/aep-discover.1").contains("time\\-limit"));
    desk.write("taken", "");
    desk.aep("man --dir taken").refused(&["taken", "folder"]);
}

#[test]
fn what_the_readmes_tell_to_type_is_understood() {
    let desk = Desk::new();
    for readme in ["aep-cli/README.md", "README.md"] {
        let Some(path) = repository(readme) else { continue };
        let text = std::fs::read_to_string(path).unwrap().replace("\\\n", " ");
        let lines: Vec<&str> = text.lines().filter(|line| line.starts_with("aep ")).collect();
        assert!(lines.len() > 5, "{readme}");
        for line in lines {
            let typed = line.split('#').next().unwrap();
            let command = typed.split_whitespace().nth(1).unwrap();
            let help = desk.aep(&format!("{command} --help"));
            for flag in typed.split_whitespace().filter(|word| word.starts_with("--")) {
                assert!(help.done().contains(flag), "{readme}: {line}: there is no {flag}");
            }
        }
    }
}
