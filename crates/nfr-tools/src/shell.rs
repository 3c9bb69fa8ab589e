//! `nfr completions` and `nfr man`: what shells and `man` know of both programs, made from the definitions of their arguments.

use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;

use clap::{Command, CommandFactory, ValueEnum};
use clap_complete::Shell;
use clap_mangen::Man;

use super::convert;
use super::failure::Failure;
use super::files::Output;

/// A program of this package.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Program {
    Nfr,
    NfrConvert,
}

/// Prints a script that completes the arguments of a program in a shell
///
/// For bash: nfr completions bash > ~/.local/share/bash-completion/completions/nfr, and the same with nfr-convert at both ends. For zsh
/// the file is named _nfr in a directory of $fpath, for fish nfr.fish in ~/.config/fish/completions.
#[derive(Debug, clap::Args)]
pub struct CompletionsArgs {
    /// The shell
    shell: Shell,
    /// The program whose arguments are completed
    #[arg(default_value = "nfr")]
    program: Program,
}

/// Writes the man pages of both programs and of each command
///
/// As in nfr man ~/.local/share/man/man1.
#[derive(Debug, clap::Args)]
pub struct ManArgs {
    /// The directory for the pages; it is made if it is missing
    #[arg(value_name = "DIR")]
    directory: PathBuf,
}

/// Runs `nfr completions`. `nfr` gives the arguments of `nfr`.
///
/// # Errors
///
/// If stdout cannot be written.
pub fn completions(args: &CompletionsArgs, nfr: impl Fn() -> Command) -> Result<(), Failure> {
    let mut command = match args.program {
        Program::Nfr => nfr(),
        Program::NfrConvert => convert::Args::command(),
    };
    let name = command.get_name().to_owned();
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command, name, &mut script);
    Ok(io::stdout().write_all(&script)?)
}

/// Runs `nfr man`. `nfr` gives the arguments of `nfr`.
///
/// # Errors
///
/// A directory that cannot be made, a page that cannot be written.
pub fn man(args: &ManArgs, nfr: impl Fn() -> Command) -> Result<(), Failure> {
    let directory = &args.directory;
    fs::create_dir_all(directory).map_err(|e| {
        Failure::failed(format!(
            "cannot make the directory {} ({e}); choose a place that you may write to",
            directory.display()
        ))
    })?;
    for command in [nfr(), convert::Args::command()] {
        for (name, page) in pages(command)? {
            Output::new(&directory.join(name))?.write(&page)?;
        }
    }
    Ok(())
}

/// The pages of a program and of its commands, with their names.
fn pages(command: Command) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    let mut command = command.disable_help_subcommand(true);
    command.build();
    let commands = command.get_subcommands().cloned().chain([command.clone()]);
    let page = |command: Command| {
        let man = Man::new(command);
        let mut page = Vec::new();
        man.render(&mut page)?;
        Ok((man.get_filename(), page))
    };
    commands.map(page).collect()
}
