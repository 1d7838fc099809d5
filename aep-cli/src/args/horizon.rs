//! How a model is compared by simulating it.

use clap::ValueEnum;
use friction_ident::{Horizon, Pd, WindowOptions};

use crate::failure::Failure;

/// What a model is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Compared {
    /// The force that it requires along the measured motion
    Force,
    /// Its motion over short windows with fitted starts
    Windows,
    /// Its motion over whole segments under the recorded force
    FreeRun,
    /// Its motion under a known PD controller that follows the recorded reference
    ClosedLoop,
}

impl Compared {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Force => "force along the motion",
            Self::Windows => "restarted windows",
            Self::FreeRun => "free run",
            Self::ClosedLoop => "closed loop",
        }
    }
}

/// How a simulation of the model is compared.
#[derive(clap::Args, Clone, Debug)]
#[command(
    next_help_heading = "Comparison by simulation (--horizon windows, free-run, closed-loop)"
)]
pub struct TimeArgs {
    /// Length of a window
    #[arg(long, value_name = "S", default_value_t = 0.2)]
    window: f64,
    /// Longest step of the simulation; by default the sampling time
    #[arg(long, value_name = "S")]
    max_step: Option<f64>,
    /// Gains of the controller: proportional, derivative (N/m and N s/m, or N m/rad and N m s/rad)
    #[arg(long, value_name = "KP,KD", value_delimiter = ',', num_args = 2)]
    gains: Vec<f64>,
    /// Generations of the search; least squares follow
    #[arg(long, value_name = "N", default_value_t = 200)]
    generations: u64,
    /// Individuals of the search
    #[arg(long, value_name = "N", default_value_t = 60)]
    population: usize,
}

/// A comparison by simulation and the budget of its search.
pub struct TimeTask {
    /// Makes the horizon for a sampling time, s.
    pub horizon: Box<dyn Fn(f64) -> Horizon>,
    /// Generations.
    pub generations: u64,
    /// Individuals.
    pub population: usize,
}

impl TimeArgs {
    /// The task these arguments describe.
    pub fn task(&self, compared: Compared) -> Result<TimeTask, Failure> {
        let (window, max_step) = (self.window, self.max_step);
        for (name, value) in [("--window", Some(window)), ("--max-step", max_step)] {
            if value.is_some_and(|value| !(value > 0.0 && value.is_finite())) {
                return Err(Failure::bad_input(format!(
                    "{name} must be a number of seconds above 0"
                )));
            }
        }
        if self.population == 0 {
            return Err(Failure::bad_input("--population must be a number of individuals above 0"));
        }
        let step = move |sampling: f64| max_step.unwrap_or(sampling);
        let horizon: Box<dyn Fn(f64) -> Horizon> = match compared {
            Compared::Force | Compared::Windows => Box::new(move |sampling| {
                let options = WindowOptions::new(window);
                Horizon::Windows(WindowOptions { max_step: step(sampling), ..options })
            }),
            Compared::FreeRun => {
                Box::new(move |sampling| Horizon::FreeRun { max_step: step(sampling) })
            }
            Compared::ClosedLoop => {
                let [proportional, derivative] = self.gains[..] else {
                    let what = "the closed loop needs the gains of its controller";
                    return Err(Failure::bad_input(what).with_hint("give --gains KP,KD"));
                };
                Box::new(move |sampling| Horizon::ClosedLoop {
                    controller: Pd::new(proportional, derivative),
                    encoder_resolution: 0.0,
                    max_step: step(sampling),
                })
            }
        };
        let (generations, population) = (self.generations, self.population);
        Ok(TimeTask { horizon, generations, population })
    }
}
