//! What can hide in a table, and what a right answer to it is.

/// A law that the base model does not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hidden {
    /// Nothing beyond mass, Coulomb and viscous friction and an offset.
    Nothing,
    /// A Lorentzian hump of friction at low speed; size: its height, N.
    Stribeck,
    /// A Gaussian hump; N.
    GaussianStribeck,
    /// Friction levels and slopes that depend on the direction; N.
    Asymmetry,
    /// Periodic force along the stroke; amplitude, N.
    Ripple,
    /// An elastic contact (one bristle that slips at the friction level); deflection at breakaway, m.
    Presliding,
    /// A Dahl contact: stiffness falls off smoothly towards the friction level; m.
    Dahl,
    /// A contact after Canudas de Wit et al., 1995, with damping of the bristle and no hump; m.
    LuGre,
    /// Two bumps of the friction level along the stroke; N.
    PositionFriction,
    /// A random friction profile along the stroke, finer than the library's; N.
    RandomProfile,
    /// Drag with the square of the speed; N at 0.2 m/s.
    QuadraticDrag,
    /// A saturating viscous force; N.
    ShearThinning,
    /// A spring about mid-stroke; N at its end.
    Spring,
    /// The weight of a pendulum, on a rotary axis; N at the rim.
    Pendulum,
    /// Friction in proportion to the force of the drive, beside a strong spring; share.
    LoadFriction,
    /// Warm-up: the friction level relaxes; N at the start.
    Drift,
    /// Breakaway force that grows with the time at rest; N after a long rest.
    RisingStatic,
    /// Beside a hump: friction that follows the speed late; s.
    FrictionalMemory,
    /// A first-order lag of the force; s.
    ActuatorLag,
    /// A delay of the force; s.
    InputDelay,
    /// The drive gives no more than a share of the force that the motion asks for; what is cut off, as a share.
    Saturation,
    /// An error within each period of the encoder; amplitude, m.
    Encoder,
    /// Part of the friction hangs behind a gap; friction behind the gap, N.
    Backlash,
    /// Part of the mass hangs behind a spring and a damper; share of the mass.
    FlexibleCoupling,
    /// A force periodic in time: no effect of the library; N.
    TimePeriodic,
    /// The friction level changes at some moment: no effect of the library; N.
    FrictionStep,
    /// A force at one place, as from a dent: no effect of the library; N.
    Dent,
}

/// A row of the matrix.
#[derive(Clone, Debug)]
pub struct Case {
    /// What is hidden.
    pub kinds: Vec<Hidden>,
    /// Its name in the table.
    pub name: String,
    /// Effects that must be found. None: nothing is missing, or no effect of the library describes it.
    pub answers: Vec<&'static str>,
    /// Effects that the base model has beyond Coulomb, viscous and an offset.
    pub beside: Vec<&'static str>,
    /// Where no effect of the library describes it: coordinates of which one is to be named.
    pub coordinates: Vec<&'static str>,
}

impl Case {
    fn listed(kind: Hidden, name: &str, answer: &'static str) -> Self {
        Self {
            kinds: vec![kind],
            name: name.to_owned(),
            answers: vec![answer],
            beside: Vec::new(),
            coordinates: Vec::new(),
        }
    }

