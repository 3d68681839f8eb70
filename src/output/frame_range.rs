//! A range of frames, as a user writes it.

use std::str::FromStr;

/// Frames from `first` to `last`, both included.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameRange {
    pub first: u32,
    pub last: u32,
}

impl FrameRange {
    pub const ALL: Self = Self {
        first: 0,
        last: u32::MAX,
    };

    pub fn contains(&self, frame: u32) -> bool {
        (self.first..=self.last).contains(&frame)
    }
}

impl FromStr for FrameRange {
    type Err = String;

    /// `10..40`, where either end may be left out, or one frame: `12`.
    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str, otherwise: u32| match text.trim() {
            "" => Ok(otherwise),
            text => text.parse().map_err(|_| wrong()),
        };
        let (first, last) = match text.split_once("..") {
            Some((first, last)) => (number(first, 0)?, number(last.trim_start_matches('='), u32::MAX)?),
            None => {
                let frame = text.trim().parse().map_err(|_| wrong())?;
                (frame, frame)
            }
        };
        if first > last {
            return Err(format!("{first} comes after {last}; write {last}..{first}"));
        }
        Ok(Self { first, last })
    }
}

fn wrong() -> String {
    "write FIRST..LAST, as in 10..40, 10.. or ..40, or one frame".to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_are_included_and_may_be_left_out() {
        let parse = |text: &str| text.parse::<FrameRange>().map(|r| (r.first, r.last));
        assert_eq!(parse("10..40"), Ok((10, 40)));
        assert_eq!(parse("7"), Ok((7, 7)));
        assert_eq!(parse("..3"), Ok((0, 3)));
        assert_eq!(parse("3.."), Ok((3, u32::MAX)));
        assert!("10..40".parse::<FrameRange>().unwrap().contains(40));
        for wrong in ["", "a", "4..3", "1-5", "-3", "1..b"] {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
    }
}
