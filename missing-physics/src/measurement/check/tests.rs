use super::*;

/// 10 s at 1 kHz: a sine of 2 s in counts of 1 µm, a force with Coulomb friction.
fn recording() -> Recording {
    from(|k| f64::from(k) * 1e-3, |force| force)
}

fn from(time: impl Fn(u32) -> f64, force: impl Fn(f64) -> f64) -> Recording {
    // Half a sample off, so that no sample falls on a change of direction.
    let phase = |k: u32| std::f64::consts::PI * (f64::from(k) + 0.5) * 1e-3;
    let times: Vec<f64> = (0..10_000).map(time).collect();
    let position = (0..10_000).map(|k| (0.05 * phase(k).sin() / 1e-6).round() * 1e-6).collect();
    let forces = (0..10_000)
        .map(|k| {
            let noise = f64::from((k * 7919) % 1000) / 1000.0 - 0.5;
            force(20.0 * phase(k).cos().signum() + 5.0 * phase(k).cos() + noise)
        })
        .collect();
    let channels =
        vec![Channel::new("force", "N", forces), Channel::new("position", "m", position)];
    Recording::new("sine", times, channels).unwrap()
}

#[test]
fn a_good_recording_has_no_warnings() {
    let check = check(&recording());
    assert!(check.findings.iter().all(|f| f.severity() == Severity::Info), "{:?}", check.findings);
    assert_eq!((check.samples, check.segments), (10_000, 1));
    assert!((check.sampling.interval_s - 1e-3).abs() < 1e-9);
    assert!(check.sampling.jitter < 1e-6);
    let quantum = check.channel("position").unwrap().quantum.unwrap();
    assert!((quantum / 1e-6 - 1.0).abs() < 1e-3);
    assert_eq!(check.channel("force").unwrap().quantum, None);
}

#[test]
fn speeds_and_changes_of_direction_are_counted() {
    let speed = check(&recording()).speed.unwrap();
    assert!((speed.top / (0.05 * std::f64::consts::PI) - 1.0).abs() < 0.02, "{}", speed.top);
    assert_eq!(speed.reversals, 10);
    assert!((speed.forward_share - speed.backward_share).abs() < 0.05);
}

#[test]
fn a_repeated_motion_tells_how_well_the_force_repeats() {
    let cycle = check(&recording()).cycle.unwrap();
    assert_eq!((cycle.samples, cycle.cycles), (2000, 5));
    // The noise has a period of 1000 samples: it repeats with the motion.
    assert!(cycle.force_repeatability.unwrap() < 1e-9);
}

#[test]
fn gaps_and_jitter_are_warned_of() {
    let gap = check(&from(|k| f64::from(k) * 1e-3 + if k > 5000 { 0.5 } else { 0.0 }, |f| f));
    assert_eq!(gap.sampling.gaps.len(), 1);
    assert!((gap.sampling.gaps[0].at_s - 5.0).abs() < 1e-9);
    let longest = gap.sampling.gaps[0].clone();
    // First, as it is the worst.
    assert_eq!(gap.findings[0], Finding::Gaps { count: 1, longest, ends_a_segment: true });
    assert_eq!(gap.findings[0].severity(), Severity::Warning);
    let shaky = check(&from(|k| (f64::from(k) + 0.4 * f64::from(k % 2)) * 1e-3, |f| f));
    let jitter = |finding: &Finding| matches!(finding, Finding::Jitter { jitter, .. } if (jitter - 0.4).abs() < 0.1);
    assert!(shaky.findings.iter().any(jitter), "{:?}", shaky.findings);
}

#[test]
fn clipping_and_a_dead_channel_are_warned_of() {
    let clipped = check(&from(|k| f64::from(k) * 1e-3, |force| force.clamp(-22.0, 100.0)));
    let held = |finding: &Finding| matches!(finding, Finding::Clipped { channel, level, .. } if channel == "force" && *level == -22.0);
    assert!(clipped.findings.iter().any(held), "{:?}", clipped.findings);
    let dead = check(&from(|k| f64::from(k) * 1e-3, |_| 3.0));
    let constant = |channel: &str, value, unit: &str| Finding::Constant {
        channel: channel.into(),
        value,
        unit: unit.into(),
        needed: true,
    };
    assert_eq!(dead.findings[0], constant("force", 3.0, "N"));
    assert_eq!(dead.findings[0].severity(), Severity::Serious);
}

#[test]
fn a_motion_in_one_direction_is_warned_of() {
    let time: Vec<f64> = (0..500).map(|k| f64::from(k) * 0.01).collect();
    let channels = vec![
        Channel::new("force", "N", time.iter().map(|t| t.sin()).collect()),
        Channel::new("position", "m", time.clone()),
    ];
    let check = check(&Recording::new("ramp", time, channels).unwrap());
    assert_eq!(check.findings[0], Finding::OneDirection);
    assert_eq!(check.cycle, None);
}

#[test]
fn the_smallest_recording_is_no_problem() {
    let time: Vec<f64> = (0..16).map(f64::from).collect();
    let zeros = vec![Channel::new("position", "m", vec![0.0; 16])];
    let check = check(&Recording::new("rest", time.clone(), zeros).unwrap());
    let still = |f: &Finding| matches!(f, Finding::Constant { value: 0.0, needed: true, .. });
    assert!(check.findings.iter().any(still), "{:?}", check.findings);
    // One sample a segment: no interval at all.
    let alone: Vec<i64> = (0..16).collect();
    let channels = vec![Channel::new("position", "m", time.clone())];
    let recording = Recording::with_segments("dots", time, channels, alone).unwrap();
    assert_eq!(super::check(&recording).sampling.duration_s, 0.0);
}

#[test]
fn a_force_that_takes_energy_out_of_the_axis_has_the_wrong_sign() {
    let negative = |recording: &Recording| {
        let findings = check(recording).findings;
        findings.iter().any(|finding| matches!(finding, Finding::NegativeWork { .. }))
    };
    let time = |k| f64::from(k) * 1e-3;
    assert!(!negative(&recording()));
    assert!(negative(&from(time, |force| -force)));
    // Mostly inertia: the work of 20 ms of delay is more than that of the friction, but nothing is turned.
    let axis = |delay: f64, sign: f64| {
        let angle = |k: u32, late: f64| 6.0 * (time(k) - late);
        let position = (0..10_000).map(|k| 0.02 * angle(k, 0.0).sin()).collect();
        let force =
            |k| sign * (-30.0 * angle(k, delay).sin() + 2.0 * angle(k, delay).cos().signum());
        let force = (0..10_000).map(force).collect();
        let channels =
            vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
        Recording::new("axis", (0..10_000).map(time).collect(), channels).unwrap()
    };
    assert!(!negative(&axis(0.0, 1.0)) && !negative(&axis(0.02, 1.0)));
    assert!(negative(&axis(0.0, -1.0)));
}

#[test]
fn millimetres_that_are_read_as_metres_are_asked_about() {
    let check = check(&{
        let recording = recording();
        let position = recording.channel("position").unwrap().values.iter().map(|x| 1e3 * x);
        let channels = vec![Channel::new("position", "m", position.collect())];
        Recording::new("mm", recording.time().to_vec(), channels).unwrap()
    });
    assert!(
        matches!(&check.findings[0], Finding::Fast { top, unit } if *top > 100.0 && unit == "m/s")
    );
}
