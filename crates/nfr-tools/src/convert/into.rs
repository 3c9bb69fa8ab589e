//! `nfr-convert --into`: a converted font gets the models that it lacks.

use std::path::{Path, PathBuf};

use crate::failure::Failure;
use crate::files::{modelled, open_neural, read};
use nfr::Target;
use nfr_convert::combine::merge;
use nfr_convert::compare::fonts::{FontPair, hinter_of};
use nfr_convert::ppem::PpemList;
use nfr_convert::{Conversion, Hinter, Options, Shape};

/// The converted font that gets more models.
pub(super) struct Existing {
    path: PathBuf,
    data: Vec<u8>,
    pub(super) target: Target,
    pub(super) hinter: Hinter,
    pub(super) ppem: PpemList,
    /// The glyphs that it has models of, ascending.
    gids: Vec<u16>,
    has_fields_only: bool,
    outlines_dropped: bool,
}

impl Existing {
    /// Opens it, and checks that it was made from `original`, the font of this index.
    pub(super) fn open(path: &Path, original: &[u8], index: u32) -> Result<Self, Failure> {
        let data = read(path)?;
        let (_, font) = open_neural(path, &data)?;
        let gids = modelled(&font)?;
        let pair = FontPair::open(original, index, &data).map_err(|e| Failure::from(e).at(path.display()))?;
        pair.check_outlines(&gids).map_err(|e| Failure::from(e).at(path.display()))?;
        let (first, last) = font.ppem_range();
        let has_fields_only = nfr::internals::table(&font)?.outlines().is_empty() && !gids.is_empty();
        Ok(Self {
            path: path.to_owned(),
            target: font.target(),
            hinter: hinter_of(&font)?,
            ppem: PpemList::from(first..=last),
            gids,
            has_fields_only,
            outlines_dropped: font.outlines_dropped(),
            data,
        })
    }

    /// Refuses sizes, a target, a hinter or a treatment of outlines that its models do not have.
    pub(super) fn check(
        &self,
        ppem: &PpemList,
        target: Target,
        hinter: Hinter,
        drops_outlines: bool,
    ) -> Result<(), Failure> {
        let path = self.path.display();
        let refuse = |what: String| Err(Failure::usage(format!("{path}: its models are {what}")));
        if *ppem != self.ppem {
            return refuse(format!("for {} ppem, and not for {ppem}; leave the sizes out", self.ppem));
        }
        if target != self.target {
            return refuse(format!("for {}, and not for {target}; leave --target out", self.target));
        }
        if hinter != self.hinter {
            return refuse(format!(
                "those of --hinter {}, and not of {hinter}; leave --hinter out",
                self.hinter
            ));
        }
        match (self.outlines_dropped, drops_outlines) {
            (true, false) => refuse("all that it has of the glyphs; add --drop-outlines".into()),
            (false, true) => refuse("beside the outlines; leave --drop-outlines out".into()),
            _ => Ok(()),
        }
    }

    /// The glyphs of a selection that it has no model of.
    pub(super) fn missing(&self, gids: &[u16]) -> Vec<u16> {
        gids.iter().copied().filter(|gid| self.gids.binary_search(gid).is_err()).collect()
    }

    /// Where models have their shapes from, if the options leave that to the program.
    pub(super) fn shape(&self, shape: Shape) -> Shape {
        if shape == Shape::Auto && self.has_fields_only { Shape::Field } else { shape }
    }

    /// Puts the models of a conversion into it. The conversion is about its glyphs, then.
    pub(super) fn merge(
        &self,
        original: &[u8],
        options: &Options,
        conversion: &mut Conversion,
    ) -> Result<(), Failure> {
        conversion.font = merge((original, options.index), &self.data, &conversion.font, options.jobs)?;
        conversion.table_bytes = nfr::Font::new(conversion.font.clone())?.table_len();
        Ok(())
    }

    /// The bytes of its file.
    pub(super) fn len(&self) -> usize {
        self.data.len()
    }

    /// The font as it is, if nothing is missing.
    pub(super) fn into_data(self) -> Vec<u8> {
        self.data
    }
}
