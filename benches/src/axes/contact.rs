//! Friction contacts that give before they slide.

use super::random::Stream;

/// Elements of a Maxwell contact.
const ELEMENTS: usize = 8;

/// An elastic contact.
#[derive(Clone, Debug)]
pub enum Contact {
    /// Springs in parallel, each of which slips at its share of the level.
    Maxwell {
        /// Share of the level and deflection at slip, m, of each element.
        elements: [(f64, f64); ELEMENTS],
        /// Deflections, m.
        stretch: [f64; ELEMENTS],
    },
    /// One bristle whose deflection approaches that of steady sliding exponentially with the way.
    LuGre {
        /// Deflection in steady sliding, m.
        deflection: f64,
        /// Damping of the bristle over its stiffness, s.
        damping: f64,
        /// Deflection, m.
        stretch: f64,
    },
}

impl Contact {
    /// Elements with random shares that slip between 8 % of `deflection` and all of it.
    pub fn maxwell(deflection: f64, random: &mut Stream) -> Self {
        let mut elements = [(0.0, 0.0); ELEMENTS];
        for (k, element) in elements.iter_mut().enumerate() {
            let part = 0.08 + 0.92 * k as f64 / (ELEMENTS - 1) as f64;
            *element = (random.between(0.3, 1.7), part * deflection);
        }
        let sum: f64 = elements.iter().map(|(share, _)| share).sum();
        for (share, _) in &mut elements {
            *share /= sum;
        }
        Self::Maxwell { elements, stretch: [0.0; ELEMENTS] }
    }

    /// A bristle of this deflection; `damping` over its stiffness in s.
    pub fn lugre(deflection: f64, damping: f64) -> Self {
        Self::LuGre { deflection, damping, stretch: 0.0 }
    }

    /// Force of the contact after the body has gone `way` in `h`, at the friction level `level`.
    pub fn force(&mut self, way: f64, h: f64, level: f64) -> f64 {
        match self {
            Self::Maxwell { elements, stretch } => elements
                .iter()
                .zip(stretch)
                .map(|((share, limit), stretch)| {
                    *stretch = (*stretch + way).clamp(-limit, *limit);
                    level * share * *stretch / limit
                })
                .sum(),
            Self::LuGre { deflection, damping, stretch } => {
                let steady = *deflection * way.signum();
                let next = steady + (*stretch - steady) * (-way.abs() / *deflection).exp();
                let rate = (next - *stretch) / h;
                *stretch = next;
                level / *deflection * (next + *damping * rate)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steady_sliding_meets_the_level_and_a_reversal_takes_twice_the_deflection() {
        for mut contact in
            [Contact::maxwell(2e-5, &mut Stream::new(&["contact"], 1)), Contact::lugre(2e-6, 0.0)]
        {
            let slide = |contact: &mut Contact, way: f64| {
                (0..1000).map(|_| contact.force(way / 1000.0, 1e-4, 7.0)).last().unwrap_or(0.0)
            };
            assert!((slide(&mut contact, 1e-4) - 7.0).abs() < 1e-9);
            assert!(slide(&mut contact, -1e-6) > -7.0);
            assert!((slide(&mut contact, -4.1e-5) + 7.0).abs() < 1e-6);
        }
    }
}
