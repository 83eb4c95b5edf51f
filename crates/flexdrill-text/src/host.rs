//! Names and addresses of machines.

use std::net::Ipv4Addr;

/// Longest name that DNS allows (bytes).
const LONGEST_NAME: usize = 253;

/// Whether this can be the name or the IPv4 address of a machine. A text of digits and dots alone must be an address.
pub fn is_host(name: &str) -> bool {
    let is_word = |part: &str| {
        !part.is_empty()
            && !part.starts_with('-')
            && part.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_')
    };
    let is_number = name.chars().all(|c| c.is_ascii_digit() || c == '.');
    name.len() <= LONGEST_NAME
        && if is_number {
            name.parse::<Ipv4Addr>().is_ok()
        } else {
            name.trim_end_matches('.').split('.').all(is_word)
        }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hosts_are_names_or_addresses() {
        for good in ["rig-7", "rig_7.example.org", "10.0.0.7", "plot.local.", "7up.example"] {
            assert!(is_host(good), "{good}");
        }
        let long = "a".repeat(300);
        for bad in [
            "",
            " ",
            "a b",
            "10.0.0",
            "10.0.0.256",
            "10.0.0.7:7400",
            "::1",
            "fe80::1",
            "a..b",
            "-a",
            "a;b",
            &long,
        ] {
            assert!(!is_host(bad), "{bad}");
        }
    }
}
