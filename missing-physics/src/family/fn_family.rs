//! A family from a closure.

use std::collections::BTreeMap;

use super::coordinate::{ComparedQuantity, Coordinate};
use super::fitted::Fitted;
use super::model_family::ModelFamily;
use super::term::Term;

/// A [`ModelFamily`] whose prediction is a closure.
///
/// ```
/// use missing_physics::{FnFamily, Settings, Term, discover};
///
/// // Cooling water: does the room matter, beside the heater?
/// let time: Vec<f64> = (0..600).map(f64::from).collect();
/// let heater = |t: f64| if (t / 90.0) as u32 % 2 == 0 { 1.0 } else { 0.0 };
/// let simulated = |heating: f64, cooling: f64, out: &mut [f64]| {
///     let mut warmth = 0.0;
///     for (k, out) in out.iter_mut().enumerate() {
///         *out = warmth;
///         warmth += heating * heater(k as f64) - cooling * warmth;
///     }
/// };
/// let mut measured = vec![0.0; time.len()];
/// simulated(0.2, 0.01, &mut measured);
/// measured.iter_mut().enumerate().for_each(|(k, y)| *y += 0.05 * ((k * k) as f64).sin());
///
/// let terms = vec![
///     Term::new("heating", "the heater", "h u").amplitude("h", "K/s", (0.0, 1.0), 0.1).always(),
///     Term::new("cooling", "losses to the room", "-c T").shape("c", "1/s", (1e-3, 0.1), 0.01),
///     Term::new("offset", "the sensor's zero", "o").amplitude("o", "K", (-20.0, 20.0), 1.0),
/// ];
/// let family = FnFamily::new(terms, time, measured, |given, out| {
///     let one = |name: &str| given.of(name).map_or(0.0, |values| values[0]);
///     simulated(one("heating"), one("cooling"), out);
///     out.iter_mut().for_each(|y| *y += one("offset"));
/// });
/// let found = discover(&family, &Settings::default(), &mut ())?;
/// assert_eq!(found.added, ["cooling"]);
/// # Ok::<(), missing_physics::DiscoverError>(())
/// ```
pub struct FnFamily<P> {
    terms: Vec<Term>,
    quantity: ComparedQuantity,
    time: Vec<f64>,
    target: Vec<f64>,
    coordinates: Vec<Coordinate>,
    noise: Option<f64>,
    predict: P,
}

/// A model as a closure sees it.
pub struct Given<'a> {
    terms: &'a [Term],
    model: &'a Fitted,
}

impl<'a> Given<'a> {
    /// The values of the term called `name`; nothing where the model lacks it.
    pub fn of(&self, name: &str) -> Option<&'a [f64]> {
        self.terms().find(|(term, _)| term.name == name).map(|(_, values)| values)
    }

    /// The terms of the model, each with its values.
    pub fn terms(&self) -> impl Iterator<Item = (&'a Term, &'a [f64])> {
        let (terms, mut rest) = (self.terms, self.model.values.as_slice());
        self.model.terms.iter().map(move |index| {
            let term = &terms[*index];
            let (values, others) = rest.split_at(term.parameters.len());
            rest = others;
            (term, values)
        })
    }
}

impl<P: Fn(&Given<'_>, &mut [f64]) + Sync> FnFamily<P> {
    /// From instants (s), what was measured at them, and what a model predicts there.
    pub fn new(terms: Vec<Term>, time: Vec<f64>, target: Vec<f64>, predict: P) -> Self {
        let quantity = ComparedQuantity { name: "output".into(), unit: "1".into() };
        Self { terms, quantity, time, target, coordinates: Vec::new(), noise: None, predict }
    }

    /// Says what is predicted, and its SI unit.
    #[must_use]
    pub fn predicting(mut self, name: &str, unit: &str) -> Self {
        self.quantity = ComparedQuantity { name: name.into(), unit: unit.into() };
        self
    }

    /// With something that the residual may depend on. A shift in time along which all of these repeat themselves is
    /// no placebo.
    #[must_use]
    pub fn along(mut self, coordinate: Coordinate) -> Self {
        self.coordinates.push(coordinate);
        self
    }

    /// With the standard deviation of the measurement's noise, in the unit of what is predicted.
    #[must_use]
    pub fn with_noise(mut self, sd: f64) -> Self {
        self.noise = Some(sd);
        self
    }
}

impl<P: Fn(&Given<'_>, &mut [f64]) + Sync> ModelFamily for FnFamily<P> {
    fn terms(&self) -> &[Term] {
        &self.terms
    }

    fn quantity(&self) -> ComparedQuantity {
        self.quantity.clone()
    }

    fn time(&self) -> &[f64] {
        &self.time
    }

    fn target(&self) -> &[f64] {
        &self.target
    }

    fn predict(&self, model: &Fitted, out: &mut [f64]) {
        out.fill(0.0);
        (self.predict)(&Given { terms: &self.terms, model }, out);
    }

    fn coordinates(&self) -> &[Coordinate] {
        &self.coordinates
    }

    fn motion(&self) -> Vec<Vec<f64>> {
        let state = self.coordinates.iter().filter(|coordinate| coordinate.state);
        state.map(|coordinate| coordinate.values.clone()).collect()
    }

    fn noise(&self) -> BTreeMap<String, f64> {
        let key = format!("{}_{}", self.quantity.name, self.quantity.unit);
        self.noise.map(|noise| (key, noise)).into_iter().collect()
    }
}
