//! The two scales at which experiments run: as published, and small enough for two cores.

use std::fmt;
use std::str::FromStr;

use super::implicit::ImplicitConfig;
use super::schedule::{implicit_rates, masked_rates};
use super::train::TrainingSchedule;

/// The scale at which experiments run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExperimentScale {
    /// The published widths, epochs and sizes: hours for each glyph, on a GPU.
    Paper,
    /// Narrower, shorter, and at as few small sizes as so little training can memorise: everything in half an hour on two
    /// cores.
    Small,
}

impl ExperimentScale {
    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Small => "small",
        }
    }
}

impl fmt::Display for ExperimentScale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for ExperimentScale {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let scale = [Self::Paper, Self::Small].into_iter().find(|scale| scale.name() == name);
        scale.ok_or_else(|| format!("unknown scale {name:?}; use paper or small"))
    }
}

/// The hyperparameters of experiments.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The scale that these began as.
    pub scale: ExperimentScale,
    /// The sides of the boxes, *s*.
    pub sides: Vec<usize>,
    /// The implicit network for one weight.
    pub implicit: ImplicitConfig,
    /// The implicit network for a family.
    pub family: ImplicitConfig,
    /// Epochs of the implicit network.
    pub implicit_epochs: usize,
    /// Hidden layers of the masked network.
    pub masked_widths: Vec<usize>,
    /// Epochs of the masked network.
    pub masked_epochs: usize,
    /// Epochs from one of its learning rates to the other.
    pub masked_period: usize,
    /// Determines first weights and the order of bitmaps.
    pub seed: u64,
}

/// Bitmaps in a batch of the masked network.
const MASKED_BATCH: usize = 32;
/// Bitmaps that batches mix in the ablation of the memorisation adaptations.
const MIXED_BATCH: usize = 4;

impl Settings {
    /// The settings of a scale.
    pub fn new(scale: ExperimentScale) -> Self {
        let whole = ImplicitConfig {
            width: 784,
            latent: 1420,
            encoder: 300,
            size: true,
            weight: false,
            frequencies: true,
            memorisation: true,
            residual: true,
        };
        let small = ImplicitConfig { width: 96, latent: 32, encoder: 32, ..whole };
        match scale {
            ExperimentScale::Paper => Self {
                scale,
                sides: (20..=63).collect(),
                implicit: whole,
                family: ImplicitConfig { width: 1024, weight: true, ..whole },
                implicit_epochs: 500,
                masked_widths: vec![1024, 512, 256, 256, 512, 1024],
                masked_epochs: 1600,
                masked_period: 50,
                seed: 1,
            },
            ExperimentScale::Small => Self {
                scale,
                sides: (20..=36).step_by(4).collect(),
                implicit: small,
                family: ImplicitConfig { weight: true, ..small },
                implicit_epochs: 500,
                masked_widths: vec![128, 64, 32, 32, 64, 128],
                masked_epochs: 800,
                masked_period: 25,
                seed: 1,
            },
        }
    }

    /// Trains both networks for so many epochs; the masked one's rates alternate as often as before.
    pub fn set_epochs(&mut self, epochs: usize) {
        self.masked_period = (self.masked_period * epochs / self.masked_epochs).max(1);
        (self.implicit_epochs, self.masked_epochs) = (epochs, epochs);
    }

    /// The training schedule of an implicit network.
    pub fn implicit_schedule(&self, config: ImplicitConfig) -> TrainingSchedule {
        let batch = if config.memorisation { 1 } else { MIXED_BATCH };
        TrainingSchedule { rates: implicit_rates(self.implicit_epochs), batch, seed: self.seed }
    }

    /// The training schedule of a masked network.
    pub fn masked_schedule(&self) -> TrainingSchedule {
        let rates = masked_rates(self.masked_epochs, self.masked_period);
        TrainingSchedule { rates, batch: MASKED_BATCH, seed: self.seed }
    }

    /// The scale at which figures and pictures were made, and whether that is the published one.
    pub fn scale_note(&self) -> &'static str {
        let published = Self { seed: self.seed, ..Self::new(ExperimentScale::Paper) };
        match self.scale {
            ExperimentScale::Paper if *self == published => "published scale",
            ExperimentScale::Paper => "PUBLISHED WIDTHS, not the published sizes and epochs",
            ExperimentScale::Small => "SMALL SCALE, not the published one",
        }
    }

    /// The line that every output carries: the scale, and the settings that matter most.
    pub fn label(&self) -> String {
        let sizes = self.sides.len();
        let (width, epochs, masked) = (self.implicit.width, self.implicit_epochs, self.masked_epochs);
        let note = self.scale_note();
        format!("{note}: {sizes} sizes; implicit {width} wide, {epochs} epochs; masked {masked} epochs")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_was_published_is_called_so() {
        let paper = Settings { seed: 7, ..Settings::new(ExperimentScale::Paper) };
        assert!(paper.label().starts_with("published scale: 44 sizes; implicit 784 wide, 500 epochs"));
        let fewer = Settings { sides: vec![20, 24], ..paper.clone() };
        assert!(fewer.label().starts_with("PUBLISHED WIDTHS, not the published sizes and epochs: 2 sizes"));
        let mut shorter = paper;
        shorter.set_epochs(100);
        assert!(shorter.label().starts_with("PUBLISHED WIDTHS"));
        assert!(Settings::new(ExperimentScale::Small).label().starts_with("SMALL SCALE"));
    }
}
