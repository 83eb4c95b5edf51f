//! Logs that are compressed, and files that are no logs at all, by their first bytes.

use std::borrow::Cow;
use std::io::Read;

use crate::FieldLogError;

/// The first bytes of files that are not read, with what they are.
const NOT_READ: [(&[u8], &str); 6] = [
    (b"PK\x03\x04", "a workbook (.xlsx) or a ZIP archive"),
    (b"\xd0\xcf\x11\xe0", "a workbook (.xls)"),
    (b"\xfd7zXZ", "compressed with xz"),
    (b"BZh", "compressed with bzip2"),
    (b"7z\xbc\xaf", "a 7-Zip archive"),
    (b"Rar!", "a RAR archive"),
];

/// The text of a log: unpacked where the content is compressed with gzip or Zstandard, whatever the file's name is.
///
/// # Errors
/// When the compressed content is damaged, is more than `most` bytes of text, or is a file of another kind.
pub(crate) fn unpacked<'a>(file: &str, content: &'a [u8], most: u64) -> Result<Cow<'a, [u8]>, FieldLogError> {
    let damaged = |how: &'static str, reason: &std::io::Error| FieldLogError::Compressed {
        file: file.to_owned(),
        how,
        reason: reason.to_string(),
    };
    if content.starts_with(b"\x1f\x8b\x08") {
        // Loggers append members, so that all of them are read.
        let decoder = flate2::read::MultiGzDecoder::new(content);
        return text_of(file, decoder, most, |reason| damaged("gzip", reason)).map(Cow::Owned);
    }
    if content.starts_with(b"\x28\xb5\x2f\xfd") {
        let decoder =
            zstd::stream::read::Decoder::with_buffer(content).map_err(|reason| damaged("Zstandard", &reason))?;
        return text_of(file, decoder, most, |reason| damaged("Zstandard", reason)).map(Cow::Owned);
    }
    let kind = NOT_READ.iter().find(|(begin, _)| content.starts_with(begin));
    kind.map_or(Ok(Cow::Borrowed(content)), |(_, kind)| {
        Err(FieldLogError::OtherFile {
            file: file.to_owned(),
            kind,
        })
    })
}

/// Reads at most `most` bytes, because some kilobytes can unpack to more than the memory holds.
fn text_of(
    file: &str,
    decoder: impl Read,
    most: u64,
    damaged: impl Fn(&std::io::Error) -> FieldLogError,
) -> Result<Vec<u8>, FieldLogError> {
    let mut text = Vec::new();
    let read = decoder.take(most + 1).read_to_end(&mut text);
    read.map_err(|reason| damaged(&reason))?;
    if text.len() as u64 > most {
        return Err(FieldLogError::TooLarge {
            file: file.to_owned(),
            bytes: text.len() as u64,
            most,
        });
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write as _;

    fn gzip(text: &[u8]) -> Vec<u8> {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
        encoder.write_all(text).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn both_kinds_are_unpacked_and_a_bound_holds() {
        let text = b"t,rpm,wob\n0,40,1\n".repeat(100);
        let zstd = zstd::encode_all(&text[..], 3).unwrap();
        for packed in [gzip(&text), zstd, [gzip(&text[..500]), gzip(&text[500..])].concat()] {
            assert_eq!(unpacked("log", &packed, 1 << 20).unwrap(), text);
            let error = unpacked("log", &packed, 1000).unwrap_err().to_string();
            assert!(error.contains("at most 1000 are read"), "{error}");
            for length in 4..packed.len() {
                // A part of a file is damaged, or ends between two members.
                if let Ok(text) = unpacked("log", &packed[..length], 1 << 20) {
                    assert!(text.len() == 500, "{length}");
                }
            }
        }
        assert_eq!(unpacked("log", &text, 10).unwrap(), text);
        let error = unpacked("log", b"PK\x03\x04....", 10).unwrap_err().to_string();
        assert!(error.contains("workbook") && error.contains("CSV UTF-8"), "{error}");
    }
}
