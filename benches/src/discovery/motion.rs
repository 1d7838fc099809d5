//! Reference motions, written without the library's own generator.

/// Sampling time, s.
pub const SAMPLE_TIME: f64 = 1e-3;

/// How much a motion tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Excitation {
    /// Many speeds, small and large reversals, creeping, rest.
    Good,
    /// The same few strokes at two speeds, over and over.
    Poor,
}

/// Builds a position reference from moves with limited speed and acceleration.
struct Moves {
    position: f64,
    samples: Vec<f64>,
}

impl Moves {
    fn new() -> Self {
        Self { position: 0.0, samples: vec![0.0] }
    }

    fn to(&mut self, target: f64, speed: f64, acceleration: f64) -> &mut Self {
        let (way, sign) = ((target - self.position).abs(), (target - self.position).signum());
        let speed = speed.min((way * acceleration).sqrt());
        let (ramp, whole) = (speed / acceleration, way / speed + speed / acceleration);
        let steps = (whole / SAMPLE_TIME).round() as usize;
        for k in 1..=steps {
            let t = k as f64 * SAMPLE_TIME;
            let gone = if t < ramp {
                0.5 * acceleration * t * t
            } else if t < whole - ramp {
                speed * (t - 0.5 * ramp)
            } else {
                way - 0.5 * acceleration * (whole - t).max(0.0).powi(2)
            };
            self.samples.push(self.position + sign * gone);
        }
        self.position = target;
        self
    }

    fn there_and_back(&mut self, way: f64, speed: f64, acceleration: f64) -> &mut Self {
        let home = self.position;
        self.to(home + way, speed, acceleration).to(home, speed, acceleration)
    }

    fn rest(&mut self, time: f64) -> &mut Self {
        let samples = (time / SAMPLE_TIME) as usize;
        self.samples.extend(std::iter::repeat_n(self.position, samples));
        self
    }
}

/// Positions, one per sampling time; `vary` (around 1) scales the speeds.
pub fn reference(excitation: Excitation, vary: [f64; 2]) -> Vec<f64> {
    let mut moves = Moves::new();
    match excitation {
        Excitation::Poor => {
            for repeat in 0..5 {
                let f = vary[repeat % 2];
                moves.there_and_back(0.1, 0.1 * f, 2.0).there_and_back(0.1, 0.2 * f, 2.0);
            }
        }
        Excitation::Good => {
            for f in vary {
                moves
                    .rest(0.1)
                    .there_and_back(2e-5, 3e-4 * f, 0.01)
                    .there_and_back(2e-5, 3e-4 * f, 0.01)
                    .rest(0.02)
                    .there_and_back(1e-4, 1e-3 * f, 0.02)
                    .rest(0.05)
                    .there_and_back(5e-4, 1e-3 * f, 0.05)
                    .rest(0.4)
                    .there_and_back(2e-3, 4e-3 * f, 0.1)
                    .there_and_back(6e-3, 1.5e-2 * f, 0.3)
                    .there_and_back(2e-2, 4e-2 * f, 1.0)
                    .rest(0.2)
                    .there_and_back(0.12, 0.1 * f, 2.0)
                    .there_and_back(0.12, 0.2 * f, 4.0)
                    .there_and_back(0.06, 0.3 * f, 6.0);
            }
        }
    }
    moves.samples
}
