//! What was found once is found no more, and a few new inputs of each kind do no harm.

use fuzz::{ALL, Campaign, Limits, hushed, read};

/// New inputs of each target.
const EXECUTIONS: u64 = 300;

#[test]
fn kept_and_new_inputs_do_what_they_may() {
    hushed();
    let mut failed = Vec::new();
    for target in &ALL {
        let campaign = Campaign::new(target, Limits::default());
        for seed in (target.seeds)() {
            let outcome = campaign.tried(&seed);
            assert!(outcome.is_ok(), "{}: {outcome:?}", target.name);
        }
        for (path, input) in read(target) {
            if let Err(cause) = campaign.tried(&input) {
                failed.push(format!("{}: {cause:?}", path.display()));
            }
        }
        let ended = campaign.run(1, |executions, _| executions >= EXECUTIONS);
        // Mutations come somewhere.
        assert!(ended.outcomes > 2, "{}: {}", target.name, ended.outcomes);
        failed.extend(ended.findings.iter().map(|f| format!("{}: {:?}", target.name, f.cause)));
    }
    let _ = std::panic::take_hook();
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn what_none_may_do_is_a_finding() {
    use fuzz::{Cause, Target};
    use std::time::Duration;

    static TARGET: Target = Target::new(
        "test",
        || vec![b"abc".to_vec()],
        |input| match input {
            b"panic" => panic!("as asked"),
            b"hang" => loop {
                std::thread::sleep(Duration::from_secs(1));
            },
            b"memory" => vec![1u8; 64 << 20].len().to_string(),
            _ => String::new(),
        },
    );
    let limits = Limits { time: Duration::from_millis(500), memory: 1 << 20, times: 1 };
    let campaign = Campaign::new(&TARGET, limits);
    assert_eq!(campaign.tried(b"abc"), Ok(String::new()));
    assert!(matches!(campaign.tried(b"panic"), Err(Cause::Panic(_))));
    assert_eq!(campaign.tried(b"memory"), Err(Cause::Memory));
    assert_eq!(campaign.tried(b"hang"), Err(Cause::Hang));
}
