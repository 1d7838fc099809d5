//! What is known of an effect, for a reader.

/// What is known of an effect, as text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Explained {
    /// Its name, as tables have it.
    pub name: String,
    /// What it is.
    pub title: String,
    /// What it adds to the model.
    pub equation: String,
    /// What it looks like in residuals.
    pub shows: String,
    /// What its law is from.
    pub reference: String,
    /// Symbol and meaning of its parameters.
    pub parameters: Vec<[String; 2]>,
    /// What it is mistaken for: other effects, and the experiment that tells them apart.
    pub mistaken_for: Vec<[String; 2]>,
}
