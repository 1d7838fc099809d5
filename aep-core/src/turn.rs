//! Whose turn it is: ask, then tell, then ask.

use crate::TellError;

/// Between an `ask` and its `tell` the positions stand; every algorithm keeps one of these.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Turn {
    asked: bool,
}

impl Turn {
    /// Notes an `ask`; whether it is the first since the last `tell`, so that positions are due.
    pub fn ask(&mut self) -> bool {
        !std::mem::replace(&mut self.asked, true)
    }

    /// Notes a `tell` of `found` costs for `expected` positions; one that is refused changes nothing.
    pub fn tell(&mut self, found: usize, expected: usize) -> Result<(), TellError> {
        if !self.asked {
            return Err(TellError::NotAsked);
        }
        if found != expected {
            return Err(TellError::Count { found, expected });
        }
        self.asked = false;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refused_tell_can_be_mended() {
        let mut turn = Turn::default();
        assert_eq!(turn.tell(2, 2), Err(TellError::NotAsked));
        assert!(turn.ask() && !turn.ask());
        assert_eq!(turn.tell(1, 2), Err(TellError::Count { found: 1, expected: 2 }));
        assert_eq!(turn.tell(2, 2), Ok(()));
        assert!(turn.ask());
    }
}
