//! References, speeds of gaits and shapes of blocks that were computed before, in files.
//!
//! A file holds the format's name and version, the problem's hash, what was computed and a checksum over all of it. A file that is damaged, cut off or
//! of another version counts as none: it is computed again and the file written anew.

use std::{env, fs, io::Write, path::PathBuf};

use bevy::math::DVec3;
use directories::ProjectDirs;

use crate::body::ParticleId;

use super::{
    GaitSpeeds, LabError, Problem, Reference, Shapes, StickSlip, energy::Energies, hash::Fnv, shapes::MEASURES,
};

/// The beginning of every reference. The number changes with the format and with what references are made of.
const HEAD: &[u8] = b"wriggle reference 2\n";
/// The beginning of every file of speeds. The number changes with the format and with how they are found.
const SPEEDS: &[u8] = b"wriggle gait speeds 1\n";
/// The beginning of every file of shapes, likewise.
const SHAPES: &[u8] = b"wriggle shapes 1\n";
/// The folder that is used instead of the platform's.
const VARIABLE: &str = "WRIGGLE_CACHE";

/// Where references are kept.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cache {
    folder: Option<PathBuf>,
}

impl Cache {
    /// The folder that the variable `WRIGGLE_CACHE` names, or else the platform's folder for what can be computed again.
    pub fn of_platform() -> Self {
        let named = env::var_os(VARIABLE).filter(|folder| !folder.is_empty()).map(PathBuf::from);
        let folder = named.or_else(|| Some(ProjectDirs::from("", "", "wriggle")?.cache_dir().into()));
        Self { folder }
    }

    /// A folder, which is made when there is something to keep.
    pub fn at(folder: impl Into<PathBuf>) -> Self {
        Self { folder: Some(folder.into()) }
    }

    /// Keeps nothing.
    pub fn none() -> Self {
        Self { folder: None }
    }

    /// The file that holds the reference of a problem, if anything is kept.
    pub fn file(&self, problem: &Problem) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join(format!("{:032x}.reference", problem.hash())))
    }

    /// The reference of a problem: the one that is kept, or else it is computed and kept. That it cannot be kept is no error.
    ///
    /// # Errors
    /// As [`Reference::solve`].
    pub fn reference(&self, problem: &Problem) -> Result<Reference, LabError> {
        let file = self.file(problem);
        kept(file, |bytes| read(problem, bytes), |reference| bytes(problem, reference), || Reference::solve(problem))
    }

    /// The speeds of the gaits of a problem: those that are kept, or else they are computed and kept. That they cannot be kept is no error.
    ///
    /// # Errors
    /// As [`GaitSpeeds::solve`].
    pub fn gait_speeds(&self, problem: &Problem) -> Result<GaitSpeeds, LabError> {
        let solve = || GaitSpeeds::solve(problem).map(|found| (found.error, found.speeds));
        let (error, speeds) = self.numbers(problem, SPEEDS, "speeds", problem.bodies.len(), solve)?;
        Ok(GaitSpeeds { speeds, error })
    }

    /// The shapes of the blocks of a problem: those that are kept, or else they are computed and kept. That they cannot be kept is no error.
    ///
    /// # Errors
    /// As [`Shapes::solve`].
    pub fn shapes(&self, problem: &Problem) -> Result<Shapes, LabError> {
        let solve = || Shapes::solve(problem).map(|found| (found.error, found.moments.into_flattened()));
        let count = problem.bodies.len() * Shapes::TIMES * MEASURES;
        let (error, numbers) = self.numbers(problem, SHAPES, "shapes", count, solve)?;
        Ok(Shapes { moments: numbers.as_chunks().0.to_vec(), error })
    }

    /// How far numbers are from what confirms them, and the numbers: as many as said. They are found in parts of the scene's own step, and depend on it, too.
    fn numbers(
        &self,
        problem: &Problem,
        head: &[u8],
        suffix: &str,
        count: usize,
        solve: impl FnOnce() -> Result<(f64, Vec<f64>), LabError>,
    ) -> Result<(f64, Vec<f64>), LabError> {
        let (hash, dt) = (problem.hash(), problem.setting.dt);
        let mut head = head.to_vec();
        head.extend(hash.to_le_bytes());
        head.extend(dt.to_le_bytes());
        let name = format!("{hash:032x}-{:016x}.{suffix}", dt.to_bits());
        let read = |bytes: &[u8]| {
            let mut rest = whole_file(bytes)?.strip_prefix(&head[..])?;
            let error = number(&mut rest)?;
            let numbers = (0..count).map(|_| number(&mut rest)).collect::<Option<_>>()?;
            rest.is_empty().then_some((error, numbers))
        };
        let bytes = |(error, numbers): &(f64, Vec<f64>)| {
            let numbers = core::iter::once(error).chain(numbers);
            with_checksum(head.iter().copied().chain(numbers.flat_map(|number| number.to_le_bytes())).collect())
        };
        kept(self.folder.as_ref().map(|folder| folder.join(name)), read, bytes, solve)
    }
}

