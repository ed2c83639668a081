//! On what numbers were measured.

use std::{fs, path::Path, process::Command};

/// The processor and the commit, in words.
pub(super) fn machine() -> String {
    format!("{}, {}", processor(), commit())
}

fn processor() -> String {
    let named = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    });
    named.unwrap_or_else(|| std::env::consts::ARCH.to_owned())
}

/// What was built: said when it was, else asked of the repository that it was built from, else the version.
fn commit() -> String {
    if let Some(commit) = option_env!("WRIGGLE_COMMIT") {
        return format!("commit {commit}");
    }
    let source = env!("CARGO_MANIFEST_DIR");
    let asked = Path::new(source).join(".git").exists().then(|| {
        Command::new("git").args(["-C", source, "describe", "--always", "--dirty", "--exclude", "*"]).output().ok()
    });
    let said = asked.flatten().filter(|output| output.status.success());
    let commit = said.and_then(|output| String::from_utf8(output.stdout).ok()).map(|text| text.trim().to_owned());
    commit
        .filter(|commit| !commit.is_empty())
        .map_or_else(|| format!("version {}", env!("CARGO_PKG_VERSION")), |commit| format!("commit {commit}"))
}
