//! Which hints are learnt.

use std::fmt;

/// Follows skrifa's version in the name of a teacher that autohints.
const AUTOHINTER: &str = "autohinter";

/// What moves the points that models learn from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Hinter {
    /// The hints that the font carries.
    #[default]
    Font,
    /// skrifa's autohinter, a port of FreeType's, which finds stems and alignment zones in the outlines and reads no hints of the
    /// font.
    Auto,
}

impl Hinter {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Font => "font",
            Self::Auto => "auto",
        }
    }

    /// The hinter of this name on the command line.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Font, Self::Auto].into_iter().find(|hinter| hinter.name() == name)
    }

    /// The hinter of a font whose certificate names this teacher.
    pub fn of_teacher(teacher: &str) -> Self {
        if teacher.split(' ').any(|word| word == AUTOHINTER) { Self::Auto } else { Self::Font }
    }

    /// The name of the teacher that runs it, for the certificate. `engine` is the engine with its version.
    pub(crate) fn teacher(self, engine: &str) -> String {
        match self {
            Self::Font => engine.to_owned(),
            Self::Auto => format!("{engine} {AUTOHINTER}"),
        }
    }
}

impl fmt::Display for Hinter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_teachers_name_tells_its_hinter() {
        for hinter in [Hinter::Font, Hinter::Auto] {
            assert_eq!(Hinter::of_teacher(&hinter.teacher("skrifa 0.49")), hinter);
            assert_eq!(Hinter::from_name(hinter.name()), Some(hinter));
        }
        assert_eq!(Hinter::from_name("light"), None);
    }
}
