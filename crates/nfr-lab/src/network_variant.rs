//! The models that experiments train, by name: the two networks, and what ablations leave out of the implicit one.

use super::implicit::ImplicitConfig;

/// The grid-fit field's name in tables.
pub const GRID_FIT: &str = "grid-fit";

/// A part that is left out of the implicit network or its training.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ablation {
    /// The frequency encoding: positions and sizes are inputs as they are.
    Frequencies,
    /// The memorisation adaptations: batches mix bitmaps, drawing uses running statistics.
    Memorisation,
    /// The residual additions.
    Residuals,
    /// The size as an input, as in the published code for one weight.
    Size,
}

impl Ablation {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Frequencies, Self::Memorisation, Self::Residuals, Self::Size];

    /// The name on the command line, and in tables after "without".
    pub fn name(self) -> &'static str {
        match self {
            Self::Frequencies => "frequencies",
            Self::Memorisation => "memorisation",
            Self::Residuals => "residuals",
            Self::Size => "size",
        }
    }

    /// The network without it.
    pub fn apply(self, config: ImplicitConfig) -> ImplicitConfig {
        match self {
            Self::Frequencies => ImplicitConfig { frequencies: false, ..config },
            Self::Memorisation => ImplicitConfig { memorisation: false, ..config },
            Self::Residuals => ImplicitConfig { residual: false, ..config },
            Self::Size => ImplicitConfig { size: false, ..config },
        }
    }
}

impl std::str::FromStr for Ablation {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|ablation| ablation.name() == name);
        found
            .ok_or_else(|| format!("unknown part {name:?}; use frequencies, memorisation, residuals or size"))
    }
}

/// A model of a glyph.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NetworkVariant {
    /// The implicit network, without some parts.
    Implicit(Vec<Ablation>),
    /// The masked network.
    Masked,
}

impl NetworkVariant {
    /// The name in tables and paths.
    pub fn name(&self) -> String {
        match self {
            Self::Masked => "masked".into(),
            Self::Implicit(without) if without.is_empty() => "implicit".into(),
            Self::Implicit(without) => {
                let parts: Vec<&str> = without.iter().map(|ablation| ablation.name()).collect();
                format!("implicit without {}", parts.join(" and "))
            }
        }
    }
}
