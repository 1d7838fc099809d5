//! How a line of a spectrum is called.

use missing_physics::measurement::quantity::{number, quantity};
use missing_physics::report::{Line, LineOf, Relation};

/// Its name: `50.0 Hz` over time, `period 2.50 mm` along a coordinate.
pub fn line(line: &Line) -> String {
    name(&line.along, line.period, &line.unit)
}

/// What it has to do with another line: `1/2 of period 5.00 mm`; empty where it has nothing.
pub fn relation(line: &Line) -> String {
    let other = |of: &LineOf| name(&of.along, of.period, &of.unit);
    match &line.relation {
        None => String::new(),
        Some(Relation::StrongerAlong { coordinate }) => format!("stronger along {coordinate}"),
        Some(Relation::Harmonic { order, of }) => format!("1/{order} of {}", other(of)),
        Some(Relation::SeenAt { of, rate, unit }) => {
            format!("{} seen at {}", other(of), quantity(*rate, unit))
        }
    }
}

fn name(along: &str, period: f64, unit: &str) -> String {
    if along == "time" {
        format!("{} Hz", number(1.0 / period))
    } else {
        format!("period {}", quantity(period, unit))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(relation: Option<Relation>) -> Line {
        Line {
            along: "time".into(),
            period: 0.02,
            unit: "s".into(),
            amplitude: 1.0,
            p_value: 0.001,
            relation,
        }
    }

    #[test]
    fn a_line_is_called_by_frequency_over_time_and_by_period_along_the_stroke() {
        assert_eq!(line(&seen(None)), "50.0 Hz");
        let along =
            Line { along: "position".into(), period: 2.5e-3, unit: "m".into(), ..seen(None) };
        assert_eq!(line(&along), "period 2.50 mm");
    }

    #[test]
    fn every_relation_has_its_words() {
        let of = LineOf { along: "position".into(), period: 2.5e-3, unit: "m".into() };
        let told = |known| relation(&seen(Some(known)));
        let seen_at = Relation::SeenAt { of: of.clone(), rate: 0.125, unit: "m/s".into() };
        assert_eq!(told(seen_at), "period 2.50 mm seen at 125 mm/s");
        assert_eq!(told(Relation::Harmonic { order: 3, of }), "1/3 of period 2.50 mm");
        let coordinate = "position (against motion)".to_owned();
        let stronger = Relation::StrongerAlong { coordinate };
        assert_eq!(told(stronger), "stronger along position (against motion)");
        assert_eq!(relation(&seen(None)), "");
    }
}
