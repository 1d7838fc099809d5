//! Working memory of a step: one value per lane.

/// All that a step computes on its way.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    /// Mean force of the drive over the step.
    pub drive: Vec<f64>,
    /// Time of the step that is left.
    pub left: Vec<f64>,
    /// Its inverse, where the step is one piece.
    pub rate: Vec<f64>,
    /// Time at the predicted middle.
    pub time: Vec<f64>,
    /// Predicted position in the middle.
    pub position: Vec<f64>,
    /// Predicted velocity in the middle.
    pub velocity: Vec<f64>,
    /// Direction of sliding or of impending sliding.
    pub direction: Vec<f64>,
    /// Smooth resisting force and its slope.
    pub force: Vec<f64>,
    pub damping: Vec<f64>,
    /// The velocity that the level follows, where an effect remembers.
    pub level_velocity: Vec<f64>,
    /// How much of the static hump has formed.
    pub bond: Vec<f64>,
    /// Level that memories add.
    pub remembered: Vec<f64>,
    /// Share of the static hump that is left.
    pub hump: Vec<f64>,
    /// Friction level.
    pub level: Vec<f64>,
    /// Friction level at rest, where a contact wants it.
    pub breakaway: Vec<f64>,
    /// Mean force of the elements and its slope.
    pub elements: Vec<f64>,
    pub stiffness: Vec<f64>,
    /// Balance of the piece: inertia, push, mean velocity.
    pub inertia: Vec<f64>,
    pub push: Vec<f64>,
    pub mean: Vec<f64>,
    /// Displacement in the piece.
    pub displacement: Vec<f64>,
    /// Whether it is still looked for: 1 or 0.
    pub open: Vec<f64>,
    /// Length of the piece that is taken.
    pub taken: Vec<f64>,
    /// Always 0: the level that an attached body sees, the velocity of a level at rest.
    pub zero: Vec<f64>,
}

impl Scratch {
    pub fn new(lanes: usize) -> Self {
        let lane = || vec![0.0; lanes];
        Self {
            drive: lane(),
            left: lane(),
            rate: lane(),
            time: lane(),
            position: lane(),
            velocity: lane(),
            direction: lane(),
            force: lane(),
            damping: lane(),
            level_velocity: lane(),
            bond: vec![1.0; lanes],
            remembered: lane(),
            hump: vec![1.0; lanes],
            level: lane(),
            breakaway: lane(),
            elements: lane(),
            stiffness: lane(),
            inertia: lane(),
            push: lane(),
            mean: lane(),
            displacement: lane(),
            open: lane(),
            taken: lane(),
            zero: lane(),
        }
    }
}
