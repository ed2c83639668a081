//! On what numbers were measured.

use std::{env, fs, path::Path, process::Command, time::UNIX_EPOCH};

/// Whether this program was built to find faults, and is slower than it has to be.
pub const IS_DEBUG_BUILD: bool = cfg!(debug_assertions);

/// The processor, the commit and how it was built, in words.
pub(super) fn machine() -> String {
    let build =
        if IS_DEBUG_BUILD { "debug build: its seconds are not those of a release build" } else { "release build" };
    format!("{}, {}, {build}", processor(), commit())
}

fn processor() -> String {
    let named = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    });
    named.unwrap_or_else(|| env::consts::ARCH.to_owned())
}

/// What was built: said when it was, else asked of the repository that it was built from, else the version.
fn commit() -> String {
    if let Some(commit) = option_env!("WRIGGLE_COMMIT") {
        return format!("commit {commit}");
    }
    let source = Path::new(env!("CARGO_MANIFEST_DIR"));
    let program = env::current_exe().and_then(fs::metadata).and_then(|program| program.modified());
    let built = program.ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok()).map(|time| time.as_secs());
    let asked = if source.join(".git").exists() { in_repository(source, built) } else { None };
    asked.unwrap_or_else(|| format!("version {}", env!("CARGO_PKG_VERSION")))
}

/// The commit that is checked out; where that was made after the program was built, in seconds of 1970, the last one before.
fn in_repository(source: &Path, built: Option<u64>) -> Option<String> {
    let git = |args: &[&str]| {
        let output = Command::new("git").arg("-C").arg(source).args(args).output().ok()?;
        let said = String::from_utf8(output.stdout).ok()?.trim().to_owned();
        (output.status.success() && !said.is_empty()).then_some(said)
    };
    let made: u64 = git(&["log", "-1", "--format=%ct"])?.parse().ok()?;
    if let Some(built) = built.filter(|built| *built < made) {
        let last = git(&["log", "-1", "--format=%h", &format!("--before=@{built}")])?;
        return Some(format!("built after commit {last}"));
    }
    git(&["describe", "--always", "--dirty", "--exclude", "*"]).map(|commit| format!("commit {commit}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_is_not_said_to_be_of_a_commit_that_was_made_after_it() {
        let folder = tempfile::tempdir().unwrap();
        let git = |made: u64, args: &[&str]| {
            let mut git = Command::new("git");
            git.arg("-C").arg(folder.path()).args(["-c", "user.name=w", "-c", "user.email=w"]).args(args);
            git.env("GIT_COMMITTER_DATE", format!("@{made} +0000")).output().is_ok_and(|output| output.status.success())
        };
        let commit = |made, text: &str| git(made, &["commit", "-q", "--allow-empty", "-m", text]);
        if !(git(0, &["init", "-q"]) && commit(1_000_000_000, "first") && commit(1_000_001_000, "second")) {
            println!("skipped: there is no git here");
            return;
        }
        let at = |built| in_repository(folder.path(), built).unwrap();
        let (before, after) = (at(Some(1_000_000_500)), at(Some(1_000_001_500)));
        assert!(before.starts_with("built after commit ") && after.starts_with("commit "), "{before}, {after}");
        assert_ne!(before.rsplit(' ').next(), after.rsplit(' ').next());
        // Built before everything that is known.
        assert_eq!(in_repository(folder.path(), Some(999_999_999)), None);
    }
}
