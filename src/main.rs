//! The program `wriggle`: see `wriggle --help`.

fn main() -> std::process::ExitCode {
    wriggle::cli::main()
}
