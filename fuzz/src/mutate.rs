//! What is done to an input.

use rand::{Rng, RngExt};

/// Longest input that is made, bytes.
const LONGEST: usize = 1 << 20;
/// Most changes of one input.
const MOST: usize = 8;
/// What is put in the place of a number in a text.
const NUMBERS: [&str; 20] = [
    "",
    "-0",
    "nan",
    "inf",
    "-inf",
    "1e400",
    "-1e308",
    "1e-320",
    "4.9e-324",
    "18446744073709551616",
    "-1",
    "0",
    "1,5",
    "1.2.3",
    "0x10",
    "--1",
    "1e",
    "é",
    "\"",
    "9007199254740993",
];
/// Whole numbers at the ends of their ranges.
const EXTREMES: [u64; 8] =
    [0, 1, 0x7f, 0x7fff, 0x7fff_ffff, 0x8000_0000, 0x7fff_ffff_ffff_ffff, u64::MAX];

/// One of `seeds` with some changes.
pub fn mutated(seeds: &[Vec<u8>], random: &mut impl Rng) -> Vec<u8> {
    let Some(seed) = any(seeds, random) else { return Vec::new() };
    let mut bytes = seed.clone();
    for _ in 0..random.random_range(1..=MOST) {
        change(&mut bytes, seeds, random);
    }
    bytes.truncate(LONGEST);
    bytes
}

fn any<'a, T>(of: &'a [T], random: &mut impl Rng) -> Option<&'a T> {
    (!of.is_empty()).then(|| &of[random.random_range(0..of.len())])
}

fn change(bytes: &mut Vec<u8>, seeds: &[Vec<u8>], random: &mut impl Rng) {
    let at = random.random_range(0..=bytes.len());
    let part = part(bytes.len(), random);
    match random.random_range(0..10) {
        0 if !part.is_empty() => bytes[part.start] ^= 1 << random.random_range(0..8),
        1 if !part.is_empty() => bytes[part.start] = random.random(),
        2 => {
            let new: Vec<u8> = (0..random.random_range(1..16)).map(|_| random.random()).collect();
            bytes.splice(at..at, new);
        }
        3 => drop(bytes.drain(part)),
        4 => {
            let again = bytes[part].repeat(1 << random.random_range(0..6));
            bytes.splice(at..at, again.into_iter().take(LONGEST));
        }
        5 => {
            let other = any(seeds, random).map_or(&[][..], Vec::as_slice);
            let from = self::part(other.len(), random);
            bytes.splice(part, other[from].iter().copied());
        }
        6 => bytes.truncate(at),
        7 => {
            let width = 1 << random.random_range(0..4);
            let number = EXTREMES[random.random_range(0..EXTREMES.len())].to_le_bytes();
            if at + width <= bytes.len() {
                bytes[at..at + width].copy_from_slice(&number[..width]);
                if random.random() {
                    bytes[at..at + width].reverse();
                }
            }
        }
        _ => {
            let number = number_from(bytes, at);
            let new = NUMBERS[random.random_range(0..NUMBERS.len())];
            bytes.splice(number, new.bytes());
        }
    }
}

/// A range of a length, rather a short one.
fn part(length: usize, random: &mut impl Rng) -> std::ops::Range<usize> {
    let longest = (length >> random.random_range(0..10)).max(1).min(length);
    let size = if longest == 0 { 0 } else { random.random_range(0..=longest) };
    let start = random.random_range(0..=length - size);
    start..start + size
}

/// The first number in a text from a place on; an empty range where there is none near.
fn number_from(bytes: &[u8], at: usize) -> std::ops::Range<usize> {
    let numeric = |byte: &u8| byte.is_ascii_digit() || b"+-.eE".contains(byte);
    let start = bytes[at..].iter().take(64).position(u8::is_ascii_digit).map_or(at, |k| at + k);
    let size = bytes[start..].iter().take_while(|byte| numeric(byte)).count();
    start..start + size
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;

    #[test]
    fn inputs_differ_from_their_seeds_and_are_the_same_for_a_seed() {
        let seeds = vec![b"time_s,force_N\n0.5,1.25\n".to_vec(), Vec::new()];
        let some = |seed| {
            let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
            (0..500).map(|_| mutated(&seeds, &mut random)).collect::<Vec<_>>()
        };
        let inputs = some(1);
        assert_eq!(inputs, some(1));
        let other: std::collections::HashSet<_> =
            inputs.iter().filter(|i| !seeds.contains(i)).collect();
        assert!(other.len() > 250, "{}", other.len());
        assert!(inputs.iter().any(|input| input.ends_with(b"nan\n")));
    }

    #[test]
    fn a_number_of_a_text_is_found_whole() {
        let text = b"a=-12.5e3;b";
        assert_eq!(&text[number_from(text, 0)], b"12.5e3");
        assert_eq!(number_from(b"abc", 1), 1..1);
    }
}
