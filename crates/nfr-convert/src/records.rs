//! Records of a file that grows while a program runs. A record that was cut off or damaged is told by its checksum.

/// Appends a record: the length of the payload (`u32`, big-endian), the payload, and its CRC-32 (`u32`, big-endian).
pub fn append_record(out: &mut Vec<u8>, payload: &[u8]) {
    out.extend((payload.len() as u32).to_be_bytes());
    out.extend(payload);
    out.extend(crc32fast::hash(payload).to_be_bytes());
}

/// The first record's payload and the bytes after the record; `None` if the record is cut off or damaged.
pub fn split_record(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = bytes.split_first_chunk()?;
    let (payload, rest) = rest.split_at_checked(u32::from_be_bytes(*length) as usize)?;
    let (checksum, rest) = rest.split_first_chunk()?;
    (u32::from_be_bytes(*checksum) == crc32fast::hash(payload)).then_some((payload, rest))
}

/// The payloads of exactly `N` records; `None` if one is cut off or damaged, or more follows.
pub fn records<const N: usize>(bytes: &[u8]) -> Option<[&[u8]; N]> {
    let mut rest = bytes;
    let mut payloads = [&bytes[..0]; N];
    for payload in &mut payloads {
        (*payload, rest) = split_record(rest)?;
    }
    rest.is_empty().then_some(payloads)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_are_read_back_in_order() {
        let mut bytes = Vec::new();
        [b"one".as_slice(), b"", b"three"].iter().for_each(|payload| append_record(&mut bytes, payload));
        let mut rest = bytes.as_slice();
        for expected in [b"one".as_slice(), b"", b"three"] {
            let (payload, after) = split_record(rest).expect("a whole record");
            assert_eq!(payload, expected);
            rest = after;
        }
        assert!(rest.is_empty());
        assert_eq!(records(&bytes), Some([b"one".as_slice(), b"", b"three"]));
        assert_eq!(records::<2>(&bytes), None, "more follows");
        assert_eq!(records::<4>(&bytes), None, "one is missing");
    }

    #[test]
    fn a_record_with_any_bit_flipped_or_any_byte_missing_is_refused() {
        let mut bytes = Vec::new();
        append_record(&mut bytes, b"payload");
        for at in 0..bytes.len() {
            assert_eq!(split_record(&bytes[..at]), None, "cut off at {at}");
            for bit in 0..8 {
                let mut damaged = bytes.clone();
                damaged[at] ^= 1 << bit;
                assert_eq!(split_record(&damaged), None, "bit {bit} of byte {at}");
            }
        }
    }
}
