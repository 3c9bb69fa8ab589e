//! Fonts that are converted or compared with: font files, collections, web fonts, and instances of variable fonts.

mod instancer;

use std::path::{Path, PathBuf};
use std::time::Duration;

use super::failure::Failure;
use super::files::read;
use instancer::Instancer;
use nfr_convert::open::open;
use nfr_convert::variable::{AxisValue, Variations};
use nfr_convert::web_font::unpack;

const HEADING: &str = "Variable fonts";

/// Which font of a file.
#[derive(Debug, Clone, clap::Args)]
pub(super) struct SourceArgs {
    /// The font's index, if the original is a collection
    #[arg(long, value_name = "N", default_value_t = 0)]
    index: u32,
    /// A value on an axis of a variable font, as in wght=600; once for each axis
    ///
    /// fontTools' instancer makes the static font, control values of hints (cvar) included: Python and fontTools have to be installed.
    #[arg(long, help_heading = HEADING, value_name = "TAG=VALUE")]
    axis: Vec<AxisValue>,
    /// The named instance of a variable font, as in "Semibold", in place of --axis
    #[arg(long, help_heading = HEADING, value_name = "NAME", conflicts_with = "axis")]
    instance: Option<String>,
    /// The Python that has fontTools
    #[arg(long, help_heading = HEADING, value_name = "PROGRAM", default_value = "python3")]
    python: PathBuf,
    /// The most seconds that fontTools may take
    #[arg(long, help_heading = HEADING, value_name = "SECONDS", default_value_t = 600)]
    instancer_timeout: u64,
}

/// A static font as the bytes of a file.
pub(super) struct Source {
    /// The file, unpacked, or the instance.
    pub(super) data: Vec<u8>,
    /// The font's index in it.
    pub(super) index: u32,
    /// The place of the instance, as in `wght=600 wdth=100`; none for a font that was static.
    pub(super) instance: Option<String>,
}

/// Reads a font file; a web font is unpacked.
pub(super) fn read_unpacked(path: &Path) -> Result<Vec<u8>, Failure> {
    let data = read(path)?;
    Ok(unpack(&data).map_err(|e| Failure::from(e).at(path.display()))?.into_owned())
}

impl SourceArgs {
    /// Reads a font.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, a variable font without a place, a place that it does not have, and those of fontTools.
    pub(super) fn load(&self, path: &Path) -> Result<Source, Failure> {
        let data = read_unpacked(path)?;
        self.face(&data, self.index, path)?
            .map_or_else(|| Ok(Source { data, index: self.index, instance: None }), Ok)
    }

    /// The instance of a font of a file that was read from `path`. None for a font that is static.
    ///
    /// # Errors
    ///
    /// As [`SourceArgs::load`].
    pub(super) fn face(&self, data: &[u8], index: u32, path: &Path) -> Result<Option<Source>, Failure> {
        self.instance_of(data, index, path).map_err(|failure| failure.at(path.display()))
    }

    fn instance_of(&self, data: &[u8], index: u32, path: &Path) -> Result<Option<Source>, Failure> {
        let font = open(data, index)?;
        let Some(variations) = Variations::of(&font) else {
            if self.axis.is_empty() && self.instance.is_none() {
                return Ok(None);
            }
            return Err(Failure::failed("the font is not variable; leave out --axis and --instance"));
        };
        let place = match &self.instance {
            Some(name) => variations.named(name)?,
            None if self.axis.is_empty() => return Err(no_place(&variations)),
            None => variations.complete(&self.axis)?,
        };
        let instancer = Instancer {
            python: &self.python,
            timeout: Duration::from_secs(self.instancer_timeout),
            path,
            index: font.ttc_index(),
        };
        let data = instancer.instance(&font, &place)?;
        let place: Vec<String> = place.iter().map(ToString::to_string).collect();
        Ok(Some(Source { data, index: 0, instance: Some(place.join(" ")) }))
    }
}

/// The failure for a variable font of which no instance is named.
fn no_place(variations: &Variations) -> Failure {
    let axis = |axis: &nfr_convert::variable::Axis| {
        format!("--axis {}", AxisValue { tag: axis.tag, value: axis.default })
    };
    let axes: Vec<String> = variations.axes.iter().map(axis).collect();
    let instances = match variations.instances.is_empty() {
        true => String::new(),
        false => format!(", or an instance with --instance: {}", variations.instances_text()),
    };
    Failure::failed(format!(
        "the font is variable, and a static one is needed; name a value for each axis ({}), as in {}{instances}",
        variations.axes_text(),
        axes.join(" ")
    ))
}