    fn unlisted(kind: Hidden, name: &str, coordinates: &[&'static str]) -> Self {
        Self {
            answers: Vec::new(),
            coordinates: coordinates.to_vec(),
            ..Self::listed(kind, name, "")
        }
    }

    fn beside(mut self, effect: &'static str) -> Self {
        self.beside.push(effect);
        self
    }

    /// Every single case.
    pub fn singles() -> Vec<Self> {
        use Hidden as H;
        vec![
            Self::unlisted(H::Nothing, "nothing", &[]),
            Self::listed(H::Stribeck, "stribeck", "stribeck"),
            Self::listed(H::GaussianStribeck, "stribeck, Gaussian", "stribeck"),
            Self::listed(H::Asymmetry, "asymmetry", "asymmetry"),
            Self::listed(H::Ripple, "ripple", "ripple"),
            Self::listed(H::Presliding, "presliding", "presliding"),
            Self::listed(H::Dahl, "presliding, Dahl", "presliding"),
            Self::listed(H::LuGre, "presliding, LuGre", "presliding"),
            Self::listed(H::PositionFriction, "position-friction", "position-friction"),
            Self::listed(H::QuadraticDrag, "quadratic-drag", "quadratic-drag"),
            Self::listed(H::ShearThinning, "shear-thinning", "shear-thinning"),
            Self::listed(H::Spring, "spring", "spring"),
            Self::listed(H::Pendulum, "gravity-pendulum", "gravity-pendulum"),
            Self::listed(H::LoadFriction, "load-friction", "load-friction").beside("spring"),
            Self::listed(H::Drift, "drift", "drift"),
            Self::listed(H::RisingStatic, "rising-static-friction", "rising-static-friction"),
            Self::listed(H::FrictionalMemory, "frictional-memory", "frictional-memory")
                .beside("stribeck"),
            Self::listed(H::ActuatorLag, "actuator-lag", "actuator-lag"),
            Self::listed(H::InputDelay, "input-delay", "input-delay"),
            Self::listed(H::Saturation, "saturation", "saturation"),
            Self::listed(H::Encoder, "encoder", "encoder"),
            Self::listed(H::Backlash, "backlash", "backlash"),
            Self::listed(H::FlexibleCoupling, "flexible-coupling", "flexible-coupling"),
            Self::unlisted(H::TimePeriodic, "periodic in time", &["time"]),
            Self::unlisted(H::FrictionStep, "friction step in time", &["time (against motion)"]),
            Self::unlisted(H::Dent, "dent in the way", &["position", "spatial spectrum"]),
            Self {
                answers: vec!["position-friction"],
                ..Self::unlisted(
                    H::RandomProfile,
                    "random friction profile",
                    &["position (against motion)"],
                )
            },
        ]
    }

    /// Every pair of listed single cases with different answers that need no further base.
    pub fn pairs() -> Vec<Self> {
        let alone: Vec<Self> = Self::singles()
            .into_iter()
            .filter(|case| {
                // A pendulum needs an axis of its own kind.
                let linear = case.kinds != [Hidden::Pendulum];
                linear
                    && !case.answers.is_empty()
                    && case.beside.is_empty()
                    && case.coordinates.is_empty()
            })
            .collect();
        let mut pairs = Vec::new();
        for (k, a) in alone.iter().enumerate() {
            for b in alone[k + 1..].iter().filter(|b| b.answers != a.answers && a.fits(b)) {
                pairs.push(Self {
                    kinds: [a.kinds.clone(), b.kinds.clone()].concat(),
                    name: format!("{} + {}", a.name, b.name),
                    answers: [a.answers.clone(), b.answers.clone()].concat(),
                    beside: Vec::new(),
                    coordinates: Vec::new(),
                });
            }
        }
        pairs
    }

    /// Whether two cases can hide in one table: each kind of dynamics is there once, and both a lag and a
    /// delay, or both laws of breakaway, are more than any recording tells apart.
    fn fits(&self, other: &Self) -> bool {
        let group = |kind: Hidden| match kind {
            Hidden::ActuatorLag | Hidden::InputDelay => 1,
            Hidden::Presliding
            | Hidden::Dahl
            | Hidden::LuGre
            | Hidden::Backlash
            | Hidden::FlexibleCoupling => 2,
            Hidden::RisingStatic | Hidden::Stribeck | Hidden::GaussianStribeck => 3,
            _ => 0,
        };
        let (mine, other) = (group(self.kinds[0]), group(other.kinds[0]));
        mine == 0 || mine != other
    }
}
