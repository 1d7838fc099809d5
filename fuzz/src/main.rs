//! Looks for inputs that panic, hang or need too much memory. One that ends the process stands in `fuzz-TARGET-last` in the
//! system's folder for temporary files.

use std::time::Duration;

use clap::Parser;
use fuzz::{ALL, Campaign, Limits, Target, find, hushed, kept};

/// Mutated inputs for every way in; what is found goes into fuzz/corpus.
#[derive(Parser)]
struct Arguments {
    /// Targets; all of them where none is named.
    targets: Vec<String>,
    /// Time for each, minutes.
    #[arg(long, default_value_t = 1.0)]
    minutes: f64,
    /// Seed of the mutations.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    let targets: Vec<&'static Target> = if arguments.targets.is_empty() {
        ALL.iter().collect()
    } else {
        arguments.targets.iter().map(|name| find(name)).collect::<anyhow::Result<_>>()?
    };
    let time = Duration::try_from_secs_f64(60.0 * arguments.minutes)?;
    hushed();
    println!("{:<12} {:>12} {:>9} {:>9}", "target", "executions", "outcomes", "findings");
    let mut found = false;
    for target in targets {
        let last = std::env::temp_dir().join(format!("fuzz-{}-last", target.name));
        let campaign =
            Campaign::new(target, Limits::default()).keeping_last(std::fs::File::create(&last)?);
        let ended = campaign.run(arguments.seed, |_, spent| spent >= time);
        std::fs::remove_file(&last)?;
        println!(
            "{:<12} {:>12} {:>9} {:>9}",
            target.name,
            ended.executions,
            ended.outcomes,
            ended.findings.len()
        );
        for finding in &ended.findings {
            let path = kept(target, &finding.input);
            std::fs::create_dir_all(fuzz::corpus(target))?;
            std::fs::write(&path, &finding.input)?;
            println!("  {:?}: {}", finding.cause, path.display());
            found = true;
        }
    }
    anyhow::ensure!(!found, "there are findings");
    Ok(())
}
