//! Working memory of a step: one value per lane.

/// All that a step computes on its way.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    /// Mean force of the drive over the step.
    pub drive: Vec<f64>,
    /// Time of the step that is left.
    pub left: Vec<f64>,
    /// Predicted position in the middle.
    pub position: Vec<f64>,
    /// Predicted velocity in the middle.
    pub velocity: Vec<f64>,
    /// Direction of sliding or of impending sliding.
    pub direction: Vec<f64>,
    /// Smooth resisting force and its slope.
    pub force: Vec<f64>,
    pub damping: Vec<f64>,
    /// Friction level.
    pub level: Vec<f64>,
    /// Forces of the elements at the start and at the end of the step, and their slope.
    pub before: Vec<f64>,
    pub after: Vec<f64>,
    pub stiffness: Vec<f64>,
    /// Displacement in the step.
    pub displacement: Vec<f64>,
    /// Length of the piece that is taken.
    pub taken: Vec<f64>,
    /// Always 0: the level that an attached body sees.
    pub zero: Vec<f64>,
}

impl Scratch {
    pub fn new(lanes: usize) -> Self {
        let lane = vec![0.0; lanes];
        Self {
            drive: lane.clone(),
            left: lane.clone(),
            position: lane.clone(),
            velocity: lane.clone(),
            direction: lane.clone(),
            force: lane.clone(),
            damping: lane.clone(),
            level: lane.clone(),
            before: lane.clone(),
            after: lane.clone(),
            stiffness: lane.clone(),
            displacement: lane.clone(),
            taken: lane.clone(),
            zero: lane,
        }
    }
}
