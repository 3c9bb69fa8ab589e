//! A font whose glyphs are drawn by networks that were trained elsewhere.

use std::collections::BTreeSet;

use nfr::internals::head_units;
use nfr::internals::model::sizes::Origin;
use nfr::internals::network::NetworkWeights;
use nfr::internals::network::Precision;
use nfr::internals::network::{Head, encode};
use nfr::internals::table::Header;
use nfr_convert::assemble::{assemble, outline_hash};
use nfr_convert::error::Error;
use nfr_convert::open::{has_models, open};
use nfr_convert::select::glyph_count;
use nfr_convert::writer::{GlyphNetwork, write};

/// The level of zstd. Higher ones save nothing: they look farther back for repetitions, which weights do not have.
const LEVEL: i32 = 19;

/// Packs a glyph's network for the table.
///
/// # Errors
///
/// As [`NetworkWeights::check`].
pub fn pack(gid: u16, weights: &NetworkWeights, precision: Precision) -> Result<GlyphNetwork, Error> {
    let encoded = encode(weights, precision)?;
    let frame = zstd::bulk::compress(&encoded.numbers, LEVEL)
        .map_err(|e| Error::Io(format!("the network of glyph {gid} cannot be compressed ({e})")))?;
    Ok(GlyphNetwork { gid, bytes: [encoded.head, frame].concat() })
}

/// Writes a font that carries networks instead of hints, and all outlines as they are. `data` is a TrueType font's file,
/// or a collection of which it is number `index`; `networks` are packed and in ascending order of their glyphs. Of `about`, the
/// target, the seed and the training's numbers are used; sizes and hash are those of the networks and the font.
///
/// # Errors
///
/// As [`open`] and [`assemble`]; `Unsupported` for a font that has models already, `MissingGlyph` for a network of a
/// glyph that the font does not have, `InvalidParameter` for no networks, or for ones that are out of order, `Malformed` or
/// `LimitExceeded` for one whose head cannot be read.
pub fn with_networks(
    data: &[u8],
    index: u32,
    networks: &[GlyphNetwork],
    about: &Header,
) -> Result<Vec<u8>, Error> {
    let font = open(data, index)?;
    if has_models(&font) {
        return Err(Error::Unsupported(
            "the font already carries an 'Nfrt' table; put the networks into the original font".into(),
        ));
    }
    let glyphs = glyph_count(&font)?;
    if let Some(missing) = networks.iter().find(|network| u32::from(network.gid) >= glyphs) {
        return Err(Error::MissingGlyph(missing.gid));
    }
    let heads = networks.iter().map(|network| Ok(Head::parse(&network.bytes)?.0));
    let heads = heads.collect::<Result<Vec<_>, Error>>()?;
    let sizes = || heads.iter().flat_map(|head| &head.sizes).map(|size| size.ppem);
    let (Some(first_ppem), Some(last_ppem)) = (sizes().min(), sizes().max()) else {
        return Err(Error::InvalidParameter("no networks; pass one at least".into()));
    };
    let header = Header {
        first_ppem,
        last_ppem,
        outline_hash: outline_hash(&font)?,
        outlines_dropped: false,
        origin: Origin::TrueType,
        glyph_count: glyph_count(&font)?.try_into().unwrap_or(0),
        ..*about
    };
    let scale = header.scale(head_units(&font)?).ok_or_else(|| {
        Error::InvalidParameter(format!("networks for {first_ppem}–{last_ppem} ppem, 1–1024 are allowed"))
    })?;
    let (table, _) = write(&header, &[], &[], networks, scale)?;
    assemble(&font, &table, &BTreeSet::new())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use nfr::internals::network::decode;
    use nfr::internals::network::{Architecture, Dense, NORMS, NetworkSize, Norm};

    const SANS: &[u8] = include_bytes!("../../../fonts/LiberationSans-Regular.ttf");

    /// A network whose weights repeat, so that they compress.
    fn network(ppem: u16) -> NetworkWeights {
        let architecture =
            Architecture { width: 24, latent: 0, encoder: 0, frequencies: false, residual: true };
        let dense = architecture.layers().into_iter().map(|(inputs, outputs)| Dense {
            inputs,
            outputs,
            weights: (0..inputs * outputs).map(|k| (k % 7) as f32 - 3.0).collect(),
            bias: vec![0.5; outputs],
        });
        let norm = Norm { gamma: vec![1.0; 24], beta: vec![0.0; 24] };
        let size = NetworkSize { ppem, side: 20, origin: [2, 17], crop: [1, 1, 18, 18] };
        NetworkWeights { architecture, sizes: vec![size], dense: dense.collect(), norms: vec![norm; NORMS] }
    }

    #[test]
    fn what_zstd_packs_the_renderer_unpacks() {
        for precision in [Precision::Eight, Precision::Sixteen] {
            let encoded = encode(&network(18), precision).unwrap();
            let packed = pack(5, &network(18), precision).unwrap();
            assert!(packed.bytes.len() < encoded.numbers.len() / 2, "{} bytes", packed.bytes.len());
            let read = decode(&packed.bytes).unwrap();
            assert_eq!((read.architecture, &read.sizes), (network(18).architecture, &network(18).sizes));
            assert_eq!(encode(&read, precision).unwrap(), encoded);
        }
    }

    #[test]
    fn a_font_says_what_its_networks_were_trained_for() {
        let networks =
            [(4, 30), (7, 12)].map(|(gid, ppem)| pack(gid, &network(ppem), Precision::Eight).unwrap());
        let file = with_networks(SANS, 0, &networks, &Header { seed: 9, ..Header::default() }).unwrap();
        let font = nfr::Font::new(file.clone()).unwrap();
        assert_eq!((font.ppem_range(), nfr::internals::header(&font).seed), ((12, 30), 9));
        assert!(nfr::internals::table(&font).unwrap().network_gids().eq([4, 7]));
        assert!(font.outlines_match() && !font.outlines_dropped());
        assert!(nfr::Rasterizer::new(&font).render(7, 12.0).is_ok());
        let again = with_networks(&file, 0, &networks, &Header::default());
        assert!(matches!(again, Err(Error::Unsupported(why)) if why.contains("already")));
    }

    #[test]
    fn networks_that_do_not_fit_a_font_are_refused() {
        let with = |networks: &[GlyphNetwork]| with_networks(SANS, 0, networks, &Header::default());
        let [first, last] = [4, 7].map(|gid| pack(gid, &network(18), Precision::Eight).unwrap());
        assert!(matches!(with(&[]), Err(Error::InvalidParameter(_))));
        assert!(matches!(with(&[last, first.clone()]), Err(Error::InvalidParameter(_))));
        let far = GlyphNetwork { gid: 60_000, ..first.clone() };
        assert_eq!(with(&[far]), Err(Error::MissingGlyph(60_000)));
        let damaged = GlyphNetwork { gid: 4, bytes: first.bytes[..12].to_vec() };
        assert!(matches!(with(&[damaged]), Err(Error::Malformed(_))));
        let mut broken = network(18);
        broken.dense[3].bias[0] = f32::NAN;
        let refused = pack(4, &broken, Precision::Eight);
        assert!(matches!(&refused, Err(Error::Malformed(why)) if why.contains("not finite")), "{refused:?}");
    }
}