/// What a file keeps, or else what is solved, which is kept then.
fn kept<T>(
    file: Option<PathBuf>,
    read: impl Fn(&[u8]) -> Option<T>,
    bytes: impl Fn(&T) -> Vec<u8>,
    solve: impl FnOnce() -> Result<T, LabError>,
) -> Result<T, LabError> {
    if let Some(known) = file.as_ref().and_then(|file| fs::read(file).ok()).and_then(|bytes| read(&bytes)) {
        return Ok(known);
    }
    let solved = solve()?;
    if let Some(file) = file {
        // Without it it is computed again: slower, and not wrong.
        let _ = write(&file, &bytes(&solved));
    }
    Ok(solved)
}

/// Writes a file beside its place and then moves it there, so that nobody ever reads half of it.
fn write(file: &std::path::Path, bytes: &[u8]) -> std::io::Result<()> {
    let folder = file.parent().unwrap_or(std::path::Path::new("."));
    fs::create_dir_all(folder)?;
    let mut temporary = tempfile::NamedTempFile::new_in(folder)?;
    temporary.write_all(bytes)?;
    temporary.persist(file)?;
    Ok(())
}

fn bytes(problem: &Problem, reference: &Reference) -> Vec<u8> {
    let mut bytes = HEAD.to_vec();
    bytes.extend(problem.hash().to_le_bytes());
    bytes.extend(reference.error.to_le_bytes());
    bytes.extend((reference.events.len() as u64).to_le_bytes());
    for event in &reference.events {
        bytes.extend((event.body as u64).to_le_bytes());
        bytes.extend(u64::from(event.particle.0).to_le_bytes());
        bytes.extend(event.time.to_le_bytes());
        bytes.extend(u64::from(event.slides).to_le_bytes());
    }
    for vector in reference.positions.iter().chain(&reference.velocities).flatten() {
        bytes.extend(vector.to_array().into_iter().flat_map(f64::to_le_bytes));
    }
    for energies in &reference.energies {
        bytes.extend(energies.all.iter().chain([&energies.scale]).flat_map(|energy| energy.to_le_bytes()));
    }
    with_checksum(bytes)
}

fn with_checksum(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.extend(checksum(&bytes).to_le_bytes());
    bytes
}

/// A file without its checksum, unless it is damaged.
fn whole_file(bytes: &[u8]) -> Option<&[u8]> {
    let (bytes, sum) = bytes.split_last_chunk::<16>()?;
    (checksum(bytes) == u128::from_le_bytes(*sum)).then_some(bytes)
}

fn checksum(bytes: &[u8]) -> u128 {
    let mut hash = Fnv::new();
    hash.bytes(bytes);
    hash.finish()
}

/// The reference in a file, unless something is wrong with it.
fn read(problem: &Problem, bytes: &[u8]) -> Option<Reference> {
    let mut rest = whole_file(bytes)?.strip_prefix(HEAD)?.strip_prefix(&problem.hash().to_le_bytes()[..])?;
    let error = number(&mut rest)?;
    let mut events = Vec::new();
    for _ in 0..whole(&mut rest)? {
        let body = whole(&mut rest)? as usize;
        let particle = ParticleId(u32::try_from(whole(&mut rest)?).ok()?);
        let (time, slides) = (number(&mut rest)?, whole(&mut rest)? != 0);
        events.push(StickSlip { body, particle, time, slides });
    }
    let samples = problem.times().len();
    let mut vectors = |count: usize| (0..count).map(|_| vector(&mut rest)).collect::<Option<Vec<_>>>();
    let sizes = problem.bodies.iter().map(|body| body.particles.len());
    let positions = sizes.clone().map(|size| vectors(samples * size)).collect::<Option<_>>()?;
    let velocities = sizes.map(&mut vectors).collect::<Option<_>>()?;
    let mut energies = || {
        let all = (0..samples).map(|_| number(&mut rest)).collect::<Option<_>>()?;
        Some(Energies { all, scale: number(&mut rest)? })
    };
    let energies = problem.bodies.iter().map(|_| energies()).collect::<Option<_>>()?;
    rest.is_empty().then_some(Reference { positions, velocities, energies, events, error })
}

fn word(rest: &mut &[u8]) -> Option<[u8; 8]> {
    let (word, others) = rest.split_first_chunk()?;
    *rest = others;
    Some(*word)
}

fn number(rest: &mut &[u8]) -> Option<f64> {
    word(rest).map(f64::from_le_bytes)
}

fn whole(rest: &mut &[u8]) -> Option<u64> {
    word(rest).map(u64::from_le_bytes)
}

fn vector(rest: &mut &[u8]) -> Option<DVec3> {
    Some(DVec3::new(number(rest)?, number(rest)?, number(rest)?))
}
