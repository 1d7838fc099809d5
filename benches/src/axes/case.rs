//! What is hidden where, and what a right answer to it is.

use super::hidden::Hidden;
use super::machine::Build;

/// How large what is hidden is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Size {
    /// There is nothing.
    Nothing,
    /// Always this.
    Fixed(f64),
    /// As visible as the level says.
    ByLevel,
}

/// What must be said.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// That nothing is missing.
    Silence,
    /// The name of an effect.
    Name,
    /// That something remains which no effect of the library explains.
    Unexplained,
}

/// A row of the table.
#[derive(Clone, Debug)]
pub struct Case {
    /// Kind of machine, or of answer: `table`, `joint`, `spindle`, `unlisted`.
    pub kind: &'static str,
    /// Name within the kind.
    pub name: &'static str,
    /// The machine.
    pub build: Build,
    /// What is hidden in it.
    pub hidden: Hidden,
    /// How large.
    pub size: Size,
    /// Effects of the base model.
    pub base: Vec<&'static str>,
    /// Effects that are a right answer; several where they cannot be told apart.
    pub answers: Vec<&'static str>,
    /// Effects that do no harm beside a right one.
    pub minor: Vec<&'static str>,
}

impl Case {
    fn new(kind: &'static str, name: &'static str, build: Build, hidden: Hidden) -> Self {
        Self {
            kind,
            name,
            build,
            hidden,
            size: Size::ByLevel,
            base: vec!["coulomb", "viscous", "offset"],
            answers: Vec::new(),
            minor: Vec::new(),
        }
    }

    fn named(mut self, answers: &[&'static str]) -> Self {
        self.answers = answers.to_vec();
        self
    }

    fn minor(mut self, effects: &[&'static str]) -> Self {
        self.minor = effects.to_vec();
        self
    }

    fn sized(mut self, size: Size) -> Self {
        self.size = size;
        self
    }

    fn nothing(kind: &'static str, name: &'static str, build: Build) -> Self {
        Self::new(kind, name, build, Hidden::Nothing).sized(Size::Nothing)
    }

    fn hanging(mut self) -> Self {
        self.build = Build::HangingJoint;
        self.base.push("gravity-pendulum");
        self
    }

    /// What must be said of it.
    pub fn wanted(&self) -> Wanted {
        match (self.kind, self.size) {
            ("unlisted", _) => Wanted::Unexplained,
            (_, Size::Nothing) => Wanted::Silence,
            _ => Wanted::Name,
        }
    }
}

/// Every case.
pub fn all() -> Vec<Case> {
    [tables(), joints(), spindles(), unlisted()].concat()
}

fn tables() -> Vec<Case> {
    use Hidden as H;
    let case = |name, hidden| Case::new("table", name, Build::Table, hidden);
    let mut base_without_offset = case("offset", H::Offset).named(&["offset", "asymmetry"]);
    base_without_offset.base.retain(|effect| *effect != "offset");
    vec![
        Case::nothing("table", "nothing", Build::Table),
        case("stribeck", H::StribeckExponential).named(&["stribeck"]).minor(&["presliding"]),
        case("stribeck-gaussian", H::StribeckGaussian).named(&["stribeck"]).minor(&["presliding"]),
        case("stribeck-tanh", H::StribeckTanh).named(&["stribeck"]).minor(&["presliding"]),
        case("lugre", H::LuGre).named(&["presliding"]),
        case("maxwell", H::Maxwell).named(&["presliding"]),
        case("healing", H::Healing)
            .named(&["rising-static-friction", "frictional-memory"])
            .minor(&["presliding", "stribeck"]),
        case("flexible", H::Flexible).named(&["flexible-coupling"]).minor(&["presliding"]),
        case("backlash", H::Backlash).named(&["backlash"]).minor(&["presliding"]),
        case("ripple", H::Ripple).named(&["ripple"]),
        case("profile", H::Profile).named(&["position-friction"]),
        case("load", H::InertialLoad).named(&["load-friction"]),
        case("drift", H::Drift).named(&["drift"]),
        case("lag", H::Lag).named(&["actuator-lag", "input-delay"]),
        case("lag-second-order", H::SecondOrderLag).named(&["actuator-lag", "input-delay"]),
        case("delay", H::Delay).named(&["input-delay", "actuator-lag"]),
        case("saturation", H::Saturation).named(&["saturation"]),
        case("gain-by-side", H::GainBySide).named(&["motor-gain"]),
        case("gain-by-current", H::GainByCurrent).named(&["motor-gain"]).minor(&["saturation"]),
        case("gain-along-stroke", H::GainAlongStroke).named(&["motor-gain"]),
        case("drag", H::Drag).named(&["quadratic-drag"]),
        case("spring", H::Spring).named(&["spring"]),
        case("asymmetry", H::Asymmetry).named(&["asymmetry"]),
        base_without_offset,
    ]
}

/// Share of the load of a gear's friction.
const GEAR: f64 = 0.064;

fn joints() -> Vec<Case> {
    use Hidden as H;
    let case = |name, hidden| Case::new("joint", name, Build::Joint, hidden);
    vec![
        Case::nothing("joint", "nothing", Build::Joint),
        Case::nothing("joint", "hanging-nothing", Build::HangingJoint).hanging(),
        case("hanging-load", H::Load).named(&["load-friction"]).hanging().sized(Size::Fixed(GEAR)),
        case("stribeck", H::StribeckExponential).named(&["stribeck"]).minor(&["presliding"]),
        case("asymmetry", H::Asymmetry).named(&["asymmetry"]),
        case("flexible", H::Flexible).named(&["flexible-coupling"]).minor(&["presliding"]),
    ]
}

fn spindles() -> Vec<Case> {
    use Hidden as H;
    let case = |name, hidden| Case::new("spindle", name, Build::Spindle, hidden);
    vec![
        Case::nothing("spindle", "nothing", Build::Spindle),
        case("ripple", H::Ripple).named(&["ripple"]),
        case("viscosity-by-direction", H::ViscosityByDirection).named(&["asymmetry"]),
        case("flexible", H::Flexible).named(&["flexible-coupling"]).minor(&["presliding"]),
    ]
}

fn unlisted() -> Vec<Case> {
    use Hidden as H;
    let case = |name, hidden| Case::new("unlisted", name, Build::Table, hidden);
    vec![
        case("periodic", H::Periodic),
        case("friction-step", H::FrictionStep),
        case("soft-ends", H::SoftEnds),
        case("past-acceleration", H::PastAcceleration),
        case("jitter", H::Jitter),
        case("dropped", H::Dropped),
        case("wrong-stamps", H::WrongStamps),
    ]
}

#[cfg(test)]
mod tests {
    use friction_ident::effects::find;

    use super::*;

    #[test]
    fn every_name_is_that_of_an_effect() {
        for case in all() {
            for name in case.base.iter().chain(&case.answers).chain(&case.minor) {
                assert!(find(name).is_ok(), "{}: {name}", case.name);
            }
        }
    }
}
