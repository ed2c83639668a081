//! How much memory there is for bodies.

use std::fs;

/// How many bytes can still be had: what the machine has available, and by how much the address space of the process may still grow, where that is limited. Nothing
/// where the system does not tell; Linux does.
pub(super) fn available() -> Option<u64> {
    let read = |file: &str, key: &str| number(&fs::read_to_string(file).ok()?, key);
    let machine = read("/proc/meminfo", "MemAvailable:").map(|kibibytes| kibibytes * 1024);
    let most = read("/proc/self/limits", "Max address space");
    let taken = read("/proc/self/status", "VmSize:").map(|kibibytes| kibibytes * 1024);
    let room = most.zip(taken).map(|(most, taken)| most.saturating_sub(taken));
    [machine, room].into_iter().flatten().min()
}

/// The number behind a key at the start of a line.
fn number(text: &str, key: &str) -> Option<u64> {
    text.lines().find_map(|line| line.strip_prefix(key))?.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_are_read_and_words_are_none() {
        let text =
            "Max cpu time      unlimited    unlimited   seconds\nMax address space 2560000000   unlimited   bytes\n";
        assert_eq!(number(text, "Max address space"), Some(2_560_000_000));
        assert_eq!(number(text, "Max cpu time"), None);
        assert_eq!(number(text, "VmSize:"), None);
    }
}
