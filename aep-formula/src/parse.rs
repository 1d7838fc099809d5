//! From text to steps, by recursive descent.

use crate::error::FormulaError;
use crate::functions::{Call, FUNCTIONS};
use crate::program::{Formula, Step};
use crate::{MOST_DEPTH, MOST_LENGTH};

/// What stands at a place.
#[derive(Clone, Debug, PartialEq)]
enum Token {
    Number(f64),
    Name(String),
    /// A name in backticks, which is no function.
    Quoted(String),
    Sign(&'static str),
    End,
}

/// Signs, the longer ones first.
const SIGNS: [&str; 18] =
    ["**", "<=", ">=", "==", "!=", "<", ">", "+", "-", "*", "/", "%", "^", "(", ")", ",", "{", "}"];
/// A sign and what it does.
type Comparison = (&'static str, fn(f64, f64) -> f64);

const COMPARISONS: [Comparison; 6] = [
    ("<", |a, b| f64::from(u8::from(a < b))),
    ("<=", |a, b| f64::from(u8::from(a <= b))),
    (">", |a, b| f64::from(u8::from(a > b))),
    (">=", |a, b| f64::from(u8::from(a >= b))),
    ("==", |a, b| f64::from(u8::from(a == b))),
    ("!=", |a, b| f64::from(u8::from(a != b))),
];

pub(crate) fn parse(text: &str) -> Result<Formula, FormulaError> {
    if text.len() > MOST_LENGTH {
        let what =
            format!("the formula has {} characters; at most {MOST_LENGTH} are read", text.len());
        return Err(FormulaError {
            what,
            text: text.chars().take(40).collect::<String>() + "...",
            at: 0,
        });
    }
    let mut parser =
        Parser { text, tokens: tokens(text)?, next: 0, names: Vec::new(), steps: Vec::new() };
    parser.comparison(0)?;
    let (token, at) = parser.peek();
    match token {
        Token::End => {}
        Token::Sign(")") => {
            return Err(FormulaError::new("this bracket was never opened", text, at));
        }
        Token::Sign("{" | "}") => {
            return Err(FormulaError::new("use round brackets: ( )", text, at));
        }
        _ => return Err(FormulaError::new("an operator is missing here", text, at)),
    }
    let depth = deepest(&parser.steps);
    Ok(Formula { text: text.to_owned(), names: parser.names, steps: parser.steps, depth })
}

fn deepest(steps: &[Step]) -> usize {
    let (mut height, mut most) = (0usize, 0);
    for step in steps {
        match step {
            Step::Number(_) | Step::Name(_) => height += 1,
            Step::Negate => {}
            Step::Call(_, arguments) => height = height + 1 - arguments,
        }
        most = most.max(height);
    }
    most
}

fn tokens(text: &str) -> Result<Vec<(Token, usize)>, FormulaError> {
    let mut all = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        if c.is_whitespace() {
            at += c.len_utf8();
        } else if c.is_ascii_digit()
            || (c == '.' && rest[1..].starts_with(|d: char| d.is_ascii_digit()))
        {
            let length = number_length(rest);
            let Ok(number) = rest[..length].parse::<f64>() else {
                return Err(FormulaError::new("this is no number", text, at));
            };
            if !number.is_finite() {
                return Err(FormulaError::new("this number is too large", text, at));
            }
            all.push((Token::Number(number), at));
            at += length;
        } else if c == '`' {
            let Some(length) = rest[1..].find('`') else {
                return Err(FormulaError::new("this backtick has no second one", text, at));
            };
            all.push((Token::Quoted(rest[1..=length].to_owned()), at));
            at += length + 2;
        } else if c.is_alphabetic() || c == '_' {
            let named = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
            let length = rest.find(|c| !named(c)).unwrap_or(rest.len());
            all.push((Token::Name(rest[..length].to_owned()), at));
            at += length;
        } else if let Some(sign) = SIGNS.iter().find(|sign| rest.starts_with(**sign)) {
            all.push((Token::Sign(sign), at));
            at += sign.len();
        } else {
            let what = match c {
                '=' => "write == to compare".to_owned(),
                '[' | ']' => {
                    "use round brackets; a name with other signs stands in backticks: `Force [N]`"
                        .to_owned()
                }
                _ => format!("'{}' has no place in a formula", c.escape_debug()),
            };
            return Err(FormulaError::new(what, text, at));
        }
    }
    all.push((Token::End, text.len()));
    Ok(all)
}

/// Length of the number at the start of `rest`: digits, a point, an exponent.
fn number_length(rest: &str) -> usize {
    let bytes = rest.as_bytes();
    let digits = |mut k: usize| {
        while bytes.get(k).is_some_and(u8::is_ascii_digit) {
            k += 1;
        }
        k
    };
    let mut end = digits(0);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(end + 1 + sign);
        if exponent > end + 1 + sign {
            end = exponent;
        }
    }
    end
}

struct Parser<'a> {
    text: &'a str,
    tokens: Vec<(Token, usize)>,
    next: usize,
    names: Vec<String>,
    steps: Vec<Step>,
}

type Done = Result<(), FormulaError>;

impl Parser<'_> {
    fn peek(&self) -> (Token, usize) {
        self.tokens[self.next.min(self.tokens.len() - 1)].clone()
    }

    fn sign(&self) -> Option<&'static str> {
        match self.tokens[self.next.min(self.tokens.len() - 1)].0 {
            Token::Sign(sign) => Some(sign),
            _ => None,
        }
    }

    fn take(&mut self, wanted: &[&'static str]) -> Option<&'static str> {
        let sign = self.sign().filter(|sign| wanted.contains(sign))?;
        self.next += 1;
        Some(sign)
    }

    fn wrong(&self, what: impl Into<String>, at: usize) -> FormulaError {
        FormulaError::new(what, self.text, at)
    }

    fn two(&mut self, call: fn(f64, f64) -> f64) {
        self.steps.push(Step::Call(Call::Two(call), 2));
    }

    fn comparison(&mut self, depth: usize) -> Done {
        if depth > MOST_DEPTH {
            let at = self.peek().1;
            return Err(self.wrong(format!("brackets go deeper than {MOST_DEPTH} here"), at));
        }
        self.sum(depth)?;
        let signs = COMPARISONS.map(|(sign, _)| sign);
        let Some(sign) = self.take(&signs) else { return Ok(()) };
        self.sum(depth)?;
        if self.sign().is_some_and(|sign| signs.contains(&sign)) {
            let at = self.peek().1;
            return Err(self.wrong("compare two at a time: (a < b)*(b < c)", at));
        }
        if let Some((_, call)) = COMPARISONS.iter().find(|(other, _)| *other == sign) {
            self.two(*call);
        }
        Ok(())
    }

    fn sum(&mut self, depth: usize) -> Done {
        self.product(depth)?;
        while let Some(sign) = self.take(&["+", "-"]) {
            self.product(depth)?;
            self.two(if sign == "+" { |a, b| a + b } else { |a, b| a - b });
        }
        Ok(())
    }

    fn product(&mut self, depth: usize) -> Done {
        self.signed(depth)?;
        while let Some(sign) = self.take(&["*", "/", "%"]) {
            self.signed(depth)?;
            self.two(match sign {
                "*" => |a, b| a * b,
                "/" => |a, b| a / b,
                _ => |a, b| a % b,
            });
        }
        Ok(())
    }

    fn signed(&mut self, depth: usize) -> Done {
        let at = self.peek().1;
        let mut negative = false;
        let mut signed = false;
        while let Some(sign) = self.take(&["+", "-"]) {
            negative ^= sign == "-";
            signed = true;
        }
        let powered = self.power(depth)?;
        if powered && signed {
            let what = "a sign before a power can be read in two ways: write -(x^2) or (-x)^2";
            return Err(self.wrong(what, at));
        }
        if negative {
            self.steps.push(Step::Negate);
        }
        Ok(())
    }

    /// A power; true where there is one.
    fn power(&mut self, depth: usize) -> Result<bool, FormulaError> {
        self.atom(depth)?;
        if self.take(&["^", "**"]).is_none() {
            return Ok(false);
        }
        if depth >= MOST_DEPTH {
            let at = self.peek().1;
            return Err(self.wrong(format!("powers go deeper than {MOST_DEPTH} here"), at));
        }
        // A sign in an exponent has one meaning: 2^-3.
        let mut negative = false;
        while let Some(sign) = self.take(&["+", "-"]) {
            negative ^= sign == "-";
        }
        self.power(depth + 1)?;
        if negative {
            self.steps.push(Step::Negate);
        }
        self.two(f64::powf);
        Ok(true)
    }

    fn atom(&mut self, depth: usize) -> Done {
        let (token, at) = self.peek();
        self.next += 1;
        match token {
            Token::Number(number) => self.steps.push(Step::Number(number)),
            Token::Name(name) if self.sign() == Some("(") => return self.call(&name, at, depth),
            Token::Quoted(name) | Token::Name(name) => self.name(name),
            Token::Sign("(") => {
                self.comparison(depth + 1)?;
                if self.take(&[")"]).is_none() {
                    let what = "this bracket is not closed, or an operator is missing in it";
                    return Err(self.wrong(what, at));
                }
            }
            Token::End => return Err(self.wrong("the formula ends too early", at)),
            Token::Sign(sign) => {
                return Err(
                    self.wrong(format!("a number or a name is missing before '{sign}'"), at)
                );
            }
        }
        Ok(())
    }

    fn name(&mut self, name: String) {
        let known = self.names.iter().position(|other| *other == name);
        let index = known.unwrap_or_else(|| {
            self.names.push(name);
            self.names.len() - 1
        });
        self.steps.push(Step::Name(index));
    }

    fn call(&mut self, name: &str, at: usize, depth: usize) -> Done {
        let Some(function) = FUNCTIONS.iter().find(|f| f.name == name) else {
            let known: Vec<&str> = FUNCTIONS.iter().map(|f| f.name).collect();
            let what = format!("there is no function '{name}'; there are: {}", known.join(", "));
            return Err(self.wrong(what, at));
        };
        self.next += 1;
        let mut arguments = 0;
        if self.sign() != Some(")") {
            loop {
                self.comparison(depth + 1)?;
                arguments += 1;
                if self.take(&[","]).is_none() {
                    break;
                }
            }
        }
        if self.take(&[")"]).is_none() {
            return Err(self.wrong(format!("the bracket of {name} is not closed"), at));
        }
        let (least, most) = function.call.arguments();
        if !(least..=most).contains(&arguments) {
            let wanted =
                if most == usize::MAX { format!("{least} or more") } else { least.to_string() };
            let what = format!("{name} takes {wanted} values, not {arguments}");
            return Err(self.wrong(what, at));
        }
        self.steps.push(Step::Call(function.call, arguments));
        Ok(())
    }
}
